// Explicit central differences on finer meshes of the paper's body, and at finite strain.

#include <fmt/format.h>

#include <array>

#include "demo/lab/bench/bench_fem.h"

namespace mobil {
namespace {

struct Mesh {
  const char* name;
  Cells cells;
};
constexpr std::array meshes = {Mesh{"fem.ecd99", {2, 2, 10}}, Mesh{"fem.ecd425", {4, 4, 16}},
                               Mesh{"fem.ecd525", {4, 4, 20}}, Mesh{"fem.ecd2673", {8, 8, 32}},
                               Mesh{"fem.ecd3321", {8, 8, 40}}};

/// Of one element: 75 to gather how it is deformed, 89 for its fibres and stress, 78 to hand out its forces.
constexpr double finite_multiply_adds = 242;

/// At finite strain, element by element: everybody's own size.
Result<void> bench_finite(BenchRun& run, const Mesh& mesh) {
  const auto muscle = paper_block(mesh.cells, Strain::finite);
  if (!muscle) return tl::unexpected(muscle.error());
  const double limit_s = critical_step(muscle->critical_steps, 1, 1).value_or(0);
  BenchBellies bellies(*muscle, Stiffness::individual, 4);
  Rounds rounds;
  for (int round = 0; round < run.rounds(3); ++round) {
    rounds.add(
        measure(run.rounds(15), [&] { bellies.tick(steps_a_tick, static_cast<float>(0.6 * limit_s * steps_a_tick)); }));
  }
  if (!bellies.finite()) return fail(fmt::format("{}: a displacement is not a number", mesh.name));
  BenchResult& time =
      add_step_time(run, mesh.name, rounds.all(), static_cast<double>(bellies.muscles()), steps_a_tick, mesh.cells);
  *time.of_peak *= finite_multiply_adds * element_count(mesh.cells) / useful_multiply_adds(mesh.cells);
  time.bound =
      fmt::format("{} multiply-adds an element, 160 sums beside; limit {:.3g} ms", finite_multiply_adds, limit_s * 1e3);
  return {};
}

}  // namespace

Result<void> bench_fem_meshes(BenchRun& run) {
  for (const Mesh& mesh : {Mesh{"fem.finite81", {2, 2, 8}}, Mesh{"fem.finite425", {4, 4, 16}}}) {
    if (auto done = bench_finite(run, mesh); !done) return done;
  }
  for (const Mesh& mesh : meshes) {
    const auto muscle = paper_block(mesh.cells);
    if (!muscle) return tl::unexpected(muscle.error());
    const double limit_s = paper_limit_s(*muscle);
    const auto tick_s = static_cast<float>(0.6 * limit_s * steps_a_tick);  // slim individuals have less
    for (const Stiffness stiffness : {Stiffness::shared, Stiffness::individual}) {
      BenchBellies bellies(*muscle, stiffness, node_count(mesh.cells) > 1000 ? 1 : 4);
      Rounds rounds;
      for (int round = 0; round < run.rounds(3); ++round) {
        rounds.add(measure(run.rounds(15), [&] { bellies.tick(steps_a_tick, tick_s); }));
      }
      if (!bellies.finite()) return fail(fmt::format("{}: a displacement is not a number", mesh.name));
      add_step_time(run, fmt::format("{}.{}", mesh.name, stiffness == Stiffness::shared ? "shared" : "individual"),
                    rounds.all(), static_cast<double>(bellies.muscles()), steps_a_tick, mesh.cells)
          .bound += fmt::format("; limit {:.3g} ms", limit_s * 1e3);
    }
  }
  return {};
}

}  // namespace mobil
