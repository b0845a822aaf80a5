#pragma once
// How a muscle's block comes from its surfaces: what the table of muscle_lattice.cpp was made with.

#include "assets/surfaces/muscle_lattice.h"

namespace mobil::inline v0_3 {

/// The sections that muscle_lattice promises, found from the surfaces of the reference body: some ten milliseconds. To
/// 1/128 mm the same on every machine.
LatticeStations shape_lattice(Muscle muscle);

}  // namespace mobil::inline v0_3
