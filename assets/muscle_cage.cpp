// The block that encloses a group's bellies, from its members' sections in the reference body.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "assets/anthropometry.h"
#include "assets/leg_sections.h"
#include "assets/muscle_plan.h"
#include "assets/muscle_table.h"
#include "engine/geometry.h"

namespace mobil {
namespace {

using namespace geometry;

constexpr double margin = 1.10, thinnest_end = 0.35;

/// Points round the members' sections, in the muscle's frame.
std::vector<Vec> outline(const LegFrame& leg, const MusclePlan& plan) {
  constexpr int levels = 80, round = 24;
  std::vector<Vec> points;
  const Quat<double> into_frame = conjugate(plan.rotation);
  for (const auto& muscle : members_of(plan.group)) {
    const auto top = static_cast<double>(muscle.sections.front().level);
    const auto bottom = static_cast<double>(muscle.sections.back().level);
    for (int i = 0; i <= levels; ++i) {
      const double level = std::min(top + (bottom - top) * i / levels, bottom);
      const auto e = leg_ellipse(muscle.sections, level);
      if (!e) continue;
      for (int j = 0; j < round; ++j) {
        const double a = 2 * std::numbers::pi * j / round, c = std::cos(a), s = std::sin(a);
        const Vec p = leg_point(leg, level, e->lateral + e->al * c + e->ll * s, e->anterior + e->aa * c + e->al * s);
        points.push_back(rotated(into_frame, p - plan.start_m));
      }
    }
  }
  return points;
}

struct Station {
  double x, y, semi_x, semi_y;
};

/// An ellipse along x and y round the points with from ≤ z ≤ to: that of their bounding box, as large as it must be.
Station enclose(const std::vector<Vec>& points, double from, double to) {
  double left = 1, right = -1, back = 1, front = -1;
  const auto within = [from, to](const Vec& p) { return p.z >= from && p.z <= to; };
  for (const auto& p : points) {
    if (!within(p)) continue;
    left = std::min(left, p.x), right = std::max(right, p.x);
    back = std::min(back, p.y), front = std::max(front, p.y);
  }
  Station s{(left + right) / 2, (back + front) / 2, (right - left) / 2, (front - back) / 2};
  double reach = 0;
  for (const auto& p : points) {
    if (within(p)) reach = std::max(reach, std::hypot((p.x - s.x) / s.semi_x, (p.y - s.y) / s.semi_y));
  }
  s.semi_x *= margin * reach;
  s.semi_y *= margin * reach;
  return s;
}

/// How far the farthest point of the belly's span lies from the cage's axis, over the cage's own reach there.
double reach(const std::vector<Vec>& points, const std::array<Station, cage_station_count>& cage, double belly_m) {
  double farthest = 0;
  for (const auto& p : points) {
    if (p.z < 0 || p.z > belly_m) continue;
    const double at = p.z / belly_m * (cage_station_count - 1);
    const auto i = std::min(static_cast<std::size_t>(at), cage_station_count - 2);
    const double w = at - static_cast<double>(i);
    const auto mix = [&](double Station::*field) { return (1 - w) * cage[i].*field + w * cage[i + 1].*field; };
    farthest = std::max(farthest, std::hypot((p.x - mix(&Station::x)) / mix(&Station::semi_x),
                                             (p.y - mix(&Station::y)) / mix(&Station::semi_y)));
  }
  return farthest;
}

CageStations make_cage(MuscleGroup group) {
  const Body body = make_body({.height_m = static_cast<float>(reference_body_height_m),
                               .mass_kg = static_cast<float>(reference_body_mass_kg)})
                        .value();
  const MusclePlan plan = make_muscle_plan(body, group).value();
  const std::vector<Vec> points = outline(leg_frame(body), plan);
  constexpr std::size_t last = cage_station_count - 1;
  const double spacing = plan.belly_length_m / last;

  std::array<Station, cage_station_count> tight{}, cage{};
  for (std::size_t i = 0; i <= last; ++i) {
    const double z = static_cast<double>(i) * spacing;
    tight[i] = enclose(points, std::max(z - spacing, 0.0), std::min(z + spacing, plan.belly_length_m));
  }
  Station middle{};
  for (std::size_t i = 0; i <= last; ++i) {
    const Station &a = tight[i > 0 ? i - 1 : 0], &b = tight[i], &c = tight[std::min(i + 1, last)];
    const auto smooth = [&](double Station::*field) { return (a.*field + 2 * b.*field + c.*field) / 4; };
    cage[i] = {smooth(&Station::x), smooth(&Station::y), smooth(&Station::semi_x), smooth(&Station::semi_y)};
    middle.semi_x = std::max(middle.semi_x, cage[i].semi_x);
    middle.semi_y = std::max(middle.semi_y, cage[i].semi_y);
  }
  for (auto& s : cage) {
    s.semi_x = std::max(s.semi_x, thinnest_end * middle.semi_x);
    s.semi_y = std::max(s.semi_y, thinnest_end * middle.semi_y);
  }
  // Smoothing has taken some of the margin here and there: the whole cage grows until all have it again.
  const double grow = std::max(1.0, margin * reach(points, cage, plan.belly_length_m));

  CageStations stations{};
  for (std::size_t i = 0; i <= last; ++i) {
    const Station& s = cage[i];
    stations[i] = {static_cast<float>(i) / static_cast<float>(last), static_cast<float>(s.x), static_cast<float>(s.y),
                   static_cast<float>(grow * s.semi_x), static_cast<float>(grow * s.semi_y)};
  }
  return stations;
}

}  // namespace

const CageStations& group_cage(MuscleGroup group) {
  static const std::array<CageStations, muscle_group_count> cages = {
      make_cage(MuscleGroup::hamstrings), make_cage(MuscleGroup::quadriceps), make_cage(MuscleGroup::triceps_surae)};
  return cages[static_cast<std::size_t>(group)];
}

}  // namespace mobil
