#include "systems/gait/step_leg.h"

#include <algorithm>
#include <cmath>

#include "assets/anthropometry.h"
#include "systems/gait/step_math.h"

namespace mobil::step {
namespace {

/// The smaller of a and b, rounded where they are nearer than `within`.
double soft_min(double a, double b, double within) {
  const double h = std::fmin(std::fmax(0.5 + 0.5 * (b - a) / within, 0.0), 1.0);
  return b + (a - b) * h - within * h * (1.0 - h);
}

double hermite(double u, double h, double a, double a_rate, double b, double b_rate) {
  const double v = 1.0 - u;
  return v * v * ((1.0 + 2.0 * u) * a + u * h * a_rate) + u * u * ((1.0 + 2.0 * v) * b - v * h * b_rate);
}

/// How high the hip passes mid-stance. Legs of one stiffness sink under the weight that a body of this height carries
/// beyond 22 kg/m²; they sink less and less, and a light body's cannot become longer than straight.
double mid_height(const Body& body, const GaitStyle& style, double stiffness) {
  const double height = body.request.height_m, stand = body.hip_height_m;
  const double excess = (body.request.mass_kg - 22.0 * height * height) * gravity / (stiffness * stand);
  constexpr double most = 0.018;
  const double sag = most * excess / std::sqrt(most * most + excess * excess);
  return stand * (style.mid_stance_height - (excess > 0.0 ? sag : 0.1 * sag));
}

/// Highest place of the middle of the hips at heel strike from which the leading leg reaches the ground.
double reachable_height(const Leg& leg) {
  const Foot foot = leg.planted(leg.strike_pitch);
  const Point offset = leg.hip_offset(0.0);
  const double behind = -0.5 * leg.step_length + leg.pivot_forward + offset.forward - foot.ankle.forward;
  const double aside = offset.out - foot.ankle.out;
  const double reach = leg.reach(leg.strike_knee);
  return foot.ankle.up + std::sqrt(std::fmax(reach * reach - behind * behind - aside * aside, 0.0)) - offset.up;
}

}  // namespace

Leg make_leg(const Body& body, const Gait& gait) {
  namespace f = fraction;
  const double height = body.request.height_m;
  const GaitStyle& s = gait.style;
  Leg leg{};
  leg.thigh = f::thigh * height;
  leg.shank = f::shank * height;
  leg.heel_back = f::heel_back * height;
  leg.ball_forward = f::ball_forward * height;
  leg.ankle_height = f::ankle_height * height;
  leg.toe_joint_height = f::toe_joint_height * height;
  leg.toes_length = f::toes_length * height;
  leg.hip_half_spacing = f::hip_half_spacing * height;
  leg.step_length = gait.step_length_m;
  leg.duration = leg.step_length / gait.speed_m_s;
  leg.double_support = 2.0 * leg.duration * gait.double_support_cycle;
  leg.flat = 2.0 * leg.duration * s.foot_flat_cycle;
  leg.toe_off = leg.duration + leg.double_support;
  leg.half_width = 0.5 * s.step_width_h * height;
  leg.pivot_forward = s.foot_pivot_h * height;
  // Amplitudes grow with the step, to 1 at a natural step of 0.43 body heights.
  const double stride = std::fmin(leg.step_length / (0.43 * height), 1.25);
  leg.toe_out = s.toe_out_deg * degree;
  leg.strike_pitch = s.strike_pitch_deg * degree * stride;
  leg.strike_knee = s.strike_knee_deg * degree;
  leg.stance_knee = s.stance_knee_deg * degree;
  leg.toe_off_knee = s.toe_off_knee_deg * degree;
  leg.release = 2.0 * leg.duration * s.knee_release_cycle;
  leg.rotation = s.pelvis_rotation_deg * degree * stride;
  leg.list = s.pelvis_list_deg * degree * stride;
  leg.shift = s.pelvis_shift_h * height;
  return leg;
}

double Leg::reach(double knee_flexion) const {
  return std::sqrt(thigh * thigh + shank * shank + 2.0 * thigh * shank * sin_cos(knee_flexion).cosine);
}

double Leg::knee(double reach_m) const {
  return arc_cosine((reach_m * reach_m - thigh * thigh - shank * shank) / (2.0 * thigh * shank));
}

HipSample Leg::middle(double t) const {
  const double turn = std::floor(t / duration);
  const double place = (t / duration - turn) * static_cast<double>(hip_path.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(place), hip_path.size() - 2);
  const double u = place - static_cast<double>(i), h = duration / static_cast<double>(hip_path.size() - 1);
  const HipSample &a = hip_path[i], &b = hip_path[i + 1];
  auto mix = [u](double from, double to) { return from + u * (to - from); };
  return {turn * step_length + pivot_forward +
              hermite(u, h, a.forward_m, a.forward_velocity, b.forward_m, b.forward_velocity),
          hermite(u, h, a.up_m, a.up_velocity, b.up_m, b.up_velocity),
          mix(a.forward_velocity, b.forward_velocity),
          mix(a.up_velocity, b.up_velocity),
          mix(a.forward_acceleration, b.forward_acceleration),
          mix(a.up_acceleration, b.up_acceleration),
          hermite(u, h, a.trunk_rad, a.trunk_rate, b.trunk_rad, b.trunk_rate),
          mix(a.trunk_rate, b.trunk_rate)};
}

Point Leg::hip_offset(double t) const {
  namespace p = pelvis_phase;
  const double at = t / duration;
  const SinCos turned = sin_cos(rotation * sin_cos(pi * (at - p::rotation)).cosine);
  const SinCos listed = sin_cos(list * (p::list_first * sin_cos(pi * (at - p::list_first_phase)).cosine +
                                        p::list_third * sin_cos(3.0 * pi * (at - p::list_third_phase)).cosine));
  const double toward = shift * sin_cos(pi * (t - 0.5 * double_support) / duration).sine;
  return {hip_half_spacing * listed.cosine * turned.cosine + toward, hip_half_spacing * listed.sine,
          hip_half_spacing * listed.cosine * turned.sine};
}

Point Leg::hip(double t) const {
  const HipSample m = middle(t);
  const Point o = hip_offset(t);
  return {o.out, m.up_m + o.up, m.forward_m + o.forward};
}

std::array<double, 2> Leg::hip_acceleration(double t) const {
  const double h = 1e-3 * duration;
  const Point a = hip_offset(t - h), b = hip_offset(t), c = hip_offset(t + h);
  const HipSample m = middle(t);
  return {m.forward_acceleration + (a.forward - 2.0 * b.forward + c.forward) / (h * h),
          m.up_acceleration + (a.up - 2.0 * b.up + c.up) / (h * h)};
}

Foot Leg::planted(double pitch) const {
  const SinCos b = sin_cos(pitch), o = sin_cos(toe_out);
  double along, up;
  if (pitch >= 0.0) {
    along = heel_back * (b.cosine - 1.0) - ankle_height * b.sine;
    up = heel_back * b.sine + ankle_height * b.cosine;
  } else {
    const double over = ankle_height - toe_joint_height;
    along = ball_forward * (1.0 - b.cosine) - over * b.sine;
    up = toe_joint_height - ball_forward * b.sine + over * b.cosine;
  }
  return {pitch, {half_width + o.sine * along, up, o.cosine * along}};
}

Foot Leg::stance(double t) const {
  if (t < flat) {
    const double u = t / flat;
    return planted(strike_pitch * (1.0 - u) * (1.0 - u) * (1.0 + 0.7 * u));
  }
  // The heel rises as much as the hip's distance asks for, given how far the knee is to be bent.
  const Point h = hip(t);
  const Point flat_ankle = planted(0.0).ankle;
  const double flat_reach =
      std::sqrt((h.out - flat_ankle.out) * (h.out - flat_ankle.out) + (h.up - flat_ankle.up) * (h.up - flat_ankle.up) +
                (h.forward - flat_ankle.forward) * (h.forward - flat_ankle.forward));
  const double u = std::fmax((t - release) / (toe_off - release), 0.0);
  const double bent = stance_knee + (toe_off_knee - stance_knee) * u * u;
  double wanted = soft_min(flat_reach, reach(bent), 0.008 * (thigh + shank));
  if (wanted >= flat_reach) return planted(0.0);
  // Circle about the toe joint, in the foot's vertical plane, against the circle about the hip.
  const SinCos o = sin_cos(toe_out);
  const double dx = h.out - half_width;
  const double along = h.forward * o.cosine + dx * o.sine - ball_forward;
  const double aside = dx * o.cosine - h.forward * o.sine;
  const double up = h.up - toe_joint_height;
  const double over = ankle_height - toe_joint_height;
  const double radius = std::sqrt(ball_forward * ball_forward + over * over);
  const double distance = std::sqrt(along * along + up * up);
  const double cosine =
      (radius * radius + distance * distance - (wanted * wanted - aside * aside)) / (2.0 * radius * distance);
  const double pitch = arc_tangent(up, along) + arc_cosine(std::fmin(cosine, 1.0)) - arc_tangent(over, -ball_forward);
  return planted(std::fmin(pitch, 0.0));
}

LegAngles Leg::angles(const Point& hip_at, const Point& ankle) const {
  const double dx = ankle.out - hip_at.out, dy = hip_at.up - ankle.up, dz = ankle.forward - hip_at.forward;
  const double distance = std::sqrt(dx * dx + dy * dy + dz * dz);
  const double direction = arc_tangent(dz, std::sqrt(dx * dx + dy * dy));
  auto corner = [&](double near, double far) {
    return arc_cosine(std::fmin((near * near + distance * distance - far * far) / (2.0 * near * distance), 1.0));
  };
  return {direction + corner(thigh, shank), direction - corner(shank, thigh), distance, direction};
}

SupportRequest support_request(const Body& body, const Gait& gait, const Leg& leg) {
  const GaitStyle& style = gait.style;
  const double mass = body.request.mass_kg, height = body.request.height_m;
  // Winter's fractions: leg 0.161, head-arms-trunk 0.678 of the mass; the trunk's length is 0.288 of the height.
  const double trunk = 0.288 * height, leg_gyration = 0.326 * (leg.thigh + leg.shank);
  SupportRequest r{};
  r.model = {0.161 * mass, 0.553,         0.161 * mass * leg_gyration * leg_gyration,  0.161 * mass,
             0.678 * mass, 0.626 * trunk, 0.678 * mass * 0.496 * 0.496 * trunk * trunk};
  const double stiffness = style.leg_stiffness_n_per_m * height / 1.8;
  r.duration_s = leg.duration;
  r.step_length_m = leg.step_length;
  r.mid_height_m = mid_height(body, style, stiffness);
  const double stiff =
      r.mid_height_m -
      std::sqrt(std::fmax(r.mid_height_m * r.mid_height_m - 0.25 * leg.step_length * leg.step_length, 0.0));
  r.strike_height_m = std::fmin(r.mid_height_m - style.hip_fall * stiff, reachable_height(leg));
  r.stiffness_n_per_m = stiffness;
  r.damping_n_s_per_m = 2.0 * style.leg_damping * std::sqrt(stiffness * mass);
  r.roll_over = style.roll_over;
  r.trunk_lean_rad = style.trunk_lean_deg * degree;
  const double topple = r.model.trunk_mass * gravity * r.model.trunk_centre;
  const double inertia = r.model.trunk_inertia + r.model.trunk_mass * r.model.trunk_centre * r.model.trunk_centre;
  r.trunk_stiffness_nm = style.trunk_stiffness * topple;
  r.trunk_damping_nm_s = std::sqrt(r.trunk_stiffness_nm * inertia);
  return r;
}

}  // namespace mobil::step
