#include <mobil/assets/surfaces/trunk_form.h>

#include <algorithm>
#include <array>
#include <numbers>

#include <mobil/anthropometry.h>
#include <mobil/components/segments.h>

namespace mobil::inline v0_3::form {
namespace {

using namespace geometry;

/// Returns the length round an oval.
double girth(double half, double deep, double exponent) {
  constexpr int steps = 64;
  double sum = 0, x = half, z = 0;
  for (int i = 1; i <= steps; ++i) {
    const double angle = std::numbers::pi / 2 * i / steps;
    const double nx = half * std::pow(std::cos(angle) + 1e-9, 2 / exponent);
    const double nz = deep * std::pow(std::sin(angle) + 1e-9, 2 / exponent);
    sum += std::hypot(nx - x, nz - z);
    x = nx;
    z = nz;
  }
  return 4 * sum;
}

/// Returns the exponent of an oval of that length, at most 3.2, which still looks like a body.
double exponent_of(double half, double deep, double length_m) {
  double low = 1.6, high = 3.2;
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (low + high);
    (girth(half, deep, middle) < length_m ? low : high) = middle;
  }
  return low;
}

}  // namespace

TrunkForm::TrunkForm(const Body& body, const BodyMeasures& own, const TrunkFit& fit)
    : scale_(form_scale(body)),
      size_(scale_.size / scale_.unit),
      shoulder_((1 / scale_.unit) * to_double(standing_pose(body).position_m[index(Segment::upper_arm_right)])) {
  const BodyMeasures m = scaled(own, 1 / scale_.unit);
  const auto womanly = [this](double man, double woman) { return std::lerp(man, woman, scale_.womanly); };
  const double hip = 0.5 * fit.hips * m.hip_breadth, waist = 0.5 * fit.waist * m.waist_breadth,
               chest = 0.5 * fit.chest * m.chest_breadth;
  const double wide = 1.08 * chest, neck = fit.neck * m.neck_girth / (2 * std::numbers::pi);
  // The chest below the shoulders is as broad as they are.
  const double broad = 0.5 * womanly(0.572, 0.598) * m.shoulder_breadth;
  // Women's chests are measured over the bust: below it, 0.92 of the girth and a smaller depth are used.
  const double bust = womanly(0, 0.16) * m.chest_depth;
  // Depth beyond that of a man of 1.75 m and 75 kg.
  const double buttock = 0.5 * (fit.hips * m.buttock_depth - 0.2267), belly = fit.waist * m.waist_depth - 0.2119,
               breast = fit.chest * (m.chest_depth - bust) - 0.2346;
  // Relative to the breadth at the navel; a belly makes the waist less pronounced.
  const double natural_waist = womanly(0.985, 0.93) + 0.04 * std::clamp(belly / 0.07, 0.0, 1.0);
  const double at_waist = exponent_of(waist, 0.5 * fit.waist * m.waist_depth, fit.waist * m.waist_girth);
  const double at_chest =
      exponent_of(wide, 0.5 * fit.chest * (m.chest_depth - bust), fit.chest * m.chest_girth * womanly(1, 0.92));
  // The back is behind the spines of the vertebrae.
  section_ = {
      {0.835, 0.045, -0.050, 0.020, 2},
      {0.865, 0.100, -0.090, 0.065, 2.2},
      {0.900, 0.87 * hip, -0.112 - buttock, 0.088 + buttock, 2.3},
      {0.950, 0.925 * hip, -0.118 - buttock, 0.098 + 0.5 * buttock + 0.3 * belly, 2.4},
      {1.000, 0.95 * 0.5 * (0.5 * m.hip_breadth + waist), -0.116 - 0.6 * buttock, 0.095 + 0.6 * belly, 2.5},
      {1.057, waist, -0.112 - 0.2 * belly, 0.100 + 0.8 * belly, at_waist},
      {1.120, natural_waist * waist, -0.112 - 0.2 * belly, 0.100 + 0.8 * belly, at_waist},
      {1.200, 0.505 * (waist + wide), -0.122 - 0.2 * breast, 0.104 + 0.5 * belly + 0.4 * breast,
       0.5 * (at_waist + at_chest)},
      {1.287, wide, -0.138 - 0.3 * breast, 0.097 + 0.7 * breast, at_chest},
      {1.350, 1.12 * broad, -0.140 - 0.2 * breast, 0.076 + 0.3 * breast, 2.7},
      {1.400, 1.10 * broad, -0.133 - 0.2 * breast, 0.062 + 0.2 * breast, 2.4},
      {1.435, 0.90 * broad, -0.126 - 0.2 * breast, 0.044 + 0.2 * breast, 2.2},
      {1.465, 0.60 * broad, -0.118, 0.022, 2},
      {1.495, 0.98 * neck, -0.110, -0.110 + 1.95 * neck, 2},
      {1.550, 0.86 * neck, -0.083, -0.083 + 1.75 * neck, 2},
      {1.600, 0.85 * neck, -0.069, -0.069 + 1.70 * neck, 2},
      {1.630, 0.50 * neck, -0.040, 0.020, 2},
  };
  constexpr std::array between = {1.000, 1.120, 1.200};  // where no girth is measured
  for (Section& section : section_) {
    if (std::ranges::find(between, section.y) == between.end()) continue;
    const double deeper = (fit.between - 1) * (section.front - section.back);
    section.half *= fit.between;
    section.back -= 0.35 * deeper;
    section.front += 0.65 * deeper;
  }
  reach_ = 0.34 * size_;
  for (Section& section : section_) {
    section.y = height(section.y);
    reach_ = std::max(reach_, section.half + 0.10);
  }
  breast_front_ = 0.026 + 0.6 * breast;
  blade_back_ = 0.106 + 0.3 * breast;
  full_ = (fit.chest * m.chest_depth) / 0.2346;
  round_ = (fit.hips * m.buttock_depth) / 0.2267;
  chest_wide_ = chest / 0.1398;
  buttock_ = buttock;
  breast_m_ = bust / 0.040;  // relative to the usual size
}

double TrunkForm::sections(const Vec& p) const {
  const auto [k, t] = between(section_.size(), p.y, [&](std::size_t i) { return section_[i].y; });
  const auto at = [&, t = t, k = k](double Section::*value) {
    return curve(section_.size(), k, t, [&](std::size_t i) { return section_[i].*value; });
  };
  const double half = at(&Section::half), back = at(&Section::back), front = at(&Section::front),
               n = at(&Section::exponent);
  const double deep = 0.5 * (front - back);
  const double u = std::abs(p.x) / half, v = std::abs(p.z - 0.5 * (front + back)) / deep;
  const double d = (std::pow(std::pow(u, n) + std::pow(v, n) + 1e-9, 1 / n) - 1) * std::min(half, deep);
  const double beyond = std::max(section_.front().y - p.y, p.y - section_.back().y);
  return beyond > 0 ? std::hypot(std::max(d, 0.0), beyond) : std::max(d, beyond);
}

double TrunkForm::distance(const Vec& at) const {
  const Vec p = (1 / scale_.unit) * at;
  const auto place = [this](double x, double y, double z) { return Vec{size_ * x, height(y), size_ * z}; };
  const Vec q{-std::abs(p.x), p.y, p.z};
  double d = sections(p);
  // From the neck to the shoulder; chest muscle, shoulder blade, buttock.
  d = smooth_union(d,
                   capsule(q, place(-0.030, 1.466, -0.066), shoulder_ + Vec{0.022, -0.020, -0.018},
                           0.042 * std::sqrt(full_), 0.046 * std::sqrt(full_)),
                   0.035);
  d = smooth_union(d, capsule(q, place(-0.050, 1.446, -0.030), shoulder_ + Vec{0.004, -0.022, 0}, 0.038, 0.046), 0.03);
  // Bones that show in thin people: rib cage, spines of the shoulder blades, crests of the pelvis, collar bones.
  d = smooth_union(d, ellipsoid(p, place(0, 1.262, -0.031), size_ * Vec{0.137, 0.175, 0.1075}), 0.02);
  d = smooth_union(d, capsule(q, place(-0.075, 1.432, -0.110), place(-0.155, 1.454, -0.070), 0.022, 0.020), 0.03);
  d = smooth_union(d, ellipsoid(q, place(-0.112, 1.013, 0.042), size_ * Vec{0.022, 0.032, 0.022}), 0.045);
  d = smooth_union(d, capsule(q, place(-0.022, 1.426, 0.034), place(-0.105, 1.440, 0.030), 0.009, 0.013), 0.045);
  const double man =
      smooth_union(d, ellipsoid(q, {-0.074 * chest_wide_, height(1.322), breast_front_}, {0.084, 0.058, 0.052}), 0.05);
  if (const double b = breast_m_; b > 0) {
    d = smooth_union(
        d,
        ellipsoid(q, {-0.078 * chest_wide_, height(1.262), breast_front_ + 0.040}, {0.060 * b, 0.062 * b, 0.056 * b}),
        0.035);
    d = smooth_union(d, ellipsoid(q, {-0.074 * chest_wide_, height(1.330), breast_front_}, {0.070, 0.060, 0.050}),
                     0.06);
    d = std::lerp(man, d, scale_.womanly);
  } else {
    d = man;
  }
  d = smooth_union(d, ellipsoid(q, {-0.080 * chest_wide_, height(1.352), -blade_back_}, {0.058, 0.088, 0.036}), 0.05);
  d = smooth_union(
      d, ellipsoid(q, {-0.078, height(0.905), -0.060 - buttock_}, {0.078 * std::sqrt(round_), 0.088, 0.070 * round_}),
      0.05);
  return scale_.unit * d;
}

double head_distance(const Vec& p, double soft) {
  const auto softer = [soft](double man, double woman) { return std::lerp(man, woman, soft); };
  const Vec q{std::abs(p.x), p.y, p.z};
  // Skull, face, jaw.
  double d = ellipsoid(q, {0, 1.656, -0.009}, {0.0775, 0.094, 0.1000});
  d = smooth_union(d, ellipsoid(q, {0, 1.672, -0.032}, {0.0690, 0.073, 0.0810}), 0.020);
  d = smooth_union(d, ellipsoid(q, {0, 1.690, 0.014}, {0.0680, 0.056, 0.0710}), 0.020);
  d = smooth_union(d, ellipsoid(q, {0, 1.604, 0.020}, {0.0625, 0.080, 0.0670}), 0.040);
  d = smooth_union(
      d, capsule(q, {0.047, 1.580, 0.004}, {0.012, 1.540, 0.064}, softer(0.0180, 0.0155), softer(0.0165, 0.0140)),
      0.034);
  d = smooth_union(d, ellipsoid(q, {0, 1.538, 0.077}, {0.019, 0.014, 0.0130}), 0.024);
  d = smooth_union(d, ellipsoid(q, {0.047, 1.611, 0.047}, {0.021, 0.016, 0.024}), 0.026);  // cheekbone
  d = smooth_union(d, ellipsoid(q, {0.036, 1.583, 0.042}, {0.023, 0.027, 0.028}), 0.030);  // cheek
  d = smooth_union(d, ellipsoid(q, {0, 1.576, 0.068}, {0.034, 0.027, 0.0215}), 0.026);     // teeth
  d = smooth_union(
      d, capsule(q, {0.013, 1.6545, 0.0870}, {0.045, 1.6545, 0.0700}, softer(0.0080, 0.0065), softer(0.0070, 0.0060)),
      0.018);                                                                                         // brow
  d = smooth_difference(d, ellipsoid(q, {0.0320, 1.6335, 0.0960}, {0.0190, 0.0115, 0.0140}), 0.016);  // eye's socket
  // Lids, closed over the eye: the upper one reaches over the lower.
  const double upper = ellipsoid(q, {0.0320, 1.6355, 0.0735}, {0.0155, 0.0125, 0.0125}),
               lower = ellipsoid(q, {0.0320, 1.6325, 0.0722}, {0.0150, 0.0110, 0.0122});
  d = smooth_union(d, smooth_union(upper, lower, 0.0006), 0.004);
  // Nose: bridge, tip, wings.
  double nose = capsule(q, {0, 1.646, 0.0865}, {0, 1.604, 0.1030}, softer(0.0068, 0.0060), softer(0.0090, 0.0078));
  nose = smooth_union(nose, ellipsoid(q, {0, 1.5975, 0.1060}, {0.0105, 0.0090, 0.0100}), 0.010);
  nose = smooth_union(nose, ellipsoid(q, {0.0115, 1.5950, 0.0945}, {0.0080, 0.0075, 0.0110}), 0.008);
  d = smooth_union(d, nose, 0.013);
  // Lips, parted by the line of the mouth.
  d = smooth_union(d, capsule(q, {0, 1.5725, 0.0895}, {0.0220, 1.5675, 0.0800}, 0.0048, 0.0030), 0.0060);
  d = smooth_union(d, capsule(q, {0, 1.5605, 0.0880}, {0.0200, 1.5645, 0.0800}, 0.0062, 0.0030), 0.0060);
  d = smooth_difference(d, capsule(q, {0, 1.5665, 0.0982}, {0.0250, 1.5662, 0.0858}, 0.0026, 0.0016), 0.0045);
  // Ear.
  const double lean = 0.25 * (q.y - 1.622);
  const Vec e{q.x, q.y, q.z + 0.012 + lean};
  double ear = ellipsoid(e, {0.0785, 1.622, 0}, {0.0075, 0.0310, 0.0180});
  ear = smooth_difference(ear, ellipsoid(e, {0.0870, 1.623, 0.0020}, {0.0075, 0.0185, 0.0100}), 0.006);
  return smooth_union(d, ear, 0.008);
}

}  // namespace mobil::inline v0_3::form
