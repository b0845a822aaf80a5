#include "systems/avoidance/lane.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/exact_math.h"

namespace mobil::inline v0_3 {
namespace {

/// Lanes to either side; their spacing, and the lateral distance within which a person belongs to one, m.
constexpr int lanes_aside = 4, lanes_across = 2 * lanes_aside + 1;
constexpr float lane_apart_m = 0.4F, lane_breadth_m = 0.7F;
/// Distance ahead within which people count, and at which the walker should be in the lane, m.
constexpr float lanes_ahead_m = 7, joins_ahead_m = 1.5F;
/// Costs of an oncoming walker in the lane; of changing to a lane, by its squared distance, /m²; of lanes to the left
/// among many oncoming walkers, /m; of a wall within wall_clear_m of the lane.
constexpr float of_oncoming = 0.5F, of_changing = 0.1F, of_left = 1, of_wall = 0.3F, wall_clear_m = 0.35F;
/// Distance ahead at which lanes are tested for walls, m; cost of a lane that a wall closes.
constexpr float tried_ahead_m = 0.8F, closed = 10;
/// Sum of weights in the lane straight ahead, and number of oncoming walkers, from which keeping right counts fully.
constexpr float opposed = 0.2F, many_oncoming = 6;
/// Sums are of integers, so that the order of people does not matter.
constexpr float unit = 1.0F / 4096;

/// Returns the angle of a heading into a lane to the left of the straight way, rad.
float off_straight(int lane) {
  static const auto angles = [] {
    std::array<float, lanes_across> made{};
    for (int i = 0; i < lanes_across; ++i)
      made[static_cast<std::size_t>(i)] =
          static_cast<float>(exact::atan2(lane_apart_m * static_cast<float>(i - lanes_aside), joins_ahead_m));
    return made;
  }();
  return angles[static_cast<std::size_t>(lane)];
}

float distance2(GroundPoint a, GroundPoint b) {
  return (a.x_m - b.x_m) * (a.x_m - b.x_m) + (a.z_m - b.z_m) * (a.z_m - b.z_m);
}

}  // namespace

GroundPoint nearest_of(const Wall& wall, GroundPoint to) {
  const float x = wall.to.x_m - wall.from.x_m, z = wall.to.z_m - wall.from.z_m, squared = x * x + z * z;
  const float along = (to.x_m - wall.from.x_m) * x + (to.z_m - wall.from.z_m) * z;
  const float part = squared > 0 ? std::clamp(along / squared, 0.0F, 1.0F) : 0;
  return {wall.from.x_m + part * x, wall.from.z_m + part * z};
}

float lane_heading(const ReservationBook& book, std::span<const BoxedWall> walls, std::uint32_t me,
                   const AvoidanceState<float>& course) {
  const Reservation& mine = book.reservation(me);
  const std::size_t now_at = mine.at(book.instant());
  const GroundPoint at = {mine.x_m[now_at], mine.z_m[now_at]};
  const GroundPoint toward = direction(course.heading_rad);
  const float ahead_x = toward.x_m, ahead_z = toward.z_m;
  const float left_x = ahead_z, left_z = -ahead_x;
  std::int64_t weight[lanes_across] = {};  // of oncoming walkers, in units
  int oncoming = 0;
  constexpr float half = 0.5F * lanes_ahead_m;
  book.near(at.x_m + half * ahead_x, at.z_m + half * ahead_z, mine, half, [&](const Nearby& other) {
    constexpr float min_against = 0.3F;  // cosine; crossing people do not count
    const float against = -(other.faces_x * ahead_x + other.faces_z * ahead_z) - min_against;
    if (other.reservation == me || !(against > 0 && against < 1)) return;  // bounds the sum
    const float x = other.x_m - at.x_m, z = other.z_m - at.z_m;
    const float ahead = x * ahead_x + z * ahead_z, left = x * left_x + z * left_z;
    if (!(ahead >= 0 && ahead <= lanes_ahead_m)) return;
    ++oncoming;
    const float counts = 2 * against * (1 - ahead / lanes_ahead_m);
    for (int i = 0; i < lanes_across; ++i) {
      const float off = std::fabs(left - lane_apart_m * static_cast<float>(i - lanes_aside));
      weight[i] += static_cast<std::int64_t>(counts * std::max(0.0F, 1 - off / lane_breadth_m) * (1 / unit));
    }
  });

  float cost[lanes_across];
  const float crowded = std::min(1.0F, static_cast<float>(oncoming) / many_oncoming);
  const float keeps_right =
      crowded * of_left * std::min(1.0F, unit * static_cast<float>(weight[lanes_aside]) / opposed);
  for (int i = 0; i < lanes_across; ++i) {
    const float left = lane_apart_m * static_cast<float>(i - lanes_aside);
    cost[i] =
        crowded * of_oncoming * unit * static_cast<float>(weight[i]) + of_changing * left * left + keeps_right * left;
  }
  for (const auto& [wall, box] : walls) {
    constexpr float reach = tried_ahead_m + lanes_aside * lane_apart_m + wall_clear_m;
    if (!box.meets({at.x_m, at.x_m, at.z_m, at.z_m}, reach) || !mine.meets(wall.height)) continue;
    const GroundPoint here = nearest_of(wall, at);
    if (distance2(here, at) > reach * reach) continue;
    for (int i = 0; i < lanes_across; ++i) {
      const float left = lane_apart_m * static_cast<float>(i - lanes_aside);
      const GroundPoint to = {at.x_m + tried_ahead_m * ahead_x + left * left_x,
                              at.z_m + tried_ahead_m * ahead_z + left * left_z};
      const GroundPoint there = nearest_of(wall, to);
      const float same_side = (to.x_m - there.x_m) * (at.x_m - here.x_m) + (to.z_m - there.z_m) * (at.z_m - here.z_m);
      const float near = std::max(0.0F, 1 - std::sqrt(distance2(to, there)) / wall_clear_m);
      cost[i] += of_wall * near * near + (same_side < 0 ? closed : 0);
    }
  }

  int best = lanes_aside;  // of equal ones the nearest, then the right one
  for (int i = 1; i <= lanes_aside; ++i)
    for (const int lane : {lanes_aside - i, lanes_aside + i})
      if (cost[lane] < cost[best]) best = lane;
  if (best == lanes_aside) return course.heading_rad;
  return course.heading_rad + off_straight(best);
}

}  // namespace mobil::inline v0_3
