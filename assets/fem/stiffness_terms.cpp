#include "assets/fem/stiffness_terms.h"

#include <fmt/format.h>

#include <mobil/engine/interrupt.h>
#include "assets/fem/hexahedron_points.h"

namespace mobil::inline v0_3 {
namespace {

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

/// Takes the deviator at the Gauss points and the dilatation as its mean. With ε̄ = ε + ⅓(mean − tr ε)·I the energy is
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
  const HourglassStiffness hourglass = hourglass_stiffness(mean, mu);
  for (std::size_t a = 0; a < 8; ++a) {
    for (std::size_t b = 0; b < 8; ++b) {
      StencilPair& pair = terms[a][b];
      add(pair, mean.gradient[a], mean.gradient[b], lambda * mean.volume_m3, mu * mean.volume_m3);
      double shared = 0;
      for (const auto& pattern : patterns) shared += pattern[a] * pattern[b];
      for (double* entry : {&pair.a_xx, &pair.a_yy, &pair.a_zz}) *entry += hourglass.across * shared;
      for (double* entry : {&pair.c_xx, &pair.c_yy, &pair.c_zz}) *entry += hourglass.along * shared;
    }
  }
  return terms;
}

void accumulate(StencilPair& sum, const StencilPair& p) {
  sum.a_xx += p.a_xx, sum.a_xy += p.a_xy, sum.a_yx += p.a_yx, sum.a_yy += p.a_yy, sum.a_zz += p.a_zz;
  sum.b_xz += p.b_xz, sum.b_yz += p.b_yz, sum.b_zx += p.b_zx, sum.b_zy += p.b_zy;
  sum.c_xx += p.c_xx, sum.c_yy += p.c_yy, sum.c_zz += p.c_zz;
}

}  // namespace

std::size_t slot_between_corners(std::size_t a, std::size_t b) {
  const auto step = [&](std::size_t d) { return (hexahedron_corner[b][d] - hexahedron_corner[a][d]) / 2; };
  return stencil_slot(step(0), step(1), step(2));
}

Result<void> check_material(const Material& m) {
  // Beyond these, products of a belly's quantities leave single precision.
  if (!(m.density_kg_m3 >= 1 && m.density_kg_m3 <= 1e6)) {
    return fail(fmt::format("density {} kg/m^3 must be from 1 to 1e6", m.density_kg_m3));
  }
  if (!(m.young_pa >= 1 && m.young_pa <= 1e12)) {
    return fail(fmt::format("Young's modulus {} Pa must be from 1 to 1e12", m.young_pa));
  }
  if (!(m.poisson >= -0.99 && m.poisson <= 0.4999)) {
    return fail(fmt::format("Poisson's ratio {} must be from -0.99 to 0.4999", m.poisson));
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
    check_interrupt();
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
        const std::size_t at = h[a] * stencil_size + slot_between_corners(a, b);
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

}  // namespace mobil::inline v0_3
