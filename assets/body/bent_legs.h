#pragma once
// A posed body with both legs bent, for pictures, tables and edge cases.

#include <mobil/components/body.h>
#include <mobil/components/pose.h>

namespace mobil::inline v0_3 {

/// Joint angles, degrees. All are 0 in the anatomical position.
struct LegBend {
  float hip_flexion = 0, knee_flexion = 0, dorsiflexion = 0;
};

/// Returns the body's pose with bent legs. The pelvis stays in place; kneecaps slide round their knees as in walking.
Pose<float> with_bent_legs(const Body& body, const LegBend& bend);

}  // namespace mobil::inline v0_3
