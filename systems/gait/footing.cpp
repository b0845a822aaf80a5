#include "systems/gait/footing.h"

#include <cstddef>
#include <utility>

namespace mobil::inline v0_3 {
namespace {

constexpr auto leaving = index(FootholdOf::leaving);
constexpr auto stance = index(FootholdOf::stance);
constexpr auto landing = index(FootholdOf::landing);

}  // namespace

void follow_feet(const GaitState<Lanes<float>>& state, Footing<Lanes<float>>& footing) {
  for (std::size_t l = 0; l < lane_count; ++l) {
    const std::uint32_t steps = state.steps[l] - footing.steps[l];
    // Steps that begin at rest can be made by the other foot.
    const bool swapped = (state.stance_side[l] & 1U) != ((footing.stance_side[l] ^ steps) & 1U);
    if (steps == 0 && !swapped) continue;
    footing.steps[l] = state.steps[l];
    footing.stance_side[l] = state.stance_side[l];
    // The ground is unknown after sleep, or if it was not queried in time.
    const bool known = steps <= 1 && footing.known[l] >= (steps == 1 ? footing_all : footing_before);
    footing.known[l] = known ? footing_before : footing_unknown;
    for (auto* values : by_foothold(footing)) {
      Lanes<float>(&of)[3] = *values;
      if (steps != 0) {
        of[leaving][l] = of[stance][l];
        of[stance][l] = of[landing][l];
      }
      if (swapped) std::swap(of[leaving][l], of[stance][l]);
      of[landing][l] = of[stance][l];
    }
    footing.moved_x_m[landing][l] = footing.moved_z_m[landing][l] = 0;
    footing.lift_early_m[l] = footing.lift_late_m[l] = 0.0F;
  }
}

}  // namespace mobil::inline v0_3
