#include <mobil/skin_atlas.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include <mobil/anthropometry.h>
#include <mobil/engine/geometry.h>
#include "assets/surfaces/carried_skin.h"

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;
using form::BodyForm;
using std::numbers::pi;

/// Regions of skin that are cut apart, by segment, the same on either side.
enum class Region : std::uint8_t { trunk, head, arm, hand, leg, foot };
constexpr std::size_t regions = 6;

Region region_of(std::size_t segment) {
  const auto is = [&](Segment right, std::size_t more) {
    for (const std::size_t side : {Side::right, Side::left}) {
      const std::size_t first = index(on_side(right, side));
      if (segment >= first && segment <= first + more) return true;
    }
    return false;
  };
  if (is(Segment::hand_right, 2)) return Region::hand;
  if (is(Segment::upper_arm_right, 1)) return Region::arm;
  if (is(Segment::foot_right, 1)) return Region::foot;
  if (is(Segment::thigh_right, 2)) return Region::leg;
  return segment >= index(Segment::C7) && segment <= index(Segment::head) ? Region::head : Region::trunk;
}

/// Unrolls round an upright axis from `low` to `high`, m: the angle from the front to the right, the distance along the
/// axis down. Beyond the ends it continues as over a ball.
struct Barrel {
  double x, z, low, high, radius;
};
// Barrels of a body of 1.75 m. Arm, leg and foot are the right ones in the anatomical position; the foot stands on its
// toes, its upper side to the front.
constexpr Barrel round_trunk = {0, -0.03, 0.98, 1.28, 0.155}, round_head = {0, 0.02, 1.53, 1.655, 0.095};
constexpr Barrel round_arm = {-0.175, -0.021, 0.86, 1.40, 0.046}, round_leg = {-0.080, 0, 0.10, 0.88, 0.075};
constexpr Barrel round_foot = {-0.085, 0.040, -0.15, 0.02, 0.045};
/// Triangles across the seam at the back extend beyond it by at most this.
constexpr double over_seam_rad = 0.5;

/// Layout of a chart: unrolled round a barrel, or seen along an axis. It has the chart's place in the square, breadth
/// and height, m, its scale relative to the others, and the point in its upper left corner.
struct ChartForm {
  Barrel barrel;    // radius 0: flat
  Vec right, down;  // axes of a flat chart
  double left_m, top_m, broad_m, high_m, scale, first_right_m, first_down_m;

  bool is_flat() const { return barrel.radius <= 0; }
  double angle(const Vec& p) const { return is_flat() ? 0 : std::atan2(p.x - barrel.x, p.z - barrel.z); }
  /// Returns the place in the chart, m. `angle_rad` is `angle`, or that plus a full turn.
  std::array<double, 2> laid(const Vec& p, double angle_rad) const {
    if (is_flat()) return {dot(p, right), dot(p, down)};
    const double end = std::clamp(p.y, barrel.low, barrel.high), across = std::hypot(p.x - barrel.x, p.z - barrel.z);
    return {barrel.radius * angle_rad, -(end + barrel.radius * std::atan2(p.y - end, across))};
  }
};
constexpr ChartForm round(const Barrel& b, double left_m, double top_m, double above_m, double below_m,
                          double scale = 1) {
  return {b,
          {},
          {},
          left_m,
          top_m,
          (2 * pi + over_seam_rad) * b.radius,
          b.high - b.low + above_m + below_m,
          scale,
          -pi * b.radius,
          -(b.high + above_m)};
}

/// Side of the square and gap between charts, m.
constexpr double side_m = 2.02, gap_m = 0.014;

constexpr bool is_left(SkinChart chart) {
  return chart > SkinChart::head && static_cast<int>(chart) % 2 == 1;
}

/// Legs and arms are in one row, hands below the arms, feet and soles at the right, trunk and head in the second row.
constexpr ChartForm form_of(SkinChart chart) {
  constexpr double a_leg = (2 * pi + over_seam_rad) * round_leg.radius + gap_m;
  constexpr double an_arm = (2 * pi + over_seam_rad) * round_arm.radius + gap_m, arms = 2 * a_leg;
  constexpr double feet = arms + 2 * an_arm, a_trunk = (2 * pi + over_seam_rad) * round_trunk.radius + gap_m;
  constexpr double a_hand = 0.135 + gap_m, hands_top = 0.72, hand_high = 0.26, palm_from = -0.25, back_from = 0.115;
  constexpr double a_sole = 0.14 + gap_m, second_foot = 0.33, soles_top = 0.66, second_row = 1.01;
  const bool second = is_left(chart);
  switch (chart) {
    case SkinChart::trunk:
      return round(round_trunk, 0, second_row, 0.25, 0.25);
    case SkinChart::head:
      return round(round_head, a_trunk, second_row, 0.155, 0.13, 1.4);
    case SkinChart::arm_right:
    case SkinChart::arm_left:
      return round(round_arm, arms + second * an_arm, 0, 0.075, 0.075);
    case SkinChart::palm_right:
    case SkinChart::palm_left:
      return {{}, {1, 0, 0}, {0, -1, 0}, arms + second * a_hand, hands_top, a_hand - gap_m, hand_high,
              1,  palm_from, -0.90};
    case SkinChart::hand_back_right:
    case SkinChart::hand_back_left:
      return {{}, {-1, 0, 0}, {0, -1, 0}, arms + (2 + second) * a_hand, hands_top, a_hand - gap_m, hand_high,
              1,  back_from,  -0.90};
    case SkinChart::leg_right:
    case SkinChart::leg_left:
      return round(round_leg, second * a_leg, 0, 0.12, 0.10);
    case SkinChart::foot_right:
    case SkinChart::foot_left:
      return round(round_foot, feet, second * second_foot, 0.075, 0.075);
    case SkinChart::sole_right:
    case SkinChart::sole_left:
      return {{}, {1, 0, 0}, {0, 0, -1}, feet + second * a_sole, soles_top, a_sole - gap_m, 0.31, 1, -0.155, -0.215};
  }
  return {};
}

SkinChart on_its_side(SkinChart right, bool left) {
  return static_cast<SkinChart>(static_cast<int>(right) + (left ? 1 : 0));
}

/// Returns the chart of a triangle with this middle and normal, in the meshing pose.
SkinChart chart_of(Region region, const Vec& middle, const Vec& normal) {
  const bool left = middle.x > 0;
  constexpr double below = 0.6;  // a sole's normal points down by at least this
  switch (region) {
    case Region::trunk:
      return SkinChart::trunk;
    case Region::head:
      return SkinChart::head;
    case Region::arm:
      return on_its_side(SkinChart::arm_right, left);
    case Region::hand:
      return on_its_side(normal.z > 0 ? SkinChart::palm_right : SkinChart::hand_back_right, left);
    case Region::leg:
      return on_its_side(SkinChart::leg_right, left);
    case Region::foot:
      return on_its_side(normal.y < -below ? SkinChart::sole_right : SkinChart::foot_right, left);
  }
  return SkinChart::trunk;
}

/// Returns a point of the meshing pose as the chart sees it: on the right side in the anatomical position, a foot
/// standing on its toes.
Vec as_seen(const BodyForm& form, SkinChart chart, const Vec& p) {
  if (chart <= SkinChart::head) return p;
  const Vec right = {is_left(chart) ? -p.x : p.x, p.y, p.z};
  if (chart < SkinChart::leg_right) return form.in_arm(right);
  const Vec leg = form.in_leg(right);
  const bool foot = chart == SkinChart::foot_right || chart == SkinChart::foot_left;
  return foot ? Vec{leg.x, -leg.z, leg.y} : leg;
}

AtlasPlace in_square(SkinChart chart, const Vec& seen, double angle_rad) {
  const ChartForm form = form_of(chart);
  const auto [along_right, along_down] = form.laid(seen, angle_rad);
  double right = std::clamp(along_right - form.first_right_m, 0.0, form.broad_m);
  if (is_left(chart)) right = form.broad_m - right;
  const double down = std::clamp(along_down - form.first_down_m, 0.0, form.high_m);
  return {static_cast<float>((form.left_m + form.scale * right) / side_m),
          static_cast<float>((form.top_m + form.scale * down) / side_m)};
}

/// Returns the region whose segments move a triangle's corners most.
Region region_of(const SkinMesh& mesh, const std::uint32_t* corner) {
  std::array<float, regions> share{};
  for (int k = 0; k < 3; ++k) {
    const SkinVertex& vertex = mesh.vertex[corner[k]];
    for (std::size_t i = 0; i < SkinVertex::max_frames; ++i) {
      const SkinFrame& frame = mesh.frame[vertex.frame[i]];
      share[static_cast<std::size_t>(region_of(segment_of(frame.from)))] += vertex.weight[i] * (1 - frame.turn);
      share[static_cast<std::size_t>(region_of(segment_of(frame.to)))] += vertex.weight[i] * frame.turn;
    }
  }
  return static_cast<Region>(std::ranges::max_element(share) - share.begin());
}

SkinAtlas make_atlas(Sex sex, SkinDetail detail) {
  const SkinMesh& mesh = skin_mesh(sex, detail);
  const Body man = *make_body(skin_body(Sex::man));
  const BodyForm form(man);
  const std::vector<Vec> places = sex == Sex::man ? mesh.place : carried_skin(mesh, sex, man);
  SkinAtlas atlas;
  std::map<std::tuple<std::uint32_t, float, float>, std::uint32_t> known;
  for (std::size_t t = 0; t < mesh.triangle.size(); t += 3) {
    const std::uint32_t* const corner = &mesh.triangle[t];
    const Vec &a = places[corner[0]], b = places[corner[1]], c = places[corner[2]];
    const Vec twice = cross(b - a, c - a), middle = (1.0 / 3) * (a + b + c);
    const Vec normal = length(twice) > 0 ? normalised(twice) : Vec{0, 1, 0};
    const SkinChart chart = chart_of(region_of(mesh, corner), middle, normal);
    const std::array<Vec, 3> seen = {as_seen(form, chart, a), as_seen(form, chart, b), as_seen(form, chart, c)};
    std::array<double, 3> angle{};
    for (std::size_t k = 0; k < 3; ++k) angle[k] = form_of(chart).angle(seen[k]);
    const auto [least, most] = std::ranges::minmax(angle);
    if (most - least > pi) {
      for (double& one : angle) one += one < 0 ? 2 * pi : 0;
    }
    atlas.chart.push_back(chart);
    for (std::size_t k = 0; k < 3; ++k) {
      const AtlasPlace place = in_square(chart, seen[k], angle[k]);
      const auto [found, is_new] =
          known.try_emplace({corner[k], place.right, place.down}, static_cast<std::uint32_t>(atlas.vertex.size()));
      if (is_new) {
        atlas.vertex.push_back(corner[k]);
        atlas.place.push_back(place);
      }
      atlas.triangle.push_back(found->second);
    }
  }
  return atlas;
}

std::array<SkinAtlas, skin_details> make_atlases(Sex sex) {
  std::array<SkinAtlas, skin_details> made;
  for (std::size_t d = 0; d < skin_details; ++d) made[d] = make_atlas(sex, static_cast<SkinDetail>(d));
  return made;
}

}  // namespace

std::vector<std::array<float, 4>> skin_tangents(const BodySkin& skin) {
  const SkinAtlas& atlas = skin_atlas(skin.sex, skin.detail);
  std::vector<Vec> right(atlas.vertex.size(), Vec{0, 0, 0}), up = right;
  for (std::size_t t = 0; t < atlas.triangle.size(); t += 3) {
    const std::uint32_t* const point = &atlas.triangle[t];
    const auto edge = [&](std::size_t k) {
      return to_double(skin.rest[atlas.vertex[point[k]]]) - to_double(skin.rest[atlas.vertex[point[0]]]);
    };
    const auto step = [&](std::size_t k, auto along) {
      return static_cast<double>(atlas.place[point[k]].*along) - static_cast<double>(atlas.place[point[0]].*along);
    };
    const double r1 = step(1, &AtlasPlace::right), r2 = step(2, &AtlasPlace::right);
    const double d1 = step(1, &AtlasPlace::down), d2 = step(2, &AtlasPlace::down), twice = r1 * d2 - r2 * d1;
    if (twice == 0) continue;
    // Both are weighted by their triangle's area in the texture.
    const double way = twice < 0 ? -1 : 1;
    const Vec along_right = way * (d2 * edge(1) - d1 * edge(2)), along_up = way * (r2 * edge(1) - r1 * edge(2));
    for (std::size_t k = 0; k < 3; ++k) {
      right[point[k]] = right[point[k]] + along_right;
      up[point[k]] = up[point[k]] + along_up;
    }
  }
  std::vector<std::array<float, 4>> tangent(right.size());
  for (std::size_t i = 0; i < right.size(); ++i) {
    const Vec normal = to_double(skin.normal[atlas.vertex[i]]);
    Vec t = right[i] - dot(right[i], normal) * normal;
    if (!(length(t) > 1e-12)) t = cross(std::abs(normal.y) < 0.9 ? Vec{0, 1, 0} : Vec{0, 0, 1}, normal);
    t = normalised(t);
    const bool is_up = dot(cross(normal, t), up[i]) >= 0;
    tangent[i] = {static_cast<float>(t.x), static_cast<float>(t.y), static_cast<float>(t.z), is_up ? 1.0F : -1.0F};
  }
  return tangent;
}

ChartBox chart_box(SkinChart chart) {
  const ChartForm form = form_of(chart);
  const auto of_side = [](double m) { return static_cast<float>(m / side_m); };
  return {of_side(form.left_m), of_side(form.top_m), of_side(form.left_m + form.scale * form.broad_m),
          of_side(form.top_m + form.scale * form.high_m)};
}

const SkinAtlas& skin_atlas(Sex sex, SkinDetail detail) {
  const auto d = static_cast<std::size_t>(detail);
  if (sex == Sex::woman) {
    static const std::array<SkinAtlas, skin_details> women = make_atlases(Sex::woman);
    return women[d];
  }
  static const std::array<SkinAtlas, skin_details> men = make_atlases(Sex::man);
  return men[d];
}

}  // namespace mobil::inline v0_3
