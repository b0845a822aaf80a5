#include "assets/fem/stiffness_terms.h"

#include <fmt/format.h>

#include <cmath>

namespace mobil {
namespace {

constexpr std::array<std::array<int, 3>, 8> corner = {
    {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}};

using Matrix3 = std::array<std::array<double, 3>, 3>;

/// Shape functions at one Gauss point: values, gradients in space, and the volume the point stands for.
struct GaussPoint {
  std::array<double, 8> value;
  std::array<std::array<double, 3>, 8> gradient;
  double volume_m3;
};

GaussPoint gauss_point(const HexahedralMesh& mesh, const Hexahedron& h, std::size_t point) {
  const double g = 1 / std::sqrt(3.0);
  const double xi[3] = {corner[point][0] * g, corner[point][1] * g, corner[point][2] * g};
  GaussPoint q{};
  double local[8][3];
  Matrix3 jacobian{};  // row: reference direction, column: space
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

using Gradient = std::array<double, 3>;

/// Adds ∫(λ·div u·div v + 2μ·ε(u):ε(v)) of shape functions with the gradients g and h, volume inside λ and μ.
void add(StencilPair& p, const Gradient& g, const Gradient& h, double lambda, double mu) {
  const double across = mu * (g[0] * h[0] + g[1] * h[1]);
  const double along = g[2] * h[2];
  p.a_xx += (lambda + mu) * g[0] * h[0] + across;
  p.a_xy += lambda * g[0] * h[1] + mu * g[1] * h[0];
  p.a_yx += lambda * g[1] * h[0] + mu * g[0] * h[1];
  p.a_yy += (lambda + mu) * g[1] * h[1] + across;
  p.a_zz += across;
  p.b_xz += lambda * g[0] * h[2] + mu * g[2] * h[0];
  p.b_yz += lambda * g[1] * h[2] + mu * g[2] * h[1];
  p.b_zx += lambda * g[2] * h[0] + mu * g[0] * h[2];
  p.b_zy += lambda * g[2] * h[1] + mu * g[1] * h[2];
  p.c_xx += mu * along;
  p.c_yy += mu * along;
  p.c_zz += (lambda + 2 * mu) * along;
}

/// The shape functions' mean gradients over an element and its volume (exact: their integrands are within the reach of
/// 2×2×2 points).
struct MeanGradient {
  std::array<Gradient, 8> gradient{};
  double volume_m3 = 0;
};

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

/// Flanagan and Belytschko's γ = h − Σ(h·xᵢ)·∂N/∂xᵢ of the four hourglass patterns: orthogonal to every linear
/// displacement, and the same however the element is stretched along the axes.
std::array<std::array<double, 8>, 4> hourglass_patterns(const HexahedralMesh& mesh, const Hexahedron& h,
                                                        const MeanGradient& mean) {
  std::array<std::array<double, 8>, 4> patterns;
  for (std::size_t p = 0; p < 4; ++p) {
    double moment[3] = {};
    for (std::size_t a = 0; a < 8; ++a) {
      const auto [x, y, z] = corner[a];
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

/// Couplings of an element's eight corners, [a][b].
using ElementTerms = std::array<std::array<StencilPair, 8>, 8>;

ElementTerms full_element(const std::array<GaussPoint, 8>& points, double lambda, double mu) {
  ElementTerms terms{};
  for (const GaussPoint& q : points) {
    for (std::size_t a = 0; a < 8; ++a) {
      for (std::size_t b = 0; b < 8; ++b) {
        add(terms[a][b], q.gradient[a], q.gradient[b], lambda * q.volume_m3, mu * q.volume_m3);
      }
    }
  }
  return terms;
}

/// The deviator at the Gauss points, the dilatation as its mean: with ε̄ = ε + ⅓(mean − tr ε)·I the energy is
/// 2μ·(ε:ε − ⅓(tr ε)²) + (λ + ⅔μ)·mean².
ElementTerms bbar_element(const std::array<GaussPoint, 8>& points, double lambda, double mu) {
  ElementTerms terms = full_element(points, -2 * mu / 3, mu);
  const MeanGradient mean = mean_gradient(points);
  const double bulk = lambda + 2 * mu / 3;
  for (std::size_t a = 0; a < 8; ++a) {
    for (std::size_t b = 0; b < 8; ++b) {
      add(terms[a][b], mean.gradient[a], mean.gradient[b], bulk * mean.volume_m3, 0);
    }
  }
  return terms;
}

ElementTerms one_point_element(const std::array<GaussPoint, 8>& points, const HexahedralMesh& mesh, const Hexahedron& h,
                               double lambda, double mu) {
  ElementTerms terms{};
  const MeanGradient mean = mean_gradient(points);
  const auto patterns = hourglass_patterns(mesh, h, mean);
  double across = 0, along = 0;  // of Σ|∇N|²
  for (const Gradient& g : mean.gradient) {
    across += g[0] * g[0] + g[1] * g[1];
    along += g[2] * g[2];
  }
  const double stiffness = hourglass_share * 4 * mu * mean.volume_m3 / 8;
  for (std::size_t a = 0; a < 8; ++a) {
    for (std::size_t b = 0; b < 8; ++b) {
      StencilPair& pair = terms[a][b];
      add(pair, mean.gradient[a], mean.gradient[b], lambda * mean.volume_m3, mu * mean.volume_m3);
      double shared = 0;
      for (const auto& pattern : patterns) shared += pattern[a] * pattern[b];
      for (double* entry : {&pair.a_xx, &pair.a_yy, &pair.a_zz}) *entry += stiffness * across * shared;
      for (double* entry : {&pair.c_xx, &pair.c_yy, &pair.c_zz}) *entry += stiffness * along * shared;
    }
  }
  return terms;
}

void accumulate(StencilPair& sum, const StencilPair& p) {
  sum.a_xx += p.a_xx, sum.a_xy += p.a_xy, sum.a_yx += p.a_yx, sum.a_yy += p.a_yy, sum.a_zz += p.a_zz;
  sum.b_xz += p.b_xz, sum.b_yz += p.b_yz, sum.b_zx += p.b_zx, sum.b_zy += p.b_zy;
  sum.c_xx += p.c_xx, sum.c_yy += p.c_yy, sum.c_zz += p.c_zz;
}

std::size_t slot_between(std::size_t a, std::size_t b) {
  const auto step = [&](std::size_t d) { return (corner[b][d] - corner[a][d]) / 2; };
  return stencil_slot(step(0), step(1), step(2));
}

}  // namespace

Result<void> check_material(const Material& m) {
  if (!(m.density_kg_m3 > 0 && m.density_kg_m3 <= 1e6)) {
    return fail(fmt::format("density {} kg/m^3 must be above 0 and at most 1e6", m.density_kg_m3));
  }
  if (!(m.young_pa > 0 && m.young_pa <= 1e12)) {
    return fail(fmt::format("Young's modulus {} Pa must be above 0 and at most 1e12", m.young_pa));
  }
  if (!(m.poisson > -1 && m.poisson <= 0.4999)) {
    return fail(fmt::format("Poisson's ratio {} must be above -1 and at most 0.4999", m.poisson));
  }
  return {};
}

Result<StiffnessTerms> assemble(const HexahedralMesh& mesh, const Material& material, Element element) {
  if (auto ok = check_material(material); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_elements(mesh); !ok) return tl::unexpected(ok.error());
  const double nu = material.poisson;
  const double lambda = material.young_pa * nu / ((1 + nu) * (1 - 2 * nu));
  const double mu = material.young_pa / (2 * (1 + nu));
  const std::size_t nodes = node_count(mesh.cells);
  StiffnessTerms terms{mesh.cells, std::vector<StencilPair>(nodes * stencil_size),
                       std::vector<double>(nodes * stencil_size), std::vector<double>(nodes)};
  for (std::uint32_t e = 0; e < element_count(mesh.cells); ++e) {
    const Hexahedron h = element_nodes(mesh.cells, e);
    std::array<GaussPoint, 8> points;
    for (std::size_t point = 0; point < 8; ++point) {
      points[point] = gauss_point(mesh, h, point);
      if (points[point].volume_m3 > 0) continue;
      return fail(fmt::format("{} is inverted inside: Jacobian {:.3g} m^3, must be above 0; move its corners apart",
                              element_label(mesh.cells, e), points[point].volume_m3));
    }
    const ElementTerms local = element == Element::full   ? full_element(points, lambda, mu)
                               : element == Element::bbar ? bbar_element(points, lambda, mu)
                                                          : one_point_element(points, mesh, h, lambda, mu);
    for (std::size_t a = 0; a < 8; ++a) {
      for (std::size_t b = 0; b < 8; ++b) {
        const std::size_t at = h[a] * stencil_size + slot_between(a, b);
        accumulate(terms.pair[at], local[a][b]);
        for (const GaussPoint& q : points) {
          terms.consistent_mass_kg[at] += material.density_kg_m3 * q.volume_m3 * q.value[a] * q.value[b];
        }
      }
      for (const GaussPoint& q : points) {
        terms.lumped_mass_kg[h[a]] += material.density_kg_m3 * q.volume_m3 * q.value[a];
      }
    }
  }
  return terms;
}

std::array<double, 9> stiffness_block(const StencilPair& p, double across, double along) {
  const double a = along, b = across, c = across * across / along;
  return {a * p.a_xx + c * p.c_xx, a * p.a_xy, b * p.b_xz, a * p.a_yx,
          a * p.a_yy + c * p.c_yy, b * p.b_yz, b * p.b_zx, b * p.b_zy,
          a * p.a_zz + c * p.c_zz};
}

}  // namespace mobil
