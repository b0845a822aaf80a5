#pragma once
// Entities and what they are made of. Every combination of parts is a table; adding or removing a part moves the
// entity's row to another one. See mobil/engine/archetype.h for the kinds of parts.
//
//   World world;
//   const auto mesh = world.share(std::make_shared<const Mesh>(…));
//   const Entity muscle = world.create(BellyScale<float>{1, 1}, FieldWidth<NodalVelocity>{243}, mesh);
//   world.add(muscle, EndDrive<float>{0, 1});  // Status::ok
//   world.get<EndDrive>(muscle)->to;           // 1
//   world.add(muscle, TagValue<Substeps>{5});  // moves to the table of those with five
//   world.remove<NodalVelocity>(muscle);       // and on to the table of those without velocities
//   world.destroy(muscle);                     // from here on everything answers Status::stale_entity
//
// Structure changes between ticks, by one thread; systems (mobil/schedule.h) change values only.

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

/// Where an entity lies; `table` is null for a stale one. Good until the next change of structure.
template <class T>
struct Place {
  T* table = nullptr;
  std::uint32_t row = 0;

  explicit operator bool() const { return table != nullptr; }
};

class World {
 public:
  /// All tables and registers take their memory from `memory`, which must outlive the world.
  explicit World(std::pmr::memory_resource* memory = std::pmr::get_default_resource());
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// An entity of these parts: component rows (their first values), FieldWidth (zeros), TagValue, Shared; each type
  /// once.
  template <class... P>
  Entity create(const P&... parts);
  Status destroy(Entity entity);
  /// Makes an entity consist of just these parts: component rows are written, fields of the same width keep their
  /// values, other ones begin with zeros.
  template <class... P>
  Status remake(Entity entity, const P&... parts);
  /// The same from lists put together at run time; each type once.
  Entity create_from(std::span<const PartValue> parts);
  Status remake_from(Entity entity, std::span<const PartValue> parts);
  /// The same for some of its parts: of those that `owned` names (ids, sorted) it has just `parts` afterwards, all
  /// others stay with their values.
  Status remake_from(Entity entity, std::span<const PartValue> parts, std::span<const std::uint64_t> owned);
  /// Many entities of the same parts. A row's values come in blocks of sixteen lanes: that of word w of the entity that
  /// is number i at [(i / 16 · words + w) · 16 + i % 16]; null is zeros. The same entities as one by one, in
  /// `entities`. Where memory runs out, the world is unchanged.
  void create_many(std::span<const PartValue> parts, std::span<Entity> entities, const Jobs& jobs = {});
  /// As the last remake_from, of many entities of one table, alive, each named once, which move to another table: the
  /// values of `parts` are as in create_many, but parts that they have already keep their own.
  void change_archetype(std::span<const Entity> entities, std::span<const PartValue> parts,
                        std::span<const std::uint64_t> owned, const Jobs& jobs = {});
  /// While one lives, what create_many and change_archetype do, and what becomes of entities remade, can be undone,
  /// and is at its end unless it was kept: rows and handles are those of before, also handles given out later. Undoing
  /// and keeping take no memory. Until then the old rows of who was remade stay in their tables: nobody goes over
  /// tables, nobody is destroyed, and in a table that others left nobody is created, or leaves but by change_archetype.
  /// One within another is part of it: what the inner one kept is undone with the outer one.
  class Transaction {
   public:
    explicit Transaction(World& world, const Jobs& jobs = {});
    ~Transaction();
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    /// What was done stays.
    void commit();

   private:
    World& world_;
    Jobs jobs_;
    std::size_t created_, moved_;  // in the journal as this one began
    bool outer_, kept_ = false;
  };
  /// All or none: where one of them is stale or named twice, Status::stale_entity. Each row that stays moves once at
  /// most; in which order rows then lie is not that of one by one. Takes memory until it returns; where there is none,
  /// they go one by one.
  Status destroy_many(std::span<const Entity> entities, const Jobs& jobs = {});
  /// Whether all of them are alive, each named once. Takes no memory.
  bool alive_once(std::span<const Entity> entities);
  /// The entities created last, in the order of their creation, are as if they had never been: handles given out
  /// afterwards are the same. Takes no memory.
  void undo_create(std::span<const Entity> entities);
  /// Room for what `remake_from` with the same arguments makes of that entity, and of others like it: `rows` in all.
  /// It then takes no memory.
  void reserve_remade(Entity entity, std::span<const PartValue> parts, std::span<const std::uint64_t> owned,
                      std::uint32_t rows);
  /// Room for so many more entities of any parts.
  void reserve_entities(std::size_t more) {
    entities_.reserve(more);
    if (owner_part_ != 0) members_.reserve(entities_.size() + more);
  }
  /// Several parts more at once, those of them that are not there.
  Status add_parts(Entity entity, std::span<const PartValue> parts);
  /// Several parts less at once, those of them that are there.
  Status remove_parts(Entity entity, std::initializer_list<std::uint64_t> ids);
  bool alive(Entity entity) const { return entities_.alive(entity); }

  /// One more part. Values of the others are kept.
  template <class P>
  Status add(Entity entity, const P& part);
  /// Another value for a component or tag that is there.
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
  /// One part less: a component by its template (`remove<Pose>`), a field or tag by its type.
  template <template <class> class C>
  Status remove(Entity entity) {
    return remove_part(entity, type_id<C<float>>());
  }
  template <class Tag>
  Status remove(Entity entity) {
    static_assert(!is_row<Tag>, "name the component without its number type: remove<Pose>(entity)");
    return remove_part(entity, type_id<Tag>());
  }

  /// Whether the entity is alive and has that part.
  template <template <class> class C>
  bool has(Entity entity) const {
    return part_of(entity, type_id<C<float>>()).has_value();
  }
  template <class Tag>
  bool has(Entity entity) const {
    static_assert(!is_row<Tag>, "name the component without its number type: has<Pose>(entity)");
    return part_of(entity, type_id<Tag>()).has_value();
  }
  /// An entity's row of a component.
  template <template <class> class C>
  tl::expected<C<float>, Status> get(Entity entity) const {
    tl::expected<C<float>, Status> row{tl::in_place};
    if (const Status status = read(entity, *row); status != Status::ok) return tl::unexpected(status);
    return row;
  }
  /// The same into a row that is there.
  template <template <class> class C>
  Status read(Entity entity, C<float>& row) const;
  /// The value of an entity's tag; of a field, its words a row.
  template <class Tag>
  tl::expected<std::uint64_t, Status> get(Entity entity) const {
    static_assert(!is_row<Tag>, "name the component without its number type: get<Pose>(entity)");
    return part_of(entity, type_id<Tag>()).map([](const ComponentId& part) { return part.value; });
  }
  /// An entity's shared resource, null when stale or missing.
  template <class T>
  const T* shared(Entity entity) const {
    const auto part = part_of(entity, type_id<T>());
    return part ? static_cast<const T*>(resource(part->value)) : nullptr;
  }
  /// All of one entity's floats of a field; the span is exactly as long as the field is wide.
  template <class Tag>
  Status get_field(Entity entity, std::span<float> out) const {
    return read_field(entity, type_id<Tag>(), out);
  }
  template <class Tag>
  Status set_field(Entity entity, std::span<const float> in) {
    return write_field(entity, type_id<Tag>(), in);
  }

  /// The component whose first two words are the index and generation of the entity that a row belongs to: said once,
  /// while the world is empty. An entity whose row names a alive owner is among its members from then on, until one of
  /// them is gone or the row names another; systems must not write it.
  void set_owner_part(const ComponentId& part) { owner_part_ = part.id; }
  std::uint64_t owner_part() const { return owner_part_; }
  /// Calls `f(member)` for each entity that belongs to `owner`, in ascending order of their indices. `f` changes
  /// nothing.
  template <class F>
  void each_member(Entity owner, F&& f) const {
    if (!alive(owner)) return;
    for (std::uint32_t m = members_.first(owner.index); m != Members::nobody; m = members_.next(m)) f(entities_.at(m));
  }
  /// The first of those, a stale handle where there is none.
  Entity first_member(Entity owner) const {
    return alive(owner) ? entities_.at(members_.first(owner.index)) : Entity{};
  }
  /// A stale handle where it belongs to nobody alive.
  Entity owner_of(Entity member) const { return alive(member) ? entities_.at(members_.owner(member.index)) : Entity{}; }

  /// Takes a share in an immutable resource until the world ends. The same resource gives the same handle again.
  /// `content`: a hash of it, where it is part of the state of rows that share it.
  template <class T>
  Shared<T> share(std::shared_ptr<const T> resource, std::uint64_t content = 0) {
    const T* raw = resource.get();
    return {raw, own(std::move(resource), content)};
  }
  /// The same of a resource whose type is known as a part alone: component_id(Shared<T>{}).
  ComponentId share_as(ComponentId part, std::shared_ptr<const void> resource) {
    part.value = own(std::move(resource), 0);
    return part;
  }
  /// The resource of that index, null when there is none.
  const void* resource(std::uint64_t index) const {
    return index < resources_.size() ? resources_[index].get() : nullptr;
  }
  std::uint64_t resource_count() const { return resources_.size(); }
  std::uint64_t resource_content(std::uint64_t index) const { return resource_content_[index]; }

  /// The value of a type that a module names as a global (mobil/engine/globals.h), or that `globals().add` was given.
  /// Throws std::logic_error, which names the type, where nobody named it.
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

  /// The number of its table among `tables()`, and its row; null when stale. Until the next change of structure.
  const EntityRegister::Location* locate(Entity entity) const { return entities_.find(entity); }
  /// Fetches what `locate` reads.
  void fetch(Entity entity) const { entities_.fetch(entity); }
  Place<Table> find(Entity entity);
  Place<const Table> find(Entity entity) const;
  /// In the order of their creation, empty ones too; a table lives and stays put as long as the world.
  std::pmr::deque<Table>& tables() { return tables_; }
  const std::pmr::deque<Table>& tables() const { return tables_; }

  /// Tells worlds apart even when one is made at the address of another that is gone.
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
  static void write_part(Place<Table>, const T&) {}  // no part: component_id says so
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
  Archetype scratch_;  // the key being put together, kept for its memory
  struct Moves {      // rows that are to take others' places, by table; kept for the same reason
    std::pmr::vector<std::uint32_t> table;
    std::pmr::vector<RowMove> move;
  };
  Moves moves_;
  std::pmr::vector<RowAt> going_;
  struct Journal {  // of an Transaction
    bool open = false;
    std::pmr::vector<RowAt> left;    // rows that entities were remade from
    std::pmr::vector<Entity> moved;  // whose those are
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
