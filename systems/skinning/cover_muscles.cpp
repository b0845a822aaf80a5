#include "systems/skinning/cover_muscles.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "assets/body/anthropometry.h"
#include "components/segments.h"
#include "engine/geometry.h"

namespace mobil {
namespace {

using namespace geometry;

constexpr float tau = 2 * std::numbers::pi_v<float>;
constexpr std::size_t bend_steps = 16;

float eased(float t) {
  t = std::clamp(t, 0.0F, 1.0F);
  return t * t * (3 - 2 * t);
}

/// The angle of (x, z) from the z axis towards the x axis in turns, 0 to 1, to 10⁻⁴ of one.
float turn_of(float x, float z) {
  const float ax = std::abs(x), az = std::abs(z);
  const float r = std::min(ax, az) / std::max({ax, az, 1e-20F}), s = r * r;
  float angle = r * (1 + s * (-0.327622764F + s * (0.15931422F - s * 0.0464964749F)));
  if (ax > az) angle = 0.25F * tau - angle;
  if (z < 0) angle = 0.5F * tau - angle;
  return (x < 0 ? tau - angle : angle) / tau;
}

/// The leg as its skin has it: straight above and below the knee, turning evenly between.
class LegRings {
 public:
  LegRings(const BodySkin& skin, const Pose<float>& pose, float lengths, Side side) {
    const std::size_t thigh = index(on_side(Segment::thigh_right, side)),
                      shank = index(on_side(Segment::shank_right, side)),
                      foot = index(on_side(Segment::foot_right, side));
    knee_ = pose.position_m[shank];
    thigh_m_ = lengths * (skin.standing.position_m[thigh].y - skin.standing.position_m[shank].y);
    shank_m_ = lengths * (skin.standing.position_m[shank].y - skin.standing.position_m[foot].y);
    bend_ = static_cast<float>(knee_bend_m / 1.75) * lengths * height_m(skin);
    out_ = side == Side::right ? 1.0F : -1.0F;
    for (std::size_t k = 0; k <= bend_steps; ++k)
      axes_[k] = columns(blended(pose.rotation[shank], pose.rotation[thigh], eased(part(k))));
    const Quat<float> relative = product(conjugate(pose.rotation[thigh]), pose.rotation[shank]);
    angle_ = std::max(0.0F, 2 * std::atan2(relative.w < 0 ? -relative.x : relative.x, std::abs(relative.w)));
  }

  struct Place {
    float along, round, radius;  // stations, angles, m
  };
  Place place(const Vec3<float>& p) const {
    const Vec3<float> from = p - knee_;
    const float high = dot(axes_[bend_steps][1], from), low = dot(axes_[0][1], from);
    std::size_t ring = 0;
    float y = low;
    if (high >= bend_) {
      ring = bend_steps;
      y = high;
    } else if (low > -bend_) {
      // The ring that the point lies in: where its height over the knee is the ring's own.
      ring = 1;
      while (ring < bend_steps && dot(axes_[ring][1], from) > height(ring)) ++ring;
      y = std::clamp(dot(axes_[ring][1], from), -bend_, bend_);
    }
    const float x = out_ * dot(axes_[ring][0], from), z = dot(axes_[ring][2], from);
    const float s = y > 0 ? 1 - y / thigh_m_ : 1 - y / shank_m_;
    constexpr auto first = static_cast<float>(LegProfile::first_s), last = static_cast<float>(LegProfile::last_s);
    return {(s - first) / (last - first) * (leg_stations - 1), turn_of(x, z) * leg_angles, std::sqrt(x * x + z * z)};
  }

  /// How far from the line a bent knee has room for skin, m, at a station and an angle; large elsewhere.
  float room(std::size_t station, std::size_t angle) const {
    constexpr auto first = static_cast<float>(LegProfile::first_s), last = static_cast<float>(LegProfile::last_s);
    const float s = first + (last - first) * static_cast<float>(station) / (leg_stations - 1);
    const float y = s < 1 ? (1 - s) * thigh_m_ : (1 - s) * shank_m_, t = 0.5F * (y / bend_ + 1);
    const float inner = -std::cos(tau * static_cast<float>(angle) / leg_angles);
    const float curved = t <= 0 || t >= 1 ? 0 : angle_ * 6 * t * (1 - t) / (2 * bend_);
    return inner > 0.05F && curved > 0.1F ? 0.92F / (curved * inner) : 1;
  }

 private:
  static float height_m(const BodySkin& skin) {
    return skin.standing.position_m[index(Segment::pelvis)].y / static_cast<float>(fraction::hip_height);
  }
  static float part(std::size_t k) { return static_cast<float>(k) / bend_steps; }
  float height(std::size_t k) const { return bend_ * (2 * part(k) - 1); }

  Vec3<float> knee_;
  float thigh_m_, shank_m_, bend_, out_, angle_;
  std::array<std::array<Vec3<float>, 3>, bend_steps + 1> axes_;  // from the shank's to the thigh's
};

/// Each point a little nearer to the mean of its four neighbours.
void smooth(std::array<float, leg_grid_points>& grid, int rounds) {
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

/// The larger, rounded over where they differ by less than w (C¹).
float rounded_max(float a, float b, float w) {
  const float d = a - b;
  if (d >= w) return a;
  if (d <= -w) return b;
  return b + (d + w) * (d + w) / (4 * w);
}

/// The larger of each point and its eight neighbours.
std::array<float, leg_grid_points> spread(const std::array<float, leg_grid_points>& grid) {
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

}  // namespace

void cover_muscles(const BodySkin& skin, const Pose<float>& pose, float lengths, Side side,
                   std::span<const Vec3<float>> muscles, std::array<float, leg_grid_points>& lift_m) {
  const LegRings rings(skin, pose, lengths, side);
  // How far muscles reach at each point; those beside it count for less, so that nothing jumps as they pass.
  constexpr float beside_m = 0.004F;
  std::array<float, leg_grid_points> reach{};
  for (const Vec3<float>& p : muscles) {
    const LegRings::Place at = rings.place(p);
    if (!(at.along >= 0 && at.along <= leg_stations - 1)) continue;  // nor NaN
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
  constexpr float round_m = 0.004F, thin_m = 0.004F, least_m = 0.0005F;
  const LegGrid& grid = skin.leg;
  // Over the skin without muscles.
  std::array<float, leg_grid_points> excess, floor;
  for (std::size_t n = 0; n < leg_grid_points; ++n) {
    const float base = lengths * grid.base[n], fat = lengths * grid.fat[n];
    excess[n] = reach[n] > 0 ? rounded_max(base, reach[n] + fat, round_m) - base : 0;
    floor[n] = reach[n] > 0 ? reach[n] + 0.5F * std::min(fat, thin_m) + least_m - base : -base;
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
    // As of the skin at rest, which `lengths` makes larger.
    lift_m[n] = h / lengths - grid.base[n];
  }
}

}  // namespace mobil
