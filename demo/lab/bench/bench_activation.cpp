// Lines of action: a leg gathered from its person's pose, the line's length, force, frame, speed and moment arms.
// Active muscles: excitation by the phase of the walk, activation, fibre and tendon.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include <mobil/anthropometry.h>
#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/components/activation.h>
#include <mobil/components/leg_frames.h>
#include <mobil/engine/access.h>
#include <mobil/engine/world.h>
#include <mobil/systems/muscles/person.h>
#include "assets/finite/shape_tables.h"
#include "assets/reduction/modal_rows.h"
#include "demo/lab/bench/bench.h"
#include "demo/lab/bench/bench_crowd.h"
#include "systems/activation/excitation.h"
#include "systems/activation/musculotendon.h"
#include "systems/deformation/finite_shape.h"
#include "systems/deformation/modal.h"
#include "systems/lines/line_motion.h"
#include "systems/lines/line_of_action.h"

namespace mobil {
namespace {

constexpr std::size_t max_blocks = 256;  // of sixteen muscles; 256 KiB

/// Sixteen muscles of one member.
struct PullBlock {
  MemberDesign<Lanes<float>> design;
  MemberState<Lanes<float>> state;
  Lanes<float> rest_m, length_m, excitation;
  LegClock<Lanes<float>> clock;
  Activation<Lanes<float>> activation;
  Musculotendon<Lanes<float>> muscle;
};

void set_all(Lanes<float>& lanes, double x) {
  std::ranges::fill(lanes.lane, static_cast<float>(x));
}

/// Measures the finite-strain shape added to a method's result, for sixteen muscles whose points are in a cache.
void bench_shape(BenchRun& run) {
  const Muscle muscle = *find_muscle("gastrocnemius_medial");
  const HexahedralMesh mesh = finite_mesh(muscle, {2, 2, 8});
  StaticStretch linear;
  linear.displacement.resize(3 * mesh.node.size());
  const FiniteShape shape = make_finite_shape(muscle, mesh, linear);
  BellyScale<Lanes<float>> scale;
  Lanes<float> end, activation;
  set_all(scale.across, 1.02), set_all(scale.along, 0.99), set_all(end, -0.01), set_all(activation, 0.3);
  std::vector<Lanes<float>> points(3 * mesh.node.size());
  const ShapeBlock block{shape, scale, end, &activation};
  const Measured adding = measure_short([&] {
    for (int i = 0; i < 64; ++i) add_shape(block, blend_of(block), true, points[0].lane, points[0].lane);
  });
  run.add_time("activation.finite_shape.us_per_muscle_tick", adding, 64.0 * lane_count, 1e-6, "us").bound =
      at_peak(run.machine, adding.best_s / (64.0 * lane_count));
}

/// Measures twelve modes of vibrating bellies, and the additional cost of stiffening by tension.
void bench_tuned(BenchRun& run) {
  const Muscle muscle = *find_muscle("gastrocnemius_medial");
  const auto basis = must(make_modal_basis(finite_mesh(muscle, {4, 4, 16}), Material{}, Element::full, {}));
  constexpr float tick_s = 1.0F / 60;
  constexpr std::size_t blocks = 64;  // 256 KiB
  BellyScale<Lanes<float>> scale;
  set_all(scale.across, 1), set_all(scale.along, 1);
  const std::size_t motion = modal_motion_width(basis.modes, basis.inputs);
  const std::size_t state = modal_state_width(basis.modes);
  EndDrive<Lanes<float>> end;
  set_all(end.from, 0), set_all(end.to, 1e-3);
  Lanes<float> activation;
  set_all(activation, 0.3);
  std::array<double, 2> us{};
  for (const bool tuned : {false, true}) {
    ModalBellies bellies;
    bellies.tuned = tuned;
    const std::vector<BellyScale<float>> bodies(lane_count, {1, 1});
    must(solve_bellies(basis, bodies, bellies));
    std::vector<Lanes<float>> motions(blocks * motion), states(blocks * state);
    for (std::size_t b = 0; b < blocks; ++b) write_motions(bellies, 8, double{tick_s}, motions[b * motion].lane);
    const Measured moving = measure_short([&] {
      std::swap(end.from, end.to);
      for (std::size_t b = 0; b < blocks; ++b) {
        const ModalBlock block{basis, scale, states[b * state].lane, motions[b * motion].lane};
        if (tuned) {
          deform_tuned(block, {FarEnd::held, end}, activation, tick_s);
        } else {
          deform_modal(block, {FarEnd::held, end}, tick_s);
        }
      }
    });
    us[tuned] = 1e6 * moving.best_s / (blocks * lane_count);
    run.add_time(fmt::format("activation.{}.us_per_muscle_tick", tuned ? "tuned" : "untuned"), moving,
                 blocks * lane_count, 1e-6, "us");
  }
  run.add_figure("activation.tuned_more.us_per_muscle_tick", us[1] - us[0], "us",
                 "of twelve motions; " + at_peak(run.machine, 1e-6 * (us[1] - us[0])));
}

constexpr std::size_t max_people = 256;  // their muscles' lines and legs take half a megabyte

/// Sixteen muscles of one group: both legs of eight people.
struct LineBlock {
  std::size_t group;
  std::array<Entity, lane_count> owner;
  LegScale<Lanes<float>> scale;
  LegFrames<Lanes<float>> leg;
  LineOfAction<Lanes<float>> line;
  EndDrive<Lanes<float>> end;
  LineMotion<Lanes<float>> motion;
};

constexpr Side side_of(std::size_t lane) {
  return lane % 2 == 0 ? Side::right : Side::left;
}

std::vector<LineBlock> make_blocks(BenchCrowd& crowd) {
  std::vector<LineBlock> blocks;
  const auto& people = crowd.people();
  for (std::size_t first = 0; first < people.size(); first += lane_count / 2) {
    for (std::size_t g = 0; g < usual_muscle_count; ++g) {
      LineBlock& block = blocks.emplace_back();
      block.group = g;
      for (std::size_t l = 0; l < lane_count; ++l) {
        block.owner[l] = people[std::min(first + l / 2, people.size() - 1)];
        const auto plan =
            must(make_muscle_plan(crowd.simulation().person(block.owner[l])->body, static_cast<Muscle>(g)));
        block.scale.thigh[l] = plan.leg_scale.thigh;
        block.scale.shank[l] = plan.leg_scale.shank;
        block.scale.across[l] = plan.leg_scale.across;
        block.line.rest_length_m[l] = static_cast<float>(plan.rest_length_m);
        block.line.stiffness_n_per_m[l] =
            static_cast<float>(bar_stiffness(Material{}, plan.section_m2, plan.rest_length_m));
      }
    }
  }
  return blocks;
}

}  // namespace

void bench_activation(BenchRun& run) {
  const Muscle muscle = *find_muscle("gastrocnemius_medial");
  const MemberPlan plan = make_muscle_plan(*make_body({}), muscle)->member[0];
  const RowExcitation row = row_excitation(muscle);
  constexpr float weight = 1, tick_s = 1.0F / 60;
  std::vector<PullBlock> blocks(std::min(max_blocks, run.people));
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    PullBlock& block = blocks[b];
    set_all(block.design.fibre_m, plan.fibre_m), set_all(block.design.tendon_m, plan.tendon_m);
    set_all(block.design.height_m, 0.3 * plan.fibre_m), set_all(block.design.force_n, 1500);
    set_all(block.rest_m, plan.rest_length_m), set_all(block.clock.speed, 0.45);
    find_rest_bellies(1, &block.rest_m, &block.design);
    for (std::size_t l = 0; l < lane_count; ++l)
      block.clock.cycle[l] = static_cast<float>((b * lane_count + l) % 101) / 101.0F;
    block.length_m = block.rest_m;
    set_all(block.excitation, 0.1);
    settle({1, &weight, &block.design, &block.length_m, &block.excitation, &block.state}, block.activation,
           block.muscle);
  }
  const auto time = [&](const auto& work) {
    return measure_short([&] {
      for (PullBlock& block : blocks) work(block);
    });
  };
  const Measured exciting = time([&](PullBlock& block) { excite(row, block.clock, &block.excitation); });
  float sway = 0.01F;
  const Measured pulling = time([&](PullBlock& block) {
    sway = -sway;
    for (std::size_t l = 0; l < lane_count; ++l) block.length_m[l] = block.rest_m[l] + sway * block.clock.cycle[l];
    contract({1, &weight, &block.design, &block.length_m, &block.excitation, &block.state}, tick_s, block.activation,
             block.muscle);
  });
  const double muscles = static_cast<double>(blocks.size() * lane_count);
  run.add_time("activation.excitation.us_per_muscle_tick", exciting, muscles, 1e-6, "us").bound =
      at_peak(run.machine, exciting.best_s / muscles);
  run.add_time("activation.kernel.us_per_muscle_tick", pulling, muscles, 1e-6, "us").bound =
      at_peak(run.machine, pulling.best_s / muscles);
  bench_shape(run);
  bench_tuned(run);
}

void bench_lines(BenchRun& run) {
  BenchCrowd crowd(std::min(max_people, run.people));
  crowd.simulation().advance(0.2);
  auto blocks = make_blocks(crowd);
  std::array<MuscleLines, usual_muscle_count> lines;
  for (std::size_t g = 0; g < usual_muscle_count; ++g) lines[g] = make_muscle_lines(static_cast<Muscle>(g));

  const Lookup<Pose> poses(crowd.simulation().world());
  const auto gather = [&](LineBlock& block) {
    for (std::size_t l = 0; l < lane_count; ++l) gather_leg(poses.find(block.owner[l]), side_of(l), block.leg, l);
  };
  const auto follow = [&](LineBlock& block) {
    lines_of_action(lines[block.group], block.scale, block.leg, FarEnd::held, block.line, block.end);
  };
  const auto time = [&](const auto& work) {
    return measure_short([&] {
      for (LineBlock& block : blocks) work(block);
    });
  };
  const Measured both = time([&](LineBlock& block) {
    gather(block);
    follow(block);
  });
  const Measured following = time(follow);
  const auto tick_s = static_cast<float>(crowd.simulation().tick_s());
  const Measured moving = time([&](LineBlock& block) {
    line_motion(lines[block.group], block.scale, block.leg, block.line, block.motion, tick_s);
  });
  const double muscles = static_cast<double>(blocks.size() * lane_count);
  run.add_time("lines.us_per_muscle_tick", both, muscles, 1e-6, "us").bound =
      fmt::format("{:.0f} % is the kernel, the rest gathers the legs", 100 * following.best_s / both.best_s);
  run.add_time("lines.kernel.us_per_muscle_tick", following, muscles, 1e-6, "us").bound =
      at_peak(run.machine, following.best_s / muscles);
  run.add_time("lines.motion.us_per_muscle_tick", moving, muscles, 1e-6, "us").bound = fmt::format(
      "speed and moment arms, as an effect: {:.1f} of the line's own kernel", moving.best_s / following.best_s);
}

}  // namespace mobil
