#include "systems/lod/lod_module.h"

#include <array>
#include <cstdint>

#include <mobil/components/lod.h>
#include "engine/snapshot.h"
#include "systems/accuracy/packed_rungs.h"
#include "systems/lod/lod_round.h"

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

bool is_sound_progress(const LodProgress& progress) {
  constexpr std::int64_t most_ps = std::int64_t{1} << 60;
  const auto sound = [&](std::int64_t cost_ps) { return cost_ps >= -most_ps && cost_ps <= most_ps; };
  return progress.crowd.is_sound() && progress.counting.is_sound() && progress.machine.is_sound() &&
         sound(progress.cost_ps) && sound(progress.counted_ps) && progress.budget_ps >= 0 && progress.factor > 0 &&
         progress.factor <= CostSpectrum::most_factor && progress.ordered.count <= progress.ordered.one.size();
}

}  // namespace

Module lod_module() {
  return {.name = "lod",
          .version = 2,
          .parts = {component_part<Needs>(), component_part<Tiers>()},
          .globals = {global_part<LodProgress, &is_sound_progress>()},
          .before = {detail_chosen()},
          .check_rows = &check_tiers};
}

}  // namespace mobil::inline v0_3
