#include "systems/terrain/terrain_module.h"

#include <cmath>
#include <cstdint>

#include <mobil/components/footing.h>
#include "engine/snapshot.h"
#include "systems/terrain/clearance.h"
#include "systems/terrain/sole_fit.h"

namespace mobil::inline v0_3 {
namespace {

bool is_sound_footing(const Footing<float>& footing) {
  constexpr float steepest = 1, fastest = 20;
  const auto within = [](float value, float most) { return std::fabs(value) <= most; };  // false for NaN
  bool sound = within(footing.lift_early_m, max_lift_m) && within(footing.lift_late_m, max_lift_m) &&
               std::isfinite(footing.stance_x_m) && std::isfinite(footing.stance_z_m) &&
               std::isfinite(footing.landing_x_m) && std::isfinite(footing.landing_z_m) &&
               footing.known <= footing_all && within(footing.slows_for, steepest);
  for (const float walk : {footing.level_speed_m_s, footing.level_length_m})
    sound = sound && walk >= 0 && walk <= fastest;
  for (std::size_t i = 0; i < 3; ++i)
    sound = sound && within(footing.height_m[i], highest_ground_m) && within(footing.rise_x[i], steepest) &&
            within(footing.rise_z[i], steepest) && within(footing.moved_x_m[i], max_moved_m) &&
            within(footing.moved_z_m[i], max_moved_m);
  return sound;
}

Result<void> check_footing(const SavedWorld& saved, std::uint32_t table) {
  if (!every_row<Footing>(saved, table, is_sound_footing)) return damaged("the ground under somebody");
  return {};
}

}  // namespace

Module terrain_module() {
  return {.name = "terrain",
          .version = 4,
          .parts = {component_id<Footing>()},
          .before = {ground_under_feet()},
          .check_rows = &check_footing};
}

}  // namespace mobil::inline v0_3
