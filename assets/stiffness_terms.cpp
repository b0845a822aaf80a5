#include "assets/stiffness_terms.h"

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

void add(StencilPair& p, const std::array<double, 3>& g, const std::array<double, 3>& h, double lambda, double mu) {
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

Result<StiffnessTerms> assemble(const HexahedralMesh& mesh, const Material& material) {
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
    for (std::size_t point = 0; point < 8; ++point) {
      const GaussPoint q = gauss_point(mesh, h, point);
      if (!(q.volume_m3 > 0)) {
        return fail(fmt::format("element {} is inverted inside (Jacobian {:.3g} m^3)", e, q.volume_m3));
      }
      for (std::size_t a = 0; a < 8; ++a) {
        terms.lumped_mass_kg[h[a]] += material.density_kg_m3 * q.volume_m3 * q.value[a];
        for (std::size_t b = 0; b < 8; ++b) {
          const std::size_t at = h[a] * stencil_size + slot_between(a, b);
          add(terms.pair[at], q.gradient[a], q.gradient[b], lambda * q.volume_m3, mu * q.volume_m3);
          terms.consistent_mass_kg[at] += material.density_kg_m3 * q.volume_m3 * q.value[a] * q.value[b];
        }
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
