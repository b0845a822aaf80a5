#include "systems/people/people_modules.h"

#include "components/body.h"
#include "components/forces.h"
#include "components/gait.h"
#include "components/leg_frames.h"
#include "components/pose.h"
#include "systems/forces/forces.h"
#include "systems/gait/gait.h"
#include "systems/kinematics/kinematics.h"
#include "systems/lines/line_of_action.h"

namespace mobil {
namespace {

void publish_legs(const Pose<Lanes<float>>& pose, Published<LegPost> posts) {
  post_legs(pose, posts.row);
}

}  // namespace

Module walking_module() {
  return {.name = "walking",
          .parts = {component_part<Gait>(), component_part<StepPlan>(), component_part<GaitState>(),
                    component_part<JointAngles>(), component_part<Feet>(), component_part<CentreOfMass>()},
          .systems = [](ScheduleBuilder& systems) {
            systems.add("gait", &advance_gait)
                .add_packed("replan", &lanes_to_plan, &plan_next_step)
                .after("gait")
                .add("turn", &turn_gait)
                .after("replan")
                .add("kinematics", &pose_skeleton)
                .add("centre of mass", &centre_of_mass);
          }};
}

Module forces_module() {
  return {.name = "forces",
          .parts = {component_part<MotionHistory>(), component_part<GroundReaction>(), component_part<JointMoments>()},
          .systems = [](ScheduleBuilder& systems) { systems.add("forces", &joint_forces); }};
}

Module skeleton_module() {
  return {.name = "skeleton",
          .parts = {component_part<BodySize>(), component_part<Pose>(), key_part(Publishes<LegPost>{})},
          .systems = [](ScheduleBuilder& systems) { systems.add("leg frames", &publish_legs); }};
}

}  // namespace mobil
