// Leg muscles of a simulation: rows that come, change and go.
#include "systems/simulation_muscles.h"

#include <algorithm>
#include <utility>

#include "systems/deformation/deformation.h"
#include "systems/kinematics/kinematics.h"
#include "systems/lines/frame_motion.h"
#include "systems/lines/line_motion.h"
#include "systems/lines/line_of_action.h"
#include "systems/simulation.h"
#include "systems/simulation_rows.h"

namespace mobil {
namespace {

/// A leg of a given pose, and its line of action with the end where it then is, as a first tick would write them.
template <template <class> class End>
struct FirstLine {
  LegFrames<float> leg;
  LineOfAction<float> line;
  End<float> end;
};

template <template <class> class End>
FirstLine<End> first_line(const MuscleLines& lines, const LegScale<float>& scale, const LineOfAction<float>& rest,
                          const Pose<float>& pose, Side side) {
  LegFrames<Lanes<float>> leg;
  for (std::size_t lane = 0; lane < lane_count; ++lane) gather_leg(pose, side, leg, lane);
  auto line = broadcast(rest);
  End<Lanes<float>> end{};
  lines_of_action(lines, broadcast(scale), leg, line, end);
  return {first_lane(leg), first_lane(line), first_lane(end)};
}

/// Of a line that has just begun: it does not lengthen yet.
LineMotion<float> first_motion(const MuscleLines& lines, const LegScale<float>& scale, const LegFrames<float>& leg,
                               const LineOfAction<float>& line, float tick_s) {
  LineMotion<Lanes<float>> motion{};
  line_motion(lines, broadcast(scale), broadcast(leg), broadcast(line), motion, tick_s);
  return first_lane(motion);
}

/// The motion of a muscle's frame up to now, as far as it is known, as the ticks before would have recorded it.
struct Inertia {
  FrameHistory<float> history;
  FrameLoad<float> load;
};

Inertia recent_inertia(const World& world, Entity human, const MuscleLines& lines, const LegScale<float>& scale,
                       Side side, float tick_s) {
  const auto sizes = broadcast(*world.get<BodySize>(human));
  const auto plan = *world.get<StepPlan>(human);
  const auto state = *world.get<GaitState>(human);
  FrameHistory<Lanes<float>> history{};
  FrameLoad<Lanes<float>> load{};
  for (const float ticks : {3.0F, 2.0F, 1.0F, 0.0F}) {
    const auto then = earlier(state, plan, ticks * tick_s);
    if (!then) continue;
    Pose<Lanes<float>> pose;
    JointAngles<Lanes<float>> angles;
    Feet<Lanes<float>> feet;
    pose_skeleton(sizes, broadcast(plan), broadcast(*then), pose, angles, feet);
    const auto line = first_line<EndDisplacement>(lines, scale, {}, first_lane(pose), side).line;
    frame_motion(broadcast(line), history, load, tick_s);
  }
  return {first_lane(history), first_lane(load)};
}

/// The shape of a belly under its line's first length, so that a walk begins without a ring.
std::vector<float> stretched(const Belly& belly, const LineOfAction<float>& line) {
  const BellyScale<float>& scale = belly.plan.scale;
  const float elongation = line.length_m - line.rest_length_m;
  const float sideways = elongation * scale.across / scale.along;
  std::vector<float> at_rest(nodal_width(belly.shape->shape->mesh.cells));
  for (std::size_t i = 0; i < at_rest.size(); ++i) {
    at_rest[i] = (i % 3 == 2 ? elongation : sideways) * static_cast<float>(belly.shape->stretch.displacement[i]);
  }
  return at_rest;
}

/// What that shape becomes under the load of a moment, ends as they are: static solutions, each of which takes away
/// most of what the last one left.
template <template <class> class End>
void sag(const Belly& belly, End<float> end, const FrameLoad<float>& load, std::vector<float>& displacement) {
  constexpr int solutions = 4;
  struct alignas(64) Line {
    float lane[lane_count];
  };
  const MuscleTemplate& shape = *belly.shape->shape;
  std::vector<Line> block(displacement.size());
  for (std::size_t i = 0; i < block.size(); ++i) std::fill_n(block[i].lane, lane_count, displacement[i]);
  std::vector<Line> scratch(scratch_floats(shape, Method::statics) / lane_count + 1);
  const auto scale = broadcast(belly.plan.scale);
  const auto ends = broadcast(end);
  const auto loads = broadcast(load);
  BellyReport<Lanes<float>> report;
  for (int i = 0; i < solutions; ++i) {
    deform_implicit({shape, scale, block.data()->lane, block.data()->lane, report, Stiffness::individual, &loads},
                    *belly.resting, ends, 1, 1.0F, scratch.data()->lane);
  }
  for (std::size_t i = 0; i < block.size(); ++i) displacement[i] = block[i].lane[0];
}

/// A component's row as it is, or what it is to begin with.
template <template <class> class C>
C<float> kept(const World& world, Entity entity, const C<float>& first) {
  return world.get<C>(entity).value_or(first);
}

/// `muscle` becomes an entity of these parts, or a new one where it is stale.
template <class... P>
void make_of(World& world, Entity& muscle, const P&... parts) {
  if (world.alive(muscle)) {
    world.remake(muscle, parts...);
  } else {
    muscle = world.create(parts...);
  }
}

template <class... P>
void make_by_method(World& world, Entity& muscle, const Belly& belly, Method method, const P&... parts) {
  const FieldWidth<NodalVelocity> velocity{static_cast<std::uint32_t>(nodal_width(belly.shape->shape->mesh.cells))};
  switch (method) {
    case Method::ecd:
      return make_of(world, muscle, parts..., velocity, TagValue<Substeps>{belly.steps});
    case Method::icd:
    case Method::caa:
      return make_of(world, muscle, parts..., velocity, TagValue<SolvedSteps>{belly.steps}, world.share(belly.solver));
    case Method::statics:
      return make_of(world, muscle, parts..., TagValue<StaticSteps>{belly.steps}, world.share(belly.solver));
    case Method::reduced:
    case Method::none:
      break;
  }
}

template <template <class> class End>
void make_muscle(World& world, Entity& muscle, const Human& human, Side side, const Belly& belly,
                 const LegMuscles& choice, float tick_s) {
  const MusclePlan& plan = belly.plan;
  const BellyTemplate& shape = *belly.shape;
  const Cells& cells = shape.shape->mesh.cells;
  LineOfAction<float> rest{};
  rest.rest_length_m = static_cast<float>(plan.rest_length_m);
  rest.stiffness_n_per_m = static_cast<float>(
      axial_stiffness(shape.axial, static_cast<double>(plan.scale.across), static_cast<double>(plan.scale.along)));
  const auto first = first_line<End>(*shape.lines, plan.leg_scale, rest, *world.get<Pose>(human.entity), side);
  auto line = kept(world, muscle, first.line);
  line.stiffness_n_per_m = rest.stiffness_n_per_m;
  const auto end = kept(world, muscle, first.end);
  const MuscleTemplate* before = world.shared<MuscleTemplate>(muscle);
  const bool anew = before == nullptr || before->mesh.cells != cells;

  const auto motion = world.get<LineMotion>(muscle);

  const auto by_method = [&](const auto&... more) {
    make_by_method(world, muscle, belly, choice.method,
                   MuscleOwner<float>{human.entity.index, human.entity.generation, side}, plan.leg_scale,
                   kept(world, muscle, first.leg), plan.scale, line, end, kept(world, muscle, BellyReport<float>{}),
                   FieldWidth<NodalDisplacement>{static_cast<std::uint32_t>(nodal_width(cells))},
                   world.share(shape.shape), world.share(shape.lines),
                   TagValue<ScratchFloats>{scratch_floats(*shape.shape, choice.method)}, more...);
  };
  std::vector<float> at_rest = anew ? stretched(belly, line) : std::vector<float>{};
  if (choice.inertia) {
    const Inertia recent = recent_inertia(world, human.entity, *shape.lines, plan.leg_scale, side, tick_s);
    const auto history = kept(world, muscle, recent.history);
    const auto load = kept(world, muscle, recent.load);
    if (anew) sag(belly, end, load, at_rest);
    by_method(history, load);
  } else {
    by_method();
  }
  if (choice.line_motion) {
    world.add(muscle, motion.value_or(first_motion(*shape.lines, plan.leg_scale, first.leg, line, tick_s)));
  }
  if (anew) {
    world.set_field<NodalDisplacement>(muscle, at_rest);
    if (world.has<NodalVelocity>(muscle)) world.set_field<NodalVelocity>(muscle, std::vector<float>(at_rest.size()));
  }
}

}  // namespace

void Simulation::set_muscle(Entity& muscle, const Human& human, Side side, const Belly& belly,
                            const LegMuscles& choice) {
  const auto tick_s = static_cast<float>(clock_.tick_s());
  if (choice.drive == Drive::displacement) {
    make_muscle<EndDisplacement>(world_, muscle, human, side, belly, choice, tick_s);
  } else {
    make_muscle<EndForce>(world_, muscle, human, side, belly, choice, tick_s);
  }
}

/// Muscles that are there keep their handles, others begin; those that are no longer asked for go.
void Simulation::set_muscles(Human& human, std::vector<Belly>& bellies, const LegMuscles& choice) {
  std::vector<HumanMuscle> all;
  for (Belly& belly : bellies) {
    HumanMuscle own{};
    for (HumanMuscle& before : human.muscles) {
      if (before.plan.muscle == belly.plan.muscle) std::swap(own.entity, before.entity);
    }
    for (const Side side : {right, left}) set_muscle(own.entity[side], human, side, belly, choice);
    own.plan = std::move(belly.plan);
    all.push_back(std::move(own));
  }
  for (const HumanMuscle& before : human.muscles) {
    for (const Entity muscle : before.entity) world_.destroy(muscle);
  }
  human.muscles = std::move(all);
  human.leg_muscles = choice;
}

Result<void> Simulation::add_leg_muscles(Entity entity, const LegMuscles& choice) {
  Human* human = find(entity);
  if (human == nullptr) return fail("add_leg_muscles: that person is not there (a stale handle); spawn one first");
  if (!human->muscles.empty()) return fail("add_leg_muscles: this person has leg muscles; remove them first");
  auto bellies = bellies_.bellies(human->body, choice, clock_.tick_s());
  if (!bellies) return fail("add_leg_muscles: " + bellies.error().message);
  set_muscles(*human, *bellies, choice);
  return {};
}

Result<void> Simulation::change_leg_muscles(Entity entity, const LegMuscles& choice) {
  Human* human = find(entity);
  if (human == nullptr) return fail("change_leg_muscles: that person is not there (a stale handle); spawn one first");
  if (human->muscles.empty()) return fail("change_leg_muscles: this person has no leg muscles; add them first");
  auto bellies = bellies_.bellies(human->body, choice, clock_.tick_s());
  if (!bellies) return fail("change_leg_muscles: " + bellies.error().message);
  set_muscles(*human, *bellies, choice);
  return {};
}

Status Simulation::remove_leg_muscles(Entity entity) {
  Human* human = find(entity);
  if (human == nullptr) return Status::stale_entity;
  for (const HumanMuscle& own : human->muscles) {
    for (const Entity muscle : own.entity) world_.destroy(muscle);
  }
  human->muscles.clear();
  human->leg_muscles = {};
  return Status::ok;
}

}  // namespace mobil
