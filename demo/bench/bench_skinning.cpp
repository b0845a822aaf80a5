// Skinning: all muscle surfaces of one walking person, both legs.

#include <fmt/format.h>

#include <optional>
#include <vector>

#include "demo/bench/bench.h"
#include "demo/bench/bench_crowd.h"
#include "demo/walk/figure.h"
#include "systems/simulation.h"
#include "systems/skinning/skinning.h"

namespace mobil {
namespace {

// A vertex' arithmetic: eight nodes' weighted mean (45), its place in the cage (3), three affine maps (54), their
// weighted sum (15), its sign (1).
constexpr double flops = 45 + 3 + 54 + 15 + 1;
constexpr double bytes = sizeof(VertexBinding) + 3 * sizeof(Vec3<float>);  // in the cage, in the body, and out

struct Skin {
  const MuscleSurface* surface;
  SkinPose pose;
  NodalLane displacement;
  bool is_left;
  std::vector<Vec3<float>> out;
};

}  // namespace

Result<void> bench_skinning(BenchRun& run) {
  Simulation simulation;
  const auto entity = simulation.spawn({});
  if (!entity) return tl::unexpected(entity.error());
  if (auto done = simulation.add_leg_muscles(*entity); !done) return done;
  const Human human = *simulation.human(*entity);
  const auto figure = make_figure(simulation, human, std::nullopt);
  if (!figure) return tl::unexpected(figure.error());
  simulation.advance(0.2);

  std::vector<Skin> skins;
  double vertices = 0;
  const auto pose = *simulation.get<Pose>(*entity);
  for (const FigureMuscle& muscle : figure->muscles) {
    for (const Side side : {right, left}) {
      const Entity belly = simulation.muscle(*entity, muscle.muscle, side);
      const NodalView nodes = simulation.nodal_displacement(belly);
      skins.push_back({&muscle.surface,
                       skin_pose(muscle.surface, side, human.body, pose, *simulation.get<LineOfAction>(belly)),
                       {nodes.first, lane_count, nodes.nodes},
                       side == left,
                       std::vector<Vec3<float>>(muscle.surface.mesh.position.size())});
      vertices += static_cast<double>(muscle.surface.mesh.position.size());
    }
  }
  const Measured time = measure_short([&] {
    for (Skin& skin : skins) skin_surface(*skin.surface, skin.pose, skin.displacement, skin.is_left, skin.out);
  });
  BenchResult& result = run.add_time("skinning.ns_per_vertex", time, vertices, 1e-9, "ns");
  const double vertex_s = result.value * 1e-9;
  result.of_peak = flops / vertex_s * 1e-9 / run.machine.fma_peak_gflops;
  result.of_bandwidth = bytes / vertex_s * 1e-9 / run.machine.bandwidth_gbps;
  result.bound = fmt::format("{:.0f} vertices in {} surfaces of one person, {:.0f} operations and {:.0f} bytes each",
                             vertices, skins.size(), flops, bytes);
  return {};
}

}  // namespace mobil
