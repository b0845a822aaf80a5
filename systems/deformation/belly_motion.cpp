#include "systems/deformation/belly_motion.h"

#include <algorithm>
#include <cmath>

#include <mobil/components/fade.h>
#include <mobil/rows.h>
#include "systems/deformation/deformation.h"
#include "systems/deformation/fade.h"

namespace mobil::inline v0_3 {
namespace {

struct alignas(64) Words {
  float lane[lane_count];
};

BellyLoad at_start(BellyLoad load) {
  load.to = load.from;
  if (load.frame) {
    load.frame->constant_to = load.frame->constant_from;
    load.frame->gradient_to = load.frame->gradient_from;
  }
  return load;
}

}  // namespace

std::array<float, 3> plane_mean(std::span<const float> three_a_node, std::size_t plane, std::size_t nodes) {
  std::array<float, 3> mean{};
  for (std::size_t i = 3 * plane * nodes; i < 3 * (plane + 1) * nodes; ++i)
    mean[i % 3] += three_a_node[i] / static_cast<float>(nodes);
  return mean;
}

void solve_static(const StaticBelly& belly, const BellyLoad& load, int solutions, std::vector<float>& displacement) {
  std::vector<Words> block(displacement.size());
  for (std::size_t i = 0; i < block.size(); ++i) std::fill_n(block[i].lane, lane_count, displacement[i]);
  std::vector<Words> scratch(scratch_floats(belly.shape, Method::statics) / lane_count + 1);
  const auto scale = broadcast(belly.scale);
  FrameLoad<Lanes<float>> frame;
  if (load.frame) frame = broadcast(*load.frame);
  BellyReport<Lanes<float>> report;
  const BellyBlock bellies{belly.shape,
                           scale,
                           block.data()->lane,
                           block.data()->lane,
                           report,
                           Stiffness::individual,
                           load.frame ? &frame : nullptr,
                           false};
  const auto end = broadcast(EndDrive<float>{load.from, load.to});
  for (int i = 0; i < solutions; ++i) {
    deform_implicit(bellies, belly.solver, {load.far_end, end}, 1, 1.0F, scratch.data()->lane);
  }
  for (std::size_t i = 0; i < block.size(); ++i) displacement[i] = block[i].lane[0];
}

std::vector<float> static_velocity(const StaticBelly& belly, const BellyLoad& load,
                                   const std::vector<float>& displacement) {
  constexpr float least = 1e-6F;  // minimum drive of the far face, m or N, for scaling a shape in proportion
  // A shape is not scaled up ten times or more, because its remaining error would grow as much.
  const bool scales = std::abs(load.to) > std::max(least, 0.1F * std::abs(load.from));
  std::vector<float> before = displacement;
  if (scales) {
    for (float& u : before) u *= load.from / load.to;
  }
  if (load.frame || !scales) {
    if (load.frame) before = displacement;
    solve_static(belly, at_start(load), load.frame ? static_solutions::once : static_solutions::from_nothing, before);
  }
  std::vector<float> velocity(displacement.size());
  for (std::size_t i = 0; i < velocity.size(); ++i) velocity[i] = (displacement[i] - before[i]) / load.tick_s;
  return velocity;
}

BellyMotion stretched(const Belly& belly, const LineOfAction<float>& line, const BellyLoad& load) {
  const auto& [across, along] = belly.plan.scale;
  const float per_metre = load.far_end == FarEnd::held ? 1.0F : 1 / line.stiffness_n_per_m;
  // For a held end: elongation of the line, or the part of it that its tendon leaves.
  const float length = load.far_end == FarEnd::held ? load.to : line.length_m - line.rest_length_m;
  const float speed = per_metre * (load.to - load.from) / load.tick_s;
  const std::size_t width = nodal_width(belly.shape->shape->mesh.cells);
  BellyMotion motion{std::vector<float>(width), std::vector<float>(width)};
  const float sideways = across / along;
  for (std::size_t i = 0; i < width; ++i) {
    const auto share = static_cast<float>(belly.shape->stretch.displacement[i]);
    motion.displacement[i] = (i % 3 == 2 ? length : length * sideways) * share;
    motion.velocity[i] = (i % 3 == 2 ? speed : speed * sideways) * share;
  }
  return motion;
}

void settle_belly(const Belly& belly, const BellySolver& solver, const BellyLoad& load, int solutions,
                  BellyMotion& motion, bool moves) {
  const StaticBelly of{*belly.shape->shape, solver, belly.plan.scale};
  solve_static(of, load, solutions, motion.displacement);
  if (moves) motion.velocity = static_velocity(of, load, motion.displacement);
}

BellyLoad load_of(const World& world, Entity muscle, float tick_s) {
  BellyLoad load;
  load.tick_s = tick_s;
  if (const auto end = world.get<EndDrive>(muscle)) {
    load.far_end = static_cast<FarEnd>(world.get<FarEnd>(muscle).value_or(0));
    load.from = end->from;
    load.to = end->to;
  }
  if (const auto frame = world.get<FrameLoad>(muscle)) load.frame = *frame;
  return load;
}

void add_fade(const World& world, Entity muscle, float tick_s, BellyMotion& motion) {
  const auto fade = world.get<Fade>(muscle);
  if (!fade) return;
  const FadeShare share = fade_share(static_cast<float>(fade->ticks) * tick_s);
  const std::vector<float> start = field_of<FadeStart>(world, muscle);
  const std::size_t width = motion.displacement.size();
  for (std::size_t i = 0; i < width; ++i) {
    motion.displacement[i] += share.displacement * start[i] + share.velocity * start[width + i];
    motion.velocity[i] += share.displacement_rate * start[i] + share.velocity_rate * start[width + i];
  }
}

std::vector<float> fade_between(const BellyMotion& before, const BellyMotion& after) {
  constexpr float min_m = 1e-5F;
  constexpr float top = 4.0F / 27;  // maximum of x(1 − x)²
  const std::size_t width = before.displacement.size();
  std::vector<float> fade(2 * width);
  bool seen = false, finite = true;
  for (std::size_t i = 0; i < width; ++i) {
    fade[i] = before.displacement[i] - after.displacement[i];
    fade[width + i] = before.velocity[i] - after.velocity[i];
    finite = finite && std::isfinite(fade[i]) && std::isfinite(fade[width + i]);
    seen = seen || std::abs(fade[i]) > min_m || top * fade_s * std::abs(fade[width + i]) > min_m;
  }
  if (!seen || !finite) fade.clear();
  return fade;
}

}  // namespace mobil::inline v0_3
