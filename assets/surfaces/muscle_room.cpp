#include "assets/surfaces/muscle_room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <mobil/assets/surfaces/body_form.h>
#include <mobil/engine/geometry.h>

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

/// From this level down the skin is the leg's profile, above it is sampled from the body's form.
constexpr double hip_to_level = 0.45;

/// A point of a horizontal section, mm.
struct SectionPoint {
  double l, a;
};

double radius_of(std::span<const Vec3<float>> ring, const Vec& middle) {
  double most = 0;
  for (const auto& p : ring) most = std::max(most, length(to_double(p) - middle));
  return most;
}

/// Moves a ring so that its middle is at `to`.
void move_to(const Vec& to, std::span<Vec3<float>> ring) {
  const Vec shift = to - ring_middle(ring);
  for (auto& p : ring) p = to_float(to_double(p) + shift);
}

/// Moves each vertex to the last point of its ray from `middle`, before the first one without room. `has_room` must
/// hold at the middle.
template <class HasRoom>
void cut_rays(const Vec& middle, std::span<Vec3<float>> ring, double step_m, const HasRoom& has_room) {
  for (auto& p : ring) {
    const Vec ray = to_double(p) - middle;
    const int steps = std::max(1, static_cast<int>(std::ceil(length(ray) / step_m)));
    double low = 0, high = 1;
    for (int i = 1; i <= steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      if (!has_room(middle + t * ray)) {
        high = t;
        break;
      }
      low = t;
    }
    if (low == 1) continue;
    for (int round = 0; round < 10; ++round) {
      const double t = 0.5 * (low + high);
      (has_room(middle + t * ray) ? low : high) = t;
    }
    p = to_float(middle + low * ray);
  }
}

/// Returns a horizontal outline between two rings; empty above the first and below the last.
std::vector<Vec3<float>> outline_at(std::span<const std::vector<Vec3<float>>> rings, float y) {
  for (std::size_t r = 0; r + 1 < rings.size(); ++r) {
    const float above = rings[r].front().y, below = rings[r + 1].front().y;
    if (y > above || y < below || above == below) continue;
    const float w = (above - y) / (above - below);
    std::vector<Vec3<float>> outline;
    for (std::size_t i = 0; i < rings[r].size(); ++i) outline.push_back((1 - w) * rings[r][i] + w * rings[r + 1][i]);
    return outline;
  }
  return {};
}

bool is_inside(std::span<const Vec3<float>> outline, const Vec& p) {
  bool inside = false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec a = to_double(outline[i]), b = to_double(outline[(i + 1) % outline.size()]);
    if ((a.z > p.z) != (b.z > p.z) && p.x < a.x + (p.z - a.z) / (b.z - a.z) * (b.x - a.x)) inside = !inside;
  }
  return inside;
}

Vec flat(const Vec& v) {
  return {v.x, 0, v.z};
}

DistanceField sampled_hip(const Body& body, const LegFrame& leg) {
  constexpr double cell_m = 0.010, around_m = 0.26, above_m = 0.42;
  const form::BodyForm form(body);
  const double low = leg_point(leg, hip_to_level + 0.1, 0, 0).y;
  DistanceField field{{-around_m, low, -around_m}, cell_m, around_m, {}, {}};
  const double middle_m = 0.04;  // muscles can reach across the middle before both sides are cut apart
  field.count = {static_cast<int>((around_m + middle_m) / cell_m) + 2,
                 static_cast<int>((leg.hip.y + above_m - low) / cell_m) + 2,
                 static_cast<int>(2 * around_m / cell_m) + 2};
  for (int z = 0; z < field.count[2]; ++z) {
    for (int y = 0; y < field.count[1]; ++y) {
      for (int x = 0; x < field.count[0]; ++x) {
        const Vec at =
            field.corner + cell_m * Vec{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
        field.value.push_back(static_cast<float>(form.armless_distance(at)));
      }
    }
  }
  return field;
}

}  // namespace

Vec ring_middle(std::span<const Vec3<float>> ring) {
  Vec sum{0, 0, 0};
  for (const auto& p : ring) sum = sum + to_double(p);
  return (1 / static_cast<double>(ring.size())) * sum;
}

SkinRoom::SkinRoom(const Body& body, const LegFrame& leg)
    : leg_(leg), profile_(body_measures(body.request)), hip_(sampled_hip(body, leg)) {}

double SkinRoom::distance(const Vec& at) const {
  const double level = leg_level(leg_, at.y);
  if (level > LegProfile::last_s) return -1;  // tendons at the foot
  const Vec axis = leg_point(leg_, std::max(level, 0.0), 0, 0), out{at.x - axis.x, 0, at.z - axis.z};
  if (level < hip_to_level) return wider_ * mobil::distance(hip_, at - (1 - 1 / wider_) * out);
  const double turn = std::atan2(out.x, out.z);
  const double radius = profile_.radius(level, turn < 0 ? turn + 2 * std::numbers::pi : turn);
  return std::hypot(out.x, out.z) - wider_ * radius;
}

void keep_in(const SkinRoom& skin, double cover_m, std::span<Vec3<float>> ring) {
  const auto has_room = [&](const Vec& p) { return skin.distance(p) < -cover_m; };
  if (std::ranges::all_of(ring, [&](const Vec3<float>& p) { return has_room(to_double(p)); })) return;
  constexpr double deeper_m = 0.002, probe_m = 0.002;
  Vec middle = ring_middle(ring);
  for (int round = 0; round < 8 && skin.distance(middle) > -cover_m - deeper_m; ++round) {
    const auto rise = [&](const Vec& off) {
      return (skin.distance(middle + off) - skin.distance(middle - off)) / (2 * probe_m);
    };
    const Vec up{rise({probe_m, 0, 0}), 0, rise({0, 0, probe_m})};
    const double steep = std::max(dot(up, up), 0.1);
    middle = middle - ((skin.distance(middle) + cover_m + 2 * deeper_m) / steep) * up;
  }
  if (!has_room(middle)) return;
  move_to(middle, ring);
  cut_rays(middle, ring, 0.02, has_room);
}

void keep_out(const LegBones& bones, double gap_m, std::span<Vec3<float>> ring) {
  constexpr double middle_gap_m = 0.0015, step_m = 0.004;
  Vec middle = ring_middle(ring);
  const double radius = radius_of(ring, middle);
  std::vector<Segment> near;
  for (const Segment segment : LegBones::hard) {
    if (bones.can_touch(segment, middle, radius + gap_m)) near.push_back(segment);
  }
  const auto distance = [&](const Vec& p) {
    double least = 1;
    for (const Segment segment : near) least = std::min(least, bones.distance(segment, p));
    return least;
  };
  for (int round = 0; round < 12; ++round) {
    bool moved = false;
    for (const Segment segment : near) {
      const double within = gap_m + middle_gap_m - bones.distance(segment, middle);
      if (within <= 0) continue;
      middle = middle + (within + 1e-4) * bones.outward(segment, middle);
      moved = true;
    }
    if (!moved) break;
  }
  const auto has_room = [&](const Vec& p) { return distance(p) > gap_m; };
  if (near.empty() || !has_room(middle)) return;
  move_to(middle, ring);
  cut_rays(middle, ring, step_m, has_room);
}

void keep_off(const LegFrame& leg, std::span<const LegSection> beneath, std::span<Vec3<float>> ring) {
  constexpr double skin_mm = 1.5, middle_outside = 1.12;
  const double level = leg_level(leg, static_cast<double>(ring[0].y));
  const auto e = beneath.empty() ? std::nullopt : leg_ellipse(beneath, level);
  if (!e) return;
  const double aa = e->aa + skin_mm, ll = e->ll + skin_mm, al = e->al, det = aa * ll - al * al;
  const Vec axis = leg_point(leg, level, 0, 0);
  // to the circle whose image is the section beneath, and back
  const auto inward = [&](double l, double a) {
    return SectionPoint{(aa * l - al * a) / det, (ll * a - al * l) / det};
  };
  const auto outward = [&](SectionPoint p) { return SectionPoint{al * p.a + ll * p.l, aa * p.a + al * p.l}; };
  const auto local = [&](const Vec3<float>& p) {
    return inward((axis.x - static_cast<double>(p.x)) / leg.unit - e->lateral,
                  (static_cast<double>(p.z) - axis.z) / leg.unit - e->anterior);
  };
  SectionPoint middle{0, 0};
  std::vector<SectionPoint> points;
  for (const auto& p : ring) {
    points.push_back(local(p));
    middle.l += points.back().l / static_cast<double>(ring.size());
    middle.a += points.back().a / static_cast<double>(ring.size());
  }
  const double distance = std::hypot(middle.l, middle.a);
  SectionPoint moved = middle;
  if (distance < middle_outside) {
    const double factor = middle_outside / std::max(distance, 1e-6);
    moved = {middle.l * factor, middle.a * factor};
  }
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const SectionPoint d{points[i].l - middle.l, points[i].a - middle.a};
    const double dd = d.l * d.l + d.a * d.a, md = moved.l * d.l + moved.a * d.a;
    const double mm = moved.l * moved.l + moved.a * moved.a - 1, root = md * md - dd * mm;
    double s = 1;
    if (md < 0 && root > 0) s = std::min(1.0, (-md - std::sqrt(root)) / dd);
    const SectionPoint q = outward({moved.l + s * d.l, moved.a + s * d.a});
    ring[i].x = static_cast<float>(axis.x - (q.l + e->lateral) * leg.unit);
    ring[i].z = static_cast<float>(axis.z + (q.a + e->anterior) * leg.unit);
  }
}

void keep_off(std::span<const std::vector<Vec3<float>>> beneath, double gap_m, std::span<Vec3<float>> ring) {
  constexpr double step_m = 0.004, middle_step_m = 0.0005, longest_m = 0.08, middle_share = 0.25;
  const std::vector<Vec3<float>> outline = outline_at(beneath, ring[0].y);
  if (outline.empty()) return;
  const Vec core = ring_middle(outline);
  const auto has_room = [&](const Vec& p) {
    const Vec out = flat(p - core);
    const double far = length(out);
    return far > gap_m && !is_inside(outline, p - (gap_m / far) * out);
  };
  // The middle moves out until a quarter of the ring's outer half beneath it has room.
  Vec middle = ring_middle(ring);
  const Vec from = flat(middle - core), away = (1 / std::max(length(from), 1e-9)) * from;
  double thick = 0;
  for (const auto& p : ring) thick = std::max(thick, dot(to_double(p) - middle, away));
  const Vec rest = middle;
  for (double moved = 0; moved < longest_m && !has_room(middle - (middle_share * thick) * away); moved += middle_step_m)
    middle = rest + moved * away;
  if (!has_room(middle)) return;
  move_to(middle, ring);
  cut_rays(middle, ring, step_m, has_room);
}

}  // namespace mobil::inline v0_3
