#pragma once
// Where the points of a foot are on its way from one foothold to the next.

#include <array>
#include <cstddef>

#include <mobil/components/body.h>
#include <mobil/components/footing.h>
#include <mobil/components/gait.h>
#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

/// Heel, ball and tips of the toes of the foot in the air at sixteen instants of its swing, in the world, m; `part`:
/// of the swing's time that is over.
struct FootPath {
  static constexpr std::size_t points = 3;
  struct At {
    float part;
    std::array<Vec3<float>, points> point_m;
  };
  std::array<At, lane_count> at;
};

/// Of one walker's step under way, over that ground, lifted as that says.
FootPath foot_path(const BodySize<float>& size, const StepPlan<float>& plan, const GaitState<float>& state,
                   const Footing<float>& footing);

}  // namespace mobil::inline v0_3
