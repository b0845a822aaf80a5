#include "demo/walk/walk_lines.h"

#include <algorithm>
#include <array>

#include <mobil/components/activation.h>
#include <mobil/engine/geometry.h>
#include <mobil/engine/world.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/systems/surfaces/body_surfaces.h>
#include <mobil/systems/surfaces/nodal_view.h>

namespace mobil {
namespace {

using namespace geometry;

/// Converts a point of a muscle's frame to the world. Points of left muscles are reflected.
Vec3<float> to_world(const LineOfAction<float>& line, Side side, const Vec3<float>& p) {
  const Vec3<float> world = line.start_m + rotated(line.rotation, p);
  return side == Side::left ? mirrored(world) : world;
}

/// Returns each edge of the boundary once.
std::vector<std::array<std::uint32_t, 2>> boundary_edges(const Cells& cells) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (const Quad& quad : boundary_quads(cells)) {
    for (std::size_t i = 0; i < 4; ++i) {
      const auto [low, high] = std::minmax(quad[i], quad[(i + 1) % 4]);
      edges.push_back({low, high});
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

/// Calls f(plan, entity, side, line) for every existing muscle.
template <class F>
void for_each_muscle(const Simulation& simulation, const Person& person, F&& f) {
  for (const PersonMuscle& own : person.muscles) {
    for (const Side side : {Side::right, Side::left}) {
      const auto line = simulation.get<LineOfAction>(own.entity[side]);
      if (line) f(own.plan, own.entity[side], side, *line);
    }
  }
}

}  // namespace

std::vector<Vec3<float>> action_lines(const Simulation& simulation, const Person& person) {
  std::vector<Vec3<float>> ends;
  for_each_muscle(simulation, person,
                  [&](const MusclePlan& plan, Entity muscle, Side side, const LineOfAction<float>& line) {
                    const float rest = static_cast<float>(plan.belly_length_m);
                    ends.push_back(to_world(line, side, {0, 0, 0}));
                    const auto pull = simulation.get<Musculotendon>(muscle);
                    const float longer = pull ? pull->belly_m : line.length_m - line.rest_length_m;
                    ends.push_back(to_world(line, side, {0, 0, rest + longer}));
                  });
  return ends;
}

std::vector<Vec3<float>> mesh_edges(const Simulation& simulation, const Person& person) {
  std::vector<Vec3<float>> ends;
  for_each_muscle(simulation, person,
                  [&](const MusclePlan& plan, Entity muscle, Side side, const LineOfAction<float>& line) {
                    const NodalView moved = nodal_displacement(simulation.world(), muscle);
                    if (moved.first == nullptr) return;  // without a mesh
                    const auto mesh = rest_mesh(person.body, plan.muscle, person.leg_muscles.cells);
                    if (!mesh) return;
                    const auto node = [&](std::uint32_t n) {
                      const auto& rest = mesh->lattice.node[n];
                      const float* u = moved.first + std::size_t{3} * n * lane_count;
                      return to_world(line, side,
                                      {static_cast<float>(rest.x) + u[0], static_cast<float>(rest.y) + u[lane_count],
                                       static_cast<float>(rest.z) + u[2 * lane_count]});
                    };
                    for (const auto& [from, to] : boundary_edges(mesh->lattice.cells)) {
                      ends.push_back(node(from));
                      ends.push_back(node(to));
                    }
                  });
  return ends;
}

}  // namespace mobil
