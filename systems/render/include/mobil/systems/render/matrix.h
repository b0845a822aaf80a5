#pragma once
// Linear algebra for cameras and shadows.

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <mobil/components/lanes.h>
#include <mobil/engine/geometry.h>

namespace mobil::inline v0_3::capture_math {

using geometry::dot;

/// Converts degrees to radians.
inline float radians(float degrees) {
  return degrees * (std::numbers::pi_v<float> / 180);
}

/// A 4×4 matrix, column-major as in OpenGL.
using Matrix4 = std::array<float, 16>;

inline Matrix4 operator*(const Matrix4& a, const Matrix4& b) {
  Matrix4 product{};
  for (std::size_t column = 0; column < 4; ++column) {
    for (std::size_t row = 0; row < 4; ++row) {
      for (std::size_t k = 0; k < 4; ++k) product[4 * column + row] += a[4 * k + row] * b[4 * column + k];
    }
  }
  return product;
}

/// Returns the transform from the world to a frame with these orthonormal axes at `origin`.
inline Matrix4 into_frame(Vec3<float> x, Vec3<float> y, Vec3<float> z, Vec3<float> origin) {
  return {x.x, y.x, z.x, 0, x.y, y.y, z.y, 0, x.z, y.z, z.z, 0, -dot(x, origin), -dot(y, origin), -dot(z, origin), 1};
}

/// Axis-aligned box; empty until something is added.
struct Box {
  Vec3<float> low{1e30F, 1e30F, 1e30F}, high{-1e30F, -1e30F, -1e30F};

  bool empty() const { return !(low.x <= high.x && low.y <= high.y && low.z <= high.z); }
  void add(Vec3<float> p, float margin = 0) {
    low = {std::fmin(low.x, p.x - margin), std::fmin(low.y, p.y - margin), std::fmin(low.z, p.z - margin)};
    high = {std::fmax(high.x, p.x + margin), std::fmax(high.y, p.y + margin), std::fmax(high.z, p.z + margin)};
  }
  Vec3<float> corner(unsigned i) const {
    return {(i & 1U) != 0 ? high.x : low.x, (i & 2U) != 0 ? high.y : low.y, (i & 4U) != 0 ? high.z : low.z};
  }
};

}  // namespace mobil::inline v0_3::capture_math
