#pragma once
// How one belly moves at finite strain, in double: what vibration along a few linear motions is held against.

#include <array>
#include <vector>

#include <mobil/engine/error.h>
#include "assets/finite/finite_belly.h"

namespace mobil::inline v0_3 {

/// What gravity and the frame's motion do to a mass at rest position x: constant + gradient·x
/// (mobil/components/muscle.h, FrameLoad).
struct FinitePush {
  std::array<double, 3> constant_m_s2{};
  std::array<std::array<double, 3>, 3> gradient_s2{};
};

/// Three numbers a node: m, m/s, m/s²; and what acted on it at the end of the last step.
struct FiniteMotion {
  std::vector<double> displacement_m, velocity_m_s, acceleration_m_s2;
  double shortening = 0, activation = 0;
  FinitePush push;
};

/// What acts on it over a step, as at the step's end. The insertion face is where the shortening (over the length) has
/// it, the origin face stays. `foundation_hz`: each node is held sideways by (2πf)² times its mass, as linear bellies
/// are; FiniteBelly's own foundation takes no part.
struct FiniteStep {
  double time_s = 0, damping_per_s = 0, foundation_hz = 0, shortening = 0, activation = 0;
  FinitePush push;
};

FiniteMotion motion_at_rest(const FiniteBelly& belly);

/// Newmark's scheme with Hilber, Hughes and Taylor's damping of what a step cannot follow (α = −0.1; Earthquake Eng.
/// Struct. Dyn. 5, 1977), lumped mass. Second order in the step. `motion` is unchanged where that fails: a step of
/// which Newton's method does not converge.
Result<void> advance(const FiniteBelly& belly, FiniteScratch& scratch, const FiniteStep& step, FiniteMotion& motion);

}  // namespace mobil::inline v0_3
