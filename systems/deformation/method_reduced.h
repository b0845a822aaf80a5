#pragma once
// Bellies that move along a few vectors of a finer mesh, or show their static answer; and their control points and
// reports, only where these are asked for.

#include "systems/deformation/method.h"

namespace mobil {

extern const DeformationMethod reduced_method;

}  // namespace mobil
