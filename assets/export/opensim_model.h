#pragma once
// Bodies of OpenSim's model.

#include <string>

#include <mobil/components/segments.h>

namespace mobil::inline v0_3 {

/// Returns the name of the model's body that a segment belongs to, such as femur_r. The trunk, head and arms are torso.
std::string opensim_body(Segment segment);

}  // namespace mobil::inline v0_3
