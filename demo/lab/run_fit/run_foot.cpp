#include "demo/lab/run_fit/run_foot.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "assets/gait/run_curves.h"
#include "demo/lab/gait_fit/step_curves.h"

namespace mobil {
namespace {

/// State of an ankle: ahead of the foothold and above the ground.
struct AnkleState {
  Moving ahead, up;
};

class FootCurves {
 public:
  FootCurves(const RunTask& task, const RunShape& shape)
      : b_(task.body.size), p_(shape), duty_(task.duty), period_(2 / task.frequency_hz) {
    flat_ = run_curve::usual_flat + at(run_shape::times, 0);
    lift_ = run_curve::usual_rise + at(run_shape::times, 1);
    leaving_ = per_second(heel_rise_end(of(run_shape::rise), duty_ - lift_), period_);
    landing_ = starts(run_shape::strike, flat_);
    off_ = {rolled(b_, leaving_, false), rolled(b_, leaving_, true)};
    land_ = {rolled(b_, landing_, false), rolled(b_, landing_, true)};
    add(starts(run_shape::pad_forward, run_curve::pad_part), land_.ahead);
    add(starts(run_shape::pad_up, run_curve::pad_part), land_.up);
  }

  double stance_pitch(double phase) const {
    const double u = std::clamp((phase - lift_) / (duty_ - lift_), 0.0, 1.0);
    return (phase < flat_ ? falling(of(run_shape::strike), phase / flat_) : 0) + heel_rise(of(run_shape::rise), u);
  }
  double pad(const ShapePart& part, double phase) const { return falling(of(part), phase / run_curve::pad_part); }
  double swung(double phase) const { return std::clamp((phase - duty_) / (1 - duty_), 0.0, 1.0); }
  double swing_pitch(double u) const {
    return quintic(u, leaving_, landing_, span()) + bumps(of(run_shape::swing_pitch), u);
  }
  /// Returns the ankle ahead of the foothold, along the foot's line, and the next foothold at `stride` along it.
  double swing_ahead(double u, double along, double stride) const {
    const auto scaled_by = [&](const Moving& m, double from) {
      return Moving{from + along * m.value, along * m.rate, along * m.bend};
    };
    return quintic(u, scaled_by(off_.ahead, 0), scaled_by(land_.ahead, stride), span());
  }
  double forward_bumps(double u) const { return bumps(of(run_shape::swing_forward), u); }
  double swing_up(double u) const { return quintic(u, off_.up, land_.up, span()) + bumps(of(run_shape::swing_up), u); }

 private:
  double at(const ShapePart& part, std::size_t i) const { return p_[part.first + i]; }
  double span() const { return (1 - duty_) * period_; }
  std::span<const double> of(const ShapePart& part) const { return std::span(p_).subspan(part.first, part.count); }
  Moving starts(const ShapePart& part, double over) const { return per_second(falling_start(of(part), over), period_); }
  static void add(const Moving& more, Moving& to) {
    to = {to.value + more.value, to.rate + more.rate, to.bend + more.bend};
  }

  const StepBody& b_;
  const RunShape& p_;
  double duty_, period_, flat_ = 0, lift_ = 0;
  Moving leaving_, landing_;  // pitch at toe-off and at contact
  AnkleState off_, land_;
};

double smooth_step(double x) {
  const double u = std::clamp(x, 0.0, 1.0);
  return u * u * u * (10 + u * (-15 + 6 * u));
}

/// Returns the bend of the toes in swing: they straighten, and are straight on a level foot.
double swing_bend(double pitch, double u) {
  constexpr double nearly_level = 0.2;
  constexpr auto from = static_cast<double>(swing_toes::from), to = static_cast<double>(swing_toes::to);
  const double bent = std::max(-pitch, 0.0) - toe_pitch(-pitch).value;
  const double level = std::lerp(1.0, smooth_step(-pitch / nearly_level), smooth_step(4 * u));
  return bent * (1 - smooth_step((u - from) / (to - from))) * level;
}

}  // namespace

void evaluate_foot(const RunTask& task, const RunShape& shape, RunFoot& foot) {
  const std::size_t n = task.samples;
  for (RunSamples* v :
       {&foot.pitch, &foot.stance_pitch, &foot.toes, &foot.pad_up, &foot.pad_forward, &foot.swung, &foot.clear})
    v->resize(n);
  foot.ankle.resize(n);
  const FootCurves curves(task, shape);
  const StepBody& b = task.body.size;
  const double along = std::cos(task.toe_out), aside = std::sin(task.toe_out), stride = 2 * step_length_m(task);
  for (std::size_t i = 0; i < n; ++i) {
    const double phase = static_cast<double>(i) / static_cast<double>(n), u = foot.swung[i] = curves.swung(phase);
    foot.stance_pitch[i] = curves.stance_pitch(phase);
    foot.pad_up[i] = curves.pad(run_shape::pad_up, phase);
    foot.pad_forward[i] = curves.pad(run_shape::pad_forward, phase);
    double& pitch = foot.pitch[i];
    Vec3<double>& ankle = foot.ankle[i];
    if (phase >= task.duty) {
      pitch = curves.swing_pitch(u);
      ankle = {-task.half_width_m - curves.swing_ahead(u, aside, 0), curves.swing_up(u),
               curves.swing_ahead(u, along, stride) + curves.forward_bumps(u)};
      foot.toes[i] = swing_bend(pitch, u);
    } else {
      pitch = foot.stance_pitch[i];
      const double ahead = rolled(b, {pitch}, false).value + foot.pad_forward[i];
      ankle = {-task.half_width_m - aside * ahead, rolled(b, {pitch}, true).value + foot.pad_up[i], along * ahead};
      foot.toes[i] = std::max(-pitch, 0.0) - toe_pitch(-pitch).value;
    }
    const double s = std::sin(pitch), c = std::cos(pitch);
    const double heel = ankle.y - b.heel_back * s - (b.ankle_height - b.heel_radius) * c - b.heel_radius;
    const double ball = ankle.y + b.ball_forward * s - (b.ankle_height - b.toe_joint_height) * c -
                        b.toe_joint_height * std::cos(pitch + foot.toes[i]);
    foot.clear[i] = std::min({heel, ball, ball + b.toes_length * std::sin(pitch + foot.toes[i])});
  }
}

}  // namespace mobil
