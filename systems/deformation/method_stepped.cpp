#include "systems/deformation/method_stepped.h"

#include <algorithm>

#include "systems/deformation/deformation.h"
#include "systems/deformation/restart.h"

namespace mobil::inline v0_3 {
namespace {
namespace of_stepped {

void deform(Shared<MuscleTemplate> shape, TagValue<Substeps> substeps, float tick_s, Scratch<ScratchFloats> scratch,
            const BellyScale<Lanes<float>>& scale, const EndDrive<Lanes<float>>& end, Maybe<FrameLoad> frame,
            Field<NodalDisplacement> displacement, Field<NodalVelocity> velocity, BellyReport<Lanes<float>>& report,
            const Rows& rows, Tally<RestartedBellies> restarted) {
  deform_explicit({*shape, scale, displacement.data, velocity.data, report, Stiffness::individual, frame.block},
                  {shape->options.far_end, end}, static_cast<std::uint32_t>(substeps.value), tick_s, scratch.data);
  restarted.add(restart_bellies(*shape, rows, end, tick_s, report, displacement.data, velocity.data));
}

void solve(Shared<MuscleTemplate> shape, Shared<BellySolver> solver, TagValue<SolvedSteps> steps, float tick_s,
           Scratch<ScratchFloats> scratch, const BellyScale<Lanes<float>>& scale, const EndDrive<Lanes<float>>& end,
           Maybe<FrameLoad> frame, Field<NodalDisplacement> displacement, Field<NodalVelocity> velocity,
           BellyReport<Lanes<float>>& report, const Rows& rows, Tally<RestartedBellies> restarted) {
  deform_implicit({*shape, scale, displacement.data, velocity.data, report, Stiffness::individual, frame.block},
                  *solver, {shape->options.far_end, end}, static_cast<std::uint32_t>(steps.value), tick_s,
                  scratch.data);
  restarted.add(restart_bellies(*shape, rows, end, tick_s, report, displacement.data, velocity.data));
}

void stepped_parts(const MuscleKind& kind, std::vector<ComponentId>& parts) {
  const MuscleTemplate& shape = *kind.shape;
  const auto width = static_cast<std::uint32_t>(nodal_width(shape.mesh.cells));
  parts.push_back(component_id(TagValue<ScratchFloats>{scratch_floats(shape, kind.method.method)}));
  parts.push_back(component_id(FieldWidth<NodalVelocity>{width}));
  if (kind.method.method == Method::explicit_central) {
    parts.push_back(component_id(TagValue<Substeps>{kind.steps}));
  } else {
    parts.push_back(component_id(TagValue<SolvedSteps>{kind.steps}));
    parts.push_back(component_id(kind.solver));
  }
}

template <Method method>
bool recognise(const Archetype& key, MuscleKind& kind) {
  const ComponentId* const steps =
      find_component(key, method == Method::explicit_central ? type_id<Substeps>() : type_id<SolvedSteps>());
  if (steps == nullptr || kind.shape.resource == nullptr) return false;
  if (method != Method::explicit_central && (kind.solver.resource == nullptr || kind.solver->method != method))
    return false;
  kind.method.method = method;
  kind.steps = static_cast<std::uint32_t>(steps->value);
  return kind.steps == steps->value;
}

Beginning begin(const NextBelly& next, bool moves) {
  BellyMotion motion = stretched(next.belly, next.line, next.load);
  if (next.choice.inertia) {
    settle_belly(next.belly, *next.belly.resting, next.load,
                 moves ? static_solutions::from_nearby : static_solutions::from_nothing, motion, moves);
  }
  if (!moves) std::fill(motion.velocity.begin(), motion.velocity.end(), 0.0F);
  return {std::move(motion.displacement), std::move(motion.velocity), {}, {}};
}

Module explicit_module() {
  return {.name = "deformation, explicit",
          .parts = {component_id(TagValue<Substeps>{}), component_id(FieldWidth<NodalVelocity>{})},
          .systems = [](ScheduleBuilder& systems) { systems.add("deformation", &deform).one_of("bellies"); }};
}

Module implicit_module() {
  return {.name = "deformation, implicit",
          .parts = {component_id(TagValue<SolvedSteps>{}), component_id(Shared<BellySolver>{})},
          .systems = [](ScheduleBuilder& systems) { systems.add("deformation, solved", &solve).one_of("bellies"); }};
}

}  // namespace of_stepped
}  // namespace

constinit const DeformationMethod explicit_method = {Method::explicit_central,
                                                     &of_stepped::explicit_module,
                                                     &of_stepped::stepped_parts,
                                                     &of_stepped::recognise<Method::explicit_central>,
                                                     &nodal_motion,
                                                     &of_stepped::begin,
                                                     &stretched_at_rest,
                                                     &go_on_as_nodes};
constinit const DeformationMethod implicit_method = {Method::implicit_central,
                                                     &of_stepped::implicit_module,
                                                     &of_stepped::stepped_parts,
                                                     &of_stepped::recognise<Method::implicit_central>,
                                                     &nodal_motion,
                                                     &of_stepped::begin,
                                                     &stretched_at_rest,
                                                     &go_on_as_nodes};
constinit const DeformationMethod newmark_method = {Method::newmark,
                                                    nullptr,
                                                    &of_stepped::stepped_parts,
                                                    &of_stepped::recognise<Method::newmark>,
                                                    &nodal_motion,
                                                    &of_stepped::begin,
                                                    &stretched_at_rest,
                                                    &go_on_as_nodes};

}  // namespace mobil::inline v0_3
