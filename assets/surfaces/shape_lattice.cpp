#include "assets/surfaces/shape_lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/assets/surfaces/muscle_surfaces.h>
#include <mobil/engine/geometry.h>
#include <mobil/muscle_table.h>

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

constexpr double thinnest_end = 0.35;
/// A block of two cells across extends to 0.962 of its ellipse.
constexpr double margin = 1.05;
constexpr std::size_t last_station = lattice_station_count - 1;

/// An ellipse: the image of the unit circle under a symmetric matrix, moved to (x, y).
struct Station {
  double x = 0, y = 0, xx = 0, xy = 0, yy = 0;
};

/// Returns 1 on the ellipse, less inside.
double reach(const Station& s, double x, double y) {
  const double det = s.xx * s.yy - s.xy * s.xy, dx = x - s.x, dy = y - s.y;
  return std::hypot(s.yy * dx - s.xy * dy, s.xx * dy - s.xy * dx) / det;
}

Station mix(const Station& a, const Station& b, double w) {
  const auto m = [w](double p, double q) { return p + w * (q - p); };
  return {m(a.x, b.x), m(a.y, b.y), m(a.xx, b.xx), m(a.xy, b.xy), m(a.yy, b.yy)};
}

/// Returns nearly the smallest ellipse round points (Khachiyan 1996; Todd & Yildirim, Discrete Appl. Math. 155, 2007).
Station enclose(const std::vector<Vec>& points) {
  constexpr int rounds = 200;
  const std::size_t n = points.size();
  std::vector<double> weight(n, 1 / static_cast<double>(n));
  Station s;
  for (int round = 0; round <= rounds; ++round) {
    Vec mean{0, 0, 0};
    for (std::size_t i = 0; i < n; ++i) mean = mean + weight[i] * points[i];
    double xx = 1e-12, xy = 0, yy = 1e-12;
    for (std::size_t i = 0; i < n; ++i) {
      const Vec d = points[i] - mean;
      xx += 2 * weight[i] * d.x * d.x, xy += 2 * weight[i] * d.x * d.y, yy += 2 * weight[i] * d.y * d.y;
    }
    const double root = std::sqrt(xx * yy - xy * xy), norm = std::sqrt(xx + yy + 2 * root);
    s = {mean.x, mean.y, (xx + root) / norm, xy / norm, (yy + root) / norm};
    std::size_t farthest = 0;
    double most = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double r = reach(s, points[i].x, points[i].y);
      if (r > most) most = r, farthest = i;
    }
    if (round == rounds) {
      s.xx *= most, s.xy *= most, s.yy *= most;
      break;
    }
    const double m = 2 * most * most + 1, step = (m - 3) / (3 * (m - 1));
    if (step <= 0) break;
    for (double& w : weight) w *= 1 - step;
    weight[farthest] += step;
  }
  return s;
}

/// Widens both semi-axes to at least `least`.
void widen(Station& s, double least) {
  const double mean = (s.xx + s.yy) / 2, half = std::hypot((s.xx - s.yy) / 2, s.xy);
  const double longer = std::max(mean + half, least), shorter = std::max(mean - half, least);
  const double stretch = half > 0 ? (longer - shorter) / (2 * half) : 0;
  const double xx = (longer + shorter) / 2 + stretch * (s.xx - s.yy) / 2;
  s.yy = longer + shorter - xx;
  s.xx = xx;
  s.xy *= stretch;
}

const Body& reference_body() {
  static const Body body = make_body({.height_m = static_cast<float>(reference_body_height_m),
                                      .mass_kg = static_cast<float>(reference_body_mass_kg)})
                               .value();
  return body;
}

/// Returns the surfaces' vertices in the muscle's frame, of a belly of the reference sizes.
std::vector<Vec> outline(const MusclePlan& plan) {
  static const std::vector<GroupSurface> surfaces =
      make_muscle_surfaces(reference_body(), muscle_members(), MuscleRoom::alone);
  std::vector<Vec> points;
  const Quat<double> into_frame = conjugate(plan.rotation);
  for (const GroupSurface& s : surfaces) {
    const bool own = s.muscle == plan.muscle || s.group == plan.muscle;
    if (!own || !is_single_muscle(s.muscle)) continue;  // tendons and ligaments have no mesh
    for (const auto& p : s.surface.mesh.position) {
      const Vec at = rotated(into_frame, to_double(p) - plan.start_m);
      const auto across = static_cast<double>(plan.scale.across), along = static_cast<double>(plan.scale.along);
      points.push_back({at.x / across, at.y / across, at.z / along});
    }
  }
  return points;
}

using Stations = std::array<Station, lattice_station_count>;

/// Returns stations smoothed with weights of a half for themselves and a quarter for each neighbour.
Stations softened(const Stations& s) {
  Stations out;
  for (std::size_t i = 0; i <= last_station; ++i) {
    out[i] = mix(s[i], mix(s[i > 0 ? i - 1 : 0], s[std::min(i + 1, last_station)], 0.5), 0.5);
  }
  return out;
}

/// Returns ellipses round the outline near each station, smoothed and at least as thick as required.
Stations follow(const std::vector<Vec>& points, double spacing) {
  Stations tight, smooth;
  double middle = 0;
  for (std::size_t i = 0; i <= last_station; ++i) {
    const double z = static_cast<double>(i) * spacing;
    std::vector<Vec> near;
    for (double within = 0.6 * spacing; near.size() < 8; within *= 1.5) {
      near.clear();
      std::copy_if(points.begin(), points.end(), std::back_inserter(near),
                   [&](const Vec& p) { return std::fabs(p.z - z) <= within; });
    }
    tight[i] = enclose(near);
  }
  smooth = softened(softened(tight));
  // Centres are smoothed further, because elements shear where they bend.
  const Stations centres = softened(softened(smooth));
  for (std::size_t i = 0; i <= last_station; ++i) smooth[i].x = centres[i].x, smooth[i].y = centres[i].y;
  for (const Station& s : smooth) {
    middle = std::max(middle, (s.xx + s.yy) / 2 - std::hypot((s.xx - s.yy) / 2, s.xy));
  }
  for (Station& s : smooth) widen(s, thinnest_end * middle);
  return smooth;
}

/// Widens each station until the outline round it is inside with its margin.
void surround(const std::vector<Vec>& points, double spacing, Stations& stations) {
  std::array<double, lattice_station_count> most{};
  for (const Vec& p : points) {
    const double at = p.z / spacing;
    if (at < 0 || at > static_cast<double>(last_station)) continue;
    const auto i = std::min(static_cast<std::size_t>(at), last_station - 1);
    const double r = reach(mix(stations[i], stations[i + 1], at - static_cast<double>(i)), p.x, p.y);
    most[i] = std::max(most[i], r);
    most[i + 1] = std::max(most[i + 1], r);
  }
  for (std::size_t i = 0; i <= last_station; ++i) {
    const double grow = std::max(1.0, margin * most[i]);
    stations[i].xx *= grow, stations[i].xy *= grow, stations[i].yy *= grow;
  }
}

/// Returns the turn of the block's axes to the directions of the sections' longest and shortest reach, at most 45°.
double roll(const Stations& stations) {
  Station sum;
  for (const Station& s : stations) sum.xx += s.xx, sum.xy += s.xy, sum.yy += s.yy;
  const double turn = 0.5 * std::atan2(2 * sum.xy, sum.xx - sum.yy), right = std::asin(1.0);
  return turn > right / 2 ? turn - right : turn < -right / 2 ? turn + right : turn;
}

LatticeStations stations_of(const Stations& ellipses) {
  const double turn = roll(ellipses), c = std::cos(turn), n = std::sin(turn);
  LatticeStations lattice{};
  for (std::size_t i = 0; i <= last_station; ++i) {
    const Station& s = ellipses[i];
    // Rounding to 1/128 mm removes differences between machines' sines, so all have the same mesh.
    const auto f = [](double metres) { return static_cast<float>(std::round(metres * 128e3) / 128e3); };
    lattice[i] = {static_cast<float>(i) / static_cast<float>(last_station),
                  f(s.x),
                  f(s.y),
                  f(s.xx * c + s.xy * n),
                  f(s.yy * c - s.xy * n),
                  f(s.xy * c - s.xx * n),
                  f(s.xy * c + s.yy * n)};
  }
  return lattice;
}

/// Smooths sections until elements are well shaped, also in the widest bodies and on the finest mesh. Only wide and
/// short blocks need it.
void straighten(double length_m, Stations& stations) {
  constexpr double least_quality = 0.325, widest = 1.8;  // of the reference body's
  const auto quality = [&] {
    const auto block = bend_block({8, 8, 32}, stations_of(stations), length_m, belly_grading);
    return block ? smallest_scaled_jacobian(scaled(*block, BellyScale<double>{widest, 1})) : 0;
  };
  for (int round = 0; round < 20 && quality() < least_quality; ++round) stations = softened(stations);
}

/// Scales all sections so that the block has that volume, m³.
void fill(double volume_m3, double length_m, Stations& stations) {
  const double now = volume(bend_block({2, 2, 2 * last_station}, stations_of(stations), length_m).value());
  const double factor = std::sqrt(volume_m3 / now);
  for (Station& s : stations) s.xx *= factor, s.xy *= factor, s.yy *= factor;
}

}  // namespace

LatticeStations shape_lattice(Muscle muscle) {
  const MusclePlan plan = make_muscle_plan(reference_body(), muscle).value();
  const std::vector<Vec> points = outline(plan);
  const double belly_m = reference_belly_m(muscle), spacing = belly_m / last_station;
  Stations stations = follow(points, spacing);
  if (is_single_muscle(muscle)) {
    straighten(belly_m, stations);
    const auto across = static_cast<double>(plan.scale.across), along = static_cast<double>(plan.scale.along);
    fill(plan.volume_m3 / (across * across * along), belly_m, stations);
  } else {
    surround(points, spacing, stations);
    straighten(belly_m, stations);
  }
  return stations_of(stations);
}

}  // namespace mobil::inline v0_3
