#include "systems/muscles/simulation_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "assets/reduction/reduced_bellies.h"
#include "components/fade.h"
#include "systems/deformation/deformation.h"
#include "systems/deformation/fade.h"
#include "systems/people/simulation_rows.h"

namespace mobil {
namespace {

// Static solutions, each of which takes away most of what the last left: from nothing, from nearby under a frame's
// load, and where a shape in proportion is all but right.
constexpr int from_nothing = 4, from_nearby = 2, once = 1;

struct alignas(64) Line {
  float lane[lane_count];
};

template <class Tag>
std::vector<float> field_of(const World& world, Entity muscle) {
  std::vector<float> values(world.get<Tag>(muscle).value_or(0));
  world.get_field<Tag>(muscle, values);
  return values;
}

struct StaticBelly {
  const MuscleTemplate& shape;
  const BellySolver& solver;
  const BellyScale<float>& scale;
};

/// Goes from `displacement` toward the static answer to the load at the tick's end.
void solve(const StaticBelly& belly, const BellyLoad& load, int solutions, std::vector<float>& displacement) {
  std::vector<Line> block(displacement.size());
  for (std::size_t i = 0; i < block.size(); ++i) std::fill_n(block[i].lane, lane_count, displacement[i]);
  std::vector<Line> scratch(scratch_floats(belly.shape, Method::statics) / lane_count + 1);
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
  const auto drive = [&](const auto& end) {
    for (int i = 0; i < solutions; ++i) deform_implicit(bellies, belly.solver, end, 1, 1.0F, scratch.data()->lane);
  };
  if (load.drive == Drive::displacement) {
    drive(broadcast(EndDisplacement<float>{load.from, load.to}));
  } else {
    drive(broadcast(EndForce<float>{load.from, load.to}));
  }
  for (std::size_t i = 0; i < block.size(); ++i) displacement[i] = block[i].lane[0];
}

BellyLoad at_start(BellyLoad load) {
  load.to = load.from;
  if (load.frame) {
    load.frame->constant_to = load.frame->constant_from;
    load.frame->gradient_to = load.frame->gradient_from;
  }
  return load;
}

/// How a static answer moved over the tick.
std::vector<float> static_velocity(const StaticBelly& belly, const BellyLoad& load,
                                   const std::vector<float>& displacement) {
  constexpr float least = 1e-6F;  // of what drives the far face, m or N, that a shape in proportion to it is scaled by
  const bool scales = std::abs(load.to) > least;
  std::vector<float> before = displacement;
  if (scales) {
    for (float& u : before) u *= load.from / load.to;
  }
  if (load.frame || !scales) {
    if (load.frame) before = displacement;
    solve(belly, at_start(load), load.frame ? once : from_nothing, before);
  }
  std::vector<float> velocity(displacement.size());
  for (std::size_t i = 0; i < velocity.size(); ++i) velocity[i] = (displacement[i] - before[i]) / load.tick_s;
  return velocity;
}

/// The inputs of a reduced belly and their rates.
struct Inputs {
  std::array<double, 1 + frame_inputs> value{}, rate{};
  std::size_t count = 1;

  std::span<const double> values() const { return {value.data(), count}; }
  std::span<const double> rates() const { return {rate.data(), count}; }
};

Inputs inputs_of(const BellyLoad& load, std::uint32_t count) {
  Inputs inputs;
  inputs.count = count;
  const auto set = [&](std::size_t i, float from, float to) {
    inputs.value[i] = static_cast<double>(to);
    inputs.rate[i] = (static_cast<double>(to) - static_cast<double>(from)) / static_cast<double>(load.tick_s);
  };
  set(0, load.from, load.to);
  if (count == 1 || !load.frame) return inputs;
  const FrameLoad<float>& f = *load.frame;
  const std::pair<const Vec3<float>*, const Vec3<float>*> rows[] = {{&f.constant_from, &f.constant_to},
                                                                    {&f.gradient_from.x, &f.gradient_to.x},
                                                                    {&f.gradient_from.y, &f.gradient_to.y},
                                                                    {&f.gradient_from.z, &f.gradient_to.z}};
  std::size_t next = 1;
  for (const auto& [from, to] : rows) {
    set(next++, from->x, to->x);
    set(next++, from->y, to->y);
    set(next++, from->z, to->z);
  }
  return inputs;
}

/// Motions at the speed of their static answers: behind these by as much as damping holds them back, or right there.
std::vector<float> state_with_loads(const ReducedBelly& belly, const Inputs& inputs, double damping_per_s) {
  std::vector<float> state(reduced_state_width(belly.vectors));
  for (std::size_t j = 0; j < belly.vectors; ++j) {
    double rate = inputs.rate[0];  // with one input a motion is kept over its participation
    if (inputs.count > 1) {
      rate = 0;
      for (std::size_t i = 0; i < inputs.count; ++i) rate += belly.participation[j][i] * inputs.rate[i];
    }
    state[2 * j] = static_cast<float>(-damping_per_s / belly.omega_1_s[j] * rate);
    state[2 * j + 1] = static_cast<float>(rate);
  }
  return state;
}

/// The static answer without the loads of the frame: the template's shape, drawn out.
BellyMotion stretched(const Belly& belly, const LineOfAction<float>& line, const BellyLoad& load) {
  const auto& [across, along] = belly.plan.scale;
  const float per_metre = load.drive == Drive::displacement ? 1.0F : 1 / line.stiffness_n_per_m;
  const float length = line.length_m - line.rest_length_m, speed = per_metre * (load.to - load.from) / load.tick_s;
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

/// What `motion` becomes under all loads: the static answer, and, where asked, how it moves.
void settle(const Belly& belly, const BellySolver& solver, const BellyLoad& load, int solutions, BellyMotion& motion,
            bool moves) {
  const StaticBelly of{*belly.shape->shape, solver, belly.plan.scale};
  solve(of, load, solutions, motion.displacement);
  if (moves) motion.velocity = static_velocity(of, load, motion.displacement);
}

/// The state that goes on from `motion`.
std::vector<float> reduced_state(const Belly& belly, const BellyLoad& load, const BellyMotion& motion) {
  const ReducedBasis& basis = *belly.basis;
  const Inputs inputs = inputs_of(load, basis.inputs);
  std::vector<float> state(reduced_state_width(basis.vectors));
  fit_state(basis, *belly.motions, inputs.values(), inputs.rates(), motion.displacement, motion.velocity, state);
  return state;
}

/// What a state shows; an empty one: the static answer.
BellyMotion reduced_motion(const ReducedBasis& basis, const ReducedBelly& belly, const BellyLoad& load,
                           const std::vector<float>& state) {
  const Inputs inputs = inputs_of(load, basis.inputs);
  const std::size_t width = 3 * basis.control_weight.size();
  BellyMotion motion{std::vector<float>(width), std::vector<float>(width)};
  show_state(basis, belly, inputs.values(), inputs.rates(), state.empty() ? state_with_loads(belly, inputs, 0) : state,
             motion.displacement, motion.velocity);
  return motion;
}

/// What the new method leaves of what was shown. Empty where nobody would see it.
std::vector<float> fade_between(const BellyMotion& before, const BellyMotion& after) {
  constexpr float least_m = 1e-5F;
  constexpr float top = 4.0F / 27;  // of x(1 − x)²
  const std::size_t width = before.displacement.size();
  std::vector<float> fade(2 * width);
  bool seen = false;
  for (std::size_t i = 0; i < width; ++i) {
    fade[i] = before.displacement[i] - after.displacement[i];
    fade[width + i] = before.velocity[i] - after.velocity[i];
    seen = seen || std::abs(fade[i]) > least_m || top * fade_s * std::abs(fade[width + i]) > least_m;
  }
  if (!seen) fade.clear();
  return fade;
}

}  // namespace

BellyLoad load_of(const World& world, Entity muscle, float tick_s) {
  BellyLoad load;
  load.tick_s = tick_s;
  if (const auto end = world.get<EndDisplacement>(muscle)) {
    load.from = end->from_m;
    load.to = end->to_m;
  } else if (const auto pull = world.get<EndForce>(muscle)) {
    load.drive = Drive::force;
    load.from = pull->from_n;
    load.to = pull->to_n;
  }
  if (const auto frame = world.get<FrameLoad>(muscle)) load.frame = *frame;
  return load;
}

std::optional<BellyMotion> computed_motion(const World& world, Entity muscle, float tick_s, LastReducedBelly& last) {
  const auto scale = world.get<BellyScale>(muscle);
  if (!scale) return std::nullopt;
  if (world.has<NodalVelocity>(muscle)) {
    return BellyMotion{field_of<NodalDisplacement>(world, muscle), field_of<NodalVelocity>(world, muscle)};
  }
  const BellyLoad load = load_of(world, muscle, tick_s);
  if (world.has<StaticSteps>(muscle)) {
    const StaticBelly belly{*world.shared<MuscleTemplate>(muscle), *world.shared<BellySolver>(muscle), *scale};
    BellyMotion motion{field_of<NodalDisplacement>(world, muscle), {}};
    motion.velocity = static_velocity(belly, load, motion.displacement);
    return motion;
  }
  const auto* basis = world.shared<ReducedBasis>(muscle);
  if (basis == nullptr) return std::nullopt;
  if (last.basis != basis || last.scale.across != scale->across || last.scale.along != scale->along) {
    ReducedBellies one;
    if (!solve_bellies(*basis, {&*scale, 1}, one)) return std::nullopt;  // never: it was made before
    last = {basis, *scale, belly_of(one, 0)};
  }
  return reduced_motion(*basis, last.belly, load, field_of<ReducedState>(world, muscle));
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

Beginning begin(const NextBelly& next, bool moves) {
  Beginning from;
  if (next.choice.method == Method::reduced) {
    const ReducedBasis& basis = *next.belly.basis;
    if (next.choice.reduced.moving) {
      from.state =
          moves ? state_with_loads(*next.belly.motions, inputs_of(next.load, basis.inputs), basis.options.damping_per_s)
                : std::vector<float>(reduced_state_width(basis.vectors));
    }
    if (has_control_points(next.choice)) {
      from.displacement = reduced_motion(basis, *next.belly.motions, next.load, from.state).displacement;
    }
    return from;
  }
  BellyMotion motion = stretched(next.belly, next.line, next.load);
  if (next.choice.inertia) {
    settle(next.belly, *next.belly.resting, next.load, moves ? from_nearby : from_nothing, motion, moves);
  }
  if (!moves) std::fill(motion.velocity.begin(), motion.velocity.end(), 0.0F);
  return {std::move(motion.displacement), std::move(motion.velocity), {}, {}};
}

Beginning go_on(const NextBelly& next, const PastBelly& past, bool keeps) {
  const Method method = next.choice.method;
  const auto& [computed, shown, seen] = past;
  if (method != Method::reduced && method != Method::statics) return {shown.displacement, shown.velocity, {}, {}};
  Beginning from;
  BellyMotion after;
  if (method == Method::statics) {
    after = stretched(next.belly, next.line, next.load);
    settle(next.belly, *next.belly.solver, next.load, next.load.frame ? from_nearby : once, after, seen);
  } else {
    if (next.choice.reduced.moving && !keeps) from.state = reduced_state(next.belly, next.load, shown);
    if (!has_control_points(next.choice)) return from;
    after = keeps ? computed : reduced_motion(*next.belly.basis, *next.belly.motions, next.load, from.state);
  }
  if (seen) from.fade = fade_between(shown, after);
  from.displacement = std::move(after.displacement);
  return from;
}

}  // namespace mobil
