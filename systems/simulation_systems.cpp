// The systems of a simulation, and what joins them to tables.
#include "components/fade.h"
#include "systems/deformation/deformation.h"
#include "systems/deformation/fade.h"
#include "systems/deformation/reduced.h"
#include "systems/forces/forces.h"
#include "systems/gait/gait.h"
#include "systems/kinematics/kinematics.h"
#include "systems/lines/frame_motion.h"
#include "systems/lines/line_motion.h"
#include "systems/lines/line_of_action.h"
#include "systems/simulation.h"

namespace mobil {
namespace {

constexpr LegPost::Leg nobodys_leg{
    {{0, 1, 0}, {0, 0.5F, 0}, {0, 0, 0}, {0, 0, 0, 1}, {0, 0, 0, 1}, {0, 0, 0, 1}, {0, 0, 0, 1}}};

void publish_legs(const Pose<Lanes<float>>& pose, Published<LegPost> posts) {
  post_legs(pose, posts.row);
}

using LegsOfOwners = LookupPublished<LegPost>;

const LegPost::Leg& leg_of(const LegsOfOwners& posts, const MuscleOwner<Lanes<float>>& owner, std::size_t lane) {
  const LegPost* post = posts.find({owner.index[lane], owner.generation[lane]});
  return post == nullptr ? nobodys_leg : post->leg[owner.side[lane]];
}

/// The one gather of a tick; those of the block `ahead` are fetched meanwhile. Whose human is gone stands still.
LegFrames<Lanes<float>> legs_of(const LegsOfOwners& posts, const MuscleOwner<Lanes<float>>& owner,
                                Ahead<MuscleOwner> ahead) {
  const LegPost::Leg* from[lane_count];
  for (std::size_t lane = 0; lane < lane_count; ++lane) from[lane] = &leg_of(posts, owner, lane);
  LegFrames<Lanes<float>> leg;
  take_legs(from, leg);
  if (ahead.block == nullptr) return leg;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const LegPost::Leg& next = leg_of(posts, *ahead.block, lane);
    __builtin_prefetch(&next);
    __builtin_prefetch(reinterpret_cast<const char*>(&next) + 64);
  }
  return leg;
}

template <template <class> class End>
void follow_lines(LegsOfOwners posts, const MuscleOwner<Lanes<float>>& owner, Ahead<MuscleOwner> ahead,
                  Shared<MuscleLines> lines, const LegScale<Lanes<float>>& scale, LineOfAction<Lanes<float>>& line,
                  End<Lanes<float>>& end) {
  lines_of_action(*lines, scale, legs_of(posts, owner, ahead), line, end);
}

void move_lines(LegsOfOwners posts, const MuscleOwner<Lanes<float>>& owner, Ahead<MuscleOwner> ahead,
                Shared<MuscleLines> lines, const LegScale<Lanes<float>>& scale, const LineOfAction<Lanes<float>>& line,
                LineMotion<Lanes<float>>& motion, float tick_s) {
  line_motion(*lines, scale, legs_of(posts, owner, ahead), line, motion, tick_s);
}

/// ECD.
template <template <class> class End>
void deform(Shared<MuscleTemplate> shape, TagValue<Substeps> substeps, float tick_s, Scratch<ScratchFloats> scratch,
            const BellyScale<Lanes<float>>& scale, const End<Lanes<float>>& end, Maybe<FrameLoad> frame,
            Field<NodalDisplacement> displacement, Field<NodalVelocity> velocity, BellyReport<Lanes<float>>& report) {
  deform_explicit({*shape, scale, displacement.data, velocity.data, report, Stiffness::individual, frame.block}, end,
                  static_cast<std::uint32_t>(substeps.value), tick_s, scratch.data);
}

/// ICD and CAA.
template <template <class> class End>
void solve(Shared<MuscleTemplate> shape, Shared<BellySolver> solver, TagValue<SolvedSteps> steps, float tick_s,
           Scratch<ScratchFloats> scratch, const BellyScale<Lanes<float>>& scale, const End<Lanes<float>>& end,
           Maybe<FrameLoad> frame, Field<NodalDisplacement> displacement, Field<NodalVelocity> velocity,
           BellyReport<Lanes<float>>& report) {
  deform_implicit({*shape, scale, displacement.data, velocity.data, report, Stiffness::individual, frame.block},
                  *solver, end, static_cast<std::uint32_t>(steps.value), tick_s, scratch.data);
}

/// Static. There is no velocity; what stands in for it is not touched.
template <template <class> class End>
void settle(Shared<MuscleTemplate> shape, Shared<BellySolver> solver, TagValue<StaticSteps>, float tick_s,
            Scratch<ScratchFloats> scratch, const BellyScale<Lanes<float>>& scale, const End<Lanes<float>>& end,
            Maybe<FrameLoad> frame, Field<NodalDisplacement> displacement, BellyReport<Lanes<float>>& report) {
  deform_implicit({*shape, scale, displacement.data, displacement.data, report, Stiffness::individual, frame.block},
                  *solver, end, 1, tick_s, scratch.data);
}

/// Who moves along vectors.
template <template <class> class End>
void move_reduced(Shared<ReducedBasis> basis, float tick_s, const BellyScale<Lanes<float>>& scale,
                  const End<Lanes<float>>& end, Maybe<FrameLoad> frame, Field<const ReducedMotion> motion,
                  Field<ReducedState> state) {
  deform_reduced({*basis, scale, state.data, motion.data, frame.block, state.next, motion.next}, end, tick_s);
}

/// What is but read of a block along vectors; motion where there is more than one input.
ReducedBlock read_only(const ReducedBasis& basis, const BellyScale<Lanes<float>>& scale, const float* state,
                       const float* motion, const FrameLoad<Lanes<float>>* frame) {
  return {basis, scale, const_cast<float*>(state), motion, frame};
}

/// Where somebody looks at them.
template <template <class> class End>
void place(Shared<ReducedBasis> basis, const BellyScale<Lanes<float>>& scale, const End<Lanes<float>>& end,
           Maybe<FrameLoad> frame, Field<const ReducedState> state, Field<const ReducedShape> shape,
           Field<NodalDisplacement> displacement) {
  ReducedBlock block = read_only(*basis, scale, state.data, nullptr, frame.block);
  block.next_state = state.next;
  place_control_points(block, {shape.data, displacement.data, false, shape.next}, end);
}

/// Where somebody looks at static answers.
template <template <class> class End>
void place_still(Shared<ReducedBasis> basis, TagValue<ReducedStatic>, const BellyScale<Lanes<float>>& scale,
                 const End<Lanes<float>>& end, Maybe<FrameLoad> frame, Field<const ReducedShape> shape,
                 Field<NodalDisplacement> displacement) {
  place_static(read_only(*basis, scale, nullptr, nullptr, frame.block),
               {shape.data, displacement.data, false, shape.next}, end);
}

/// Where somebody asks what either did.
template <template <class> class End>
void report_vectors(Shared<ReducedBasis> basis, Shared<MuscleTemplate> control, float tick_s,
                    const BellyScale<Lanes<float>>& scale, const End<Lanes<float>>& end, Maybe<FrameLoad> frame,
                    MaybeField<ReducedMotion> motion, MaybeField<ReducedState> state, Field<const ReducedShape> shape,
                    Field<const NodalDisplacement> displacement, BellyReport<Lanes<float>>& report) {
  const ControlPoints points{shape.data, const_cast<float*>(displacement.data)};  // it is but read
  report_reduced(read_only(*basis, scale, state.data, motion.data, frame.block), *control, points, end, tick_s, report);
}

/// What a change of method left over.
void fade(float tick_s, Field<const NodalDisplacement> displacement, Field<const FadeStart> start,
          Fade<Lanes<float>>& since, Field<ShownDisplacement> shown) {
  fade_out(displacement.data, start.data, displacement.words, since, shown.data, tick_s);
}

}  // namespace

Result<Schedule> make_schedule(std::pmr::memory_resource* memory) {
  ScheduleBuilder systems;
  systems.add("gait", &advance_gait)
      .add_packed("replan", &lanes_to_plan, &plan_next_step)
      .after("gait")
      .add("turn", &turn_gait)
      .after("replan")
      .add("kinematics", &pose_skeleton)
      .add("centre of mass", &centre_of_mass)
      .add("forces", &joint_forces)
      .add("leg frames", &publish_legs)
      .add("lines of action", &follow_lines<EndDisplacement>)
      .add("lines of action, pulling", &follow_lines<EndForce>)
      .after("lines of action")
      .add("line motion", &move_lines)
      .add("frame motion", &frame_motion)
      .add("deformation", &deform<EndDisplacement>)
      .add("deformation, pulled", &deform<EndForce>)
      .after("deformation")
      .add("deformation, solved", &solve<EndDisplacement>)
      .after("deformation, pulled")
      .add("deformation, solved, pulled", &solve<EndForce>)
      .after("deformation, solved")
      .add("deformation, static", &settle<EndDisplacement>)
      .after("deformation, solved, pulled")
      .add("deformation, static, pulled", &settle<EndForce>)
      .after("deformation, static")
      .add("deformation, reduced", &move_reduced<EndDisplacement>)
      .add("deformation, reduced, pulled", &move_reduced<EndForce>)
      .after("deformation, reduced")
      .add("control points", &place<EndDisplacement>)
      .after("deformation, static, pulled")
      .add("control points, pulled", &place<EndForce>)
      .after("control points")
      .add("control points, static", &place_still<EndDisplacement>)
      .after("control points, pulled")
      .add("control points, static, pulled", &place_still<EndForce>)
      .after("control points, static")
      .add("reports", &report_vectors<EndDisplacement>)
      .after("deformation, static, pulled")
      .add("reports, pulled", &report_vectors<EndForce>)
      .after("reports")
      .add("fade", &fade);
  return systems.build(memory);
}

}  // namespace mobil
