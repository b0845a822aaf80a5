#include <mobil/assets/surfaces/custom_skin.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <mobil/engine/geometry.h>
#include <mobil/engine/interrupt.h>
#include "assets/surfaces/space_cells.h"
#include "assets/surfaces/surface_mesh.h"

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

constexpr double seam_m = 0.06, furthest_m = 0.08, cap_m = 0.002;
/// Maximum offset of skin under shorts, and height above their hem up to which it is drawn.
constexpr float under_cloth_m = 0.004F, over_hem_m = 0.04F;

Vec unit(const Vec& v) {
  const double size = length(v);
  return size > 0 ? 1 / size * v : Vec{0, 1, 0};
}

/// Axes along an edge, across it and out of the skin.
struct SkinAxes {
  Vec along, across, out;
};
SkinAxes axes_of(const Vec& edge, const Vec& normal) {
  const Vec out = unit(normal), along = unit(edge - dot(edge, out) * out);
  return {along, cross(out, along), out};
}
Vec in_axes(const SkinAxes& axes, const Vec& v) {
  return {dot(v, axes.along), dot(v, axes.across), dot(v, axes.out)};
}

/// Returns the weight of each corner in the point of a triangle nearest to `p` (Ericson, Real-Time Collision Detection,
/// 5.1.5).
Vec nearest_weights(const Vec& p, const std::array<Vec, 3>& at) {
  const Vec ab = at[1] - at[0], ac = at[2] - at[0], ap = p - at[0];
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const Vec bp = p - at[1];
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  const Vec cp = p - at[2];
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double t = (d4 - d3) / (d4 - d3 + d5 - d6);
    return {0, 1 - t, t};
  }
  const double sum = va + vb + vc;
  return {va / sum, vb / sum, vc / sum};
}

/// Triangles of one leg's skin, by cells of space.
class LegSkin {
 public:
  LegSkin(const BodySkin& skin, std::span<const Vec3<float>> position, std::span<const Vec3<float>> normal,
          std::size_t side)
      : mesh_(skin_mesh(skin.sex, skin.detail)), position_(position), normal_(normal), shorts_(position.size()) {
    for (std::uint32_t t = 0; t < mesh_.triangle.size(); t += 3) {
      const std::uint32_t* const corner = &mesh_.triangle[t];
      if (std::all_of(corner, corner + 3, [&](std::uint32_t v) { return is_of_leg(skin, v, side); })) add(t);
    }
    constexpr auto part = static_cast<std::size_t>(SkinPart::shorts);
    for (std::size_t i = 3 * std::size_t{mesh_.first_triangle[part]};
         i < 3 * std::size_t{mesh_.first_triangle[part + 1]}; ++i)
      shorts_[mesh_.triangle[i]] = true;
  }

  static bool is_of_leg(const BodySkin& skin, std::uint32_t v, std::size_t side) {
    constexpr float over_the_middle_m = 0.01F;
    const float out = side == Side::right ? -skin.rest[v].x : skin.rest[v].x;
    const SkinMesh& mesh = skin_mesh(skin.sex, skin.detail);
    const SkinVertex& hangs = mesh.vertex[v];
    const auto heaviest = std::ranges::max_element(hangs.weight) - std::begin(hangs.weight);
    const SkinFrame& frame = mesh.frame[hangs.frame[static_cast<std::size_t>(heaviest)]];
    return out > -over_the_middle_m && is_leg(frame.from) && is_leg(frame.to);
  }

  /// True if the nearest triangle is of shorts.
  bool is_under_shorts(const SkinFollower& one) const {
    const auto is_in = [&](std::uint32_t v) { return shorts_[v]; };
    return std::all_of(one.corner, one.corner + 3, is_in);
  }
  /// Returns the lowest height of the shorts, m.
  float hem() const {
    float lowest = std::numeric_limits<float>::infinity();
    for (std::size_t v = 0; v < shorts_.size(); ++v)
      if (shorts_[v]) lowest = std::min(lowest, position_[v].y);
    return lowest;
  }

  /// Binds a vertex with its normal.
  SkinFollower follower(const Vec& p, const Vec& normal, double beside_part) const {
    SkinFollower follower{};
    const std::uint32_t t = nearest(p, normal);
    const std::array<Vec, 3> at = corners(t);
    const Vec weight = nearest_weights(p, at);
    const std::array<double, 3> weights = {weight.x, weight.y, weight.z};
    Vec point{0, 0, 0}, out{0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      follower.corner[k] = mesh_.triangle[t + k];
      follower.weight[k] = static_cast<float>(weights[k]);
      point = point + weights[k] * at[k];
      out = out + weights[k] * to_double(normal_[follower.corner[k]]);
    }
    const SkinAxes axes = axes_of(at[1] - at[0], out);
    const Vec off = p - point;
    const double size = length(off), part = beside_part * (size > furthest_m ? furthest_m / size : 1);
    follower.beside_m = to_float(in_axes(axes, part * off));
    follower.normal = to_float(in_axes(axes, normal));
    return follower;
  }

 private:
  static bool is_leg(std::uint8_t s) {
    using enum Segment;
    const auto segment = static_cast<Segment>(segment_of(s));
    constexpr std::array legs = {pelvis,     thigh_right, shank_right, foot_right, toes_right,  patella_right,
                                 thigh_left, shank_left,  foot_left,   toes_left,  patella_left};
    return std::ranges::find(legs, segment) != legs.end();
  }
  std::array<Vec, 3> corners(std::uint32_t t) const {
    return {to_double(position_[mesh_.triangle[t]]), to_double(position_[mesh_.triangle[t + 1]]),
            to_double(position_[mesh_.triangle[t + 2]])};
  }
  Vec middle(std::uint32_t t) const {
    const auto at = corners(t);
    return 1.0 / 3 * (at[0] + at[1] + at[2]);
  }
  void add(std::uint32_t t) {
    const Vec at = middle(t);
    for (const Vec& corner : corners(t)) largest_m_ = std::max(largest_m_, length(corner - at));
    cells_.add(t, at);
  }

  /// Returns the nearest triangle that faces about the same way, or of all triangles if none nearby does.
  std::uint32_t nearest(const Vec& p, const Vec& normal) const {
    constexpr std::int32_t furthest = 5;  // cells
    constexpr double same_way = 0.3;
    std::uint32_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    const auto look = [&](std::uint32_t t, bool any_way) {
      const auto corner = corners(t);
      const Vec out = cross(corner[1] - corner[0], corner[2] - corner[0]);
      if (!any_way && dot(unit(out), normal) < same_way) return;
      const Vec weight = nearest_weights(p, corner);
      const Vec off = p - (weight.x * corner[0] + weight.y * corner[1] + weight.z * corner[2]);
      if (const double square = dot(off, off); square < least) {
        least = square;
        best = t;
      }
    };
    for (std::int32_t r = 0; r <= furthest && std::sqrt(least) > (r - 1) * cells_.cell_m() - largest_m_; ++r)
      cells_.near(p, r, r, [&](std::uint32_t t) { look(t, false); });
    if (least < std::numeric_limits<double>::infinity()) return best;
    cells_.each([&](std::uint32_t t) { look(t, true); });
    return best;
  }

  const SkinMesh& mesh_;
  std::span<const Vec3<float>> position_, normal_;
  std::vector<bool> shorts_;  // per vertex
  double largest_m_ = 0;      // from a triangle's middle to a corner
  SpaceCells cells_{0.02};
};

/// Returns each vertex' mean of its triangles' normals, weighted by their areas.
std::vector<Vec> normals_of(const SurfaceMesh& mesh) {
  std::vector<Vec> normal(mesh.position.size(), Vec{0, 0, 0});
  for (std::size_t t = 0; t < mesh.triangle.size(); t += 3) {
    const Vec a = to_double(mesh.position[mesh.triangle[t]]), b = to_double(mesh.position[mesh.triangle[t + 1]]),
              c = to_double(mesh.position[mesh.triangle[t + 2]]);
    for (std::size_t k = 0; k < 3; ++k) {
      Vec& sum = normal[mesh.triangle[t + k]];
      sum = sum + cross(b - a, c - a);
    }
  }
  for (Vec& n : normal) n = unit(n);
  return normal;
}

float top_of(const SurfaceMesh& mesh) {
  return std::ranges::max_element(mesh.position, {}, &Vec3<float>::y)->y;
}

/// Adds `whole`, one piece of a leg. `top` is the top of that leg, m.
void add_leg(const SurfaceMesh& whole, double top, const LegSkin& skin, bool shorts_stay, CustomSkin& own) {
  const float covered = skin.hem() + over_hem_m;
  SurfaceMesh mesh{whole.name, whole.position, {}};
  for (std::size_t t = 0; t < whole.triangle.size(); t += 3) {
    const std::uint32_t* const corner = &whole.triangle[t];
    const auto all = [&](auto is) { return std::all_of(corner, corner + 3, is); };
    const bool cap = all([&](std::uint32_t v) { return double{whole.position[v].y} > top - cap_m; });
    const bool hidden = shorts_stay && all([&](std::uint32_t v) { return whole.position[v].y > covered; });
    if (!cap && !hidden) mesh.triangle.insert(mesh.triangle.end(), corner, corner + 3);
  }
  drop_unused(mesh);
  const std::vector<Vec> normal = normals_of(mesh);
  const auto first = static_cast<std::uint32_t>(own.vertex.size());
  for (std::size_t v = 0; v < mesh.position.size(); ++v) {
    check_interrupt();
    const Vec p = to_double(mesh.position[v]);
    const double below = std::clamp((top - p.y) / seam_m, 0.0, 1.0);
    SkinFollower one = skin.follower(p, normal[v], below * below * (3 - 2 * below));
    if (shorts_stay && skin.is_under_shorts(one)) one.beside_m.z = std::min(one.beside_m.z, under_cloth_m);
    own.vertex.push_back(one);
  }
  for (const std::uint32_t v : mesh.triangle) own.triangle.push_back(first + v);
}

}  // namespace

CustomSkin bind_custom_skin(const BodySkin& skin, std::span<const Vec3<float>> position,
                            std::span<const Vec3<float>> normal, std::span<const SurfaceMesh> legs, bool shorts_stay) {
  CustomSkin own;
  float top = -std::numeric_limits<float>::infinity();
  for (const SurfaceMesh& mesh : legs)
    if (!mesh.triangle.empty()) top = std::max(top, top_of(mesh));
  for (const std::size_t side : {std::size_t{Side::right}, std::size_t{Side::left}}) {
    const LegSkin leg(skin, position, normal, side);
    for (const SurfaceMesh& mesh : legs) {
      if (!mesh.triangle.empty())
        add_leg(side == Side::right ? mesh : mirror_image(mesh), double{top}, leg, shorts_stay, own);
    }
  }
  const SkinMesh& shared = skin_mesh(skin.sex, skin.detail);
  for (std::size_t part = 0; part < skin_parts; ++part) {
    const bool stays = shorts_stay && static_cast<SkinPart>(part) == SkinPart::shorts;
    const auto is_replaced = [&](std::uint32_t v) {
      return !stays && skin.rest[v].y < top &&
             (LegSkin::is_of_leg(skin, v, Side::right) || LegSkin::is_of_leg(skin, v, Side::left));
    };
    for (std::size_t t = shared.first_triangle[part]; t < shared.first_triangle[part + 1]; ++t) {
      const std::uint32_t* const corner = &shared.triangle[3 * t];
      if (!std::all_of(corner, corner + 3, is_replaced)) own.left.insert(own.left.end(), corner, corner + 3);
    }
    own.first_left[part + 1] = static_cast<std::uint32_t>(own.left.size() / 3);
  }
  return own;
}

}  // namespace mobil::inline v0_3
