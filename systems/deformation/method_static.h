#pragma once
// Bellies that show the static solution for each tick's load.

#include "systems/deformation/method.h"

namespace mobil::inline v0_3 {

extern const DeformationMethod static_method;

}  // namespace mobil::inline v0_3
