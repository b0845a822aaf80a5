#pragma once
// Computes a muscle's block from its surfaces, for the table of muscle_lattice.cpp.

#include "assets/surfaces/muscle_lattice.h"

namespace mobil::inline v0_3 {

/// Returns the sections of muscle_lattice, computed from the surfaces of the reference body in about ten milliseconds.
/// Rounded to 1/128 mm, they are equal on every machine.
LatticeStations shape_lattice(Muscle muscle);

}  // namespace mobil::inline v0_3
