#include <mobil/assets/surfaces/limb_forms.h>

#include <algorithm>
#include <array>

#include <mobil/anthropometry.h>
#include <mobil/components/segments.h>

namespace mobil::inline v0_3::form {
namespace {

using namespace geometry;

Vec joint(const Body& body, Segment segment) {
  return to_double(standing_pose(body).position_m[index(segment)]);
}

}  // namespace

LegForm::LegForm(const Body& body, const BodyMeasures& m, bool shod, double hip_part)
    : unit_(form_scale(body).unit),
      hip_(joint(body, Segment::thigh_right)),
      knee_y_(joint(body, Segment::shank_right).y),
      shank_m_(knee_y_ - joint(body, Segment::foot_right).y),
      dome_m_(0.150 * static_cast<double>(body.size.leg_scale_m) / 1.75),
      long_(m.foot_length / 0.2686 / unit_),
      wide_(m.foot_breadth / 0.1001 / unit_),
      profile_(m),
      shod_(shod),
      hip_part_(hip_part) {
  const double high = joint(body, Segment::foot_right).y / (0.039 * 1.75) / unit_;
  // From the heel to the ball: forward from the ankle, half breadth, lowest and highest point, inward; mm.
  constexpr std::array<std::array<double, 5>, 9> sections = {{{-46, 27, 2, 76, 0},
                                                              {-34, 31, 0, 86, 0},
                                                              {8, 35, 0, 98, 0},
                                                              {42, 38, 0, 86, -5},
                                                              {82, 42, 0, 64, -13},
                                                              {116, 46, 0, 47, -21},
                                                              {138, 47, 0, 38, -25},
                                                              {156, 44, 1, 30, -28},
                                                              {168, 36, 3, 24, -30}}};
  for (const auto& [ahead, half, low, top, inward] : sections)
    foot_.push_back({1e-3 * ahead * long_, 1e-3 * half * wide_, 0.5e-3 * (top - low) * high, 1e-3 * inward * wide_,
                     0.5e-3 * (top + low) * high});
}

double LegForm::foot(const Vec& q) const {
  double d = tube(foot_, q.z, q.x, q.y);
  // The heel, a separate ball.
  d = smooth_union(d, ellipsoid(q, {0, 0.030 * long_, -0.030 * long_}, {0.031 * wide_, 0.030 * long_, 0.035 * long_}),
                   0.02);
  if (q.z < 0.08 * long_ || d > 0.08) return d;
  if (shod_)
    return smooth_union(d, ellipsoid(q, {-0.026 * wide_, 0.019, 0.140 * long_}, {0.047 * wide_, 0.021, 0.064 * long_}),
                        0.015);
  // Root and tip of each toe, great toe first: inward, ahead; radius; mm.
  constexpr std::array<std::array<double, 5>, 5> toes = {{{1, 158, -6, 196, 12.5},
                                                          {-18, 160, -26, 198, 8.8},
                                                          {-33, 156, -41, 190, 8.5},
                                                          {-46, 147, -53, 175, 8.4},
                                                          {-57, 134, -62, 155, 8.2}}};
  for (const auto& [root_x, root_z, tip_x, tip_z, radius] : toes) {
    const double r = 1e-3 * radius * wide_;
    d = smooth_union(d,
                     capsule(q, {1e-3 * root_x * wide_, 1.15 * r, 1e-3 * root_z * long_},
                             {1e-3 * tip_x * wide_, 0.95 * r, 1e-3 * tip_z * long_}, r, 0.92 * r),
                     0.007);
  }
  return d;
}

double LegForm::radius(double s, double turn) const {
  constexpr double top_s = 0.12, below_s = 0.45;
  return profile_.radius(s, turn) * (hip_part_ + (1 - hip_part_) * smoothstep(top_s, below_s, s));
}

double LegForm::distance(const Vec& p) const {
  const double x = p.x - hip_.x, z = p.z - hip_.z, from_line = std::hypot(x, z);
  const double turn = std::atan2(x, z);
  const double r = radius(s(p.y), turn);
  double d = from_line - r;
  // A dome over the buttock above, a narrowing into the foot below.
  if (const double top = (p.y - y(0.06)) / dome_m_; top > 1) {
    d = std::hypot(from_line, (top - 1) * dome_m_);
  } else if (top > 0) {
    d = from_line - r * std::sqrt(1 - top * top);
  }
  const double into_foot_m = 0.06 * unit_;
  if (const double below = y(LegProfile::last_s) - p.y; below > 0) {
    // Except for the tendons to the heel and to the instep, which run straight.
    const double behind = smoothstep(0.6, 0.95, -std::cos(turn)), before = smoothstep(0.6, 0.95, std::cos(turn));
    const double narrower = 0.3 - 0.5 * behind - 0.4 * before;
    d = from_line - r * (1 - narrower * std::min(below / into_foot_m, 1.0));
    if (below > into_foot_m) d = std::hypot(std::max(d, 0.0), below - into_foot_m);
  }
  if (p.y > 0.25 * unit_) return d;
  // Ankle bones, the outer one lower and further back.
  const Vec at = (1 / unit_) * p;  // in the foot's unit
  const double ankle = y(2) / unit_, middle = hip_.x / unit_;
  d /= unit_;
  d = smooth_union(d, ellipsoid(at, {middle - 0.031 * wide_, ankle + 0.004, -0.010}, {0.011, 0.017, 0.014}), 0.018);
  d = smooth_union(d, ellipsoid(at, {middle + 0.030 * wide_, ankle + 0.013, 0.004}, {0.011, 0.017, 0.014}), 0.018);
  return unit_ * smooth_union(d, foot({x / unit_, at.y, at.z}), 0.022);
}

ArmForm::ArmForm(const Body& body, const BodyMeasures& own)
    : unit_(form_scale(body).unit), shoulder_(joint(body, Segment::upper_arm_right)) {
  const BodyMeasures m = scaled(own, 1 / unit_);
  wide_ = m.hand_breadth / 0.0867;
  const double elbow = (shoulder_.y - joint(body, Segment::forearm_right).y) / unit_;
  length_m_ = (shoulder_.y - joint(body, Segment::hand_right).y) / unit_;
  hand_m_ = 0.108 * static_cast<double>(body.size.arm_scale_m) / unit_;
  const double fore = length_m_ - elbow, biceps = m.biceps_girth / tau, forearm = m.forearm_girth / tau,
               wrist = m.wrist_girth / tau;
  const double deltoid = 1.10 * biceps;
  // Towards the trunk it is as wide as it is thick, outward it extends to the breadth of the shoulders.
  const double inward = deltoid - 0.006, outward = 0.5 * m.shoulder_breadth + shoulder_.x / unit_ - 0.004;
  const double across = 0.5 * (inward + outward), middle = 0.5 * (inward - outward);
  const double slope = std::clamp(across / 0.07, 1.0, 1.18);    // broad shoulders fall off more gently
  const double beyond = std::max(outward - 1.4 * biceps, 0.0);  // the upper arm leads to broad shoulders
  const double top = 1 / (slope * slope * slope);
  ring_ = {{-0.022, top * 0.46 * across, top * 0.52 * deltoid, 0.006 + 0.5 * middle, 0},
           {-0.002, top * 0.84 * across, top * 0.90 * deltoid, 0.006 + middle, 0},
           {0.032 * slope * slope, 1.00 * across, 1.07 * deltoid, middle, 0},
           {0.080 * slope * slope, 0.98 * across, 1.03 * deltoid, middle, 0.001},
           {0.40 * elbow, 0.98 * biceps + 0.4 * beyond, 1.09 * biceps + 0.2 * beyond, -0.001 - 1.1 * beyond, 0.003},
           {0.62 * elbow, 0.91 * biceps + 0.2 * beyond, 1.04 * biceps + 0.1 * beyond, -0.7 * beyond, 0.005},
           {elbow - 0.045, 0.83 * biceps, 0.84 * biceps, -0.1 * beyond, 0.002},
           {elbow, 0.88 * biceps, 0.76 * biceps, 0, -0.003},
           {elbow + 0.050, 1.08 * forearm, 0.95 * forearm, -0.003, 0},
           {elbow + 0.100, 1.00 * forearm, 0.93 * forearm, -0.002, 0},
           {elbow + 0.70 * fore, 1.27 * wrist, 1.12 * wrist, 0, 0},
           {elbow + fore - 0.025, 1.11 * wrist, 0.88 * wrist, 0, 0},
           {elbow + fore + 0.010, 1.08 * wrist, 0.80 * wrist, 0, 0.001}};
}

/// Returns the distance to the hand. q is from the wrist, to the fingertips (y), to the thumb (x), out of the palm (z).
double ArmForm::hand(const Vec& q) const {
  const double l = hand_m_ / 0.189, w = wide_;
  const std::array<Ring, 6> palm = {{{-0.010 * l, 0.027 * w, 0.019 * w, 0.000, 0.000},
                                     {0.020 * l, 0.030 * w, 0.0165 * w, 0.002 * w, 0.001},
                                     {0.050 * l, 0.038 * w, 0.0155 * w, 0.002 * w, 0.001},
                                     {0.076 * l, 0.0415 * w, 0.0135 * w, -0.001 * w, 0.000},
                                     {0.092 * l, 0.039 * w, 0.0115 * w, -0.001 * w, 0.000},
                                     {0.102 * l, 0.030 * w, 0.0085 * w, -0.001 * w, 0.001}}};
  double d = tube(palm, q.y, q.x, q.z);
  // Balls of the thumb and of the little finger.
  d = smooth_union(d, ellipsoid(q, {0.022 * w, 0.045 * l, 0.010}, {0.017 * w, 0.031 * l, 0.013}), 0.012);
  d = smooth_union(d, ellipsoid(q, {-0.024 * w, 0.042 * l, 0.007}, {0.013 * w, 0.032 * l, 0.011}), 0.012);
  struct Finger {
    double root_x, root_y, length, fan, radius;
  };
  constexpr std::array<Finger, 4> fingers = {{{0.0240, 0.0945, 0.0850, 0.082, 0.0086},
                                              {0.0070, 0.0945, 0.0950, 0.010, 0.0088},
                                              {-0.0090, 0.0898, 0.0880, -0.045, 0.0084},
                                              {-0.0240, 0.0840, 0.0700, -0.128, 0.0076}}};
  constexpr std::array<double, 3> phalanx = {0.46, 0.30, 0.24}, bend = {0.03, 0.10, 0.18}, thick = {1.0, 0.93, 0.85};
  for (const Finger& finger : fingers) {
    Vec at{finger.root_x * w, (finger.root_y - 0.012) * l, 0};
    double r = finger.radius * w;
    for (std::size_t k = 0; k < phalanx.size(); ++k) {
      const double long_m = phalanx[k] * (finger.length + (k == 0 ? 0.012 : 0)) * l;
      const Vec next = at + long_m * Vec{std::sin(finger.fan) * std::cos(bend[k]),
                                         std::cos(finger.fan) * std::cos(bend[k]), std::sin(bend[k])};
      const double narrower = finger.radius * w * thick[k] * 0.93;
      d = smooth_union(d, capsule(q, at, next, r, narrower), k == 0 ? 0.006 : 0.002);
      at = next;
      r = narrower;
    }
  }
  const std::array<Vec, 4> thumb = {{{0.020 * w, 0.018 * l, 0.006},
                                     {0.043 * w, 0.058 * l, 0.018},
                                     {0.053 * w, 0.086 * l, 0.025},
                                     {0.056 * w, 0.108 * l, 0.031}}};
  constexpr std::array<double, 4> round = {0.0150, 0.0112, 0.0098, 0.0082};
  double t = capsule(q, thumb[0], thumb[1], round[0] * w, round[1] * w);
  for (std::size_t k = 1; k + 1 < thumb.size(); ++k)
    t = smooth_union(t, capsule(q, thumb[k], thumb[k + 1], round[k] * w, round[k + 1] * w), 0.003);
  return smooth_union(d, t, 0.012);
}

double ArmForm::distance(const Vec& p) const {
  const Vec from = (1 / unit_) * (p - shoulder_);
  const double along = -from.y, d = tube(ring_, along, from.x, from.z);
  if (along < length_m_ - 0.06) return unit_ * d;
  return unit_ * smooth_union(d, hand({-from.x, along - length_m_, from.z}), 0.015);
}

}  // namespace mobil::inline v0_3::form
