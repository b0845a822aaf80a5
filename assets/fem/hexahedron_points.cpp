#include "assets/fem/hexahedron_points.h"

#include <cmath>

#include "assets/fem/stiffness_terms.h"

namespace mobil::inline v0_3 {
namespace {

using Matrix3 = std::array<std::array<double, 3>, 3>;

}  // namespace

GaussPoint gauss_point(const HexahedralMesh& mesh, const Hexahedron& h, std::size_t point) {
  const double g = 1 / std::sqrt(3.0);
  const auto& corner = hexahedron_corner;
  const double xi[3] = {corner[point][0] * g, corner[point][1] * g, corner[point][2] * g};
  GaussPoint q{};
  double local[8][3];
  Matrix3 jacobian{};  // rows are reference directions, columns are space
  for (std::size_t a = 0; a < 8; ++a) {
    double factor[3];
    for (std::size_t d = 0; d < 3; ++d) factor[d] = 0.5 * (1 + corner[a][d] * xi[d]);
    q.value[a] = factor[0] * factor[1] * factor[2];
    for (std::size_t d = 0; d < 3; ++d) {
      local[a][d] = 0.5 * corner[a][d] * factor[(d + 1) % 3] * factor[(d + 2) % 3];
      const auto& p = mesh.node[h[a]];
      jacobian[d][0] += local[a][d] * p.x;
      jacobian[d][1] += local[a][d] * p.y;
      jacobian[d][2] += local[a][d] * p.z;
    }
  }
  Matrix3 cofactor;
  for (std::size_t r = 0; r < 3; ++r) {
    const auto& u = jacobian[(r + 1) % 3];
    const auto& v = jacobian[(r + 2) % 3];
    cofactor[r] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  }
  q.volume_m3 = jacobian[0][0] * cofactor[0][0] + jacobian[0][1] * cofactor[0][1] + jacobian[0][2] * cofactor[0][2];
  for (std::size_t a = 0; a < 8; ++a) {
    for (std::size_t c = 0; c < 3; ++c) {
      q.gradient[a][c] =
          (local[a][0] * cofactor[0][c] + local[a][1] * cofactor[1][c] + local[a][2] * cofactor[2][c]) / q.volume_m3;
    }
  }
  return q;
}

MeanGradient mean_gradient(const std::array<GaussPoint, 8>& points) {
  MeanGradient mean;
  for (const GaussPoint& q : points) {
    mean.volume_m3 += q.volume_m3;
    for (std::size_t a = 0; a < 8; ++a) {
      for (std::size_t d = 0; d < 3; ++d) mean.gradient[a][d] += q.volume_m3 * q.gradient[a][d];
    }
  }
  for (auto& g : mean.gradient) {
    for (double& x : g) x /= mean.volume_m3;
  }
  return mean;
}

HourglassPatterns hourglass_patterns(const HexahedralMesh& mesh, const Hexahedron& h, const MeanGradient& mean) {
  HourglassPatterns patterns;
  for (std::size_t p = 0; p < 4; ++p) {
    double moment[3] = {};
    for (std::size_t a = 0; a < 8; ++a) {
      const auto [x, y, z] = hexahedron_corner[a];
      const int pattern[4] = {y * z, z * x, x * y, x * y * z};
      patterns[p][a] = pattern[p];
      const auto& at = mesh.node[h[a]];
      moment[0] += pattern[p] * at.x;
      moment[1] += pattern[p] * at.y;
      moment[2] += pattern[p] * at.z;
    }
    for (std::size_t a = 0; a < 8; ++a) {
      for (std::size_t d = 0; d < 3; ++d) patterns[p][a] -= moment[d] * mean.gradient[a][d];
    }
  }
  return patterns;
}

HourglassStiffness hourglass_stiffness(const MeanGradient& mean, double shear_pa) {
  double across = 0, along = 0;  // of Σ|∇N|²
  for (const Gradient& g : mean.gradient) {
    across += g[0] * g[0] + g[1] * g[1];
    along += g[2] * g[2];
  }
  const double stiffness = hourglass_share * 4 * shear_pa * mean.volume_m3 / 8;
  return {stiffness * across, stiffness * along};
}

}  // namespace mobil::inline v0_3
