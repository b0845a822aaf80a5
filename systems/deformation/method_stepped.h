#pragma once
// Bellies whose displacements and velocities of nodes are the state: explicit central differences (ECD), and the
// implicit ones that solve for each step (ICD, CAA).

#include "systems/deformation/method.h"

namespace mobil::inline v0_3 {

extern const DeformationMethod explicit_method, implicit_method, newmark_method;

}  // namespace mobil::inline v0_3
