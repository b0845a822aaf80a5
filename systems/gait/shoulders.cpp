#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "assets/body/joint_limits.h"
#include "systems/gait/kinematics_wide-inl.h"
#include "systems/gait/shoulders.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

constexpr std::size_t lowest = index(Segment::L5), shoulders = index(Segment::T1), head = index(Segment::head);

/// Returns the part of the shoulders' turn that each segment from the fifth lumbar vertebra to the head has made.
constexpr auto turn_parts() {
  constexpr std::size_t below = shoulders - lowest + 1;
  std::array<float, head - lowest + 1> parts{};
  double trunk = 0, neck = 0;
  for (std::size_t i = 0; i < vertebra_limits.size(); ++i) (i < below ? trunk : neck) += vertebra_limits[i].rotation;
  double made = 0;
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    const double range = vertebra_limits[i].rotation;
    made += i < below ? range / trunk : -range / neck;
    parts[i] = static_cast<float>(made);
  }
  return parts;  // the head's is 0
}

/// Returns a rotation about the vertical. Sine and cosine of half its angle are accurate to 1e-7 within a right angle.
HWY_INLINE WideQuat small_turn(const Wide& angle) {
  const Wide half = 0.5F * angle, squared = half * half;
  const Wide sine =
      half *
      fma(squared, fma(squared, fma(squared, wide(-1.0F / 5040), wide(1.0F / 120)), wide(-1.0F / 6)), wide(1.0F));
  const Wide cosine =
      fma(squared, fma(squared, fma(squared, wide(-1.0F / 720), wide(1.0F / 24)), wide(-0.5F)), wide(1.0F));
  return {wide(0.0F), sine, wide(0.0F), cosine};
}

void shoulders_block(const Lanes<float>& turn_rad, Pose<Lanes<float>>& pose) {
  constexpr auto parts = turn_parts();
  const Wide turn = load(turn_rad);
  if (!any(abs(turn) > 0.0F)) return;
  const auto lies = [&](std::size_t s) HWY_ATTR { return load(pose.position_m[s]); };
  const auto turned = [&](std::size_t s, const WideQuat& by)
                          HWY_ATTR { store(by * load(pose.rotation[s]), pose.rotation[s]); };
  // A segment keeps its place on the rotated one below, which moves from `lay` to `lying`.
  WideVec lay = lies(lowest), lying = lay;
  WideQuat below = small_turn(parts[0] * turn), trunk = below;
  WideVec trunk_lay = lay, trunk_lies = lay;
  turned(lowest, below);
  for (std::size_t s = lowest + 1; s <= head; ++s) {
    const WideVec was = lies(s);
    lying = lying + rotate(below, was - lay);
    lay = was;
    store(lying, pose.position_m[s]);
    below = small_turn(parts[s - lowest] * turn);
    turned(s, below);
    if (s == shoulders) trunk = below, trunk_lay = lay, trunk_lies = lying;
  }
  for (std::size_t s = index(Segment::clavicle_right); s <= index(Segment::thumb_left); ++s) {
    store(trunk_lies + rotate(trunk, lies(s) - trunk_lay), pose.position_m[s]);
    turned(s, trunk);
  }
}

void ease_block(AvoidanceState<Lanes<float>>& course, float tick_s, float decay) {
  constexpr float rate = shoulder_spring_per_s;  // critically damped, solved exactly: independent of the tick
  const Wide to = load(course.turn_to_rad), turn = load(course.turn_rad), speed = load(course.turn_rad_s);
  const Wide off = turn - to, pull = fma(wide(rate), off, speed);
  const Wide next = decay * fma(wide(tick_s), pull, off), next_speed = decay * fnma(wide(rate * tick_s), pull, speed);
  constexpr float still_rad = 1e-3F, still_rad_s = 1e-2F;
  const WideMask there = (abs(next) < still_rad) & (abs(next_speed) < still_rad_s);
  store(select(there, to, to + next), course.turn_rad);
  store(select(there, wide(0.0F), next_speed), course.turn_rad_s);
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {

HWY_EXPORT(shoulders_block);
HWY_EXPORT(ease_block);

void turn_shoulders(const Lanes<float>& turn_rad, Pose<Lanes<float>>& pose) {
  HWY_DYNAMIC_DISPATCH(shoulders_block)(turn_rad, pose);
}

void ease_shoulders(AvoidanceState<Lanes<float>>& course, float tick_s) {
  // Exponential of the tick over the spring's time by its series, accurate to 1e-5 for ticks of up to 0.1 s.
  const float x = shoulder_spring_per_s * tick_s;
  const float growth = 1 + x * (1 + x / 2 * (1 + x / 3 * (1 + x / 4 * (1 + x / 5 * (1 + x / 6 * (1 + x / 7))))));
  HWY_DYNAMIC_DISPATCH(ease_block)(course, tick_s, 1 / growth);
}

}  // namespace mobil::inline v0_3
#endif
