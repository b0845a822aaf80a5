#pragma once
// A posed body with both legs bent: for pictures, tables and hard cases.

#include <mobil/components/body.h>
#include <mobil/components/pose.h>

namespace mobil::inline v0_3 {

/// Degrees; all 0: the anatomical position.
struct LegBend {
  float hip_flexion = 0, knee_flexion = 0, dorsiflexion = 0;
};

/// The pelvis stays where the body stands; kneecaps slide round their knees as in a walk.
Pose<float> with_bent_legs(const Body& body, const LegBend& bend);

}  // namespace mobil::inline v0_3
