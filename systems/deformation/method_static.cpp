#include "systems/deformation/method_static.h"

#include <algorithm>

#include "systems/deformation/deformation.h"
#include "systems/deformation/restart.h"

namespace mobil::inline v0_3 {
namespace {
namespace of_static {

/// Static bellies have no velocity. The buffer passed instead is not touched.
void settle(Shared<MuscleTemplate> shape, Shared<BellySolver> solver, TagValue<StaticSteps>, float tick_s,
            Scratch<ScratchFloats> scratch, const BellyScale<Lanes<float>>& scale, const EndDrive<Lanes<float>>& end,
            Maybe<FrameLoad> frame, Field<NodalDisplacement> displacement, BellyReport<Lanes<float>>& report,
            const Rows& rows, Tally<RestartedBellies> restarted) {
  deform_implicit({*shape, scale, displacement.data, displacement.data, report, Stiffness::individual, frame.block},
                  *solver, {shape->options.far_end, end}, 1, tick_s, scratch.data);
  restarted.add(restart_bellies(*shape, rows, end, tick_s, report, displacement.data, nullptr));
}

Module static_module() {
  return {.name = "deformation, static",
          .parts = {component_id(TagValue<StaticSteps>{})},
          .systems = [](ScheduleBuilder& systems) { systems.add("deformation, static", &settle).one_of("bellies"); }};
}

void static_parts(const MuscleKind& kind, std::vector<ComponentId>& parts) {
  parts.push_back(component_id(TagValue<ScratchFloats>{scratch_floats(*kind.shape, Method::statics)}));
  parts.push_back(component_id(TagValue<StaticSteps>{kind.steps}));
  parts.push_back(component_id(kind.solver));
}

bool recognise(const Archetype& key, MuscleKind& kind) {
  const ComponentId* const steps = find_component(key, type_id<StaticSteps>());
  if (steps == nullptr || kind.shape.resource == nullptr) return false;
  if (kind.solver.resource == nullptr || kind.solver->method != Method::statics) return false;
  kind.method.method = Method::statics;
  kind.steps = static_cast<std::uint32_t>(steps->value);
  return kind.steps == steps->value;
}

std::optional<BellyMotion> computed(const World& world, Entity muscle, float tick_s, LastReducedBelly&) {
  const BellyScale<float> scale = *world.get<BellyScale>(muscle);
  const StaticBelly belly{*world.shared<MuscleTemplate>(muscle), *world.shared<BellySolver>(muscle), scale};
  BellyMotion motion{field_of<NodalDisplacement>(world, muscle), {}};
  motion.velocity = static_velocity(belly, load_of(world, muscle, tick_s), motion.displacement);
  return motion;
}

Beginning begin(const NextBelly& next, bool moves) {
  BellyMotion motion = stretched(next.belly, next.line, next.load);
  if (next.choice.inertia) {
    settle_belly(next.belly, *next.belly.resting, next.load,
                 moves ? static_solutions::from_nearby : static_solutions::from_nothing, motion, false);
  }
  return {std::move(motion.displacement), {}, {}, {}};
}

Beginning go_on(const NextBelly& next, const PastBelly& past, bool) {
  BellyMotion after = stretched(next.belly, next.line, next.load);
  settle_belly(next.belly, *next.belly.solver, next.load,
               next.load.frame ? static_solutions::from_nearby : static_solutions::once, after, past.seen);
  Beginning from;
  if (past.seen) from.fade = fade_between(past.shown, after);
  from.displacement = std::move(after.displacement);
  return from;
}

}  // namespace of_static
}  // namespace

constinit const DeformationMethod static_method = {
    Method::statics,      &of_static::static_module, &of_static::static_parts, &of_static::recognise,
    &of_static::computed, &of_static::begin,         &stretched_at_rest,       &of_static::go_on};

}  // namespace mobil::inline v0_3
