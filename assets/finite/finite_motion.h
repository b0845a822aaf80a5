#pragma once
// Motion of one belly at finite strain, in double: the reference for vibration along a few linear motions.

#include <array>
#include <vector>

#include <mobil/engine/error.h>
#include "assets/finite/finite_belly.h"

namespace mobil::inline v0_3 {

/// Acceleration of a mass at rest position x by gravity and the frame's motion: constant + gradient·x
/// (mobil/components/muscle.h, FrameLoad).
struct FinitePush {
  std::array<double, 3> constant_m_s2{};
  std::array<std::array<double, 3>, 3> gradient_s2{};
};

/// Three numbers a node, m, m/s and m/s², and the load at the end of the last step.
struct FiniteMotion {
  std::vector<double> displacement_m, velocity_m_s, acceleration_m_s2;
  double shortening = 0, activation = 0;
  FinitePush push;
};

/// Load over a step, as at the step's end. The shortening (over the length) places the insertion face; the origin face
/// stays. `foundation_hz` holds each node sideways by (2πf)² times its mass, as in linear bellies. FiniteBelly's own
/// foundation is not used.
struct FiniteStep {
  double time_s = 0, damping_per_s = 0, foundation_hz = 0, shortening = 0, activation = 0;
  FinitePush push;
};

FiniteMotion motion_at_rest(const FiniteBelly& belly);

/// Advances one step of Newmark's scheme with lumped mass and Hilber, Hughes and Taylor's damping of motion that a step
/// cannot follow (α = −0.1; Earthquake Eng. Struct. Dyn. 5, 1977). Second order in the step. Fails, with `motion`
/// unchanged, if Newton's method does not converge.
Result<void> advance(const FiniteBelly& belly, FiniteScratch& scratch, const FiniteStep& step, FiniteMotion& motion);

}  // namespace mobil::inline v0_3
