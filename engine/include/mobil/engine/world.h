#pragma once
// Entities and their parts. Each combination of parts is a table. Adding or removing a part moves the entity's row to
// another table. mobil/engine/archetype.h has the kinds of parts.
//
//   World world;
//   const auto mesh = world.share(std::make_shared<const Mesh>(…));
//   const Entity muscle = world.create(BellyScale<float>{1, 1}, FieldWidth<NodalVelocity>{243}, mesh);
//   world.add(muscle, EndDrive<float>{0, 1});  // Status::ok
//   world.get<EndDrive>(muscle)->to;           // 1
//   world.add(muscle, TagValue<Substeps>{5});  // moves to the table of those with five
//   world.remove<NodalVelocity>(muscle);       // and on to the table of those without velocities
//   world.destroy(muscle);                     // from here on every call returns Status::stale_entity
//
// The structure changes only between ticks, on one thread; systems (mobil/schedule.h) change only values.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <initializer_list>
#include <memory>
#include <memory_resource>
#include <new>
#include <span>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include <mobil/engine/archetype.h>
#include <mobil/engine/entity.h>
#include <mobil/engine/globals.h>
#include <mobil/engine/jobs.h>
#include <mobil/engine/members.h>
#include <mobil/engine/table.h>

namespace mobil::inline v0_3 {

/// Table and row of an entity; `table` is null for a stale one. Valid until the next change of structure.
template <class T>
struct Place {
  T* table = nullptr;
  std::uint32_t row = 0;

  explicit operator bool() const { return table != nullptr; }
};

class World {
 public:
  /// All tables and registers allocate from `memory`, which must outlive the world.
  explicit World(std::pmr::memory_resource* memory = std::pmr::get_default_resource());
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// Creates an entity of these parts: component rows (their first values), FieldWidth (zeros), TagValue, Shared; each
  /// type once.
  template <class... P>
  Entity create(const P&... parts);
  Status destroy(Entity entity);
  /// Replaces an entity's parts by exactly these. Component rows are written, fields of the same width keep their
  /// values, other fields begin with zeros.
  template <class... P>
  Status remake(Entity entity, const P&... parts);
  /// `create` and `remake` with lists built at run time; each type once.
  Entity create_from(std::span<const PartValue> parts);
  Status remake_from(Entity entity, std::span<const PartValue> parts);
  /// Replaces some parts of an entity: afterwards it has exactly `parts` among those in `owned` (ids, sorted). Other
  /// parts stay, with their values.
  Status remake_from(Entity entity, std::span<const PartValue> parts, std::span<const std::uint64_t> owned);
  /// Creates many entities of the same parts. Values are in blocks of sixteen lanes, null for zeros: word w of entity i
  /// at [(i / 16 · words + w) · 16 + i % 16]. `entities` receives the same handles as from single calls. If memory runs
  /// out, the world is unchanged.
  void create_many(std::span<const PartValue> parts, std::span<Entity> entities, const Jobs& jobs = {});
  /// Replaces some parts of many entities, like the last remake_from. The entities are alive, each named once, of one
  /// table, and move to another. Values are laid out as in create_many; parts that exist already keep theirs.
  void change_archetype(std::span<const Entity> entities, std::span<const PartValue> parts,
                        std::span<const std::uint64_t> owned, const Jobs& jobs = {});
  /// Scope that undoes create_many, change_archetype, and later changes of the moved entities, unless committed. Rows
  /// and handles are then as before, including handles given out later. Undoing and committing do not allocate. Until
  /// the transaction ends, old rows stay in place: do not iterate tables or destroy entities. In a table that entities
  /// left, do not create entities, and move others only by change_archetype. A nested transaction is part of the outer
  /// one, which can undo what the inner one committed.
  class Transaction {
   public:
    explicit Transaction(World& world, const Jobs& jobs = {});
    ~Transaction();
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    /// Makes the changes permanent.
    void commit();

   private:
    World& world_;
    Jobs jobs_;
    std::size_t created_, moved_;  // in the journal at the start of this one
    bool outer_, kept_ = false;
  };
  /// Destroys all or none: returns Status::stale_entity if one is stale or named twice. Each remaining row moves at
  /// most once; the resulting order of rows differs from that of single calls. Allocates until it returns; if memory
  /// runs out, entities are destroyed one by one.
  Status destroy_many(std::span<const Entity> entities, const Jobs& jobs = {});
  /// Returns true if all are alive and each is named once. Does not allocate.
  bool alive_once(std::span<const Entity> entities);
  /// Undoes the creation of the entities created last, given in order of creation; later handles are the same as
  /// without them. Does not allocate.
  void undo_create(std::span<const Entity> entities);
  /// Makes room for the row that `remake_from` with these arguments gives this entity, and for others like it: `rows`
  /// in total. `remake_from` then does not allocate.
  void reserve_remade(Entity entity, std::span<const PartValue> parts, std::span<const std::uint64_t> owned,
                      std::uint32_t rows);
  /// Makes room for `more` entities of any parts.
  void reserve_entities(std::size_t more) {
    entities_.reserve(more);
    if (owner_part_ != 0) members_.reserve(entities_.size() + more);
  }
  /// Adds several parts at once; existing ones are skipped.
  Status add_parts(Entity entity, std::span<const PartValue> parts);
  /// Removes several parts at once; missing ones are skipped.
  Status remove_parts(Entity entity, std::initializer_list<std::uint64_t> ids);
  bool alive(Entity entity) const { return entities_.alive(entity); }

  /// Adds a part; the values of the others are kept.
  template <class P>
  Status add(Entity entity, const P& part);
  /// Sets the value of an existing component or tag.
  template <template <class> class C>
  Status set(Entity entity, const C<float>& row);
  template <class Tag>
  Status set(Entity entity, const TagValue<Tag>& tag) {
    return replace_tag(entity, component_id(tag));
  }
  template <class T>
  Status set(Entity entity, const Shared<T>& shared) {
    return replace_tag(entity, component_id(shared));
  }
  /// Removes a part: a component by its template (`remove<Pose>`), a field or tag by its type.
  template <template <class> class C>
  Status remove(Entity entity) {
    return remove_part(entity, type_id<C<float>>());
  }
  template <class Tag>
  Status remove(Entity entity) {
    static_assert(!is_row<Tag>, "name the component without its number type: remove<Pose>(entity)");
    return remove_part(entity, type_id<Tag>());
  }

  /// Returns true if the entity is alive and has that part.
  template <template <class> class C>
  bool has(Entity entity) const {
    return part_of(entity, type_id<C<float>>()).has_value();
  }
  template <class Tag>
  bool has(Entity entity) const {
    static_assert(!is_row<Tag>, "name the component without its number type: has<Pose>(entity)");
    return part_of(entity, type_id<Tag>()).has_value();
  }
  /// Returns an entity's row of a component.
  template <template <class> class C>
  tl::expected<C<float>, Status> get(Entity entity) const {
    tl::expected<C<float>, Status> row{tl::in_place};
    if (const Status status = read(entity, *row); status != Status::ok) return tl::unexpected(status);
    return row;
  }
  /// Reads an entity's row of a component into `row`.
  template <template <class> class C>
  Status read(Entity entity, C<float>& row) const;
  /// Returns the value of an entity's tag, or a field's number of words a row.
  template <class Tag>
  tl::expected<std::uint64_t, Status> get(Entity entity) const {
    static_assert(!is_row<Tag>, "name the component without its number type: get<Pose>(entity)");
    return part_of(entity, type_id<Tag>()).map([](const ComponentId& part) { return part.value; });
  }
  /// Returns an entity's shared resource, or null if stale or missing.
  template <class T>
  const T* shared(Entity entity) const {
    const auto part = part_of(entity, type_id<T>());
    return part ? static_cast<const T*>(resource(part->value)) : nullptr;
  }
  /// Reads or writes all of one entity's floats of a field; the span must have exactly the field's width.
  template <class Tag>
  Status get_field(Entity entity, std::span<float> out) const {
    return read_field(entity, type_id<Tag>(), out);
  }
  template <class Tag>
  Status set_field(Entity entity, std::span<const float> in) {
    return write_field(entity, type_id<Tag>(), in);
  }

  /// Sets the component whose first two words are the index and generation of a row's owner. Call it once, while the
  /// world is empty. An entity whose row names an alive owner is one of its members, until one of them is destroyed or
  /// the row names another. Systems must not write that component.
  void set_owner_part(const ComponentId& part) { owner_part_ = part.id; }
  std::uint64_t owner_part() const { return owner_part_; }
  /// Calls `f(member)` for each member of `owner`, in ascending order of indices. `f` must not change the structure.
  template <class F>
  void each_member(Entity owner, F&& f) const {
    if (!alive(owner)) return;
    for (std::uint32_t m = members_.first(owner.index); m != Members::nobody; m = members_.next(m)) f(entities_.at(m));
  }
  /// Returns the first member, or a stale handle.
  Entity first_member(Entity owner) const {
    return alive(owner) ? entities_.at(members_.first(owner.index)) : Entity{};
  }
  /// Returns the alive owner of a member, or a stale handle.
  Entity owner_of(Entity member) const { return alive(member) ? entities_.at(members_.owner(member.index)) : Entity{}; }

  /// Shares ownership of an immutable resource until the world ends. A resource always has one handle.
  /// `content`: a hash of it, if it is part of the state of its rows.
  template <class T>
  Shared<T> share(std::shared_ptr<const T> resource, std::uint64_t content = 0) {
    const T* raw = resource.get();
    return {raw, own(std::move(resource), content)};
  }
  /// Shares a resource whose type is given as a part: component_id(Shared<T>{}).
  ComponentId share_as(ComponentId part, std::shared_ptr<const void> resource) {
    part.value = own(std::move(resource), 0);
    return part;
  }
  /// Returns the resource with that index, or null.
  const void* resource(std::uint64_t index) const {
    return index < resources_.size() ? resources_[index].get() : nullptr;
  }
  std::uint64_t resource_count() const { return resources_.size(); }
  std::uint64_t resource_content(std::uint64_t index) const { return resource_content_[index]; }

  /// Returns the value of a type that a module declares as a global (mobil/engine/globals.h), or that was passed to
  /// `globals().add`. Throws std::logic_error, with the type's name, for other types.
  template <class T>
  T& global() {
    return *std::launder(reinterpret_cast<T*>(globals_.at(type_id<T>(), type_name<T>())));
  }
  template <class T>
  const T& global() const {
    return *std::launder(reinterpret_cast<const T*>(globals_.at(type_id<T>(), type_name<T>())));
  }
  Globals& globals() { return globals_; }
  const Globals& globals() const { return globals_; }

  /// Returns the index of an entity's table in `tables()` and its row, or null if stale. Valid until the structure
  /// changes.
  const EntityRegister::Location* locate(Entity entity) const { return entities_.find(entity); }
  /// Prefetches the memory that `locate` reads.
  void fetch(Entity entity) const { entities_.fetch(entity); }
  Place<Table> find(Entity entity);
  Place<const Table> find(Entity entity) const;
  /// Returns all tables in order of creation, including empty ones. Tables never move or end before the world.
  std::pmr::deque<Table>& tables() { return tables_; }
  const std::pmr::deque<Table>& tables() const { return tables_; }

  /// Returns a value that differs for every world, even if one is created at the address of a destroyed one.
  const std::shared_ptr<const char>& identity() const { return identity_; }

 private:
  friend class WorldSnapshot;  // engine/snapshot.h

  struct RowAt {
    std::uint32_t table, row;
    bool operator<(const RowAt& other) const { return table != other.table ? table < other.table : row < other.row; }
  };

  Place<Table> create_row(const Archetype& key, Entity& entity);
  std::uint32_t add_rows(std::uint32_t table, std::span<const PartValue> parts, std::uint32_t count, const Jobs& jobs);
  void erase_row(const EntityRegister::Location& at);
  void remove_rows(std::pmr::vector<RowAt>& gone, const Jobs& jobs);
  void destroy_together(std::span<const Entity> entities, const Jobs& jobs);
  Status add_part(Entity entity, const ComponentId& part);
  Status remove_part(Entity entity, std::uint64_t id);
  Status replace_tag(Entity entity, const ComponentId& tag);
  void move(Entity entity, const Archetype& key);
  std::uint32_t table_of(const Archetype& key);
  tl::expected<ComponentId, Status> part_of(Entity entity, std::uint64_t id) const;
  Status read_field(Entity entity, std::uint64_t id, std::span<float> out) const;
  Status write_field(Entity entity, std::uint64_t id, std::span<const float> in);
  std::uint64_t own(std::shared_ptr<const void> resource, std::uint64_t content);
  void relate(Entity entity);
  void forget(Entity entity);
  void key_from(std::span<const PartValue> parts);
  void key_remade(Entity entity, std::span<const PartValue> parts, std::span<const std::uint64_t> owned);
  void write_from(Place<Table> place, std::span<const PartValue> parts);

  template <class T>
  static void write_part(Place<Table>, const T&) {}  // component_id rejects it
  template <template <class> class C>
  static void write_part(Place<Table> place, const C<float>& row) {
    place.table->write(place.row, place.table->column(type_id<C<float>>()), ComponentLayout<C>::words, &row);
  }
  template <class Tag>
  static void write_part(Place<Table>, const FieldWidth<Tag>&) {}
  template <class Tag>
  static void write_part(Place<Table>, const TagValue<Tag>&) {}
  template <class T>
  static void write_part(Place<Table>, const Shared<T>&) {}
  template <class T>
  static void write_part(Place<Table>, const Publishes<T>&) {}

  std::pmr::memory_resource* memory_;
  EntityRegister entities_;
  std::pmr::deque<Table> tables_;
  std::pmr::vector<std::uint64_t> table_hash_;  // of their keys
  std::pmr::vector<std::shared_ptr<const void>> resources_;
  std::pmr::vector<std::uint64_t> resource_content_;
  Globals globals_;
  Members members_;
  std::uint64_t owner_part_ = 0;
  Archetype scratch_;  // the key under construction, kept for its memory
  struct Moves {      // rows that replace others, by table; kept for the same reason
    std::pmr::vector<std::uint32_t> table;
    std::pmr::vector<RowMove> move;
  };
  Moves moves_;
  std::pmr::vector<RowAt> going_;
  struct Journal {  // of a Transaction
    bool open = false;
    std::pmr::vector<RowAt> left;    // rows from which entities moved
    std::pmr::vector<Entity> moved;  // their entities
    std::pmr::vector<Entity> created;
  };
  Journal journal_;
  std::shared_ptr<const char> identity_;
};

template <class... P>
Entity World::create(const P&... parts) {
  static_assert(distinct({part_id<P>...}), "each component, field and tag once");
  scratch_.clear();
  (insert_component(scratch_, component_id(parts)), ...);
  Entity entity;
  [[maybe_unused]] const Place<Table> place = create_row(scratch_, entity);
  (write_part(place, parts), ...);
  relate(entity);
  return entity;
}

template <class... P>
Status World::remake(Entity entity, const P&... parts) {
  static_assert(distinct({part_id<P>...}), "each component, field and tag once");
  if (!alive(entity)) return Status::stale_entity;
  scratch_.clear();
  (insert_component(scratch_, component_id(parts)), ...);
  if (!(scratch_ == find(entity).table->key())) move(entity, scratch_);
  [[maybe_unused]] const Place<Table> place = find(entity);
  (write_part(place, parts), ...);
  relate(entity);
  return Status::ok;
}

template <class P>
Status World::add(Entity entity, const P& part) {
  const Status status = add_part(entity, component_id(part));
  if (status != Status::ok) return status;
  write_part(find(entity), part);
  relate(entity);
  return status;
}

template <template <class> class C>
Status World::set(Entity entity, const C<float>& row) {
  const auto part = part_of(entity, type_id<C<float>>());
  if (!part) return part.error();
  write_part(find(entity), row);
  if (part->id == owner_part_) relate(entity);
  return Status::ok;
}

template <template <class> class C>
Status World::read(Entity entity, C<float>& row) const {
  const auto part = part_of(entity, type_id<C<float>>());
  if (!part) return part.error();
  const auto place = find(entity);
  place.table->read(place.row, place.table->column(part->id), ComponentLayout<C>::words, &row);
  return Status::ok;
}

}  // namespace mobil::inline v0_3
