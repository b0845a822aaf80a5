#include <mobil/assets/surfaces/form_scale.h>

#include <algorithm>
#include <cmath>

#include <mobil/anthropometry.h>
#include <mobil/assets/body/body_measures.h>
#include "assets/body/body_scales.h"
#include "assets/body/growth.h"

namespace mobil::inline v0_3::form {
namespace {

constexpr double man_m = 1.75, hip = man_m * fraction::hip_height, c7 = man_m * column_height(Segment::C7);

/// Returns how far the joint of a segment is ahead of the hips in that man, m.
double joint_z(Segment of) {
  double z = 0;
  for (std::size_t s = index(of); s != index(Segment::pelvis); s = index(segment_parent[s]))
    z += man_m * unit_body.joint_offset[s].z;
  return z;
}

/// Returns the height in an adult's head of a point in a child's. The lower third of the face is 0.85 times as high
/// and the eyes are lower, both our assumption.
double adult_face(double y) {
  constexpr double chin = 1.533, nose = 1.597, eyes = 1.6335, lower = 0.85, down = (1 - lower) * (nose - chin);
  if (y < chin) return y;
  if (y < nose - down) return chin + (y - chin) / lower;
  if (y < eyes - down) return y + down;
  return man_m - (man_m - y) * (man_m - eyes) / (man_m - eyes + down);
}

}  // namespace

double FormScale::height(double y) const {
  if (y <= hip) return leg * y;
  if (y <= c7) return trunk * y + (leg - trunk) * hip;
  return head * y + ((leg - trunk) * hip + (trunk - head) * c7);
}

double FormScale::usual_height(double y) const {
  if (y <= height(hip)) return (1 / leg) * y;
  if (y <= height(c7)) return (1 / trunk) * (y - (leg - trunk) * hip);
  return (1 / head) * (y - ((leg - trunk) * hip + (trunk - head) * c7));
}

Vec FormScale::in_head(const Vec& p) const {
  const double y = usual_height(p.y);
  return {(1 / head_wide) * p.x, std::lerp(y, adult_face(y), young), (1 / head_wide) * (p.z - head_z_m)};
}

double FormScale::face_height(double y) const {
  constexpr int rounds = 4;
  double own = y;
  for (int i = 0; i < rounds; ++i) own += y - std::lerp(own, adult_face(own), young);
  return own;
}

Vec FormScale::usual(const Vec& p) const {
  constexpr double from = 1.49, to = 1.53;  // neck
  const double y = usual_height(p.y), part = smoothstep(from, to, y);
  const Vec below{(1 / size) * p.x, y, (1 / size) * p.z}, above = in_head(p);
  const auto mix = [part](double a, double b) { return std::lerp(a, b, part); };
  return {mix(below.x, above.x), mix(below.y, above.y), mix(below.z, above.z)};
}

FormScale form_scale(const Body& body) {
  const auto scales = group_scales(body.size);
  const auto of = [&](LengthGroup g) { return static_cast<double>(scales[static_cast<std::size_t>(g)]) / man_m; };
  const double size = of(LengthGroup::height), head = of(LengthGroup::head), age = body.request.age_y;
  FormScale s{.size = size,
              .leg = of(LengthGroup::leg),
              .trunk = of(LengthGroup::trunk),
              .head = head,
              .head_wide = size,
              .arm = of(LengthGroup::arm),
              .unit = std::lerp(1.0, size, child_part(age)),
              .young = std::clamp((16 - age) / 10, 0.0, 1.0),
              .womanly = body.request.sex == Sex::woman ? std::clamp((age - 10) / 6, 0.0, 1.0) : 0,
              .head_z_m = 0};
  static const BodyMeasures usual = body_measures({});
  const BodyMeasures own = body_measures(body.request);
  s.head_wide = 0.5 * (own.head_length / usual.head_length + own.head_breadth / usual.head_breadth);
  s.head_z_m = (size - s.head_wide) * joint_z(Segment::C7) +
               (head - s.head_wide) * (joint_z(Segment::head) - joint_z(Segment::C7));
  return s;
}

}  // namespace mobil::inline v0_3::form
