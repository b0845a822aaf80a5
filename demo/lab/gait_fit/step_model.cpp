#include <numbers>
#include <span>

#include "assets/gait/leg_model.h"
#include "demo/lab/compare/compare_reference.h"
#include "demo/lab/gait_fit/step_curves.h"
#include "demo/lab/gait_fit/upper_body.h"

namespace mobil {
namespace {

constexpr double pi = std::numbers::pi, gravity = gravity_m_s2;
constexpr std::size_t n = cycle_samples, half_cycle = n / 2;

/// Usual foot flat and heel rise, fractions of the cycle; the fraction in which the heel's pad yields.
constexpr double usual_flat = 0.09, usual_rise = 0.30, pad_part = 0.05;
constexpr auto pivot_height = static_cast<double>(forces::pivot_height);

/// Places over the cycle: forward, up, and outward on the leg's own side.
struct Track {
  Samples z, y, x;
};

/// Force and moment that accelerate one segment, per kg of body.
struct Force {
  double z, y, spin;
};

/// Force that accelerates a leg with the arm that follows it, and its moments about the axes across and along.
struct LegLoad {
  double z = 0, y = 0, pitch = 0, roll = 0;
};

class Model {
 public:
  Model(const StepTask& task, const StepShape& shape, StepCycle& cycle) : t_(task), p_(shape), c_(cycle) {
    period_ = 2 * t_.step_length_m / t_.speed_m_s;
    off_ = 0.5 + t_.double_support;
  }
  void move();
  void load() {
    place_masses();
    accelerate_leg();
    add_arm();
    share_load();
    balance();
  }

 private:
  double at(const ShapePart& part, std::size_t i) const { return p_[part.first + i]; }
  double harmonics(const ShapePart& part, std::size_t count, double phase) const;
  std::span<const double> of(const ShapePart& part) const { return std::span(p_).subspan(part.first, part.count); }
  void move_foot();
  void move_leg();
  double second(const Samples& q, std::size_t i, double travel = 0) const;
  static std::size_t other(std::size_t i) { return (i + half_cycle) % n; }
  /// Returns the elapsed fraction of double support, at `phase` of the cycle after a heel strike.
  double landed(double phase) const { return std::clamp(phase / t_.double_support, 0.0, 1.0); }
  void place_masses();
  void accelerate_leg();
  void add_arm();
  void share_load();
  void balance();
  void find_moments(std::size_t i, double fz, double fy);

  const StepTask& t_;
  const StepShape& p_;
  StepCycle& c_;
  double period_, off_;
  Track hip_;      // of the right leg, x to its own side
  Samples reach_;  // of the right leg: angle of the line from hip to ankle, forward
  Samples list_;   // of the pelvis, right side up
  Samples lean_;   // of the leg's plane, outward
  Track knee_, ankle_;
  std::array<Track, 3> centre_;  // of the masses of thigh, shank and foot
  std::array<std::array<Force, n>, 3> force_;
  std::array<LegLoad, n> leg_;
  Samples arm_up_;  // mass times height
};

double Model::harmonics(const ShapePart& part, std::size_t count, double phase) const {
  double sum = at(part, 0);
  for (std::size_t k = 1; k <= count; ++k) {
    const double a = 2 * pi * static_cast<double>(k) * phase;
    sum += at(part, k) * std::cos(a) + at(part, count + k) * std::sin(a);
  }
  return sum;
}

void Model::move_foot() {
  const double flat = usual_flat + at(step_shape::times, 0), lift = usual_rise + at(step_shape::times, 1);
  const double rising = off_ - lift, swing_part = 1 - off_, span = swing_part * period_;
  // State of the foot at toe-off and at the next strike.
  const Moving leaving = per_second(heel_rise_end(of(step_shape::rise), rising), period_);
  const auto starts = [&](const ShapePart& part, double over) {
    return per_second(falling_start(of(part), over), period_);
  };
  const Moving landing = starts(step_shape::strike, flat);
  const Moving pad_up = starts(step_shape::pad_up, pad_part), pad_on = starts(step_shape::pad_forward, pad_part);
  const auto place = [](Moving a, const Moving& b, double on) {
    return Moving{a.value + b.value + on, a.rate + b.rate, a.bend + b.bend};
  };
  const Moving off_on = rolled(t_.body, leaving, false), off_up = rolled(t_.body, leaving, true);
  const Moving land_on = place(rolled(t_.body, landing, false), pad_on, 0);
  const Moving land_up = place(rolled(t_.body, landing, true), pad_up, 0);
  const double out_s = std::sin(t_.toe_out), out_c = std::cos(t_.toe_out), stride = 2 * t_.step_length_m;
  const auto on_ground = [](const Moving& along, double times, double from) {
    return Moving{from + times * along.value, times * along.rate, times * along.bend};
  };
  for (std::size_t i = 0; i < n; ++i) {
    const double phase = static_cast<double>(i) / n;
    c_.stance_pitch[i] = (phase < flat ? falling(of(step_shape::strike), phase / flat) : 0) +
                         heel_rise(of(step_shape::rise), std::clamp((phase - lift) / rising, 0.0, 1.0));
    c_.pad_up[i] = falling(of(step_shape::pad_up), phase / pad_part);
    c_.pad_forward[i] = falling(of(step_shape::pad_forward), phase / pad_part);
    c_.swings[i] = phase >= off_;
    const double u = c_.swung[i] = std::clamp((phase - off_) / swing_part, 0.0, 1.0);
    if (c_.swings[i]) {
      c_.pitch[i] = quintic(u, leaving, landing, span) + bumps(of(step_shape::swing_pitch), u);
      c_.ankle_forward[i] = quintic(u, on_ground(off_on, out_c, 0), on_ground(land_on, out_c, stride), span) +
                            bumps(of(step_shape::swing_forward), u);
      c_.ankle_up[i] = quintic(u, off_up, land_up, span) + bumps(of(step_shape::swing_up), u);
      c_.ankle_out[i] =
          quintic(u, on_ground(off_on, out_s, t_.half_width_m), on_ground(land_on, out_s, t_.half_width_m), span);
    } else {
      c_.pitch[i] = c_.stance_pitch[i];
      const double on = rolled(t_.body, {c_.pitch[i]}, false).value + c_.pad_forward[i];
      c_.ankle_forward[i] = out_c * on;
      c_.ankle_up[i] = rolled(t_.body, {c_.pitch[i]}, true).value + c_.pad_up[i];
      c_.ankle_out[i] = t_.half_width_m + out_s * on;
    }
    const double s = std::sin(c_.pitch[i]), c = std::cos(c_.pitch[i]);
    const StepBody& b = t_.body;
    c_.heel_clear[i] = c_.ankle_up[i] - b.heel_back * s - (b.ankle_height - b.heel_radius) * c - b.heel_radius;
    const double joint = c_.ankle_up[i] + b.ball_forward * s - (b.ankle_height - b.toe_joint_height) * c;
    const double straight = std::clamp(
        (u - static_cast<double>(swing_toes::from)) / static_cast<double>(swing_toes::to - swing_toes::from), 0.0, 1.0);
    const double bent = std::max(-c_.pitch[i], 0.0) - toe_pitch(-c_.pitch[i]).value;
    const double toes = c_.pitch[i] + bent * (1 - straight * straight * (3 - 2 * straight));
    c_.ball_clear[i] = joint - b.toe_joint_height * std::cos(toes);
    c_.toe_clear[i] = c_.ball_clear[i] + b.toes_length * std::sin(toes);
  }
}

/// Moves the hip of the right leg, and thigh and shank between it and the ankle.
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
    // A leg out of reach is pulled in smoothly, so that a fit finds its way back.
    constexpr double least = 2e-4;
    const double bent =
        c_.slack[i] > least ? c_.slack[i] : least * std::exp(std::min(c_.slack[i] - least, 0.0) / least);
    const double used = full - bent;
    const double near = (b.thigh * b.thigh - b.shank * b.shank + used * used) / (2 * used);
    const double bulge = std::sqrt(std::max(b.thigh * b.thigh - near * near, 1e-12));
    const double direction = reach_[i] = std::atan2(on, across);
    list_[i] = listed;
    c_.thigh[i] = direction + std::atan2(bulge, near);
    c_.shank[i] = direction - std::atan2(bulge, used - near);
    c_.hip[i] = c_.thigh[i] + c_.tilt[i];
    c_.knee[i] = c_.thigh[i] - c_.shank[i];
    c_.ankle[i] = c_.pitch[i] - c_.shank[i];
    hip_.z[i] = hip_on;
    hip_.y[i] = hip_up;
    hip_.x[i] = hip_out;
    lean_[i] = std::atan2(out, down);
  }
}

void Model::move() {
  for (std::size_t i = 0; i < n; ++i) {
    const double phase = static_cast<double>(i) / n;
    c_.hips_forward[i] = t_.speed_m_s * period_ * phase + harmonics(step_shape::hips_forward, 4, 2 * phase);
    c_.hips_up[i] = t_.body.leg + harmonics(step_shape::hips_up, 4, 2 * phase);
    c_.trunk[i] = harmonics(step_shape::trunk, 3, 2 * phase);
    const double a = 2 * pi * phase;
    c_.hips_left[i] = at(step_shape::aside, 0) * std::cos(a) + at(step_shape::aside, 1) * std::cos(3 * a) +
                      at(step_shape::aside, 2) * std::sin(a) + at(step_shape::aside, 3) * std::sin(3 * a);
  }
  move_foot();
  move_leg();
}

double Model::second(const Samples& q, std::size_t i, double travel) const {
  const double after = i + 1 < n ? q[i + 1] : q[0] + travel, before = i > 0 ? q[i - 1] : q[n - 1] - travel;
  const double dt = period_ / n;
  return (after - 2 * q[i] + before) / (dt * dt);
}

/// Places knee, ankle and the centres of mass of thigh, shank and foot, from the hip down.
void Model::place_masses() {
  const StepBody& b = t_.body;
  const double foot_on = forces::foot_centre.z * b.height, foot_down = forces::foot_centre.y * b.height;
  for (std::size_t i = 0; i < n; ++i) {
    const double ts = std::sin(c_.thigh[i]), tc = std::cos(c_.thigh[i]);
    const double ss = std::sin(c_.shank[i]), sc = std::cos(c_.shank[i]);
    const double ls = std::sin(lean_[i]), lc = std::cos(lean_[i]);
    const auto along = [&](const Track& from, double length, double sine, double cosine, Track& to) {
      to.z[i] = from.z[i] + length * sine;
      to.y[i] = from.y[i] - length * cosine * lc;
      to.x[i] = from.x[i] + length * cosine * ls;
    };
    along(hip_, b.thigh, ts, tc, knee_);
    along(hip_, static_cast<double>(forces::thigh.centre) * b.thigh, ts, tc, centre_[0]);
    along(knee_, b.shank, ss, sc, ankle_);
    along(knee_, static_cast<double>(forces::shank.centre) * b.shank, ss, sc, centre_[1]);
    const double ps = std::sin(c_.pitch[i]), pc = std::cos(c_.pitch[i]);
    centre_[2].z[i] = ankle_.z[i] + foot_on * pc - foot_down * ps;
    centre_[2].y[i] = ankle_.y[i] + foot_on * ps + foot_down * pc;
    centre_[2].x[i] = ankle_.x[i];
  }
}

/// Finds the force that accelerates the leg against gravity, and its moments about the right foothold.
void Model::accelerate_leg() {
  const StepBody& b = t_.body;
  const double stride = 2 * t_.step_length_m;
  const double masses[3] = {b.thigh_mass, b.shank_mass, b.foot_mass};
  const auto spin_of = [](double mass, const forces::Rod& rod, double length) {
    return mass * std::pow(static_cast<double>(rod.gyration) * length, 2);
  };
  const double inertia[3] = {
      spin_of(b.thigh_mass, forces::thigh, b.thigh), spin_of(b.shank_mass, forces::shank, b.shank),
      spin_of(b.foot_mass, forces::foot, std::hypot(b.ball_forward, b.ankle_height - b.toe_joint_height))};
  const Samples* angle[3] = {&c_.thigh, &c_.shank, &c_.pitch};
  for (std::size_t i = 0; i < n; ++i) {
    LegLoad sum;
    for (std::size_t s = 0; s < 3; ++s) {
      const Track& centre = centre_[s];
      const double az = second(centre.z, i, stride), ay = second(centre.y, i) + gravity, ax = second(centre.x, i);
      // thigh and shank turn forward with their lower ends, the foot with its toes: all against forward pitch
      const double spin = -inertia[s] * second(*angle[s], i);
      force_[s][i] = {masses[s] * az, masses[s] * ay, spin};
      sum.z += masses[s] * az;
      sum.y += masses[s] * ay;
      sum.pitch += masses[s] * (centre.y[i] * az - centre.z[i] * ay) + spin;
      sum.roll += masses[s] * (centre.y[i] * ax - centre.x[i] * ay);
    }
    leg_[i] = sum;
  }
}

/// Adds the left arm, which follows the right leg.
void Model::add_arm() {
  const ArmBody& arm = t_.body.arm;
  const auto& joint = t_.body.upper.shoulder;
  const double stride = 2 * t_.step_length_m, per = 1 / (t_.leg_forward - t_.leg_back);
  Track upper, lower;
  Samples upper_turn, lower_turn;
  for (std::size_t i = 0; i < n; ++i) {
    const double ahead = (reach_[i] - t_.leg_back) * per;
    const double a = ahead * (t_.arm_forward + t_.arm_back) - t_.arm_back - c_.trunk[i];
    const double b = a + ahead * (t_.elbow_forward - t_.elbow_back) + t_.elbow_back;
    const double z = c_.hips_forward[i] +
                     (joint.forward + joint.by_chest * c_.trunk[i] + joint.by_pelvis * (c_.tilt[i] - neutral_tilt));
    const double y = c_.hips_up[i] + joint.up;
    upper.z[i] = z + arm.upper_centre * std::sin(a);
    upper.y[i] = y - arm.upper_centre * std::cos(a);
    lower.z[i] = z + (arm.length * std::sin(a) + arm.lower_centre * std::sin(b));
    lower.y[i] = y - (arm.length * std::cos(a) + arm.lower_centre * std::cos(b));
    upper.x[i] = lower.x[i] = -c_.hips_left[i] - (joint.by_pelvis * list_[i] + joint.aside);
    upper_turn[i] = a;
    lower_turn[i] = b;
  }
  const auto add = [&](const Track& at, const Samples& turn, double mass, double inertia) {
    for (std::size_t i = 0; i < n; ++i) {
      const double az = second(at.z, i, stride), ay = second(at.y, i) + gravity, ax = second(at.x, i);
      leg_[i].z += mass * az;
      leg_[i].y += mass * ay;
      leg_[i].pitch += mass * (at.y[i] * az - at.z[i] * ay) - inertia * second(turn, i);
      leg_[i].roll += mass * (at.y[i] * ax - at.x[i] * ay);
      arm_up_[i] += mass * at.y[i];
    }
  };
  arm_up_.fill(0);
  add(upper, upper_turn, arm.upper, arm.upper_spin);
  add(lower, lower_turn, arm.lower, arm.lower_spin);
}

/// Finds the right foot's share of the weight, and its centre of pressure before balance is required.
void Model::share_load() {
  const auto taken = [&](double u) {
    return 1 - (1 - u) * (1 - u) *
                   (1 + u * (at(step_shape::share, 0) + u * (at(step_shape::share, 1) + u * at(step_shape::share, 2))));
  };
  for (std::size_t i = 0; i < n; ++i) {
    const double phase = static_cast<double>(i) / n, over = 2 * std::clamp(phase / off_, 0.0, 1.0) - 1;
    c_.pressure[i] = 0.05;
    for (std::size_t k = 0; k < step_shape::pressure.count; ++k)
      c_.pressure[i] += at(step_shape::pressure, k) * legendre(k, over);
    c_.share[i] = phase < t_.double_support ? taken(landed(phase))
                  : phase < 0.5             ? 1
                  : phase < off_            ? 1 - taken(landed(phase - 0.5))
                                            : 0;
  }
}

/// Finds the ground reaction of both feet, the place where it must act, and the right foot's share of it.
void Model::balance() {
  const double step = t_.step_length_m;
  const StepBody& b = t_.body;
  const UpperBody& upper_body = b.upper;
  Samples upper_z, upper_y, upper_x;
  for (std::size_t i = 0; i < n; ++i) {
    upper_z[i] = c_.hips_forward[i] + (upper_body.forward + upper_body.by_chest * c_.trunk[i] +
                                       upper_body.by_pelvis * (c_.tilt[i] - neutral_tilt));
    upper_y[i] = c_.hips_up[i] + upper_body.up;
    upper_x[i] = c_.hips_left[i] + upper_body.by_pelvis * list_[i];
  }
  const auto apart = [&](double u) {
    return 4 * u * (1 - u) *
           (at(step_shape::split, 1) + at(step_shape::split, 2) * (2 * u - 1) +
            at(step_shape::split, 3) * legendre(2, 2 * u - 1));
  };
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t o = other(i);
    const double phase = static_cast<double>(i) / n, lead = phase < 0.5 ? -step : step;
    const double uz = upper_body.mass * second(upper_z, i, 2 * step);
    const double uy = upper_body.mass * (second(upper_y, i) + gravity);
    const double ux = upper_body.mass * second(upper_x, i);
    c_.total_forward[i] = uz + leg_[i].z + leg_[o].z;
    c_.total_up[i] = uy + leg_[i].y + leg_[o].y;
    const double spin =
        (upper_body.spin_by_chest * second(c_.trunk, i) + upper_body.spin_by_pelvis * second(c_.tilt, i));
    const double moment = leg_[i].pitch + leg_[o].pitch - lead * leg_[o].y + upper_y[i] * uz - upper_z[i] * uy + spin;
    const double bearing = std::max(c_.total_up[i], 1.0);
    c_.wanted_pressure[i] = -moment / bearing;
    // to the left of the walking line; right leg's own side is −x
    const double roll =
        -leg_[i].roll + leg_[o].roll + upper_y[i] * ux - upper_x[i] * uy + upper_body.spin_by_list * second(list_, i);
    c_.pressure_aside[i] = -roll / bearing - (1 - 2 * c_.share[i]) * t_.half_width_m;
    const double mean = c_.share[i] * c_.pressure[i] + (1 - c_.share[i]) * (c_.pressure[o] + lead);
    c_.lacking[i] = c_.wanted_pressure[i] - mean;
    c_.borne[i] = c_.pressure[i] + c_.lacking[i];
    c_.centre_up[i] =
        (upper_body.mass * upper_y[i] + arm_up_[i] + arm_up_[o] + b.thigh_mass * (centre_[0].y[i] + centre_[0].y[o]) +
         b.shank_mass * (centre_[1].y[i] + centre_[1].y[o]) + b.foot_mass * (centre_[2].y[i] + centre_[2].y[o]));
    double push = 0;
    if (phase < t_.double_support) push = apart(landed(phase));
    if (phase >= 0.5 && phase < off_) push = -apart(landed(phase - 0.5));
    const double lean = c_.share[i] * c_.total_up[i] / (c_.centre_up[i] * (pivot_height + at(step_shape::split, 0)));
    const double fz = c_.share[i] * c_.total_forward[i] + lean * (mean + c_.lacking[i] - c_.borne[i]) + gravity * push;
    c_.forward[i] = fz / gravity;
    c_.up[i] = c_.share[i] * c_.total_up[i] / gravity;
    find_moments(i, fz, c_.share[i] * c_.total_up[i]);
  }
}

/// Finds joint moments from the foot up, about the axis across, forward pitch positive; the ground pushes by (fz, fy).
void Model::find_moments(std::size_t i, double fz, double fy) {
  const auto moment_of = [](double z, double y, double qz, double qy) { return y * qz - z * qy; };
  const double az = ankle_.z[i], ay = ankle_.y[i];
  const Force &foot = force_[2][i], &shank = force_[1][i], &thigh = force_[0][i];
  double turning = moment_of(centre_[2].z[i] - az, centre_[2].y[i] - ay, foot.z, foot.y) -
                   moment_of(c_.borne[i] - az, -ay, fz, fy) + foot.spin;
  double tz = foot.z - fz, ty = foot.y - fy;
  c_.ankle_moment[i] = turning;
  turning += moment_of(az - knee_.z[i], ay - knee_.y[i], tz, ty) +
             moment_of(centre_[1].z[i] - knee_.z[i], centre_[1].y[i] - knee_.y[i], shank.z, shank.y) + shank.spin;
  tz += shank.z;
  ty += shank.y;
  c_.knee_moment[i] = -turning;
  turning += moment_of(knee_.z[i] - hip_.z[i], knee_.y[i] - hip_.y[i], tz, ty) +
             moment_of(centre_[0].z[i] - hip_.z[i], centre_[0].y[i] - hip_.y[i], thigh.z, thigh.y) + thigh.spin;
  c_.hip_moment[i] = turning;
}

}  // namespace

StepBody step_body(StepKind kind, double leg_scale_m) {
  namespace f = fraction;
  const auto sizes = [](const BodyRequest& request) { return make_body(request)->size; };
  BodySize<float> size = sizes(typical_body(kind == StepKind::woman ? Sex::woman : Sex::man, usual_age_y));
  auto* const number = reinterpret_cast<float*>(&size);
  if (kind == StepKind::child) {  // between a boy and a girl
    const BodySize<float> boy = sizes(typical_body(Sex::man, 7)), girl = sizes(typical_body(Sex::woman, 7));
    const auto *const one = reinterpret_cast<const float*>(&boy), *const other = reinterpret_cast<const float*>(&girl);
    for (std::size_t i = 0; i < sizeof(size) / sizeof(float); ++i) number[i] = 0.5F * (one[i] + other[i]);
  }
  const BodyParts parts = body_parts(size, leg_scale_m / static_cast<double>(size.leg_scale_m));
  const double h = leg_scale_m;
  return {h,
          f::hip_height * h,
          f::thigh * h,
          f::shank * h,
          f::ankle_height * h,
          f::heel_back * h,
          f::ball_forward * h,
          f::toe_joint_height * h,
          f::toes_length * h,
          parts.joint_offset[index(Segment::thigh_left)].x,
          f::heel_radius * h,
          static_cast<double>(size.thigh_mass),
          static_cast<double>(size.shank_mass),
          static_cast<double>(size.foot_mass),
          make_upper_body(parts),
          make_arm(parts)};
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
  const double k = task.body.height / fitted_height_m;
  set(step_shape::hips_forward, {-0.42 * task.step_length_m});
  set(step_shape::hips_up, {-0.02 * task.body.leg, -0.02 * k});
  set(step_shape::trunk, {0.03});
  set(step_shape::aside, {0, 0, -0.02 * k});
  set(step_shape::strike, {0.38 * std::min(1.0, task.step_length_m / (0.75 * k)), -0.3, -0.9});
  set(step_shape::rise, {0.6, 0.4});
  set(step_shape::times, {0, -0.22});
  set(step_shape::pressure, {0, 0.08 * k});
  set(step_shape::share, {1.3});
  set(step_shape::swing_up, {0.05 * k});
  return p;
}

}  // namespace mobil
