#include <mobil/assets/body/leg_profile.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <mobil/assets/body/between.h>

namespace mobil::inline v0_3 {
namespace {

constexpr std::size_t stations = 73, angles = 64, harmonics = 4;
using form::tau;

struct Station {
  double s;
  std::array<double, 1 + 2 * harmonics> wave;  // mean, then cosine and sine of one, two… turns, mm
};

/// Measured on the skin of BodyParts3D 3.0, © The Database Center for Life Science, licensed under CC Attribution-Share
/// Alike 2.1 Japan. Seventeen stations with four harmonics each reproduce one man's leg to 1.1 mm rms.
constexpr std::array<Station, 17> measured = {{
    {0.20, {93.0, -15.9, -4.4, 2.5, -11.1, -4.2, 0.3, 0.2, -3.6}},
    {0.30, {87.3, -5.9, -9.0, 0.3, -9.0, -3.9, -0.2, -1.1, -0.0}},
    {0.40, {82.5, -0.2, -9.6, -1.6, -9.6, -3.2, 0.2, -0.9, 0.5}},
    {0.50, {78.6, 2.1, -8.6, -1.5, -10.5, -2.8, 0.3, -0.4, 0.9}},
    {0.60, {74.7, 4.4, -7.3, 0.6, -10.7, -2.0, -0.9, 0.3, 1.7}},
    {0.70, {70.3, 8.5, -6.4, 2.7, -9.7, -0.7, -1.1, -0.3, 1.2}},
    {0.80, {65.1, 12.4, -4.3, 3.1, -8.1, 0.5, -1.4, -0.4, 0.1}},
    {0.90, {59.8, 14.5, -3.6, 2.1, -7.1, 2.2, -2.4, 0.5, -0.9}},
    {1.00, {58.3, 12.1, -4.9, 2.2, -6.7, 2.5, -4.1, -0.4, -3.4}},
    {1.10, {56.7, 1.9, -9.3, 4.9, -3.5, 0.2, -3.9, 0.2, -2.1}},
    {1.20, {55.0, -10.1, -14.2, 4.2, -3.2, -1.2, -2.3, 0.1, -1.5}},
    {1.30, {56.4, -16.5, -14.5, 2.5, -4.0, -2.1, -1.1, -0.4, -1.0}},
    {1.40, {56.5, -18.8, -13.1, 1.2, -3.9, -2.0, -1.1, -0.5, -0.9}},
    {1.50, {52.6, -17.8, -12.4, 0.8, -3.1, -1.1, -0.7, -0.9, -0.5}},
    {1.62, {44.8, -14.4, -11.0, 0.1, -0.3, -1.4, -1.1, -0.6, -0.4}},
    {1.76, {36.2, -11.5, -7.8, 0.9, -0.3, -0.3, -0.2, 0.5, 0.0}},
    {1.90, {35.2, -2.4, -0.6, 4.6, -1.6, 1.0, 0.0, 0.4, -2.1}},
}};

double shape_mm(double s, double turn) {
  const auto [k, t] = form::between(measured.size(), s, [](std::size_t i) { return measured[i].s; });
  const auto at = [&](std::size_t i) {
    const auto& wave = measured[i].wave;
    double r = wave[0];
    for (std::size_t n = 1; n <= harmonics; ++n) {
      const double angle = static_cast<double>(n) * turn;
      r += wave[2 * n - 1] * std::cos(angle) + wave[2 * n] * std::sin(angle);
    }
    return r;
  };
  return at(k) + t * (at(k + 1) - at(k));
}

template <class Radius>
double tape(const Radius& radius) {
  double sum = 0, x = 0, z = radius(0);
  for (std::size_t j = 1; j <= angles; ++j) {
    const double turn = tau * static_cast<double>(j) / angles, r = radius(turn);
    sum += std::hypot(r * std::sin(turn) - x, r * std::cos(turn) - z);
    x = r * std::sin(turn);
    z = r * std::cos(turn);
  }
  return sum;
}

}  // namespace

LegProfile::LegProfile(const BodyMeasures& m) {
  struct Girth {
    double s, m, scale;
  };
  std::array<Girth, 4> girths = {
      {{0.20, m.thigh_girth, 0}, {0.86, m.lower_thigh_girth, 0}, {1.36, m.calf_girth, 0}, {1.84, m.ankle_girth, 0}}};
  for (Girth& girth : girths) girth.scale = girth.m / tape([&](double turn) { return shape_mm(girth.s, turn); });
  radius_.reserve(stations * angles);
  for (std::size_t i = 0; i < stations; ++i) {
    const double s = first_s + (last_s - first_s) * static_cast<double>(i) / (stations - 1);
    const auto [k, t] = form::between(girths.size(), s, [&](std::size_t n) { return girths[n].s; });
    const double scale = girths[k].scale + t * t * (3 - 2 * t) * (girths[k + 1].scale - girths[k].scale);
    for (std::size_t j = 0; j < angles; ++j)
      radius_.push_back(scale * shape_mm(s, tau * static_cast<double>(j) / angles));
  }
}

double LegProfile::radius(double s, double turn) const {
  const double along = std::clamp((s - first_s) / (last_s - first_s), 0.0, 1.0) * (stations - 1);
  const auto i = std::min(static_cast<std::size_t>(along), stations - 2);
  double round = turn / tau * angles;
  if (round < 0) round += angles;
  const auto whole = static_cast<std::size_t>(round);
  const std::size_t j = whole % angles, next = (j + 1) % angles;
  const double u = along - static_cast<double>(i), v = round - static_cast<double>(whole);
  const double* row = &radius_[i * angles];
  const double* below = row + angles;
  return (1 - u) * ((1 - v) * row[j] + v * row[next]) + u * ((1 - v) * below[j] + v * below[next]);
}

double LegProfile::girth(double s) const {
  return tape([&](double turn) { return radius(s, turn); });
}

}  // namespace mobil::inline v0_3
