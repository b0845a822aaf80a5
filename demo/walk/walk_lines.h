#pragma once
// Lines in pictures: lines of action, and the edges of the finite-element meshes.

#include <vector>

#include <mobil/components/lanes.h>
#include <mobil/simulation.h>
#include <mobil/systems/muscles/person.h>

namespace mobil {

/// Returns the current ends of each muscle's straight span, two points per muscle, world, m.
std::vector<Vec3<float>> action_lines(const Simulation& simulation, const Person& person);

/// Returns the outer edges of each muscle's currently deformed mesh, two points per edge, world, m.
std::vector<Vec3<float>> mesh_edges(const Simulation& simulation, const Person& person);

}  // namespace mobil
