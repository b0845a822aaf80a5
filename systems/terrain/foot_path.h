#pragma once
// Path of a foot's points from one foothold to the next.

#include <array>
#include <cstddef>

#include <mobil/components/body.h>
#include <mobil/components/footing.h>
#include <mobil/components/gait.h>
#include <mobil/components/lanes.h>
#include <mobil/components/step_plan.h>

namespace mobil::inline v0_3 {

/// Heel, ball and toe tips of the swing foot at sixteen instants of its swing, in the world, m. `part` is the elapsed
/// part of the swing's time.
struct FootPath {
  static constexpr std::size_t points = 3;
  struct At {
    float part;
    std::array<Vec3<float>, points> point_m;
  };
  std::array<At, lane_count> at;
};

/// Returns the path of one walker's step under way, over the ground and with the lift in `footing`.
FootPath foot_path(const BodySize<float>& size, const StepPlan<float>& plan, const GaitState<float>& state,
                   const Footing<float>& footing);

}  // namespace mobil::inline v0_3
