#include "demo/gait_fit/step_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "assets/body/anthropometry.h"
#include "components/gait.h"
#include "demo/gait_fit/upper_body.h"

namespace mobil {
namespace {

constexpr double pi = std::numbers::pi, gravity = 9.81;
constexpr std::size_t n = cycle_samples, half_cycle = n / 2;
constexpr double reference_height = 1.75;

/// Masses of a leg's segments, of the body; centres and radii of gyration of their lengths (Winter).
constexpr double thigh_mass = 0.100, shank_mass = 0.0465, foot_mass = 0.0145;
constexpr double rod_centre = 0.433, thigh_gyration = 0.323, shank_gyration = 0.302, foot_gyration = 0.475;
/// Usual foot flat and heel rise, of the cycle; the part of it in which the heel's pad yields.
constexpr double usual_flat = 0.09, usual_rise = 0.30, pad_part = 0.05;
/// How much higher than the centre of mass the point is that the feet's forces lean toward.
constexpr double pivot_height = 1.4;

/// A value with its first two derivatives by time.
struct Moving {
  double value = 0, rate = 0, bend = 0;
};

/// Fifth-degree polynomial between two states over u in 0…1 that takes `span` seconds.
double quintic(double u, const Moving& a, const Moving& b, double span) {
  const double r = b.value - a.value - a.rate * span - 0.5 * a.bend * span * span;
  const double s = (b.rate - a.rate) * span - a.bend * span * span, q = 0.5 * (b.bend - a.bend) * span * span;
  return a.value + u * (a.rate * span +
                        u * (0.5 * a.bend * span * span +
                             u * ((10 * r - 4 * s + q) + u * ((-15 * r + 7 * s - 2 * q) + u * (6 * r - 3 * s + q)))));
}

double legendre(std::size_t degree, double x) {
  double before = 1, now = x;
  if (degree == 0) return 1;
  for (std::size_t k = 1; k < degree; ++k) {
    const double k1 = static_cast<double>(k);
    const double next = ((2 * k1 + 1) * x * now - k1 * before) / (k1 + 1);
    before = now;
    now = next;
  }
  return now;
}

/// Places over the cycle: forward, up, out on the leg's own side.
struct Track {
  Samples z, y, x;
};

class Model {
 public:
  Model(const StepTask& task, const StepShape& shape, StepCycle& cycle) : t_(task), p_(shape), c_(cycle) {
    period_ = 2 * t_.step_length_m / t_.speed_m_s;
    off_ = 0.5 + t_.double_support;
  }
  void move();
  void load();

 private:
  double at(const ShapePart& part, std::size_t i) const { return p_[part.first + i]; }
  double harmonics(const ShapePart& part, std::size_t count, double phase) const;
  double falling(const ShapePart& part, std::size_t more, double u) const;
  Moving falling_start(const ShapePart& part, double span) const;
  double bumps(const ShapePart& part, double u) const;
  void move_foot();
  void move_leg();
  Moving per_second(const Moving& by_cycle) const {
    return {by_cycle.value, by_cycle.rate / period_, by_cycle.bend / (period_ * period_)};
  }
  Moving rolled(const Moving& pitch, bool up) const;
  double second(const Samples& q, std::size_t i, double travel = 0) const;
  double rise(double u) const;
  static std::size_t other(std::size_t i) { return (i + half_cycle) % n; }

  const StepTask& t_;
  const StepShape& p_;
  StepCycle& c_;
  double period_, off_;
  Track hip_;     // of the right leg, x to its own side
  Samples lean_;  // of the leg's plane, outward
};

double Model::harmonics(const ShapePart& part, std::size_t count, double phase) const {
  double sum = at(part, 0);
  for (std::size_t k = 1; k <= count; ++k) {
    const double a = 2 * pi * static_cast<double>(k) * phase;
    sum += at(part, k) * std::cos(a) + at(part, count + k) * std::sin(a);
  }
  return sum;
}

/// (1 − u)³ times a polynomial that starts with the part's first number and no slope of its own; 0 from u = 1 on.
double Model::falling(const ShapePart& part, std::size_t more, double u) const {
  const double left = std::max(1 - u, 0.0);
  double tail = 0;
  for (std::size_t i = more; i > 0; --i) tail = u * (at(part, i) + tail);
  return left * left * left * (at(part, 0) * (1 + u * (3 + 6 * u)) + tail);
}

Moving Model::falling_start(const ShapePart& part, double span) const {
  return per_second({at(part, 0), at(part, 1) / span, (2 * at(part, 2) - 6 * at(part, 1)) / (span * span)});
}

/// 64 (u (1 − u))³ times Legendre polynomials.
double Model::bumps(const ShapePart& part, double u) const {
  double sum = 0;
  for (std::size_t i = 0; i < part.count; ++i) sum += at(part, i) * legendre(i, 2 * u - 1);
  const double bump = u * (1 - u);
  return 64 * bump * bump * bump * sum;
}

/// Pitch from heel rise on, u from 0 to 1 at toe-off: heel up, negative.
double Model::rise(double u) const {
  double sum = 0;
  for (std::size_t i = shape::rise.count; i > 0; --i) sum = at(shape::rise, i - 1) + u * sum;
  return -u * u * u * sum;
}

/// The ankle of a foot that rolls over the rim of its heel (toes up) or of its ball (heel up): its height, or its place
/// ahead of the foothold.
Moving Model::rolled(const Moving& pitch, bool up) const {
  const StepBody& b = t_.body;
  const double s = std::sin(pitch.value), c = std::cos(pitch.value);
  const bool heel = pitch.value >= 0;
  const double radius = heel ? b.heel_radius : b.ball_radius, over = b.ankle_height - radius;
  const double arm = heel ? b.heel_back : -b.ball_forward;  // the rim's centre behind the ankle
  double value, first, bend;
  if (up) {
    value = radius + arm * s + over * c;
    first = arm * c - over * s;
    bend = -arm * s - over * c;
  } else {
    value = arm * (c - 1) - over * s - radius * pitch.value;
    first = -arm * s - over * c - radius;
    bend = -arm * c + over * s;
  }
  return {value, first * pitch.rate, bend * pitch.rate * pitch.rate + first * pitch.bend};
}

void Model::move_foot() {
  const double flat = usual_flat + at(shape::times, 0), lift = usual_rise + at(shape::times, 1);
  const double rising = off_ - lift, swing_part = 1 - off_, span = swing_part * period_;
  // Where the foot is at toe-off and at the next strike.
  double sum = 0, slope = 0, bend = 0;
  for (std::size_t i = 0; i < shape::rise.count; ++i) {
    const double k = static_cast<double>(i + 3), v = at(shape::rise, i);
    sum -= v;
    slope -= k * v;
    bend -= k * (k - 1) * v;
  }
  const Moving leaving = per_second({sum, slope / rising, bend / (rising * rising)});
  const Moving landing = falling_start(shape::strike, flat);
  const Moving pad_up = falling_start(shape::pad_up, pad_part), pad_on = falling_start(shape::pad_forward, pad_part);
  const auto place = [](Moving a, const Moving& b, double on) {
    return Moving{a.value + b.value + on, a.rate + b.rate, a.bend + b.bend};
  };
  const Moving off_on = rolled(leaving, false), off_up = rolled(leaving, true);
  const Moving land_on = place(rolled(landing, false), pad_on, 2 * t_.step_length_m);
  const Moving land_up = place(rolled(landing, true), pad_up, 0);
  const double out_s = std::sin(t_.toe_out);
  for (std::size_t i = 0; i < n; ++i) {
    const double phase = static_cast<double>(i) / n;
    c_.stance_pitch[i] = (phase < flat ? falling(shape::strike, 3, phase / flat) : 0) +
                         rise(std::clamp((phase - lift) / rising, 0.0, 1.0));
    c_.pad_up[i] = falling(shape::pad_up, 2, phase / pad_part);
    c_.pad_forward[i] = falling(shape::pad_forward, 2, phase / pad_part);
    c_.swings[i] = phase >= off_;
    const double u = c_.swung[i] = std::clamp((phase - off_) / swing_part, 0.0, 1.0);
    if (c_.swings[i]) {
      c_.pitch[i] = quintic(u, leaving, landing, span) + bumps(shape::swing_pitch, u);
      c_.ankle_forward[i] = quintic(u, off_on, land_on, span) + bumps(shape::swing_forward, u);
      c_.ankle_up[i] = quintic(u, off_up, land_up, span) + bumps(shape::swing_up, u);
      const Moving from{t_.half_width_m + out_s * off_on.value, out_s * off_on.rate, out_s * off_on.bend};
      const double strike_on = land_on.value - 2 * t_.step_length_m;
      const Moving to{t_.half_width_m + out_s * strike_on, out_s * land_on.rate, out_s * land_on.bend};
      c_.ankle_out[i] = quintic(u, from, to, span);
    } else {
      c_.pitch[i] = c_.stance_pitch[i];
      const double on = rolled({c_.pitch[i]}, false).value + c_.pad_forward[i];
      c_.ankle_forward[i] = on;
      c_.ankle_up[i] = rolled({c_.pitch[i]}, true).value + c_.pad_up[i];
      c_.ankle_out[i] = t_.half_width_m + out_s * on;
    }
    const double s = std::sin(c_.pitch[i]), c = std::cos(c_.pitch[i]);
    const StepBody& b = t_.body;
    c_.heel_clear[i] = c_.ankle_up[i] - b.heel_back * s - (b.ankle_height - b.heel_radius) * c - b.heel_radius;
    c_.ball_clear[i] = c_.ankle_up[i] + b.ball_forward * s - (b.ankle_height - b.ball_radius) * c - b.ball_radius;
    const double straight = std::clamp(
        (u - static_cast<double>(swing_toes::from)) / static_cast<double>(swing_toes::to - swing_toes::from), 0.0, 1.0);
    c_.toe_clear[i] =
        c_.ball_clear[i] + b.toes_length * std::sin(c_.pitch[i] * straight * straight * (3 - 2 * straight));
  }
}

/// The hip of the right leg, and thigh and shank between it and the ankle.
void Model::move_leg() {
  namespace p = pelvis_phase;
  const StepBody& b = t_.body;
  const double full = b.thigh + b.shank;
  for (std::size_t i = 0; i < n; ++i) {
    const double phase = static_cast<double>(i) / n, steps = 2 * phase;
    const auto wave = [&](float at, int harmonic) {
      return std::cos(pi * harmonic * (steps - static_cast<double>(at)));
    };
    const double turned = t_.pelvis_rotation * wave(p::rotation, 1);
    const double listed = t_.pelvis_list * (static_cast<double>(p::list_first) * wave(p::list_first_phase, 1) +
                                            static_cast<double>(p::list_third) * wave(p::list_third_phase, 3));
    c_.tilt[i] = t_.pelvis_tilt + t_.pelvis_tilt_wave * wave(p::tilt, 2);
    const double arm = b.hip_half_spacing * std::cos(listed);
    const double hip_on = c_.hips_forward[i] + arm * std::sin(turned);
    const double hip_up = c_.hips_up[i] + b.hip_half_spacing * std::sin(listed);
    const double hip_out = -c_.hips_left[i] + arm * std::cos(turned);
    const double on = c_.ankle_forward[i] - hip_on, down = hip_up - c_.ankle_up[i], out = c_.ankle_out[i] - hip_out;
    const double across = std::hypot(down, out), reach = std::hypot(on, across);
    c_.slack[i] = full - reach;
    // A leg out of reach is drawn in smoothly, so that a fit finds its way back.
    constexpr double least = 2e-4;
    const double bent =
        c_.slack[i] > least ? c_.slack[i] : least * std::exp(std::min(c_.slack[i] - least, 0.0) / least);
    const double used = full - bent;
    const double near = (b.thigh * b.thigh - b.shank * b.shank + used * used) / (2 * used);
    const double bulge = std::sqrt(std::max(b.thigh * b.thigh - near * near, 1e-12));
    const double direction = std::atan2(on, across);
    c_.thigh[i] = direction + std::atan2(bulge, near);
    c_.shank[i] = direction - std::atan2(bulge, used - near);
    c_.knee[i] = c_.thigh[i] - c_.shank[i];
    hip_.z[i] = hip_on;
    hip_.y[i] = hip_up;
    hip_.x[i] = hip_out;
    lean_[i] = std::atan2(out, down);
  }
}

void Model::move() {
  for (std::size_t i = 0; i < n; ++i) {
    const double phase = static_cast<double>(i) / n;
    c_.hips_forward[i] = t_.speed_m_s * period_ * phase + harmonics(shape::hips_forward, 4, 2 * phase);
    c_.hips_up[i] = t_.body.leg + harmonics(shape::hips_up, 4, 2 * phase);
    c_.trunk[i] = harmonics(shape::trunk, 3, 2 * phase);
    const double a = 2 * pi * phase;
    c_.hips_left[i] = at(shape::aside, 0) * std::cos(a) + at(shape::aside, 1) * std::cos(3 * a) +
                      at(shape::aside, 2) * std::sin(a) + at(shape::aside, 3) * std::sin(3 * a);
  }
  move_foot();
  move_leg();
}

double Model::second(const Samples& q, std::size_t i, double travel) const {
  const double after = i + 1 < n ? q[i + 1] : q[0] + travel, before = i > 0 ? q[i - 1] : q[n - 1] - travel;
  const double dt = period_ / n;
  return (after - 2 * q[i] + before) / (dt * dt);
}

void Model::load() {
  const StepBody& b = t_.body;
  const double step = t_.step_length_m, stride = 2 * step, h = b.height;
  static thread_local Track knee, ankle, centre[3];  // of the three segments' masses
  const double masses[3] = {thigh_mass, shank_mass, foot_mass};
  const double foot_on = 0.35 * b.ball_forward, foot_down = -0.5 * b.ankle_height;
  for (std::size_t i = 0; i < n; ++i) {
    const double ts = std::sin(c_.thigh[i]), tc = std::cos(c_.thigh[i]);
    const double ss = std::sin(c_.shank[i]), sc = std::cos(c_.shank[i]);
    const double ls = std::sin(lean_[i]), lc = std::cos(lean_[i]);
    const auto along = [&](const Track& from, double length, double sine, double cosine, Track& to) {
      to.z[i] = from.z[i] + length * sine;
      to.y[i] = from.y[i] - length * cosine * lc;
      to.x[i] = from.x[i] + length * cosine * ls;
    };
    along(hip_, b.thigh, ts, tc, knee);
    along(hip_, rod_centre * b.thigh, ts, tc, centre[0]);
    along(knee, b.shank, ss, sc, ankle);
    along(knee, rod_centre * b.shank, ss, sc, centre[1]);
    const double ps = std::sin(c_.pitch[i]), pc = std::cos(c_.pitch[i]);
    centre[2].z[i] = ankle.z[i] + foot_on * pc - foot_down * ps;
    centre[2].y[i] = ankle.y[i] + foot_on * ps + foot_down * pc;
    centre[2].x[i] = ankle.x[i];
  }
  const double inertia[3] = {thigh_mass * std::pow(thigh_gyration * b.thigh, 2),
                             shank_mass * std::pow(shank_gyration * b.shank, 2),
                             foot_mass * std::pow(foot_gyration * b.ball_forward, 2)};
  const Samples* angle[3] = {&c_.thigh, &c_.shank, &c_.pitch};

  // What accelerates the leg: forces and their moments about the right foothold, per kg of body.
  static thread_local Samples leg_z, leg_y, leg_pitch, leg_x, leg_roll;
  struct Forces {
    double z, y, spin;
  };
  static thread_local std::array<std::array<Forces, n>, 3> force;
  for (std::size_t i = 0; i < n; ++i) {
    double fz = 0, fy = 0, fx = 0, pitch = 0, roll = 0;
    for (std::size_t s = 0; s < 3; ++s) {
      const double az = second(centre[s].z, i, stride), ay = second(centre[s].y, i) + gravity,
                   ax = second(centre[s].x, i);
      // thigh and shank turn forward with their lower ends, the foot with its toes: all against forward pitch
      const double spin = -inertia[s] * second(*angle[s], i);
      force[s][i] = {masses[s] * az, masses[s] * ay, spin};
      fz += masses[s] * az;
      fy += masses[s] * ay;
      fx += masses[s] * ax;
      pitch += masses[s] * (centre[s].y[i] * az - centre[s].z[i] * ay) + spin;
      roll += masses[s] * (centre[s].y[i] * ax - centre[s].x[i] * ay);
    }
    leg_z[i] = fz;
    leg_y[i] = fy;
    leg_x[i] = fx;
    leg_pitch[i] = pitch;
    leg_roll[i] = roll;
  }

  static thread_local Samples upper_z, upper_y;
  for (std::size_t i = 0; i < n; ++i) {
    upper_z[i] = c_.hips_forward[i] + h * (upper_body.forward + upper_body.by_chest * c_.trunk[i] +
                                           upper_body.by_pelvis * (c_.tilt[i] - neutral_tilt_deg * pi / 180));
    upper_y[i] = c_.hips_up[i] + h * upper_body.up;
  }
  const double share_start[3] = {at(shape::share, 0), at(shape::share, 1), at(shape::share, 2)};
  const auto taken = [&](double u) {
    return 1 - (1 - u) * (1 - u) * (1 + u * (share_start[0] + u * (share_start[1] + u * share_start[2])));
  };
  const auto apart = [&](double u) {
    return 4 * u * (1 - u) *
           (at(shape::split, 1) + at(shape::split, 2) * (2 * u - 1) + at(shape::split, 3) * legendre(2, 2 * u - 1));
  };
  Samples& pressure = c_.pressure;
  for (std::size_t i = 0; i < n; ++i) {
    const double phase = static_cast<double>(i) / n, over = 2 * std::clamp(phase / off_, 0.0, 1.0) - 1;
    pressure[i] = 0.05;
    for (std::size_t k = 0; k < shape::pressure.count; ++k) pressure[i] += at(shape::pressure, k) * legendre(k, over);
    const double u1 = std::clamp(phase / t_.double_support, 0.0, 1.0);
    const double u2 = std::clamp((phase - 0.5) / t_.double_support, 0.0, 1.0);
    c_.share[i] = phase < t_.double_support ? taken(u1) : phase < 0.5 ? 1 : phase < off_ ? 1 - taken(u2) : 0;
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t o = other(i);
    const double phase = static_cast<double>(i) / n, lead = phase < 0.5 ? -step : step;
    const double uz = upper_body.mass * second(upper_z, i, stride);
    const double uy = upper_body.mass * (second(upper_y, i) + gravity);
    const double ux = upper_body.mass * second(c_.hips_left, i);
    c_.total_forward[i] = uz + leg_z[i] + leg_z[o];
    c_.total_up[i] = uy + leg_y[i] + leg_y[o];
    const double spin =
        h * h * (upper_body.spin_by_chest * second(c_.trunk, i) + upper_body.spin_by_pelvis * second(c_.tilt, i));
    const double moment = leg_pitch[i] + leg_pitch[o] - lead * leg_y[o] + upper_y[i] * uz - upper_z[i] * uy + spin;
    const double bearing = std::max(c_.total_up[i], 1.0);
    c_.wanted_pressure[i] = -moment / bearing;
    // to the left of the walking line; right leg's own side is −x
    const double roll = -leg_roll[i] + leg_roll[o] + upper_y[i] * ux - c_.hips_left[i] * uy;
    const double left_foot = t_.half_width_m;
    c_.pressure_aside[i] = -roll / bearing - (1 - 2 * c_.share[i]) * left_foot;
    const double mean = c_.share[i] * pressure[i] + (1 - c_.share[i]) * (pressure[o] + lead);
    const double lacking = c_.wanted_pressure[i] - mean, own = pressure[i] + lacking;
    c_.lacking[i] = lacking;
    c_.borne[i] = own;
    const double centre_up =
        (upper_body.mass * upper_y[i] + thigh_mass * (centre[0].y[i] + centre[0].y[o]) +
         shank_mass * (centre[1].y[i] + centre[1].y[o]) + foot_mass * (centre[2].y[i] + centre[2].y[o]));
    c_.centre_up[i] = centre_up;
    const double u1 = std::clamp(phase / t_.double_support, 0.0, 1.0);
    const double u2 = std::clamp((phase - 0.5) / t_.double_support, 0.0, 1.0);
    double push = 0;
    if (phase < t_.double_support) push = apart(u1);
    if (phase >= 0.5 && phase < off_) push = -apart(u2);
    const double lean = c_.share[i] * c_.total_up[i] / (centre_up * (pivot_height + at(shape::split, 0)));
    const double fz = c_.share[i] * c_.total_forward[i] + lean * (mean + lacking - own) + gravity * push;
    const double fy = c_.share[i] * c_.total_up[i];
    c_.forward[i] = fz / gravity;
    c_.up[i] = fy / gravity;

    // From the foot up: moments about the axis across, forward pitch positive.
    const auto moment_of = [](double z, double y, double qz, double qy) { return y * qz - z * qy; };
    const double az = ankle.z[i], ay = ankle.y[i];
    const Forces &foot = force[2][i], &shank = force[1][i], &thigh = force[0][i];
    double turning = moment_of(centre[2].z[i] - az, centre[2].y[i] - ay, foot.z, foot.y) -
                     moment_of(own - az, -ay, fz, fy) + foot.spin;
    double tz = foot.z - fz, ty = foot.y - fy;
    c_.ankle_moment[i] = turning;
    turning += moment_of(az - knee.z[i], ay - knee.y[i], tz, ty) +
               moment_of(centre[1].z[i] - knee.z[i], centre[1].y[i] - knee.y[i], shank.z, shank.y) + shank.spin;
    tz += shank.z;
    ty += shank.y;
    c_.knee_moment[i] = -turning;
    turning += moment_of(knee.z[i] - hip_.z[i], knee.y[i] - hip_.y[i], tz, ty) +
               moment_of(centre[0].z[i] - hip_.z[i], centre[0].y[i] - hip_.y[i], thigh.z, thigh.y) + thigh.spin;
    c_.hip_moment[i] = turning;
  }
}

}  // namespace

StepBody step_body(double height_m) {
  namespace f = fraction;
  const double h = height_m, k = height_m / reference_height;
  return {h,
          f::hip_height * h,
          f::thigh * h,
          f::shank * h,
          f::ankle_height * h,
          f::heel_back * h,
          f::ball_forward * h,
          f::toe_joint_height * h,
          f::toes_length * h,
          f::hip_half_spacing * h,
          0.030 * k,
          0.035 * k};
}

void evaluate_step(const StepTask& task, const StepShape& shape, StepCycle& cycle) {
  Model model(task, shape, cycle);
  model.move();
  model.load();
}

StepShape first_shape(const StepTask& task) {
  StepShape p{};
  const auto set = [&](const ShapePart& part, std::initializer_list<double> values) {
    std::copy(values.begin(), values.end(), p.begin() + static_cast<long>(part.first));
  };
  const double k = task.body.height / reference_height;
  set(shape::hips_forward, {-0.42 * task.step_length_m});
  set(shape::hips_up, {-0.02 * task.body.leg, -0.02 * k});
  set(shape::trunk, {0.03});
  set(shape::aside, {0, 0, -0.02 * k});
  set(shape::strike, {0.38 * std::min(1.0, task.step_length_m / (0.75 * k)), -0.3, -0.9});
  set(shape::rise, {0.6, 0.4});
  set(shape::pressure, {0, 0.08 * k});
  set(shape::share, {1.3});
  set(shape::swing_up, {0.05 * k});
  return p;
}

}  // namespace mobil
