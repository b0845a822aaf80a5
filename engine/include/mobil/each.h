#pragma once
// Iteration over blocks between ticks, with the same parameters as systems:
//   each(world, [](const Rows& rows, const Pose<Lanes<float>>& pose, Fatigue<Lanes<float>>& fatigue) { … });

#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>

#include <mobil/engine/access.h>
#include <mobil/engine/world.h>

namespace mobil::inline v0_3 {

/// Column of a component in a table; false if the table has none.
template <template <class> class C>
class TableColumn {
 public:
  explicit TableColumn(const Table& table) : first_word_(table.column(type_id<C<float>>())) {}
  explicit operator bool() const { return first_word_ != Table::no_column; }

  /// Returns the component in a block of that table. Values written to lanes without a row are lost.
  C<Lanes<float>>& at(Table& table, std::size_t block) const {
    return *reinterpret_cast<C<Lanes<float>>*>(table.block(block) + first_word_ * lane_count);
  }
  const C<Lanes<float>>& at(const Table& table, std::size_t block) const {
    return *reinterpret_cast<const C<Lanes<float>>*>(table.block(block) + first_word_ * lane_count);
  }

 private:
  std::uint32_t first_word_;
};

/// Implements `each`.
template <class F, class... P>
void each_with(World& world, F& f, Parameters<P...>) {
  static_assert(!(is_timed<P> || ...), "between ticks there is neither a tick nor scratch memory: leave that out");
  for (Table& table : world.tables()) {
    std::array<Bound, sizeof...(P) + 1> bound{};
    [[maybe_unused]] Bound* next = bound.data();
    if (!(Parameter<P>::bind(world, table, *next++) && ...)) continue;
    for (std::size_t b = 0; b < table.block_count(); ++b) {
      [&]<std::size_t... i>(std::index_sequence<i...>) {
        f(Parameter<P>::make({world, table, b, {}}, bound[i])...);
      }
      (std::index_sequence_for<P...>{});
    }
  }
}

/// True if no parameter writes.
template <class... P>
constexpr bool writes_nothing(Parameters<P...>) {
  return ((Parameter<P>::access().mode != Access::Mode::write) && ...);
}

/// Calls `f` for each block of each table that matches its parameters, which are those of systems
/// (mobil/engine/access.h). Runs on this thread, tables in the order of their creation. Lanes from `Rows::live` on are
/// parked copies. `f` must not change the world's structure.
template <class F>
void each(World& world, F&& f) {
  each_with(world, f, Signature<std::remove_cvref_t<F>>{});
}
/// Reads only: `const` components, `Field<const Tag>`.
template <class F>
void each(const World& world, F&& f) {
  using Taken = Signature<std::remove_cvref_t<F>>;
  static_assert(writes_nothing(Taken{}), "this world is only read: take `const Pose<Lanes<float>>&`");
  each_with(const_cast<World&>(world), f, Taken{});
}

}  // namespace mobil::inline v0_3
