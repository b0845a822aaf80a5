#pragma once
// The block that follows a muscle's surfaces in the reference body: what its template is meshed from.

#include <array>
#include <cstddef>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/components/muscle.h>

namespace mobil::inline v0_3 {

/// The mesh of a muscle's template, muscle frame, reference body: t ascending from 0 to 1 over the belly. Its sections
/// follow the surface that it would have alone (MuscleRoom). A single muscle's mesh has the muscle's volume; a group's
/// encloses its members and all that lies between them. Its ends are no thinner than 0.35 of its middle. The numbers
/// are a table, which shape_lattice (shape_lattice.h) made. When a muscle's surface changes, the test
/// MuscleLattice.IsWhatTheSurfacesGive fails and prints the new table.
inline constexpr std::size_t lattice_station_count = 9;
using LatticeStations = std::array<LatticeStation, lattice_station_count>;
inline constexpr std::size_t lattice_muscles = 16;  // all of the table's rows
const LatticeStations& muscle_lattice(Muscle muscle);
/// How the elements of templates are graded: finer towards the ends, where bellies taper and are held.
inline constexpr Grading belly_grading{.across = 1, .along = 1.5};

}  // namespace mobil::inline v0_3
