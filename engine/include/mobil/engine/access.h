#pragma once
// Parameters of systems. The scheduler derives accesses from a system's signature.
//
//   const C<Lanes<float>>&   reads this block's component;          C<Lanes<float>>&   writes it (and can read it);
//   Field<const Tag>         reads this block's field;              Field<Tag>         writes it (and can read it);
//   Maybe<C>                 reads this block's component if the table has it; MaybeField<const Tag> a field;
//                            MaybeField<Tag> writes it (and can read it);
//   Ahead<C>                 the component of the next blocks, for prefetching what it refers to;
//   Later<Tag>               this block's field that a later system works on, for prefetching it;
//   Previous<C>              reads the component as it was before this tick's writers;
//   Lookup<C>                reads the component of other entities, this tick's;
//   Published<T>             writes what the block's rows publish; LookupPublished<T> reads it;
//   TagValue<Tag>, Shared<T> the table's tag or shared resource;
//   Scratch<Tag>             scratch memory, as many floats as the table's tag specifies;
//   Tally<Tag>               adds to a count of the tick, which is not state (Schedule::tally); one a system;
//   Tick, float              the tick; a plain float is its length in s;
//   Rows                     the entities of the block's lanes;
//   const Table&             the block's table: number of rows, parts; results must not depend on it.
//
// A system runs on every block of every table that has all named components, fields and tags (except Maybe, Later,
// Scratch and Tally).

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include <mobil/engine/archetype.h>
#include <mobil/engine/clock.h>
#include <mobil/engine/world.h>

namespace mobil::inline v0_3 {

/// The lanes of one block: sixteen entities. The first `live` are rows, the rest parked copies of the first.
struct Rows {
  const Entity* entity;
  std::uint32_t live;
};

/// A field of one block: word w of lane l at data[16·w + l], 64-byte aligned.
template <class Tag>
struct Field {
  std::conditional_t<std::is_const_v<Tag>, const float*, float*> data;
  std::uint32_t words;
  const float* next;  // the next block's, to prefetch but not read; null at the last block
};

/// A component as it was before this tick; the system runs before all writers.
template <template <class> class C>
struct Previous {
  const C<Lanes<float>>* block;

  const C<Lanes<float>>& operator*() const { return *block; }
  const C<Lanes<float>>* operator->() const { return block; }
};

/// A component of the table's next blocks, with values of an earlier tick. It lets a system predict and prefetch what
/// it will need. Null past the last block.
template <template <class> class C>
struct Ahead {
  const C<Lanes<float>>*block, *second, *third;
};

/// A field of this block that a later system works on, to prefetch but not read; null if missing.
template <class Tag>
struct Later {
  const float* data;
  std::uint32_t words;
};

/// A component that some tables lack; null if missing.
template <template <class> class C>
struct Maybe {
  const C<Lanes<float>>* block;
};

/// A field that some tables lack; null if missing.
template <class Tag>
struct MaybeField {
  std::conditional_t<std::is_const_v<Tag>, const float*, float*> data;
};

/// Scratch memory for this block until the system returns, 64-byte aligned, uninitialised. It has as many floats as the
/// table's TagValue<Tag>; null if that is 0 or missing.
template <class Tag>
struct Scratch {
  float* data;
  std::size_t floats;
};

/// A count that systems add to and the schedule keeps, for rare events that must be reported and are not state. Sums
/// are integers, and therefore independent of the order of blocks.
template <class Tag>
class Tally {
 public:
  explicit Tally(std::atomic<std::uint64_t>* sum) : sum_(sum) {}

  /// Adds to the count; callable from any thread.
  void add(std::uint64_t count) const {
    if (count > 0) sum_->fetch_add(count, std::memory_order_relaxed);
  }

 private:
  std::atomic<std::uint64_t>* sum_;
};

/// Finds a column in any entity's row.
class ColumnLookup {
 public:
  /// An entity's row of the column: word w at column[16·w + lane].
  struct Found {
    const float* column = nullptr;  // null when the entity is stale or has no such column
    std::uint32_t lane = 0;
  };

  ColumnLookup(const World& world, std::uint64_t id) : world_(&world), id_(id) {}
  /// Prefetches the memory that `find` reads first.
  void fetch(Entity entity) const { world_->fetch(entity); }
  /// Returns null for a stale entity or a table without the column.
  Found find(Entity entity) const {
    const auto* const at = world_->locate(entity);
    if (at == nullptr) return {};
    Seen& seen = seen_[at->table % seen_count];
    if (seen.number != at->table) {
      const Table& table = world_->tables()[at->table];
      seen = {at->table, table.column(id_), &table};
    }
    if (seen.first_word == Table::no_column) return {};
    return {seen.table->block(at->row / lane_count) + seen.first_word * lane_count,
            static_cast<std::uint32_t>(at->row % lane_count)};
  }

 private:
  static constexpr std::size_t seen_count = 4;  // successive lookups are in few tables
  struct Seen {
    std::uint32_t number = ~0U, first_word = Table::no_column;
    const Table* table = nullptr;
  };

  const World* world_;
  std::uint64_t id_;
  mutable Seen seen_[seen_count];
};

/// Rows of component C of any entity.
template <template <class> class C>
class Lookup {
 public:
  explicit Lookup(const World& world) : columns_(world, type_id<C<float>>()) {}

  /// Returns word 0 of that entity's row; word w is at offset 16·w. Null if the entity is stale or lacks the component.
  const float* find(Entity entity) const {
    const auto [column, lane] = columns_.find(entity);
    return column == nullptr ? nullptr : column + lane;
  }

 private:
  ColumnLookup columns_;
};

/// Published structs of a block's sixteen rows; the system must write all of them.
template <class T>
struct Published {
  T* row;
};

/// Published structs of any entity in this tick.
template <class T>
class LookupPublished {
 public:
  explicit LookupPublished(const World& world) : columns_(world, type_id<T>()) {}

  /// Prefetches the memory that `find` reads first.
  void fetch(Entity entity) const { columns_.fetch(entity); }

  /// Returns null if the entity is stale or does not publish T.
  const T* find(Entity entity) const {
    const auto [column, lane] = columns_.find(entity);
    return column == nullptr ? nullptr : reinterpret_cast<const T*>(column) + lane;
  }

 private:
  ColumnLookup columns_;
};

/// A function's or a lambda's parameters.
template <class... P>
struct Parameters {};
template <class F>
struct Signature : Signature<decltype(&F::operator())> {};
template <class R, class... P>
struct Signature<R (*)(P...)> : Parameters<P...> {};
template <class R, class... P>
struct Signature<R (*)(P...) noexcept> : Parameters<P...> {};
template <class R, class F, class... P>
struct Signature<R (F::*)(P...) const> : Parameters<P...> {};
template <class R, class F, class... P>
struct Signature<R (F::*)(P...) const noexcept> : Parameters<P...> {};
template <class R, class F, class... P>
struct Signature<R (F::*)(P...)> : Parameters<P...> {};

/// Access of one parameter to a component or field (`none`: irrelevant to the order).
struct Access {
  enum class Mode : std::uint8_t { none, read, write, previous, lookup };

  Mode mode = Mode::none;
  std::uint64_t id = 0;
  std::string_view name;
};

/// A parameter bound to one table.
struct Bound {
  std::uint32_t first_word = 0;
  std::uint32_t words = 0;
  std::uint64_t tag = 0;
  const void* resource = nullptr;
  std::size_t scratch_floats = 0;
};

/// One block of a system's call.
struct BlockView {
  const World& world;
  Table& table;
  std::size_t block;
  Tick tick;
  float* scratch = nullptr;
  std::atomic<std::uint64_t>* tally = nullptr;  // the system's
};

/// Traits of a parameter of type P: its access (`access`), binding to a table (`bind`, false if the table lacks the
/// part), and construction for a block (`make`).
template <class P>
struct Parameter;

template <class P>
struct Parameter<const P&> : Parameter<P> {};

/// Parameters that any table can provide.
struct AnywhereParameter {
  static constexpr Access access() { return {}; }
  static bool bind(const World&, const Table&, Bound&) { return true; }
};

/// Rejects types that are not parameters.
template <class P>
struct Parameter : AnywhereParameter {
  static_assert(!std::is_same_v<P, P>,
                "a system takes blocks of sixteen: `const Pose<Lanes<float>>&` to read, `Pose<Lanes<float>>&` to write,"
                " or what else mobil/engine/access.h names; not a row, not a copy");
  static P make(const BlockView&, const Bound&);
};

/// Binding of a component or field: its access, and its place in a block.
template <Access::Mode mode, class T>
struct ColumnParameter {
  static constexpr Access access() { return {mode, type_id<T>(), type_name<T>()}; }
  static bool bind(const World&, const Table& table, Bound& bound) {
    const ComponentId* part = find_component(table.key(), type_id<T>());
    if (part == nullptr || !has_column(part->kind)) return false;
    bound.first_word = table.column(part->id);
    bound.words = static_cast<std::uint32_t>(part->value);
    return true;
  }
  static float* data(const BlockView& view, const Bound& bound) {
    return view.table.block(view.block) + bound.first_word * lane_count;
  }
};

/// Binding of a tag or shared resource.
template <class T>
struct TagParameter {
  static constexpr Access access() { return {}; }
  static bool bind(const World& world, const Table& table, Bound& bound) {
    const ComponentId* part = find_component(table.key(), type_id<T>());
    if (part == nullptr || has_column(part->kind)) return false;
    bound.tag = part->value;
    bound.resource = world.resource(part->value);
    return true;
  }
};

template <template <class> class C>
struct Parameter<C<Lanes<float>>&> : ColumnParameter<Access::Mode::write, C<float>> {
  static C<Lanes<float>>& make(const BlockView& view, const Bound& bound) {
    static_assert(ComponentLayout<C>::words > 0);
    return *reinterpret_cast<C<Lanes<float>>*>(Parameter::data(view, bound));
  }
};

template <template <class> class C>
struct Parameter<const C<Lanes<float>>&> : ColumnParameter<Access::Mode::read, C<float>> {
  static const C<Lanes<float>>& make(const BlockView& view, const Bound& bound) {
    return Parameter<C<Lanes<float>>&>::make(view, bound);
  }
};

template <template <class> class C>
struct Parameter<Maybe<C>> : ColumnParameter<Access::Mode::read, C<float>> {
  static bool bind(const World& world, const Table& table, Bound& bound) {
    if (!Parameter<const C<Lanes<float>>&>::bind(world, table, bound)) bound.words = 0;
    return true;
  }
  static Maybe<C> make(const BlockView& view, const Bound& bound) {
    return {bound.words == 0 ? nullptr : &Parameter<const C<Lanes<float>>&>::make(view, bound)};
  }
};

template <template <class> class C>
struct Parameter<Previous<C>> : ColumnParameter<Access::Mode::previous, C<float>> {
  static Previous<C> make(const BlockView& view, const Bound& bound) {
    return {&Parameter<C<Lanes<float>>&>::make(view, bound)};
  }
};

template <class Tag>
struct Parameter<Field<Tag>>
    : ColumnParameter<std::is_const_v<Tag> ? Access::Mode::read : Access::Mode::write, std::remove_const_t<Tag>> {
  static Field<Tag> make(const BlockView& view, const Bound& bound) {
    const bool last = view.block + 1 >= view.table.block_count();
    return {Parameter::data(view, bound), bound.words,
            last ? nullptr : view.table.block(view.block + 1) + bound.first_word * lane_count};
  }
};

template <template <class> class C>
struct Parameter<Ahead<C>> : AnywhereParameter {
  static bool bind(const World& world, const Table& table, Bound& bound) {
    return Parameter<const C<Lanes<float>>&>::bind(world, table, bound);
  }
  static Ahead<C> make(const BlockView& view, const Bound& bound) {
    const auto next = [&](std::size_t by) -> const C<Lanes<float>>* {
      if (view.block + by >= view.table.block_count()) return nullptr;
      return reinterpret_cast<const C<Lanes<float>>*>(view.table.block(view.block + by) +
                                                      bound.first_word * lane_count);
    };
    return {next(1), next(2), next(3)};
  }
};

template <class Tag>
struct Parameter<Later<Tag>> : AnywhereParameter {
  static bool bind(const World& world, const Table& table, Bound& bound) {
    if (!Parameter<Field<const Tag>>::bind(world, table, bound)) bound.words = 0;
    return true;
  }
  static Later<Tag> make(const BlockView& view, const Bound& bound) {
    return {bound.words == 0 ? nullptr : view.table.block(view.block) + bound.first_word * lane_count, bound.words};
  }
};

template <class Tag>
struct Parameter<MaybeField<Tag>>
    : ColumnParameter<std::is_const_v<Tag> ? Access::Mode::read : Access::Mode::write, std::remove_const_t<Tag>> {
  static bool bind(const World& world, const Table& table, Bound& bound) {
    if (!Parameter<Field<Tag>>::bind(world, table, bound)) bound.words = 0;
    return true;
  }
  static MaybeField<Tag> make(const BlockView& view, const Bound& bound) {
    return {bound.words == 0 ? nullptr : Parameter::data(view, bound)};
  }
};

template <template <class> class C>
struct Parameter<Lookup<C>> : AnywhereParameter {
  static constexpr Access access() { return {Access::Mode::lookup, type_id<C<float>>(), type_name<C<float>>()}; }
  static Lookup<C> make(const BlockView& view, const Bound&) { return Lookup<C>(view.world); }
};

template <class T>
struct Parameter<Published<T>> : AnywhereParameter {
  static constexpr Access access() { return {Access::Mode::write, type_id<T>(), type_name<T>()}; }
  static bool bind(const World&, const Table& table, Bound& bound) {
    bound.first_word = table.column(type_id<T>());
    return bound.first_word != Table::no_column;
  }
  static Published<T> make(const BlockView& view, const Bound& bound) {
    return {reinterpret_cast<T*>(view.table.block(view.block) + bound.first_word * lane_count)};
  }
};

template <class T>
struct Parameter<LookupPublished<T>> : AnywhereParameter {
  static constexpr Access access() { return {Access::Mode::lookup, type_id<T>(), type_name<T>()}; }
  static LookupPublished<T> make(const BlockView& view, const Bound&) { return LookupPublished<T>(view.world); }
};

template <class Tag>
struct Parameter<TagValue<Tag>> : TagParameter<Tag> {
  static TagValue<Tag> make(const BlockView&, const Bound& bound) { return {bound.tag}; }
};

template <class T>
struct Parameter<Shared<T>> : TagParameter<T> {
  static Shared<T> make(const BlockView&, const Bound& bound) {
    return {static_cast<const T*>(bound.resource), bound.tag};
  }
};

template <class Tag>
struct Parameter<Scratch<Tag>> : AnywhereParameter {
  static bool bind(const World&, const Table& table, Bound& bound) {
    const ComponentId* part = find_component(table.key(), type_id<Tag>());
    if (part != nullptr && part->kind == PartKind::tag) bound.scratch_floats = part->value;
    return true;
  }
  static Scratch<Tag> make(const BlockView& view, const Bound& bound) {
    return {bound.scratch_floats == 0 ? nullptr : view.scratch, bound.scratch_floats};
  }
};

/// A tally's tag is listed among its system's accesses with mode `none`, so it does not affect the order.
template <class Tag>
struct Parameter<Tally<Tag>> : AnywhereParameter {
  static constexpr Access access() { return {Access::Mode::none, type_id<Tag>(), type_name<Tag>()}; }
  static Tally<Tag> make(const BlockView& view, const Bound&) { return Tally<Tag>(view.tally); }
};

/// True if a parameter is an Of of some tag, by value or by reference.
template <template <class> class Of, class P>
inline constexpr bool is_tagged = false;
template <template <class> class Of, class Tag>
inline constexpr bool is_tagged<Of, Of<Tag>> = true;
template <template <class> class Of, class Tag>
inline constexpr bool is_tagged<Of, const Of<Tag>&> = true;
/// True for scratch memory.
template <class P>
inline constexpr bool is_scratch = is_tagged<Scratch, P>;
/// True for tallies.
template <class P>
inline constexpr bool is_tally = is_tagged<Tally, P>;

/// True if a parameter is valid only within a tick.
template <class P>
inline constexpr bool is_timed = is_scratch<P> || is_tally<P>;
template <>
inline constexpr bool is_timed<Tick> = true;
template <>
inline constexpr bool is_timed<const Tick&> = true;
template <>
inline constexpr bool is_timed<float> = true;

template <>
struct Parameter<Tick> : AnywhereParameter {
  static Tick make(const BlockView& view, const Bound&) { return view.tick; }
};

template <>
struct Parameter<float> : AnywhereParameter {
  static float make(const BlockView& view, const Bound&) { return view.tick.dt_s; }
};

template <>
struct Parameter<const Table&> : AnywhereParameter {
  static const Table& make(const BlockView& view, const Bound&) { return view.table; }
};

template <>
struct Parameter<Rows> : AnywhereParameter {
  static Rows make(const BlockView& view, const Bound&) {
    return {view.table.entities(view.block), view.table.live(view.block)};
  }
};

}  // namespace mobil::inline v0_3
