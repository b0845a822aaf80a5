#pragma once
// Bellies whose state is displacements and velocities of nodes: explicit central differences (ECD), and the methods
// that solve for each step (ICD, CAA).

#include "systems/deformation/method.h"

namespace mobil::inline v0_3 {

extern const DeformationMethod explicit_method, implicit_method, newmark_method;

}  // namespace mobil::inline v0_3
