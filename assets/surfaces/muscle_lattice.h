#pragma once
// The block that follows a muscle's surfaces in the reference body, from which its template is meshed.

#include <array>
#include <cstddef>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/components/muscle.h>

namespace mobil::inline v0_3 {

/// Mesh sections of a muscle's template, muscle frame, reference body: t ascending from 0 to 1 over the belly. They
/// follow the surface that the muscle would have alone (MuscleRoom). A single muscle's mesh has the muscle's volume; a
/// group's encloses its members and all that is between them. Its ends are at least 0.35 times as thick as its middle.
/// The numbers are a table made by shape_lattice (shape_lattice.h). When a muscle's surface changes, the test
/// MuscleLattice.MatchesTheSurfaces fails and prints the new table.
inline constexpr std::size_t lattice_station_count = 9;
using LatticeStations = std::array<LatticeStation, lattice_station_count>;
inline constexpr std::size_t lattice_muscles = muscle_count;
const LatticeStations& muscle_lattice(Muscle muscle);
/// Grading of the elements of templates: finer towards the ends, where bellies taper and are held.
inline constexpr Grading belly_grading{.across = 1, .along = 1.5};

}  // namespace mobil::inline v0_3
