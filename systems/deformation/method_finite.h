#pragma once
// Method::finite: explicit central differences at finite strain, with active fibres if the muscle has Activation.

#include "systems/deformation/method.h"

namespace mobil::inline v0_3 {

extern const DeformationMethod finite_method;

/// Returns the rest state at finite strain under the drive of the end, minus the linear static solution. The finite
/// state is that of the table of finite shapes at this activation. Without a table it is that of a relaxed belly that
/// keeps its volume.
BellyMotion finite_less_linear(const NextBelly& next);

}  // namespace mobil::inline v0_3
