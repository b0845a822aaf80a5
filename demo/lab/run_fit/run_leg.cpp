#include "demo/lab/run_fit/run_leg.h"

#include <algorithm>
#include <cmath>

namespace mobil {
namespace {

using namespace geometry;
using enum Segment;

constexpr double cap_part = static_cast<double>(kneecap_part);

Vec3<double> in_world(const LegPlane& leg, double ahead, double down) {
  return {leg.side_x * down, leg.side_y * down, ahead};
}

/// Place of the kneecap from the knee.
struct Kneecap {
  double ahead, down;
};
Kneecap kneecap(const RunBody& body, const LegPlane& leg) {
  const auto& offset = body.parts.joint_offset;
  const Vec3<double> from_knee = offset[index(patella_right)] - offset[index(shank_right)];
  const double turn = cap_part * (leg.thigh_angle - leg.shank_angle) - leg.thigh_angle;
  const double s = std::sin(turn), c = std::cos(turn);
  return {s * from_knee.y + c * from_knee.z, s * from_knee.z - c * from_knee.y};
}

}  // namespace

LegPlane leg_plane(const StepBody& b, const Vec3<double>& hip, const Vec3<double>& ankle) {
  const Vec3<double> d = ankle - hip;
  const double across = std::hypot(d.x, d.y), distance = std::hypot(d.z, across), full = b.thigh + b.shank;
  LegPlane leg{};
  leg.side_x = d.x / across;
  leg.side_y = d.y / across;
  leg.slack = full - distance;
  // A leg out of reach is pulled in smoothly, so that a fit finds its way back.
  constexpr double least = 2e-4;
  const double bent = leg.slack > least ? leg.slack : least * std::exp(std::min(leg.slack - least, 0.0) / least);
  const double used = full - bent, near = (b.thigh * b.thigh - b.shank * b.shank + used * used) / (2 * used);
  const double bulge = std::sqrt(std::max(b.thigh * b.thigh - near * near, 1e-12));
  const double ahead = d.z / distance, down = across / distance;
  leg.knee_ahead = near * ahead + bulge * down;
  leg.knee_down = near * down - bulge * ahead;
  leg.ankle_ahead = used * ahead;
  leg.ankle_down = used * down;
  const double direction = std::atan2(d.z, across);
  leg.thigh_angle = direction + std::atan2(bulge, near);
  leg.shank_angle = direction - std::atan2(bulge, used - near);
  return leg;
}

LegPose leg_pose(const RunBody& body, const LegPlane& leg, const Vec3<double>& hip, double toe_out, double pitch,
                 double toes) {
  const Rotation side = turn_about_z(std::atan2(leg.side_x, -leg.side_y));
  const double flexion = leg.thigh_angle - leg.shank_angle;
  const Kneecap cap = kneecap(body, leg);
  const Rotation outward = turn_about_y(-toe_out);
  LegPose pose;
  pose.position = {hip, hip + in_world(leg, leg.knee_ahead + cap.ahead, leg.knee_down + cap.down),
                   hip + in_world(leg, leg.knee_ahead, leg.knee_down),
                   hip + in_world(leg, leg.ankle_ahead, leg.ankle_down)};
  pose.rotation = {product(side, turn_about_x(-leg.thigh_angle)),
                   product(side, turn_about_x(cap_part * flexion - leg.thigh_angle)),
                   product(side, turn_about_x(-leg.shank_angle)), product(outward, turn_about_x(-pitch)),
                   product(outward, turn_about_x(-(pitch + toes)))};
  pose.position[4] = pose.position[3] + rotated(pose.rotation[3], body.parts.joint_offset[index(toes_right)]);
  return pose;
}

FootMoment foot_moment(const RunBody& body, double toe_out, double pitch, double toes) {
  const Rotation outward = turn_about_y(-toe_out), foot = product(outward, turn_about_x(-pitch)),
                 tips = product(outward, turn_about_x(-(pitch + toes)));
  const BodyParts& p = body.parts;
  constexpr std::size_t f = index(foot_right), t = index(toes_right);
  const Vec3<double> joint = rotated(foot, p.joint_offset[t]);
  return {p.mass[f] + p.mass[t],
          p.mass[f] * rotated(foot, p.centre_of_mass[f]) + p.mass[t] * (joint + rotated(tips, p.centre_of_mass[t]))};
}

LegMoment leg_moment(const RunBody& body, const LegPlane& leg, const Vec3<double>& hip, const FootMoment& foot) {
  const BodyParts& p = body.parts;
  const StepBody& b = body.size;
  constexpr std::size_t thigh = index(thigh_right), cap = index(patella_right), shank = index(shank_right);
  const double on_thigh = -p.centre_of_mass[thigh].y / b.thigh, on_shank = -p.centre_of_mass[shank].y / b.shank;
  const double at_knee = p.mass[thigh] * on_thigh + p.mass[cap] + p.mass[shank] * (1 - on_shank);
  const double at_ankle = p.mass[shank] * on_shank + foot.mass;
  const double total = p.mass[thigh] + p.mass[cap] + p.mass[shank] + foot.mass;
  const Kneecap offset = kneecap(body, leg);
  LegMoment m;
  m.sum = total * hip +
          in_world(leg, at_knee * leg.knee_ahead + p.mass[cap] * offset.ahead + at_ankle * leg.ankle_ahead,
                   at_knee * leg.knee_down + p.mass[cap] * offset.down + at_ankle * leg.ankle_down) +
          foot.sum;

  // Derivatives of the knee by the hip, with the ankle held. The plane turns about the line from hip to ankle.
  const double distance = std::hypot(leg.ankle_ahead, leg.ankle_down);
  const double ea = leg.ankle_ahead / distance, ed = leg.ankle_down / distance, qa = ed, qd = -ea;
  const double near = leg.knee_ahead * ea + leg.knee_down * ed, bulge = leg.knee_ahead * qa + leg.knee_down * qd;
  const double near_rate = 0.5 - (b.thigh * b.thigh - b.shank * b.shank) / (2 * distance * distance);
  const double bulge_rate = -near * near_rate / bulge;
  const auto in_plane = [&](double row_e, double row_q, double column_e, double column_q) {
    return near_rate * row_e * column_e + near / distance * row_q * column_q + bulge_rate * row_q * column_e -
           bulge / distance * row_e * column_q;
  };
  const double aa = in_plane(ea, qa, ea, qa), ad = in_plane(ea, qa, ed, qd), da = in_plane(ed, qd, ea, qa),
               dd = in_plane(ed, qd, ed, qd), turn = leg.knee_down / leg.ankle_down;
  const double x = leg.side_x, y = leg.side_y, other_share = total - foot.mass - p.mass[shank] * on_shank - at_knee;
  const LegDerivatives knee = {{{dd * x * x + turn * y * y, (dd - turn) * x * y, da * x},
                                {(dd - turn) * x * y, dd * y * y + turn * x * x, da * y},
                                {ad * x, ad * y, aa}}};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) m.by_hip[r][c] = (r == c ? other_share + at_knee : 0) - at_knee * knee[r][c];
  }
  return m;
}

}  // namespace mobil
