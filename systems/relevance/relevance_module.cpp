#include <mobil/systems/relevance/relevance_module.h>

#include <array>
#include <cstdint>

#include <mobil/components/relevance.h>
#include <mobil/systems/relevance/ladder.h>
#include "engine/snapshot.h"
#include "systems/relevance/packed_rungs.h"

namespace mobil::inline v0_3 {
namespace {

/// Whether every rung, view and speed is one that there is.
bool is_sound_tiers(const Tiers<float>& tiers) {
  for (std::uint32_t m = 0; m < most_muscles; ++m) {
    const std::uint32_t rung = rung_at(tiers.rung, m), goal = rung_at(tiers.goal, m);
    if ((rung >= rung_count && rung < refused_rung) || (goal >= rung_count && goal < refused_rung)) return false;
  }
  return tiers.view < view_name.size() && tiers.speed_step < RungLadder::speed_steps;
}

Result<void> check_tiers(const SavedWorld& saved, std::uint32_t table) {
  if (every_row<Tiers>(saved, table, is_sound_tiers)) return {};
  return damaged("a choice of methods");
}

}  // namespace

std::span<const KeyPart> relevance_parts() {
  static constexpr std::array parts = {component_part<Needs>(), component_part<Tiers>()};
  return parts;
}

Module relevance_module() {
  return {.name = "relevance", .parts = {component_part<Needs>(), component_part<Tiers>()}, .check_rows = &check_tiers};
}

}  // namespace mobil::inline v0_3
