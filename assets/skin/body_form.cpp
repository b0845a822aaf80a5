#include "assets/skin/body_form.h"

namespace mobil::form {

using namespace geometry;

BodyForm::BodyForm(const Body& body, double fuller_trunk, bool shod)
    : size_(static_cast<double>(body.request.height_m) / 1.75),
      sex_(body.request.sex),
      trunk_(body, body_measures(body.request), fuller_trunk),
      leg_(body, body_measures(body.request), shod),
      arm_(body, body_measures(body.request)) {}

Vec BodyForm::turned(const Vec& p, const Vec& about, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const Vec d = p - about;
  return about + Vec{c * d.x - s * d.y, s * d.x + c * d.y, d.z};
}

BodyForm::Parts BodyForm::parts(const Vec& p) const {
  const Vec q{-std::abs(p.x), p.y, p.z};
  constexpr double far = 1;  // parts that are nowhere near
  Parts parts{far, far, far, far};
  if (p.y > 0.78 * size_ && q.x > -trunk_.reach()) parts.trunk = trunk_.distance(p);
  if (p.y > 1.44 * size_) parts.head = size_ * head_distance((1 / size_) * p, sex_);
  if (p.y < 1.12 * size_) parts.leg = leg_.distance(in_leg(q));
  if (q.x < -0.08 * size_ && p.y > 0.70 * size_) parts.arm = arm_.distance(in_arm(q));
  return parts;
}

double BodyForm::united(const Parts& part) {
  double d = smooth_union(part.trunk, part.head, 0.030);
  d = smooth_union(d, part.leg, 0.065);
  return smooth_union(d, part.arm, 0.035);
}

double BodyForm::rest_distance(const Vec& p) const {
  const Vec right{-std::abs(p.x), p.y, p.z};
  Parts part{trunk_.distance(p), leg_.distance(right), arm_.distance(right), 1};
  if (p.y > 1.44 * size_) part.head = size_ * head_distance((1 / size_) * p, sex_);
  return united(part);
}

Vec BodyForm::slope(const Vec& p) const {
  constexpr double e = 0.001;
  const auto along = [&](const Vec& step) { return (distance(p + step) - distance(p - step)) / (2 * e); };
  return {along({e, 0, 0}), along({0, e, 0}), along({0, 0, e})};
}

}  // namespace mobil::form
