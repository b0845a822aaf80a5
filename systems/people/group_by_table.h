#pragma once
// Grouping of entities by table, for functions that change many rows of a table at once (World::change_archetype).

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <mobil/engine/world.h>

namespace mobil::inline v0_3 {

/// Sorts entities by index and removes duplicates.
inline void drop_repeated(std::vector<Entity>& entities) {
  std::ranges::sort(entities, {}, &Entity::index);
  entities.erase(std::unique(entities.begin(), entities.end()), entities.end());
}

/// Calls f(entities of one table) for each table, with entities in the given order. Entities must be alive. Tables are
/// those before the first call; changes by `f` do not affect the grouping.
template <class F>
void group_by_table(const World& world, std::span<const Entity> entities, const F& f) {
  std::vector<std::pair<std::uint32_t, Entity>> placed;
  for (const Entity one : entities) placed.emplace_back(world.locate(one)->table, one);
  std::ranges::stable_sort(placed, {}, &std::pair<std::uint32_t, Entity>::first);
  std::vector<Entity> together;
  for (auto first = placed.begin(); first != placed.end();) {
    together.clear();
    const std::uint32_t table = first->first;
    for (; first != placed.end() && first->first == table; ++first) together.push_back(first->second);
    f(std::span<const Entity>(together));
  }
}

}  // namespace mobil::inline v0_3
