#include "systems/relevance/relevance_module.h"

#include <array>
#include <bit>
#include <cstdint>

#include "components/relevance.h"
#include "engine/snapshot.h"
#include "systems/relevance/ladder.h"
#include "systems/relevance/packed_rungs.h"

namespace mobil {
namespace {

/// Whether every rung, view and speed is one that there is.
bool tiers_are_sound(const SavedWorld& world, std::uint32_t table, std::uint32_t column) {
  constexpr auto words = static_cast<std::uint32_t>(ComponentLayout<Tiers>::words);
  for (std::uint32_t row = 0; row < world.tables[table].rows; ++row) {
    std::array<std::uint32_t, words> word;
    for (std::uint32_t w = 0; w < words; ++w) word[w] = world.word(table, row, column + w);
    const auto tiers = std::bit_cast<Tiers<float>>(word);
    for (std::uint32_t m = 0; m < most_muscles; ++m) {
      const std::uint32_t rung = rung_at(tiers.rung, m), goal = rung_at(tiers.goal, m);
      if ((rung >= rung_count && rung < refused_rung) || (goal >= rung_count && goal < refused_rung)) return false;
    }
    if (tiers.view >= view_name.size() || tiers.speed_step >= RungLadder::speed_steps) return false;
  }
  return true;
}

Result<void> check_rows(const SavedWorld& saved, std::uint32_t table) {
  const std::uint32_t column = saved.column(table, type_id<Tiers<float>>());
  if (column == Table::no_column || tiers_are_sound(saved, table, column)) return {};
  return fail("the snapshot does not agree with itself (a choice of methods); give one that `save` made");
}

}  // namespace

std::span<const KeyPart> relevance_parts() {
  static constexpr std::array parts = {component_part<Needs>(), component_part<Tiers>()};
  return parts;
}

Module relevance_module() {
  return {.name = "relevance", .parts = {component_part<Needs>(), component_part<Tiers>()}, .check_rows = &check_rows};
}

}  // namespace mobil
