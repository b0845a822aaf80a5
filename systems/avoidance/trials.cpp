#include "systems/avoidance/trials.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include <mobil/anthropometry.h>
#include "systems/gait/step_limits.h"

namespace mobil::inline v0_3 {
namespace {

using namespace step_limits;

constexpr float pi = std::numbers::pi_v<float>;
constexpr float beside[] = {0, 12 * pi / 180, -12 * pi / 180, 27 * pi / 180, -27 * pi / 180};
/// Slowest walk, m/s, with a leg of leg_m.
constexpr float slowest = 0.3F;
/// Length of short steps, for lack of room, relative to the walker's own.
constexpr float short_step = 0.5F;
/// Minimum turn on the spot, rad.
constexpr float min_turn = 0.1F;

void put(Trials& trials, std::size_t lane, TrialKind kind, const Trial<float>& trial) {
  trials.kind[lane] = kind;
  trials.trial.speed_m_s[lane] = trial.speed_m_s;
  trials.trial.turn_rad[lane] = trial.turn_rad;
  trials.trial.length_part[lane] = trial.length_part;
  trials.trial.slant_rad[lane] = trial.slant_rad;
  trials.trial.aside_m[lane] = trial.aside_m;
}

}  // namespace

float wrapped(float angle_rad) {
  return angle_rad - 2 * pi * std::floor(angle_rad / (2 * pi) + 0.5F);
}

Trials make_trials(const HeelStrikePlace<float>& at, const AvoidanceState<float>& course) {
  Trials trials;
  const float leg = static_cast<float>(fraction::thigh + fraction::shank) * at.height_m;
  const float scale = std::sqrt(leg / leg_m), least = slowest * scale, now = at.speed_m_s;
  const float wish = trials.wish_rad = wrapped(course.heading_rad - at.heading_rad);
  const float toward = std::clamp(wish, -max_turn, max_turn);
  if (now > 0) {
    const float slower = std::max(now - max_slower * scale, least);
    const float last = now > last_speed * scale ? std::max(now - max_slower * scale, last_speed * scale) : 0;
    const float wanted = std::max(std::min(course.speed_m_s, now + max_faster * scale), slower);
    const float straight_on = 0.70F * at.advance_m * at.bend_per_m;  // as in systems/gait/next_foot-inl.h
    put(trials, reserved, last > 0 ? TrialKind::go : TrialKind::stay, {last, straight_on, 1, 0, 0});
    std::size_t lane = 1;
    for (const float speed : {wanted, 0.5F * (wanted + slower), slower}) {
      const float length_part = speed < wanted ? short_step : 1;
      for (const float turn : beside) put(trials, lane++, TrialKind::go, {speed, toward + turn, length_part, 0, 0});
    }
    return trials;
  }
  put(trials, reserved, TrialKind::stay, {});
  std::size_t lane = 1;
  const float wanted = std::clamp(course.speed_m_s, least, first_speed * scale);
  for (const float turn : {beside[0], beside[1], beside[2]})
    put(trials, lane++, TrialKind::go, {wanted, toward + turn, short_step, 0, 0});
  for (const float turn : {beside[0], beside[3], beside[4]})
    put(trials, lane++, TrialKind::go, {least, toward + turn, short_step, 0, 0});
  put(trials, lane++, TrialKind::turn, {0, wish > min_turn ? std::min(wish, max_turn) : max_turn, 1, 0, 0});
  put(trials, lane++, TrialKind::turn, {0, wish < -min_turn ? std::max(wish, -max_turn) : -max_turn, 1, 0, 0});
  const float longer = leg / aside_leg_m;
  for (const auto& [slant, far] : {std::pair{0.5F, aside_m},
                                   {-0.5F, aside_m},
                                   {1.0F, ahead_m},
                                   {0.0F, ahead_m},
                                   {0.0F, 0.5F * ahead_m},
                                   {0.25F, ahead_m},
                                   {-0.25F, ahead_m}})
    put(trials, lane++, TrialKind::aside, {0, 0, 1, slant * pi, far * longer});
  return trials;
}

}  // namespace mobil::inline v0_3
