#include "systems/people/people_modules.h"
#include <mobil/schedule.h>
#include "engine/fetch_ahead.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <initializer_list>

#include <mobil/anthropometry.h>
#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/leg_frames.h>
#include <mobil/components/pose.h>
#include <mobil/components/step_plan.h>
#include <mobil/forces.h>
#include <mobil/systems/limits/limit_monitor.h>
#include "engine/snapshot.h"
#include "systems/activation/excitation.h"
#include "systems/forces/forces.h"
#include "systems/gait/body_motion.h"
#include "systems/gait/footing.h"
#include "systems/gait/gait.h"
#include "systems/gait/kinematics.h"
#include "systems/lines/line_of_action.h"
#include "systems/people/ground_forces.h"
#include "systems/people/person_requests.h"
#include "systems/people/pose_measures.h"

namespace mobil::inline v0_3 {
namespace {

/// Prefetches the clock of the block three ahead, which every tick reads. One block has too little work to hide the
/// latency of memory.
void fetch_clock(const GaitState<Lanes<float>>* state) {
  if (state != nullptr) FetchAhead(&state->time_s).fetch(1);
}

void advance_walkers(const StepPlan<Lanes<float>>& plan, Ahead<StepPlan> next_plan, GaitState<Lanes<float>>& state,
                     Ahead<GaitState> next, float tick_s) {
  fetch_clock(next.third);
  if (next_plan.third != nullptr) FetchAhead(&next_plan.third->duration_s).fetch(1);
  advance_gait(plan, state, tick_s);
}

void turn_walkers(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                  const Gait<Lanes<float>>& wanted, GaitState<Lanes<float>>& state, Ahead<GaitState> next,
                  float tick_s) {
  fetch_clock(next.third);
  turn_gait(size, plan, wanted, state, tick_s);
}

void pose_walkers(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan, Ahead<StepPlan> next_plan,
                  const GaitState<Lanes<float>>& state, Ahead<GaitState> next_state, Maybe<Footing> footing,
                  Pose<Lanes<float>>& pose, Ahead<Pose> next_pose, JointAngles<Lanes<float>>& angles,
                  Ahead<JointAngles> next_angles, Feet<Lanes<float>>& feet, Ahead<Feet> next_feet) {
  pose_skeleton(size, plan, state, footing.block, pose, angles, feet,
                {next_plan.block, next_state.block, next_pose.block, next_angles.block, next_feet.block});
}

void move_walkers(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                  const GaitState<Lanes<float>>& state, Maybe<Footing> footing, BodyMotion<Lanes<float>>& motion) {
  walker_motion(size, plan, state, footing.block, motion);
}

void press_walkers(const BodySize<Lanes<float>>& size, const BodyMotion<Lanes<float>>& motion,
                   const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state, Maybe<Footing> footing,
                   GroundReaction<Lanes<float>>& ground, JointMoments<Lanes<float>>& moments) {
  joint_forces(size, motion, plan, state, footing.block, ground, moments);
}

void publish_legs(const Pose<Lanes<float>>& pose, Ahead<Pose> next, Published<PublishedLeg> posts) {
  post_legs(pose, next.block, posts.row);
}

void publish_clocks(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                    const GaitState<Lanes<float>>& state, Published<PublishedLeg> posts) {
  set_clocks(size, plan, state, posts.row);
}

/// Checks that a skeleton has all of its components and a walker all of gait's. A compact walker has no pose component.
Result<void> check_walker_key(const Archetype& key, const World&) {
  const auto count = [&](std::initializer_list<std::uint64_t> ids) {
    return std::count_if(ids.begin(), ids.end(), [&](std::uint64_t id) { return find_component(key, id) != nullptr; });
  };
  const auto body = count({type_id<BodySize<float>>(), type_id<Physique<float>>()});
  const auto pose = count(
      {type_id<Pose<float>>(), type_id<JointAngles<float>>(), type_id<Feet<float>>(), type_id<CentreOfMass<float>>()});
  const auto walk = count({type_id<Gait<float>>(), type_id<StepPlan<float>>(), type_id<GaitState<float>>()});
  const auto limbs = count({type_id<LimbLengths<float>>()});
  const bool nobody = body == 0 && pose == 0 && walk == 0, posed = body == 2 && pose == 4 && walk == 0;
  const bool walker = body == 2 && (pose == 4 || pose == 0) && walk == 3;
  if ((nobody || posed || walker) && (limbs == 0 || posed)) return {};
  return damaged("the parts of a person");
}

/// Checks that forces are complete and match a walker (BodyMotion) or a posed person (PoseHistory).
Result<void> check_forces_key(const Archetype& key, const World&) {
  const auto has = [&](std::uint64_t id) { return find_component(key, id) != nullptr; };
  const bool walks = has(type_id<Gait<float>>()), forces = has(type_id<GroundReaction<float>>());
  const bool motion = has(type_id<BodyMotion<float>>()), past = has(type_id<PoseHistory<float>>());
  if (forces == has(type_id<JointMoments<float>>()) && motion == (forces && walks) && past == (forces && !walks))
    return {};
  return damaged("the forces of a person");
}

/// Checks that every saved body is within the ranges of check_body().
Result<void> check_walker_rows(const SavedWorld& saved, std::uint32_t table) {
  const std::uint32_t size = saved.column(table, type_id<BodySize<float>>());
  const std::uint32_t physique = saved.column(table, type_id<Physique<float>>());
  const std::uint32_t limbs = saved.column(table, type_id<LimbLengths<float>>());
  if (size == Table::no_column || physique == Table::no_column) return {};
  for (std::uint32_t row = 0; row < saved.tables[table].rows; ++row) {
    const auto number = [&](std::uint32_t word) { return std::bit_cast<float>(saved.word(table, row, word)); };
    const std::uint32_t build = saved.word(table, row, physique + 3);
    BodyRequest body{number(size),
                     number(size + 1),
                     {number(physique), number(physique + 1), number(physique + 2)},
                     constitution_of(build),
                     {},
                     sex_of(build),
                     age_of(build)};
    if (limbs != Table::no_column)
      body.limbs = {number(limbs), number(limbs + 1), number(limbs + 2), number(limbs + 3)};
    if (!check_body(body)) return damaged("a person's body");
    const BodySize<float> made = body_size(body);
    std::array<std::uint32_t, sizeof(made) / sizeof(std::uint32_t)> words;
    std::memcpy(words.data(), &made, sizeof(made));
    for (std::uint32_t w = 0; w < words.size(); ++w)
      if (saved.word(table, row, size + w) != words[w]) return damaged("a person's sizes");
  }
  return {};
}

}  // namespace

Module walking_module() {
  return {.name = "walking",
          .version = 4,
          .parts = {component_id<Gait>(), component_id<StepPlan>(), component_id<GaitState>()},
          .systems = [](ScheduleBuilder& systems) {
            systems.add("gait", &advance_walkers)
                .add_packed("replan", &lanes_to_plan, &plan_next_step)
                .after("gait")
                .add("turn", &turn_walkers)
                .after("replan")
                .add("walk limits", &count_limit_violations)
                .after("turn")
                .add("footing", &follow_feet)
                .after("turn")
                .add("kinematics", &pose_walkers)
                .add("centre of mass", &centre_of_mass);
          }};
}

Module forces_module() {
  return {.name = "forces",
          .parts = {component_id<BodyMotion>(), component_id<GroundReaction>(), component_id<JointMoments>(),
                    component_id<PoseHistory>()},
          .systems =
              [](ScheduleBuilder& systems) {
                systems.add("motion", &move_walkers)
                    .add("forces", &press_walkers)
                    .add("posed forces", &press_posed)
                    .after("forces");
              },
          .check_key = &check_forces_key};
}

Module skeleton_module() {
  return {.name = "skeleton",
          .version = 2,
          .parts = {component_id<BodySize>(), component_id<Physique>(), component_id<LimbLengths>(),
                    component_id<Pose>(), component_id<JointAngles>(), component_id<Feet>(),
                    component_id<CentreOfMass>(), component_id(Publishes<PublishedLeg>{})},
          .systems =
              [](ScheduleBuilder& systems) {
                systems.add("leg frames", &publish_legs)
                    .add("leg clocks", &publish_clocks)
                    .after("leg frames")
                    .add("limbs' mass", &move_mass_along_limbs)
                    .after("centre of mass");
              },
          .check_key = &check_walker_key,
          .check_rows = &check_walker_rows};
}

}  // namespace mobil::inline v0_3
