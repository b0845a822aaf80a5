// Lines of action: a leg gathered from its human's pose, the line's length, force and frame from it, and its speed and
// moment arms.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/engine/access.h>
#include "demo/lab/bench/bench.h"
#include "demo/lab/bench/bench_crowd.h"
#include "systems/lines/line_motion.h"
#include "systems/lines/line_of_action.h"

namespace mobil {
namespace {

constexpr std::size_t most_people = 256;  // their muscles' lines and legs take half a megabyte

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

Result<std::vector<LineBlock>> make_blocks(BenchCrowd& crowd) {
  std::vector<LineBlock> blocks;
  const auto& people = crowd.people();
  for (std::size_t first = 0; first < people.size(); first += lane_count / 2) {
    for (std::size_t g = 0; g < muscle_group_count; ++g) {
      LineBlock& block = blocks.emplace_back();
      block.group = g;
      for (std::size_t l = 0; l < lane_count; ++l) {
        block.owner[l] = people[std::min(first + l / 2, people.size() - 1)];
        const auto plan = make_muscle_plan(crowd.simulation().human(block.owner[l])->body, static_cast<Muscle>(g));
        if (!plan) return tl::unexpected(plan.error());
        block.scale.thigh[l] = plan->leg_scale.thigh;
        block.scale.shank[l] = plan->leg_scale.shank;
        block.scale.across[l] = plan->leg_scale.across;
        block.line.rest_length_m[l] = static_cast<float>(plan->rest_length_m);
        block.line.stiffness_n_per_m[l] =
            static_cast<float>(bar_stiffness(Material{}, plan->section_m2, plan->rest_length_m));
      }
    }
  }
  return blocks;
}

}  // namespace

Result<void> bench_lines(BenchRun& run) {
  const auto made = BenchCrowd::make(std::min(most_people, run.humans));
  if (!made) return tl::unexpected(made.error());
  BenchCrowd& crowd = **made;
  crowd.simulation().advance(0.2);
  auto blocks = make_blocks(crowd);
  if (!blocks) return tl::unexpected(blocks.error());
  std::array<MuscleLines, muscle_group_count> lines;
  for (std::size_t g = 0; g < muscle_group_count; ++g) lines[g] = make_muscle_lines(static_cast<Muscle>(g));

  const Lookup<Pose> poses(crowd.simulation().world());
  const auto gather = [&](LineBlock& block) {
    for (std::size_t l = 0; l < lane_count; ++l) gather_leg(poses.find(block.owner[l]), side_of(l), block.leg, l);
  };
  const auto follow = [&](LineBlock& block) {
    lines_of_action(lines[block.group], block.scale, block.leg, FarEnd::held, block.line, block.end);
  };
  const auto time = [&](const auto& work) {
    return measure_short([&] {
      for (LineBlock& block : *blocks) work(block);
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
  const double muscles = static_cast<double>(blocks->size() * lane_count);
  run.add_time("lines.us_per_muscle_tick", both, muscles, 1e-6, "us").bound =
      fmt::format("{:.0f} % is the kernel, the rest gathers the legs", 100 * following.best_s / both.best_s);
  run.add_time("lines.kernel.us_per_muscle_tick", following, muscles, 1e-6, "us").bound =
      at_peak(run.machine, following.best_s / muscles);
  run.add_time("lines.motion.us_per_muscle_tick", moving, muscles, 1e-6, "us").bound = fmt::format(
      "speed and moment arms, as an effect: {:.1f} of the line's own kernel", moving.best_s / following.best_s);
  return {};
}

}  // namespace mobil
