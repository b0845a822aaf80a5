#pragma once
// What pictures draw as lines: lines of action, and the edges of the finite-element meshes.

#include <vector>

#include <mobil/components/lanes.h>
#include <mobil/simulation.h>
#include <mobil/systems/muscles/person.h>

namespace mobil {

/// The ends of each muscle's straight span now, two points a muscle, in the world (m).
std::vector<Vec3<float>> action_lines(const Simulation& simulation, const Person& person);

/// The edges on the outside of each muscle's mesh as it is deformed now, two points an edge, in the world (m).
std::vector<Vec3<float>> mesh_edges(const Simulation& simulation, const Person& person);

}  // namespace mobil
