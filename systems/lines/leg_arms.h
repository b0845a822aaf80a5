#pragma once
// Lengths and moment arms of all lines of a leg, for sharing its moments.

#include <span>

#include <mobil/components/activation.h>
#include <mobil/components/leg_frames.h>
#include "systems/lines/muscle_lines.h"

namespace mobil::inline v0_3 {

/// Computes the path length of each line, m, and its arms, m, as exact derivatives (systems/lines/line_motion.h). Arms
/// of knee and ankle are about the x axes of thigh and shank. Those of the hip are about the axes of JointMoments:
/// `facing` is the horizontal direction ahead, a unit vector, mirrored for a left leg like the leg. A NaN stays in its
/// lane. `flexion_rad` receives the leg's flexion.
void leg_arms(std::span<const MuscleLines> lines, const LegScale<Lanes<float>>& scale,
              const LegFrames<Lanes<float>>& legs, const Vec3<Lanes<float>>& facing, Lanes<float>* path_m,
              LegMoments<Lanes<float>>* arm_m, LegFlexion<Lanes<float>>& flexion_rad);

}  // namespace mobil::inline v0_3
