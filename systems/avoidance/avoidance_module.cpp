#include "systems/avoidance/avoidance_module.h"

#include <cstdint>

#include <mobil/components/avoidance.h>
#include <mobil/components/gait.h>
#include <mobil/components/pose.h>
#include <mobil/schedule.h>
#include "engine/snapshot.h"
#include "systems/gait/shoulders.h"

namespace mobil::inline v0_3 {
namespace {

bool within(float value, float low, float high) {
  return value >= low && value <= high;  // false for NaN
}

void ease_walkers(const GaitState<Lanes<float>>&, AvoidanceState<Lanes<float>>& course, float tick_s) {
  ease_shoulders(course, tick_s);
}

void turn_walkers(const GaitState<Lanes<float>>&, const AvoidanceState<Lanes<float>>& course,
                  Pose<Lanes<float>>& pose) {
  turn_shoulders(course.turn_rad, pose);
}

bool is_sound_course(const AvoidanceState<float>& course) {
  constexpr float fastest_m_s = 10, furthest_rad = 1e4F, longest = 10, broadest_m = 10, for_ever_s = 1e9F;
  constexpr float round_rad = 1;
  return within(course.speed_m_s, 0, fastest_m_s) && within(course.heading_rad, -furthest_rad, furthest_rad) &&
         within(course.usual, 0, longest) && within(course.radius_m, 0, broadest_m) &&
         within(course.shoulders_m, 0, broadest_m) && within(course.waits_s, 0, for_ever_s) &&
         within(course.turn_rad, -round_rad, round_rad) && within(course.turn_to_rad, -round_rad, round_rad) &&
         // the spring stays within that range on its way
         within(course.turn_rad + course.turn_rad_s / shoulder_spring_per_s, -round_rad, round_rad);
}

Result<void> check_course(const SavedWorld& saved, std::uint32_t table) {
  if (!every_row<AvoidanceState>(saved, table, is_sound_course)) return damaged("where somebody wants to go");
  return {};
}

}  // namespace

Module avoidance_module() {
  return {.name = "avoidance",
          .version = 2,
          .parts = {component_id<AvoidanceState>()},
          .systems =
              [](ScheduleBuilder& systems) {
                systems.add("shoulders", &ease_walkers).add("turned shoulders", &turn_walkers).after("kinematics");
              },
          .before = {steps_chosen()},
          .check_rows = &check_course};
}

}  // namespace mobil::inline v0_3
