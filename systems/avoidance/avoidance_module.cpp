#include "systems/avoidance/avoidance_module.h"

#include <cstdint>

#include "components/avoidance.h"
#include "engine/snapshot.h"

namespace mobil {
namespace {

bool within(float value, float low, float high) {
  return value >= low && value <= high;  // false where it is not a number
}

bool is_sound(const Course<float>& course) {
  constexpr float fastest_m_s = 10, furthest_rad = 1e4F, longest = 10, broadest_m = 10, for_ever_s = 1e9F;
  return within(course.speed_m_s, 0, fastest_m_s) && within(course.heading_rad, -furthest_rad, furthest_rad) &&
         within(course.usual, 0, longest) && within(course.radius_m, 0, broadest_m) &&
         within(course.waits_s, 0, for_ever_s);
}

Result<void> check_rows(const SavedWorld& saved, std::uint32_t table) {
  if (!every_row<Course>(saved, table, is_sound))
    return fail("the snapshot does not agree with itself (where somebody wants to go); give one that `save` made");
  return {};
}

}  // namespace

Module avoidance_module() {
  return {.name = "avoidance", .parts = {component_part<Course>()}, .check_rows = &check_rows};
}

}  // namespace mobil
