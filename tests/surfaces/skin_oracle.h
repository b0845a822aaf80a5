#pragma once
// Skin one vertex at a time, in plain code: reference for the kernels of systems/surfaces.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <type_traits>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/assets/surfaces/body_skin.h>
#include <mobil/components/pose.h>
#include <mobil/components/segments.h>
#include <mobil/engine/geometry.h>
#include <mobil/systems/surfaces/cover_muscles.h>

namespace mobil::skin_oracle {
using namespace geometry;

constexpr float tau = 2 * std::numbers::pi_v<float>;
constexpr std::size_t steps = 16;

inline float eased(float t) {
  t = std::clamp(t, 0.0F, 1.0F);
  return t * t * (3 - 2 * t);
}

/// Returns the angle of (x, z) from the z axis towards the x axis in turns, 0 to 1, to 10⁻⁴ turns.
inline float turn_of(float x, float z) {
  const float ax = std::abs(x), az = std::abs(z);
  const float r = std::min(ax, az) / std::max({ax, az, 1e-20F}), s = r * r;
  float angle = r * (1 + s * (-0.327622764F + s * (0.15931422F - s * 0.0464964749F)));
  if (ax > az) angle = 0.25F * tau - angle;
  if (z < 0) angle = 0.5F * tau - angle;
  return (x < 0 ? tau - angle : angle) / tau;
}

/// Returns the rotation at `share` of the shorter way from a to b.
template <class F>
Quat<F> blended(const Quat<F>& a, const Quat<F>& b, std::type_identity_t<F> share) {
  const F p = 1 - share, q = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w < 0 ? -share : share;
  const Quat<F> sum{p * a.x + q * b.x, p * a.y + q * b.y, p * a.z + q * b.z, p * a.w + q * b.w};
  const F scale = 1 / std::sqrt(sum.x * sum.x + sum.y * sum.y + sum.z * sum.z + sum.w * sum.w);
  return {scale * sum.x, scale * sum.y, scale * sum.z, scale * sum.w};
}

/// Rings of a joint, from the segment below to the segment above; shown for a bent knee:
///
///     |  above  |
///     +---------+       ring `steps` at height `high`, with the axes of the segment above
///      `         `      rings between, with blended axes
///       +---------+     ring 0 at height `low`, with the axes of the segment below
///        `  below  `
struct Bend {
  Vec3<float> centre;
  float low, high, angle;
  std::array<std::array<Vec3<float>, 3>, steps + 1> axes;

  Bend(const Pose<float>& pose, std::size_t above, std::size_t below, const SkinBend& bend, float size)
      : centre(pose.position_m[below]),
        low(-size * static_cast<float>(bend.below_m)),
        high(size * static_cast<float>(bend.above_m)) {
    const Quat<float>&upper = pose.rotation[above], &lower = pose.rotation[below];
    for (std::size_t k = 0; k <= steps; ++k)
      axes[k] = columns(blended(lower, upper, eased(static_cast<float>(k) / steps)));
    const Quat<float> joint = product(conjugate(upper), lower);
    angle = 2 * std::atan2(joint.w < 0 ? -joint.x : joint.x, std::abs(joint.w));
  }
  float height(std::size_t k) const { return low + (high - low) * static_cast<float>(k) / steps; }
  float curved(float y) const {
    const float t = (y - low) / (high - low);
    return t <= 0 || t >= 1 ? 0 : angle * 6 * t * (1 - t) / (high - low);
  }
  /// Returns a point in the axes of one ring: left, up, front.
  Vec3<float> in(std::size_t k, const Vec3<float>& p) const {
    return {dot(axes[k][0], p - centre), dot(axes[k][1], p - centre), dot(axes[k][2], p - centre)};
  }
  /// Returns a point in the first ring whose height is not below the point's.
  Vec3<float> in(const Vec3<float>& p) const {
    std::size_t k = 1;
    while (k < steps && in(k, p).y > height(k)) ++k;
    Vec3<float> at = in(k, p);
    at.y = std::clamp(at.y, low, high);
    return at;
  }
};

/// The leg in its skin's coordinates: straight along thigh and shank, turning at its joints.
class Rings {
 public:
  Rings(const BodySkin& skin, const Pose<float>& pose, float lengths, Side side)
      : Rings(skin, pose, lengths, on_side(Segment::thigh_right, side), on_side(Segment::shank_right, side),
              on_side(Segment::foot_right, side)) {
    out_ = side == Side::right ? 1.0F : -1.0F;
  }

  struct Place {
    float along, round, radius;  // stations, angles, m
  };
  Place place(const Vec3<float>& p) const {
    const Vec3<float> high = knee_.in(steps, p), low = knee_.in(std::size_t{0}, p);
    const auto over_knee = [&](float y) { return y > 0 ? 1 - y / thigh_m_ : 1 - y / shank_m_; };
    const auto square = [](const Vec3<float>& at) { return at.x * at.x + at.z * at.z; };
    if (high.y >= knee_.high && !(low.y <= knee_.low && square(low) < square(high))) {
      if (high.y <= thigh_m_ + hip_.low) return place(high, over_knee(high.y));
      const Vec3<float> at = hip_.in(p);
      return place(at, -at.y / thigh_m_);
    }
    if (low.y > knee_.low) {
      const Vec3<float> at = knee_.in(p);
      return place(at, over_knee(at.y));
    }
    if (low.y >= ankle_.high - shank_m_ || low.z <= 0) return place(low, over_knee(low.y));
    const Vec3<float> at = ankle_.in(p);
    return place(at, 2 - at.y / shank_m_);
  }

  /// Returns the curvature of a bend's hollow at a station and an angle, rad/m; below 0 on its outer side.
  float hollow(std::size_t station, std::size_t angle) const {
    return -curved(station) * std::cos(tau * static_cast<float>(angle) / leg_angles);
  }
  /// Returns the distance from the line up to which a bent joint has room for skin, m; large elsewhere.
  float room(std::size_t station, std::size_t angle) const {
    const float in = hollow(station, angle);
    return in > 0.05F && std::abs(curved(station)) > 0.1F ? 0.92F / in : 1;
  }

 private:
  float curved(std::size_t station) const {
    constexpr auto first = static_cast<float>(first_leg_s), last = static_cast<float>(last_leg_s);
    const float s = first + (last - first) * static_cast<float>(station) / (leg_stations - 1);
    const float y = s < 1 ? (1 - s) * thigh_m_ : (1 - s) * shank_m_;
    return (knee_.angle > 0 ? knee_.curved(y) : 0) + hip_.curved(-s * thigh_m_);
  }
  Rings(const BodySkin& skin, const Pose<float>& pose, float lengths, Segment thigh, Segment shank, Segment foot)
      : hip_(pose, index(Segment::pelvis), index(thigh), hip_bend, lengths * size_of(skin)),
        knee_(pose, index(thigh), index(shank), knee_bend, lengths * size_of(skin)),
        ankle_(pose, index(shank), index(foot), ankle_bend, lengths * size_of(skin)) {
    const auto y = [&](Segment s) { return skin.standing.position_m[index(s)].y; };
    thigh_m_ = lengths * (y(thigh) - y(shank));
    shank_m_ = lengths * (y(shank) - y(foot));
  }
  static float size_of(const BodySkin& skin) {
    return skin.standing.position_m[index(Segment::pelvis)].y / static_cast<float>(1.75 * fraction::hip_height);
  }
  Place place(const Vec3<float>& at, float s) const {
    constexpr auto first = static_cast<float>(first_leg_s), last = static_cast<float>(last_leg_s);
    const float x = out_ * at.x;
    return {(s - first) / (last - first) * (leg_stations - 1), turn_of(x, at.z) * leg_angles,
            std::sqrt(x * x + at.z * at.z)};
  }

  Bend hip_, knee_, ankle_;
  float thigh_m_, shank_m_, out_ = 1;
};

/// Moves each point slightly towards the mean of its four neighbours.
inline void smooth(std::array<float, leg_grid_points>& grid, int rounds) {
  std::array<float, leg_grid_points> next;
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < leg_stations; ++i) {
      const float* here = &grid[i * leg_angles];
      const float* above = &grid[(i == 0 ? 0 : i - 1) * leg_angles];
      const float* below = &grid[std::min(i + 1, leg_stations - 1) * leg_angles];
      for (std::size_t j = 0; j < leg_angles; ++j) {
        next[i * leg_angles + j] = 0.5F * here[j] + 0.125F * (above[j] + below[j] + here[(j + 1) % leg_angles] +
                                                              here[(j + leg_angles - 1) % leg_angles]);
      }
    }
    grid = next;
  }
}

/// Returns the larger value, rounded where they differ by less than w (C¹).
inline float rounded_max(float a, float b, float w) {
  const float d = a - b;
  if (d >= w) return a;
  if (d <= -w) return b;
  return b + (d + w) * (d + w) / (4 * w);
}

/// Returns the maximum of each point and its eight neighbours.
inline std::array<float, leg_grid_points> spread(const std::array<float, leg_grid_points>& grid) {
  std::array<float, leg_grid_points> wide{};
  for (std::size_t i = 0; i < leg_stations; ++i) {
    for (std::size_t j = 0; j < leg_angles; ++j) {
      float most = 0;
      for (std::size_t a = i == 0 ? 0 : i - 1; a <= std::min(i + 1, leg_stations - 1); ++a) {
        for (const std::size_t b : {j, (j + 1) % leg_angles, (j + leg_angles - 1) % leg_angles})
          most = std::max(most, grid[a * leg_angles + b]);
      }
      wide[i * leg_angles + j] = most;
    }
  }
  return wide;
}

inline void cover(const BodySkin& skin, const Pose<float>& pose, float lengths, Side side,
                  std::span<const Vec3<float>> muscles, std::array<float, leg_grid_points>& lift_m) {
  const Rings rings(skin, pose, lengths, side);
  // Largest extent of muscles at each point. Muscles at a lateral distance count less, so passing ones cause no jump.
  constexpr float beside_m = 0.004F;
  std::array<float, leg_grid_points> reach{};
  for (const Vec3<float>& p : muscles) {
    const Rings::Place at = rings.place(p);
    if (!(at.along >= 0 && at.along <= leg_stations - 1)) continue;  // also excludes NaN
    const auto i = static_cast<std::size_t>(at.along);
    const auto j = static_cast<std::size_t>(at.round);
    for (std::size_t a = i; a <= std::min(i + 1, leg_stations - 1); ++a) {
      for (std::size_t b = j; b <= j + 1; ++b) {
        const float u = at.along - static_cast<float>(a), v = at.round - static_cast<float>(b);
        float& most = reach[a * leg_angles + b % leg_angles];
        most = std::max(most, at.radius - beside_m * (u * u + v * v));
      }
    }
  }
  constexpr float round_m = 0.004F, thin_m = 0.004F, min_m = 0.0005F;
  const LegGrid& grid = skin.leg;
  // Relative to the skin without muscles.
  std::array<float, leg_grid_points> excess, floor;
  for (std::size_t n = 0; n < leg_grid_points; ++n) {
    const float base = lengths * grid.base[n], fat = lengths * grid.fat[n];
    const float least = min_m + 0.0008F * std::max(0.0F, rings.hollow(n / leg_angles, n % leg_angles));
    excess[n] = reach[n] > 0 ? rounded_max(base, reach[n] + fat, round_m) - base : 0;
    floor[n] = reach[n] > 0 ? reach[n] + 0.5F * std::min(fat, thin_m) + least - base : -base;
  }
  smooth(excess, 4);
  for (int round = 0; round < 3; ++round) {
    std::array<float, leg_grid_points> lacking;
    for (std::size_t n = 0; n < leg_grid_points; ++n) lacking[n] = std::max(0.0F, floor[n] - excess[n]);
    lacking = spread(lacking);
    smooth(lacking, 3);
    for (std::size_t n = 0; n < leg_grid_points; ++n) excess[n] += lacking[n];
  }
  for (std::size_t n = 0; n < leg_grid_points; ++n) {
    float h = lengths * grid.base[n] + std::max(excess[n], floor[n]);
    const float room = rings.room(n / leg_angles, n % leg_angles), most = 0.8F * room;
    if (h > most) {
      const float beyond = (h - most) / (0.2F * room);
      h = most + 0.2F * room * beyond / (1 + beyond);
    }
    // In units of the skin at rest, which `lengths` scales.
    lift_m[n] = h / lengths - grid.base[n];
  }
}

struct RestPoint {
  Vec3<float> place, normal;
};

/// Returns a vertex at rest, moved away from its leg's line. Its normal tilts with the slope of the displacement.
inline RestPoint lifted(const BodySkin& skin, const SkinCover& cover, const LegPlace& leg, const RestPoint& rest) {
  const std::size_t side = rest.place.x > 0 ? Side::left : Side::right;
  const std::array<float, leg_grid_points>& grid = cover.lift_m[side];
  const auto i = static_cast<std::size_t>(leg.along), j = static_cast<std::size_t>(leg.round) % leg_angles;
  const std::size_t k = (j + 1) % leg_angles;
  const float u = leg.along - static_cast<float>(i), v = leg.round - std::floor(leg.round);
  const float *row = &grid[i * leg_angles], *next = row + leg_angles;
  const float above = (1 - v) * row[j] + v * row[k], below = (1 - v) * next[j] + v * next[k];
  const float lift = leg.amount * ((1 - u) * above + u * below);
  const float a_station = leg.amount * (below - above);
  const float an_angle = leg.amount * ((1 - u) * (row[k] - row[j]) + u * (next[k] - next[j]));

  const auto at = [&](Segment s) { return skin.standing.position_m[index(on_side(s, side))]; };
  const Vec3<float> hip = at(Segment::thigh_right), knee = at(Segment::shank_right);
  const float x = rest.place.x - hip.x, z = rest.place.z - hip.z, away = std::sqrt(x * x + z * z);
  if (away < 0.01F) return rest;
  constexpr float stations = (leg_stations - 1) / static_cast<float>(last_leg_s - first_leg_s);
  const float down = stations / (rest.place.y > knee.y ? hip.y - knee.y : knee.y - at(Segment::foot_right).y);
  const float turn = an_angle * leg_angles / (2 * std::numbers::pi_v<float> * away);
  const float out = side == Side::right ? 1.0F : -1.0F;  // angles increase towards the inner side
  const Vec3<float> normal{rest.normal.x - turn * out * z / away, rest.normal.y + a_station * down,
                           rest.normal.z + turn * out * x / away};
  return {{rest.place.x + lift * x / away, rest.place.y, rest.place.z + lift * z / away}, normal};
}

/// Returns each vertex's position and unit normal. Frames and their mean are in double precision.
inline std::vector<std::array<Vec3<double>, 2>> place(const BodySkin& skin, const Pose<float>& pose,
                                                      const SkinCover* cover) {
  const SkinMesh& mesh = skin_mesh(skin.sex, skin.detail);
  const auto rotation = [&](std::uint8_t s) {
    const Quat<double> own = to_double(pose.rotation[segment_of(s)]);
    if (s < segment_count) return own;
    // the forearm without its rotation about its own length
    const Quat<double> arm = to_double(pose.rotation[index(on_side(Segment::upper_arm_right, s - segment_count))]);
    const Quat<double> elbow = product(conjugate(arm), own);
    const double n = std::sqrt(elbow.y * elbow.y + elbow.w * elbow.w);
    return product(own, conjugate(Quat<double>{0, elbow.y / n, 0, elbow.w / n}));
  };
  std::vector<std::array<Vec3<double>, 2>> all;
  for (std::size_t v = 0; v < mesh.vertex.size(); ++v) {
    RestPoint rest{skin.rest[v], skin.normal[v]};
    if (cover != nullptr && mesh.leg[v].amount > 0) rest = lifted(skin, *cover, mesh.leg[v], rest);
    Vec3<double> at{0, 0, 0}, normal{0, 0, 0};
    for (std::size_t k = 0; k < SkinVertex::max_frames; ++k) {
      const auto weight = static_cast<double>(mesh.vertex[v].weight[k]);
      if (weight == 0) continue;
      const SkinFrame& frame = mesh.frame[mesh.vertex[v].frame[k]];
      const std::size_t bone = segment_of(frame.to);
      const Quat<double> q = blended(rotation(frame.from), rotation(frame.to), static_cast<double>(frame.turn));
      at = at + weight * (to_double(pose.position_m[bone]) +
                          rotated(q, to_double(rest.place) - to_double(skin.standing.position_m[bone])));
      normal = normal + weight * rotated(q, to_double(rest.normal));
    }
    all.push_back({at, normalised(normal)});
  }
  return all;
}

}  // namespace mobil::skin_oracle
