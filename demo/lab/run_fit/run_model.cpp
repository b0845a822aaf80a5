#include "demo/lab/run_fit/run_model.h"

#include <algorithm>
#include <cmath>

#include "assets/gait/run_curves.h"
#include "demo/lab/compare/compare_reference.h"
#include "demo/lab/run_fit/run_foot.h"
#include "demo/lab/run_fit/run_leg.h"
#include "demo/lab/run_fit/run_top.h"

namespace mobil {
namespace {

using namespace geometry;
using enum Segment;

constexpr double gravity = gravity_m_s2;
constexpr std::size_t first_of_leg = index(thigh_right);

/// Mirror image of an angular momentum or a moment.
Vec3<double> mirrored_turn(const Vec3<double>& v) {
  return {v.x, -v.y, -v.z};
}

/// Returns the solution of a · x = b by Cramer's rule.
Vec3<double> solved(const LegDerivatives& a, const Vec3<double>& b) {
  const Vec3<double> c0{a[0][0], a[1][0], a[2][0]}, c1{a[0][1], a[1][1], a[2][1]}, c2{a[0][2], a[1][2], a[2][2]};
  const double by = 1 / dot(c0, cross(c1, c2));
  return {by * dot(b, cross(c1, c2)), by * dot(c0, cross(b, c2)), by * dot(c0, cross(c1, b))};
}

std::vector<double> with_first(double first, const RunShape& shape, const ShapePart& part) {
  std::vector<double> all = {first};
  for (std::size_t i = 0; i < part.count; ++i) all.push_back(shape[part.first + i]);
  return all;
}

/// A moment about the axis across, forward pitch positive.
double pitching(const Vec3<double>& arm, const Vec3<double>& force) {
  return arm.y * force.z - arm.z * force.y;
}

}  // namespace

double contact_s(const RunTask& task) {
  return 2 * task.duty / task.frequency_hz;
}
double step_length_m(const RunTask& task) {
  return task.speed_m_s / task.frequency_hz;
}

struct RunModel::State {
  RunTask task;
  RunTop top;
  std::array<double, top_numbers> top_of{};
  std::vector<LegPose> leg;  // the right one over the cycle
  std::vector<FootMoment> foot;
  RunVectors last_hips;                  // middle of the hips
  RunVectors hip_offset;                 // of the right hip from the middle of the hips
  RunVectors leg_momentum;               // from each sample to the next, times the interval
  std::array<RunSamples, 3> group_turn;  // thigh, shank and foot: its part across, of their own rotation

  explicit State(const RunTask& of) : task(of) {}
  std::size_t n() const { return task.samples; }
  std::size_t half() const { return task.samples / 2; }
  double interval() const { return 2 / (task.frequency_hz * static_cast<double>(n())); }

  void move_centre(const RunShape& shape, RunCycle& c) const;
  void place_hips(RunCycle& c);
  void place_legs(RunCycle& c);
  void add_turning(RunCycle& c);
  void balance(RunCycle& c) const;
  void find_moments(RunCycle& c) const;

  /// Returns a place of the second half of the cycle as the right leg sees it, from one half a cycle earlier.
  Vec3<double> half_later(const Vec3<double>& at) const {
    return mirrored(at) + Vec3<double>{0, 0, step_length_m(task)};
  }
  Vec3<double> at_any(const RunVectors& of_step, std::size_t i) const {
    return i < half() ? of_step[i] : half_later(of_step[i - half()]);
  }
  LegMoment right_leg(std::size_t i, const Vec3<double>& hips, const RunCycle& c) const {
    const Vec3<double> hip = hips + hip_offset[i];
    return leg_moment(task.body, leg_plane(task.body.size, hip, c.foot.ankle[i]), hip, foot[i]);
  }
};

/// Finds the path of the centre of mass, and the force.
void RunModel::State::move_centre(const RunShape& shape, RunCycle& c) const {
  namespace r = run_curve;
  const auto number = [&](const ShapePart& part, std::size_t i) { return shape[part.first + i]; };
  const auto up_numbers =
      with_first(r::weight_term(task.duty, number(run_shape::force_up, 1)), shape, run_shape::force_up);
  const auto forward_numbers =
      with_first(r::steady_term(number(run_shape::force_forward, 1)), shape, run_shape::force_forward);
  const r::ForcePath up = r::force_path(up_numbers), forward = r::force_path(forward_numbers),
                     aside = r::force_path({shape.data() + run_shape::force_aside.first, run_shape::force_aside.count});
  const double t_c = contact_s(task), span = 1 / task.frequency_hz, weight = gravity * t_c * t_c, end = span / t_c;
  const double rate_up = -(weight * r::twice_at(up, end) - 0.5 * gravity * span * span) / span;
  const double rate_on = (step_length_m(task) - weight * r::twice_at(forward, end)) / span;
  const double rate_left = -0.5 * gravity * t_c * r::impulse(aside);  // and reversed after a step
  const double left = -0.5 * (rate_left * span + weight * r::twice_at(aside, end));
  for (std::size_t i = 0; i < half(); ++i) {
    const double t = span * static_cast<double>(i) / static_cast<double>(half()), u = t / t_c;
    c.step.force[i] = {r::force_at(aside, u), r::force_at(up, u), r::force_at(forward, u)};
    c.step.centre[i] = {left + rate_left * t + weight * r::twice_at(aside, u),
                        number(run_shape::centre, 1) + task.body.size.leg + rate_up * t + weight * r::twice_at(up, u) -
                            0.5 * gravity * t * t,
                        number(run_shape::centre, 0) + rate_on * t + weight * r::twice_at(forward, u)};
  }
}

/// Finds the hips with which the centre of mass of all segments is on its path: Newton's method, by plain steps until
/// it is near.
void RunModel::State::place_hips(RunCycle& c) {
  constexpr int max_rounds = 14;
  constexpr double near_m = 4e-3, plain = 1 / 0.85, done_m = 1e-12;
  for (std::size_t i = 0; i < n(); ++i) {
    const double phase = static_cast<double>(i) / static_cast<double>(n()),
                 half_spacing = task.body.size.hip_half_spacing;
    const double turn = run_harmonics(task.given.turn, 1, 2, phase), list = run_harmonics(task.given.list, 1, 2, phase);
    const double flat = half_spacing * std::cos(list);
    hip_offset[i] = {-flat * std::cos(turn), half_spacing * std::sin(list), flat * std::sin(turn)};
    foot[i] = foot_moment(task.body, task.toe_out, c.foot.pitch[i], c.foot.toes[i]);
  }
  const double length = step_length_m(task);
  for (std::size_t i = 0; i < half(); ++i) {
    const Vec3<double>& wanted = c.step.centre[i];
    Vec3<double> hips = wanted - Vec3<double>{0, 0.05 * task.body.size.height, 0.02};
    for (int round = 0;; ++round) {
      const LegMoment right = right_leg(i, hips, c), left = right_leg(i + half(), half_later(hips), c);
      const double left_mass = 0.5 * (1 - top.mass);
      const Vec3<double> left_sum = mirrored(left.sum) - Vec3<double>{0, 0, left_mass * length};
      const Vec3<double> off = wanted - (top.mass * (hips + top.centre[i]) + right.sum + left_sum);
      const double error = c.step.error[i] = geometry::length(off);
      if (error < done_m || round == max_rounds) break;
      if (error > near_m) {
        hips = hips + plain * off;
        continue;
      }
      LegDerivatives by{};
      for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t k = 0; k < 3; ++k) {
          const double sign = (row == 0) != (k == 0) ? -1 : 1;
          by[row][k] = right.by_hip[row][k] + sign * left.by_hip[row][k] + (row == k ? top.mass : 0);
        }
      }
      hips = hips + solved(by, off);
    }
    c.cycle.hips[i] = hips;
    c.cycle.hips[i + half()] = half_later(hips);
  }
}

void RunModel::State::place_legs(RunCycle& c) {
  for (std::size_t i = 0; i < n(); ++i) {
    const double phase = static_cast<double>(i) / static_cast<double>(n());
    const Vec3<double> hip = c.cycle.hips[i] + hip_offset[i];
    const LegPlane plane = leg_plane(task.body.size, hip, c.foot.ankle[i]);
    leg[i] = leg_pose(task.body, plane, hip, task.toe_out, c.foot.pitch[i], c.foot.toes[i]);
    c.cycle.slack[i] = plane.slack;
    c.cycle.hip[i] = plane.thigh_angle + run_harmonics(task.given.tilt, 0, 2, phase);
    c.cycle.knee[i] = plane.thigh_angle - plane.shank_angle;
    c.cycle.ankle[i] = c.foot.pitch[i] - plane.shank_angle;
  }
}

/// Finds the rate of the angular momentum about the centre of mass.
void RunModel::State::add_turning(RunCycle& c) {
  const BodyParts& parts = task.body.parts;
  constexpr std::array<std::size_t, leg_segments> group = {0, 0, 1, 2, 2};
  const auto from_centre = [&](std::size_t i, std::size_t k, const Vec3<double>& centre) {
    return leg[i].position[k] + rotated(leg[i].rotation[k], parts.centre_of_mass[first_of_leg + k]) - centre;
  };
  for (RunSamples& turn : group_turn) std::ranges::fill(turn, 0);
  for (std::size_t i = 0; i < n(); ++i) {
    const std::size_t j = (i + 1) % n();
    const Vec3<double> centre = at_any(c.step.centre, i), next = at_any(c.step.centre, j);
    Vec3<double> sum{0, 0, 0};
    for (std::size_t k = 0; k < leg_segments; ++k) {
      const std::size_t s = first_of_leg + k;
      const Vec3<double> own = turned_by(leg[i].rotation[k], leg[j].rotation[k], parts.inertia[s]);
      group_turn[group[k]][i] += own.x;
      sum = sum + own + parts.mass[s] * cross(from_centre(i, k, centre), from_centre(j, k, next));
    }
    leg_momentum[i] = sum;
  }
  RunVectors all(half());
  const double per = 1 / (interval() * interval());
  for (std::size_t i = 0; i < half(); ++i) {
    const auto top_at = [&](std::size_t k) { return c.cycle.hips[k] + top.centre[k] - c.step.centre[k]; };
    const Vec3<double> after = i + 1 < half() ? top_at(i + 1) : mirrored(top_at(0));
    all[i] = top.momentum[i] + top.mass * cross(top_at(i), after) + leg_momentum[i] +
             mirrored_turn(leg_momentum[i + half()]);
  }
  for (std::size_t i = 0; i < half(); ++i)
    c.step.turning[i] = per * (all[i] - (i > 0 ? all[i - 1] : mirrored_turn(all[half() - 1])));
}

/// Finds the place where the ground must press for the moment of the motion, and the moments that it cannot give.
void RunModel::State::balance(RunCycle& c) const {
  const StepBody& b = task.body.size;
  const double along = std::cos(task.toe_out), outward = std::tan(task.toe_out);
  const double pad = 0.03 / 1.75 * b.height, half_sole = 0.02 * b.height, least = 1e-3;
  const double heel = -b.heel_back, tip = b.ball_forward + b.toes_length;
  for (std::size_t i = 0; i < half(); ++i) {
    const double pitch = c.foot.stance_pitch[i];
    const double toes_down = std::clamp(1 - std::max(pitch, 0.0) / 0.30, 0.0, 1.0),
                 heel_up = std::clamp(std::max(-pitch, 0.0) / 0.15, 0.0, 1.0);
    c.step.front[i] = along * std::min(heel + (tip - heel) * toes_down + pad, tip);
    c.step.back[i] = along * (heel + (b.ball_forward - pad - heel) * heel_up);
    const Vec3<double>&at = c.step.centre[i], turning = c.step.turning[i], force = gravity * c.step.force[i];
    const double bears = std::max(force.y, least);
    c.step.wanted[i] = at.z - (turning.x + at.y * force.z) / bears;
    const double z = std::clamp(c.step.wanted[i], c.step.back[i], c.step.front[i]);
    c.step.pitch_lacking[i] = turning.x + at.y * force.z + (z - at.z) * force.y;
    const double line = -task.half_width_m - outward * z, moment = turning.z - at.y * force.x;
    c.step.aside[i] = at.x + moment / bears - line;
    const double x = line + std::clamp(c.step.aside[i], -half_sole, half_sole);
    c.step.roll_lacking[i] = moment + (at.x - x) * force.y;
    c.step.yaw[i] = turning.y - ((z - at.z) * force.x - (x - at.x) * force.z);
  }
}

/// Finds joint moments from the foot up, about the axis across.
void RunModel::State::find_moments(RunCycle& c) const {
  const BodyParts& parts = task.body.parts;
  const double per = 1 / (interval() * interval());
  const Vec3<double> travel{0, 0, 2 * step_length_m(task)}, weight{0, gravity, 0};
  const auto centre = [&](std::size_t i, std::size_t k) {
    return leg[i].position[k] + rotated(leg[i].rotation[k], parts.centre_of_mass[first_of_leg + k]);
  };
  for (std::size_t i = 0; i < n(); ++i) {
    const bool first = i == 0, last = i + 1 == n();
    const std::size_t before = first ? n() - 1 : i - 1, after = last ? 0 : i + 1;
    double moment = 0;
    Vec3<double> pull{0, 0, 0}, joint = leg[i].position[3];
    if (i < half()) {
      const double pressed = std::clamp(c.step.wanted[i], c.step.back[i], c.step.front[i]);
      const Vec3<double> force = gravity * c.step.force[i];
      moment = -pitching(Vec3<double>{0, 0, pressed} - joint, force);
      pull = -1 * force;
    }
    const auto add = [&](std::initializer_list<std::size_t> segments, std::size_t group, const Vec3<double>& to) {
      moment += pitching(joint - to, pull) + per * (group_turn[group][i] - group_turn[group][before]);
      joint = to;
      for (const std::size_t k : segments) {
        const Vec3<double> at = centre(i, k), next = centre(after, k) + (last ? 1.0 : 0.0) * travel,
                           past = centre(before, k) - (first ? 1.0 : 0.0) * travel;
        const Vec3<double> force = parts.mass[first_of_leg + k] * (per * (next - 2 * at + past) + weight);
        moment += pitching(at - to, force);
        pull = pull + force;
      }
      return moment;
    };
    c.cycle.ankle_moment[i] = add({3, 4}, 2, leg[i].position[3]);
    c.cycle.knee_moment[i] = -add({2}, 1, leg[i].position[2]);
    c.cycle.hip_moment[i] = add({0, 1}, 0, leg[i].position[0]);
  }
}

RunModel::RunModel(const RunTask& task) : state_(std::make_unique<State>(task)) {
  State& s = *state_;
  s.leg.resize(s.n());
  s.foot.resize(s.n());
  s.hip_offset.resize(s.n());
  s.leg_momentum.resize(s.n());
  for (RunSamples& turn : s.group_turn) turn.resize(s.n());
}
RunModel::~RunModel() = default;

const RunTask& RunModel::task() const {
  return state_->task;
}

void RunModel::evaluate(const RunShape& shape, RunCycle& c) {
  State& s = *state_;
  for (RunVectors* v : {&c.step.centre, &c.step.force, &c.step.turning}) v->resize(s.half());
  for (RunSamples* v : {&c.step.wanted, &c.step.front, &c.step.back, &c.step.pitch_lacking, &c.step.aside,
                        &c.step.roll_lacking, &c.step.yaw, &c.step.error})
    v->resize(s.half());
  for (RunSamples* v : {&c.cycle.hip, &c.cycle.knee, &c.cycle.ankle, &c.cycle.slack, &c.cycle.hip_moment,
                        &c.cycle.knee_moment, &c.cycle.ankle_moment})
    v->resize(s.n());
  c.cycle.hips.resize(s.n());
  const auto numbers = numbers_of_top(shape);
  if (s.top.pose.empty() || numbers != s.top_of) {
    evaluate_top(s.task, shape, s.top);
    s.top_of = numbers;
  }
  c.step.trunk = s.top.trunk;
  c.step.side_lean = s.top.side_lean;
  c.step.shoulders = s.top.shoulders;
  s.move_centre(shape, c);
  evaluate_foot(s.task, shape, c.foot);
  s.place_hips(c);
  s.place_legs(c);
  s.add_turning(c);
  s.balance(c);
  s.find_moments(c);
  s.last_hips = c.cycle.hips;
}

RunPose RunModel::pose(std::size_t sample) const {
  const State& s = *state_;
  RunPose pose = s.top.pose[sample];
  const Vec3<double> back{0, 0, -step_length_m(s.task)};
  for (std::size_t k = 0; k < segment_count; ++k) pose.position[k] = pose.position[k] + s.last_hips[sample];
  for (std::size_t k = 0; k < leg_segments; ++k) {
    const LegPose &right = s.leg[sample], &left = s.leg[sample + s.half()];
    pose.position[first_of_leg + k] = right.position[k];
    pose.rotation[first_of_leg + k] = right.rotation[k];
    pose.position[first_of_leg + leg_segments + k] = mirrored(left.position[k]) + back;
    pose.rotation[first_of_leg + leg_segments + k] = mirrored(left.rotation[k]);
  }
  return pose;
}

RunBody run_body(double leg_scale_m) {
  const BodySize<float> size = make_body(typical_body(Sex::man, usual_age_y))->size;
  return {body_parts(size, leg_scale_m / static_cast<double>(size.leg_scale_m)), step_body(StepKind::man, leg_scale_m)};
}

}  // namespace mobil
