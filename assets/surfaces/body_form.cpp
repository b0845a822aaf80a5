#include <mobil/assets/surfaces/body_form.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <vector>

namespace mobil::inline v0_3::form {
namespace {

// Widths of the blends between the trunk and head, legs and arms.
constexpr double head_blend_m = 0.030, leg_blend_m = 0.065, arm_blend_m = 0.035;
constexpr double far_m = 1;           // distance of parts that are nowhere near
constexpr double lowest_head = 1.44;  // the head starts above, m of a body of 1.75 m
// Middles of the trunk and of the neck, forward of the hips, m of a body of 1.75 m. Tapes are laid round them.
constexpr double middle_m = -0.02, neck_middle_m = -0.05;

}  // namespace

using namespace geometry;

BodyForm::BodyForm(const Body& body, const TrunkFit& fit, bool shod)
    : scale_(form_scale(body)),
      sex_(body.request.sex),
      soft_(sex_ == Sex::woman ? 1 : scale_.young),
      trunk_(body, body_measures(body.request), fit),
      leg_(body, body_measures(body.request), shod, fit.thighs),
      arm_(body, body_measures(body.request)) {}

Vec BodyForm::turned(const Vec& p, const Vec& about, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const Vec d = p - about;
  return about + Vec{c * d.x - s * d.y, s * d.x + c * d.y, d.z};
}

BodyForm::Parts BodyForm::parts(const Vec& p) const {
  const Vec q{-std::abs(p.x), p.y, p.z};
  Parts parts{far_m, far_m, far_m, far_m};
  if (p.y > scale_.height(0.78) && q.x > -trunk_.reach()) parts.trunk = trunk_.distance(p);
  parts.head = head(p);
  if (p.y < scale_.height(1.12)) parts.leg = leg_.distance(in_leg(q));
  if (q.x < -0.08 * scale_.size && p.y > scale_.height(0.70)) parts.arm = arm_.distance(in_arm(q));
  return parts;
}

double BodyForm::head(const Vec& p) const {
  if (p.y <= scale_.height(lowest_head)) return far_m;
  return std::min(scale_.head, scale_.head_wide) * head_distance(scale_.in_head(p), soft_);
}

double BodyForm::united(const Parts& part) const {
  double d = smooth_union(part.trunk, part.head, scale_.unit * head_blend_m);
  d = smooth_union(d, part.leg, scale_.unit * leg_blend_m);
  return smooth_union(d, part.arm, scale_.unit * arm_blend_m);
}

double BodyForm::rest_distance(const Vec& p) const {
  return smooth_union(armless_distance(p), arm_.distance({-std::abs(p.x), p.y, p.z}), scale_.unit * arm_blend_m);
}

double BodyForm::armless_distance(const Vec& p) const {
  Parts part{trunk_.distance(p), leg_.distance({-std::abs(p.x), p.y, p.z}), far_m, far_m};
  part.head = head(p);
  return united(part);
}

double BodyForm::armless_radius(const Vec& from, const Vec& direction, double longest_m) const {
  constexpr int halvings = 14;
  double within = 0, beyond = longest_m;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (within + beyond);
    (armless_distance(from + middle * direction) < 0 ? within : beyond) = middle;
  }
  return within;
}

double BodyForm::girth(double y) const {
  constexpr int rays = 60;
  constexpr double longest_m = 0.6;
  const Vec from{0, y, scale_.size * (y > scale_.height(1.46) ? neck_middle_m : middle_m)};
  // From the back round the right side to the front. A tape spans hollows, so points inside it are left out.
  std::vector<std::array<double, 2>> tape;
  for (int i = 0; i <= rays; ++i) {
    const double angle = std::numbers::pi * i / rays, out = std::sin(angle), ahead = -std::cos(angle);
    const double radius = armless_radius(from, {out, 0, ahead}, longest_m);
    const std::array<double, 2> p = {radius * out, radius * ahead};
    while (tape.size() > 1) {
      const auto &a = tape[tape.size() - 2], &b = tape.back();
      if ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0) break;
      tape.pop_back();
    }
    tape.push_back(p);
  }
  double half = 0;
  for (std::size_t i = 1; i < tape.size(); ++i)
    half += std::hypot(tape[i][0] - tape[i - 1][0], tape[i][1] - tape[i - 1][1]);
  return 2 * half;
}

Vec BodyForm::slope(const Vec& p) const {
  constexpr double e = 0.001;
  const auto along = [&](const Vec& step) { return (distance(p + step) - distance(p - step)) / (2 * e); };
  return {along({e, 0, 0}), along({0, e, 0}), along({0, 0, e})};
}

}  // namespace mobil::inline v0_3::form
