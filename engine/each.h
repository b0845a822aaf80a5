#pragma once
// All blocks of all tables that have some components, for code between ticks: what a system's signature does within
// one. `each_block<Pose, Feet>(world, [](const Rows& rows, const Pose<Lanes<float>>& pose, …) { … })`.

#include <cstddef>

#include "engine/access.h"
#include "engine/world.h"

namespace mobil {

/// Where a table has a component; false where it has none.
template <template <class> class C>
class TableColumn {
 public:
  explicit TableColumn(const Table& table) : first_word_(table.column(type_id<C<float>>())) {}
  explicit operator bool() const { return first_word_ != Table::no_column; }

  /// Of a block of that table; what is written to a lane beyond the rows is lost.
  C<Lanes<float>>& at(Table& table, std::size_t block) const {
    return *reinterpret_cast<C<Lanes<float>>*>(table.block(block) + first_word_ * lane_count);
  }
  const C<Lanes<float>>& at(const Table& table, std::size_t block) const {
    return *reinterpret_cast<const C<Lanes<float>>*>(table.block(block) + first_word_ * lane_count);
  }

 private:
  std::uint32_t first_word_;
};

/// Calls `f(rows, components…)` for each block, tables in the order of their making. Lanes from `rows.live` on are
/// parked copies.
template <template <class> class... C, class F>
void each_block(const World& world, F&& f) {
  for (const Table& table : world.tables()) {
    const bool all = ((find_part(table.key(), type_id<C<float>>()) != nullptr) && ...);
    for (std::size_t b = 0; all && b < table.block_count(); ++b) {
      f(Rows{table.entities(b), table.live(b)}, TableColumn<C>(table).at(table, b)...);
    }
  }
}
/// The same with components that may be written. The structure of the world must stay as it is meanwhile.
template <template <class> class... C, class F>
void each_block(World& world, F&& f) {
  each_block<C...>(static_cast<const World&>(world), [&](const Rows& rows, const C<Lanes<float>>&... component) {
    f(rows, const_cast<C<Lanes<float>>&>(component)...);
  });
}

}  // namespace mobil
