// From a body and a gait to the curves of its step.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "systems/gait/gait.h"
#include "systems/gait/step_leg.h"
#include "systems/gait/step_math.h"
#include "systems/gait/step_swing.h"

namespace mobil {
namespace {

using namespace step;

constexpr std::size_t intervals = knot_count - 1;

/// Bends the trailing knee less, and then ends double support earlier, until the foot leaves the ground no steeper than
/// the calf allows. False if no toe-off is possible.
bool fit_toe_off(Leg& leg) {
  constexpr double steepest = 68.0 * degree, least_knee = 22.0 * degree, least_double_support = 0.04;
  for (;;) {
    const double reach = leg.angles(leg.hip(leg.toe_off), leg.planted(-steepest).ankle).reach;
    const double limit = reach < leg.reach(0.0) ? leg.knee(reach) : 0.0;
    const double shorter = 0.97 * leg.double_support;
    if (limit >= std::fmin(least_knee, leg.toe_off_knee) || shorter < least_double_support * 2.0 * leg.duration) {
      leg.toe_off_knee = std::fmin(leg.toe_off_knee, limit);
      leg.stance_knee = std::fmin(leg.stance_knee, 0.7 * leg.toe_off_knee);
      return limit > 6.0 * degree;
    }
    leg.double_support = shorter;
    leg.toe_off = leg.duration + shorter;
  }
}

/// Knots of a curve given densely by `value(i)` at i = 0 … dense (a multiple of the intervals); slopes by central
/// differences, at the ends by the given ones (per second).
template <class Value>
void fit(Curve<float>& curve, std::size_t dense, double span, double first_rate, double last_rate, Value value) {
  const std::size_t every = dense / intervals;
  for (std::size_t k = 0; k < knot_count; ++k) {
    const std::size_t i = k * every;
    double slope;
    if (k == 0)
      slope = first_rate * span / intervals;
    else if (k == intervals)
      slope = last_rate * span / intervals;
    else
      slope = (8.0 * (value(i + 1) - value(i - 1)) - (value(i + 2) - value(i - 2))) / 12.0 * static_cast<double>(every);
    curve.value[k] = static_cast<float>(value(i));
    curve.slope[k] = static_cast<float>(slope);
  }
}

template <class Function>
double rate_of(Function function, double t, double h) {
  return (function(t + h) - function(t - h)) / (2.0 * h);
}

}  // namespace

Result<StepPlan<float>> plan_step(const Body& body, const Gait& gait) {
  const GaitStyle& style = gait.style;
  Leg leg = make_leg(body, gait);
  Result<SupportStep> support = solve_support(support_request(body, gait, leg));
  if (!support) return fail(support.error().message);
  leg.hip_path = support->sample;

  if (!fit_toe_off(leg))
    return fail(
        fmt::format("gait: a step of {:.2f} m at {:.2f} m/s is too long for legs of {:.2f} m; choose a shorter "
                    "step or a lower speed",
                    leg.step_length, gait.speed_m_s, leg.thigh + leg.shank));
  constexpr std::size_t dense = 96;
  for (std::size_t i = 0; i <= dense; ++i) {
    const double t = leg.toe_off * static_cast<double>(i) / dense;
    const double reach = leg.angles(leg.hip(t), leg.stance(t).ankle).reach;
    if (!(reach < 0.9999 * leg.reach(0.0)))
      return fail(
          fmt::format("gait: a step of {:.2f} m at {:.2f} m/s would stretch the standing leg beyond straight; "
                      "choose a shorter step or a lower mid_stance_height",
                      leg.step_length, gait.speed_m_s));
  }
  Result<Swing> swing = solve_swing(leg, swing_model(leg, body.request.mass_kg), style);
  if (!swing) return fail(swing.error().message);

  StepPlan<float> plan{};
  auto set = [](float& field, double value) { field = static_cast<float>(value); };
  set(plan.duration_s, leg.duration);
  set(plan.double_support_s, leg.double_support);
  set(plan.flat_s, leg.flat);
  plan.load_to = 1.0F;
  set(plan.step_length_m, leg.step_length);
  set(plan.half_width_m, leg.half_width);
  set(plan.toe_out_sin, sin_cos(leg.toe_out).sine);
  set(plan.toe_out_cos, sin_cos(leg.toe_out).cosine);
  set(plan.strike_pitch, leg.strike_pitch);
  set(plan.swing_out_from_m, swing->sample.front().ankle.out);
  set(plan.swing_out_to_m, swing->sample.back().ankle.out);
  set(plan.pelvis_rotation, leg.rotation);
  set(plan.pelvis_list, leg.list);
  set(plan.pelvis_shift_m, leg.shift);
  set(plan.pelvis_tilt, style.pelvis_tilt_deg * degree);
  set(plan.pelvis_tilt_wave, style.pelvis_tilt_wave_deg * degree);
  set(plan.shoulder_rotation, style.shoulder_rotation);
  const double stride = std::fmin(leg.step_length / (0.43 * body.request.height_m), 1.25);
  const double pace = std::fmin(1.5 * gait.speed_m_s / std::sqrt(gravity * body.hip_height_m), 1.0) * stride;
  set(plan.arm_back, style.arm_back_deg * degree * pace);
  set(plan.arm_forward, style.arm_forward_deg * degree * pace);
  set(plan.elbow_back, style.elbow_back_deg * degree);
  set(plan.elbow_forward, (style.elbow_back_deg + (style.elbow_forward_deg - style.elbow_back_deg) * pace) * degree);
  set(plan.arm_abduction, style.arm_abduction_deg * degree);
  set(plan.forearm_pronation, style.forearm_pronation_deg * degree);
  set(plan.finger_flexion, style.finger_flexion_deg * degree);

  const std::vector<HipSample>& hips = leg.hip_path;
  const HipSample& start = hips.front();
  fit(plan.hip_forward_m, dense, leg.duration, start.forward_velocity, start.forward_velocity,
      [&](std::size_t i) { return leg.pivot_forward + hips[i].forward_m; });
  fit(plan.hip_up_m, dense, leg.duration, start.up_velocity, start.up_velocity,
      [&](std::size_t i) { return hips[i].up_m; });
  fit(plan.trunk_pitch, dense, leg.duration, start.trunk_rate, start.trunk_rate,
      [&](std::size_t i) { return hips[i].trunk_rad; });

  const double h = 1e-4 * leg.duration;
  auto pitch = [&](double t) { return leg.stance(t).pitch; };
  const double off_rate = rate_of(pitch, leg.toe_off, h);
  const double standing_span = leg.toe_off - leg.flat, swing_span = 2.0 * leg.duration - leg.toe_off;
  fit(plan.foot_pitch[0], dense, standing_span, 0.0, off_rate,
      [&](std::size_t i) { return pitch(leg.flat + standing_span * static_cast<double>(i) / dense); });
  const std::vector<SwingSample>& s = swing->sample;
  fit(plan.foot_pitch[1], dense, swing_span, off_rate, rate_of(pitch, 0.0, h),
      [&](std::size_t i) { return s[i].pitch; });
  auto ankle = [&](double t) { return leg.stance(t).ankle; };
  // The ankle leaves the ground smoothly; how it lands is the swing's own, heel strike being an impact.
  auto landing = [&](auto value) {
    return (25.0 * value(dense) - 48.0 * value(dense - 1) + 36.0 * value(dense - 2) - 16.0 * value(dense - 3) +
            3.0 * value(dense - 4)) *
           static_cast<double>(dense) / (12.0 * swing_span);
  };
  auto swing_forward = [&](std::size_t i) { return s[i].ankle.forward; };
  auto swing_up = [&](std::size_t i) { return s[i].ankle.up; };
  fit(plan.swing_forward_m, dense, swing_span, rate_of([&](double t) { return ankle(t).forward; }, leg.toe_off, h),
      landing(swing_forward), swing_forward);
  fit(plan.swing_up_m, dense, swing_span, rate_of([&](double t) { return ankle(t).up; }, leg.toe_off, h),
      landing(swing_up), swing_up);
  fit(plan.swing_toes, dense, swing_span, -off_rate, 0.0, [&](std::size_t i) { return s[i].toes; });

  double back = 1e9, forward = -1e9;
  for (std::size_t i = 0; i <= dense; ++i) {
    const double part = static_cast<double>(i) / dense;
    const double standing = leg.toe_off * part, swinging = leg.toe_off + swing_span * part;
    const double down = leg.angles(leg.hip(standing), leg.stance(standing).ankle).direction;
    const double up = leg.angles(leg.hip(swinging), s[i].ankle).direction;
    back = std::min({back, down, up});
    forward = std::max({forward, down, up});
  }
  set(plan.leg_back, back);
  set(plan.leg_forward, forward);
  return plan;
}

}  // namespace mobil
