#include "systems/lod/lod_module.h"

#include <array>
#include <cstdint>

#include <mobil/components/lod.h>
#include "engine/snapshot.h"
#include "systems/accuracy/packed_levels.h"
#include "systems/lod/lod_round.h"

namespace mobil::inline v0_3 {
namespace {

/// Returns true if every level, view and speed step is valid.
bool is_sound_state(const LodState<float>& lod_state) {
  for (std::uint32_t m = 0; m < max_muscles; ++m) {
    const std::uint32_t level = level_at(lod_state.level, m), goal = level_at(lod_state.goal, m);
    if ((level >= level_count && level < refused_level) || (goal >= level_count && goal < refused_level)) return false;
  }
  return lod_state.view < view_name.size() && lod_state.speed_step < LodTable::speed_steps;
}

Result<void> check_tiers(const SavedWorld& saved, std::uint32_t table) {
  if (every_row<LodState>(saved, table, is_sound_state)) return {};
  return damaged("a choice of methods");
}

bool is_sound_progress(const LodProgress& progress) {
  constexpr std::int64_t max_ps = std::int64_t{1} << 60;
  const auto sound = [&](std::int64_t cost_ps) { return cost_ps >= -max_ps && cost_ps <= max_ps; };
  return progress.crowd.is_sound() && progress.counting.is_sound() && progress.machine.is_sound() &&
         sound(progress.cost_ps) && sound(progress.counted_ps) && progress.budget_ps >= 0 && progress.factor > 0 &&
         progress.factor <= CostSpectrum::max_factor && progress.ordered.count <= progress.ordered.one.size();
}

}  // namespace

Module lod_module() {
  return {.name = "lod",
          .version = 2,
          .parts = {component_id<LodRequest>(), component_id<LodState>()},
          .globals = {global_part<LodProgress, &is_sound_progress>()},
          .before = {detail_chosen()},
          .check_rows = &check_tiers};
}

}  // namespace mobil::inline v0_3
