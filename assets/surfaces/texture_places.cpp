#include <mobil/assets/surfaces/texture_places.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include <mobil/engine/geometry.h>
#include "assets/reduction/dense.h"
#include "engine/eigen.h"

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

using Vec = Vec3<double>;

constexpr std::size_t steps = 24;

/// A polyline, with the distance of each point along it, m.
struct MiddleLine {
  std::vector<Vec> middle;
  std::vector<double> at;

  explicit MiddleLine(std::vector<Vec> middles) : middle(std::move(middles)), at{0} {
    for (std::size_t i = 1; i < middle.size(); ++i) at.push_back(at.back() + length(middle[i] - middle[i - 1]));
  }

  /// The line's nearest point: distance along it, offset to the point and direction there. The ends extend straight.
  struct Foot {
    double at;
    Vec out, way;
  };
  Foot foot_of(const Vec& point) const {
    Foot best{};
    double nearest = 1e300;
    for (std::size_t i = 0; i + 1 < middle.size(); ++i) {
      const Vec span = middle[i + 1] - middle[i];
      const double whole = std::max(length(span), 1e-9);
      const Vec way = (1 / whole) * span;
      const double low = i == 0 ? -1e300 : 0, high = i + 2 == middle.size() ? 1e300 : whole;
      const double along = std::clamp(dot(point - middle[i], way), low, high);
      const Vec out = point - (middle[i] + along * way);
      if (dot(out, out) >= nearest) continue;
      nearest = dot(out, out);
      best = {at[i] + along, out, way};
    }
    return best;
  }
};

/// Returns the cubic nearest to all points, by their positions along it (0–1), at equal steps.
std::vector<Vec> middle_of(std::span<const Vec3<float>> position, const std::vector<double>& along) {
  const auto powers = [](double t) { return Eigen::RowVector4d(1, t, t * t, t * t * t); };
  const auto rows = static_cast<Eigen::Index>(position.size());
  Eigen::MatrixXd power(rows, 4), place(rows, 3);
  for (std::size_t v = 0; v < position.size(); ++v) {
    const auto row = static_cast<Eigen::Index>(v);
    power.row(row) = powers(2 * along[v] - 1);
    place.row(row) << position[v].x, position[v].y, position[v].z;
  }
  const Eigen::Matrix<double, 4, 3> cubic = least_squares(power, place);
  std::vector<Vec> middle;
  for (std::size_t i = 0; i <= steps; ++i) {
    const Eigen::RowVector3d at = powers(2 * static_cast<double>(i) / steps - 1) * cubic;
    middle.push_back({at.x(), at.y(), at.z()});
  }
  return middle;
}

/// Scales to 0–1.
void normalise(std::vector<double>& along) {
  const auto [low, high] = std::ranges::minmax(along);
  const double whole = std::max(high - low, 1e-9);
  for (double& a : along) a = std::clamp((a - low) / whole, 0.0, 1.0);
}

}  // namespace

std::vector<TexturePlace> texture_places(std::span<const Vec3<float>> position, const Vec3<float>& axis,
                                         const Vec3<float>& front) {
  std::vector<TexturePlace> place(position.size());
  if (position.empty()) return place;
  std::vector<double> along;
  for (const Vec3<float>& p : position) along.push_back(dot(to_double(p), to_double(axis)));
  normalise(along);
  // The line bends as the surface does, so each look measures along the line of the previous one.
  constexpr int looks = 4;
  for (int look = 0; look < looks; ++look) {
    const MiddleLine line(middle_of(position, along));
    for (std::size_t v = 0; v < position.size(); ++v) {
      const auto [at, out, way] = line.foot_of(to_double(position[v]));
      along[v] = at;
      const Vec ahead = orthogonal(to_double(front), way), aside = cross(way, ahead);
      place[v].around = static_cast<float>(std::atan2(dot(out, aside), dot(out, ahead)) / std::numbers::pi);
    }
    normalise(along);
  }
  for (std::size_t v = 0; v < position.size(); ++v) place[v].along = static_cast<float>(along[v]);
  return place;
}

std::vector<TexturePlace> texture_places(std::span<const Vec3<float>> position) {
  Vec3<float> low{1e30F, 1e30F, 1e30F}, high{-1e30F, -1e30F, -1e30F};
  for (const Vec3<float>& p : position) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3<float> side = high - low;
  const auto away = [](float from, float to) { return std::abs(from) > std::abs(to) ? -1.0F : 1.0F; };
  if (side.y >= side.x && side.y >= side.z) return texture_places(position, {0, away(low.y, high.y), 0}, {0, 0, 1});
  if (side.x >= side.z) return texture_places(position, {away(low.x, high.x), 0, 0}, {0, 0, 1});
  return texture_places(position, {0, 0, away(low.z, high.z)}, {0, 1, 0});
}

std::vector<TexturePlace> folded_places(std::span<const Vec3<float>> position) {
  std::vector<TexturePlace> places = texture_places(position);
  for (TexturePlace& place : places) place = folded(place);
  return places;
}

std::vector<AlongStencil> along_stencils(std::span<const std::uint32_t> triangle, std::span<const TexturePlace> place) {
  struct Best {
    double score = -1e300;  // how well the triangle contains the direction: negative outside it
    std::uint32_t first = 0, second = 0;
    double of_first = 0, of_second = 0;
  };
  std::vector<std::array<Best, 2>> best(place.size());  // ahead, behind
  std::vector<double> turn(place.size(), 0.0);
  for (std::size_t t = 0; t + 2 < triangle.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = triangle[t + k], b = triangle[t + (k + 1) % 3], c = triangle[t + (k + 2) % 3];
      const auto apart = [&](std::uint32_t to) {
        return std::pair{static_cast<double>(place[to].along - place[v].along),
                         std::remainder(static_cast<double>(place[to].around - place[v].around), 2.0)};
      };
      const auto [b_along, b_around] = apart(b);
      const auto [c_along, c_around] = apart(c);
      const double area = b_along * c_around - b_around * c_along;
      turn[v] += area;
      if (std::abs(area) < 1e-12) continue;
      const double of_b = c_around / area, of_c = -b_around / area;  // solves for one unit along, none around
      const double size = std::abs(of_b) + std::abs(of_c);
      for (const std::size_t way : {std::size_t{0}, std::size_t{1}}) {
        const double sign = way == 0 ? 1 : -1;
        const double score = std::min(sign * of_b, sign * of_c) / size;
        if (score <= best[v][way].score) continue;
        best[v][way] = {score, b, c, of_b, of_c};
      }
    }
  }
  std::vector<AlongStencil> stencil(place.size());
  for (std::uint32_t v = 0; v < place.size(); ++v) {
    AlongStencil& own = stencil[v];
    own.handed = (turn[v] < 0) == (place[v].around < 0) ? 1.0F : -1.0F;
    for (std::size_t way = 0; way < 2; ++way) {
      const Best& from = best[v][way];
      const bool none = from.score < -1e299;
      own.neighbour[2 * way] = none ? v : from.first;
      own.neighbour[2 * way + 1] = none ? v : from.second;
      own.weight[2 * way] = static_cast<float>(from.of_first);
      own.weight[2 * way + 1] = static_cast<float>(from.of_second);
    }
  }
  return stencil;
}

}  // namespace mobil::inline v0_3
