#include "assets/surfaces/figure_shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "engine/geometry.h"

namespace mobil {
namespace {

using namespace geometry;

/// A round body from `a` to `b` with half-axes (m) across and along z (front to back) at either end; rounded there.
struct Limb {
  Vec3<float> a, b;
  float across_a, deep_a, across_b, deep_b;
};

/// Rings round the line from a to b, closing smoothly at both ends.
void loft(const Limb& limb, SurfaceMesh& mesh) {
  constexpr std::uint32_t around = 12, rings = 11;
  const Vec3<float> axis = normalised(limb.b - limb.a);
  const Vec3<float> front = std::abs(axis.z) < 0.8F ? Vec3<float>{0, 0, 1} : Vec3<float>{0, 1, 0};
  const Vec3<float> side = normalised(cross(front, axis)), deep = cross(axis, side);
  const auto first = static_cast<std::uint32_t>(mesh.position.size());
  for (std::uint32_t r = 0; r < rings; ++r) {
    const float t = static_cast<float>(r) / (rings - 1);
    const float angle = std::numbers::pi_v<float> * t;
    const float round = std::pow(std::max(std::sin(angle), 1e-4F), 0.55F);
    const float along = 0.5F - 0.5F * std::cos(angle);
    const Vec3<float> centre = limb.a + along * (limb.b - limb.a);
    const float x = round * (limb.across_a + along * (limb.across_b - limb.across_a));
    const float z = round * (limb.deep_a + along * (limb.deep_b - limb.deep_a));
    for (std::uint32_t k = 0; k < around; ++k) {
      const float turn = 2 * std::numbers::pi_v<float> * static_cast<float>(k) / around;
      mesh.position.push_back(centre + (x * std::cos(turn)) * side + (z * std::sin(turn)) * deep);
      if (r + 1 == rings) continue;
      const std::uint32_t p = first + r * around + k, q = first + r * around + (k + 1) % around;
      for (const std::uint32_t v : {p, q, p + around, q, q + around, p + around}) mesh.triangle.push_back(v);
    }
  }
}

/// What a segment looks like: parts of the stature, in its own frame.
void shape(const Body& body, Segment s, SurfaceMesh& mesh) {
  using enum Segment;
  const float h = body.request.height_m;
  const Vec3<float> tip = body.tip_m[index(s)];
  const auto limb = [&](Vec3<float> a, Vec3<float> b, float across_a, float deep_a, float across_b, float deep_b) {
    loft({a, b, across_a * h, deep_a * h, across_b * h, deep_b * h}, mesh);
  };
  const auto up = [&](float x, float y, float z) { return Vec3<float>{x * h, y * h, z * h}; };
  if (s == pelvis) {
    limb(up(0, -0.045F, -0.005F), up(0, 0.105F, 0), 0.100F, 0.070F, 0.086F, 0.062F);
  } else if (s >= L5 && s <= T1) {
    const float part = static_cast<float>(index(s) - index(L5)) / static_cast<float>(index(T1) - index(L5));
    const float narrows = 4 * std::max(0.0F, part - 0.75F);  // to the neck
    const float across = 0.081F + 0.023F * std::sin(3.0F * part) - 0.030F * narrows;
    const float deep = 0.058F + 0.011F * std::sin(3.0F * part) - 0.014F * narrows;
    const Vec3<float> middle = 0.5F * tip + up(0, 0, 0.030F - 0.016F * part);
    const float half = 0.085F - 0.040F * narrows;  // far into its neighbours, so that no ribs are seen
    limb(middle - up(0, half, 0), middle + up(0, half, 0), across, deep, across, deep);
  } else if (s >= C7 && s <= C1) {
    limb(up(0, -0.016F, 0.006F), tip + up(0, 0.016F, 0.006F), 0.032F, 0.034F, 0.032F, 0.034F);
  } else if (s == head) {
    limb(up(0, -0.022F, 0.016F), tip + up(0, 0.004F, 0.010F), 0.040F, 0.050F, 0.050F, 0.062F);
  } else if (s < clavicle_right) {
    const float out = s >= thigh_left ? 1.0F : -1.0F;
    switch ((index(s) - index(thigh_right)) % 5) {
      case 0:
        return limb(up(0.004F * out, 0.030F, 0), tip + up(0, -0.020F, 0.004F), 0.054F, 0.058F, 0.035F, 0.037F);
      case 2:
        return limb(up(0, 0.022F, 0), tip + up(0, -0.016F, 0), 0.037F, 0.041F, 0.022F, 0.025F);
      case 3: {
        const Vec3<float> heel{0, body.heel_m.y + 0.022F * h, body.heel_m.z - 0.006F * h};
        const Vec3<float> ball{tip.x, body.ball_m.y + 0.020F * h, body.ball_m.z + 0.016F * h};
        return limb(heel, ball, 0.021F, 0.024F, 0.028F, 0.018F);
      }
      case 4:
        return limb(up(0, 0, -0.016F), tip + up(0, 0, 0.004F), 0.027F, 0.014F, 0.024F, 0.012F);
      default:
        return;
    }
  } else {
    switch ((index(s) - index(clavicle_right)) % 6) {
      case 0:
        return limb(up(0, -0.012F, 0), tip + up(0, 0.004F, 0), 0.036F, 0.046F, 0.034F, 0.034F);
      case 1:
        return limb(up(0, 0.024F, 0), tip + up(0, -0.014F, 0), 0.032F, 0.034F, 0.024F, 0.026F);
      case 2:
        return limb(up(0, 0.016F, 0), tip + up(0, -0.008F, 0), 0.024F, 0.025F, 0.015F, 0.017F);
      case 3:
        return limb(up(0, 0.008F, 0), tip + up(0, -0.008F, 0), 0.014F, 0.020F, 0.012F, 0.022F);
      default:
        return limb(up(0, 0.006F, 0), tip, 0.009F, 0.014F, 0.007F, 0.010F);
    }
  }
}

}  // namespace

Cloth cloth_of(Segment s) {
  using enum Segment;
  if (s == pelvis) return Cloth::trousers;
  if (s >= L5 && s <= T1) return Cloth::shirt;
  if (s >= C7 && s <= head) return Cloth::skin;
  const std::size_t leg = (index(s) - index(thigh_right)) % 5, arm = (index(s) - index(clavicle_right)) % 6;
  if (s < clavicle_right) return leg <= 2 ? Cloth::trousers : Cloth::shoes;
  return arm <= 1 ? Cloth::shirt : Cloth::skin;
}

std::vector<BoneSurface> make_figure_shapes(const Body& body) {
  std::vector<BoneSurface> all;
  for (std::size_t s = 0; s < segment_count; ++s) {
    BoneSurface surface;
    surface.segment = static_cast<Segment>(s);
    shape(body, surface.segment, surface.mesh);
    if (!surface.mesh.position.empty()) all.push_back(std::move(surface));
  }
  return all;
}

}  // namespace mobil
