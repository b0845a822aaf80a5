#include "assets/fem/finite_kernel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "assets/fem/finite_element.h"
#include "assets/fem/hexahedron_points.h"
#include "engine/exact_math.h"

namespace mobil::inline v0_3 {
namespace {

/// Returns the direction of the element's middle line from its lower face to its upper.
Gradient direction_along(const HexahedralMesh& mesh, const Hexahedron& h) {
  Gradient along{};
  for (std::size_t a = 0; a < 8; ++a) {
    const double sign = hexahedron_corner[a][2];
    const Vec3<double>& at = mesh.node[h[a]];
    along[0] += sign * at.x, along[1] += sign * at.y, along[2] += sign * at.z;
  }
  const double length = std::sqrt(along[0] * along[0] + along[1] * along[1] + along[2] * along[2]);
  for (double& x : along) x /= length;
  return along;
}

/// Adds `across`·(s, s, s) and `along`·(s, s, s) to the couplings of equal directions.
void add_alike(StencilPair& pair, double across, double along) {
  for (double* entry : {&pair.a_xx, &pair.a_yy, &pair.a_zz}) *entry += across;
  for (double* entry : {&pair.c_xx, &pair.c_yy, &pair.c_zz}) *entry += along;
}

/// Adds c·(div u)(div v) of shape functions with the gradients g and h.
void add_dilatation(StencilPair& p, const Gradient& g, const Gradient& h, double c) {
  p.a_xx += c * g[0] * h[0], p.a_xy += c * g[0] * h[1];
  p.a_yx += c * g[1] * h[0], p.a_yy += c * g[1] * h[1];
  p.b_xz += c * g[0] * h[2], p.b_yz += c * g[1] * h[2];
  p.b_zx += c * g[2] * h[0], p.b_zy += c * g[2] * h[1];
  p.c_zz += c * g[2] * h[2];
}

MeanGradient mean_of(const HexahedralMesh& mesh, const Hexahedron& h) {
  std::array<GaussPoint, 8> points;
  for (std::size_t point = 0; point < 8; ++point) points[point] = gauss_point(mesh, h, point);
  return mean_gradient(points);
}

/// Checks that sections across the muscle are flat, as in all meshes here. The kernel omits the terms of slanted ones.
Result<void> check_sections(const HexahedralMesh& mesh) {
  const std::uint32_t nodes = plane_nodes(mesh.cells);
  const double flat_m = 1e-9 * (mesh.node.back().z - mesh.node.front().z);
  for (std::uint32_t n = 0; n < mesh.node.size(); ++n) {
    const std::uint32_t plane = n / nodes;
    if (std::fabs(mesh.node[n].z - mesh.node[std::size_t{plane} * nodes].z) <= flat_m) continue;
    return fail(
        fmt::format("section {} of the mesh is not flat: at finite strain all nodes of a section need one z", plane));
  }
  return {};
}

/// Sets the factors of the sums over the corners, times ±1, that make up gradients and hourglass patterns.
void set_sums(const HexahedralMesh& mesh, const Hexahedron& h, const MeanGradient& mean, FiniteKernelElement& to) {
  const auto factor = [&](std::size_t c, auto sign) {
    double sum = 0;
    for (std::size_t a = 0; a < 8; ++a) sum += mean.gradient[a][c] * sign(hexahedron_corner[a]) / 8;
    return static_cast<float>(sum);
  };
  using Corner = const std::array<int, 3>&;
  const auto xi = [](Corner at) { return at[0]; };
  const auto eta = [](Corner at) { return at[1]; };
  const auto zeta = [](Corner at) { return at[2]; };
  const auto eta_zeta = [](Corner at) { return at[1] * at[2]; };
  const auto xi_zeta = [](Corner at) { return at[0] * at[2]; };
  const auto xi_eta = [](Corner at) { return at[0] * at[1]; };
  const auto all = [](Corner at) { return at[0] * at[1] * at[2]; };
  for (std::size_t c = 0; c < 2; ++c)
    to.across[c] = {factor(c, xi), factor(c, eta), factor(c, eta_zeta), factor(c, xi_zeta)};
  to.along = {factor(2, xi),      factor(2, eta),  factor(2, eta_zeta),
              factor(2, xi_zeta), factor(2, zeta), factor(2, xi_eta)};
  const auto part = [&](auto sign) {
    double x = 0, y = 0;
    for (std::size_t a = 0; a < 8; ++a) {
      x += sign(hexahedron_corner[a]) * mesh.node[h[a]].x;
      y += sign(hexahedron_corner[a]) * mesh.node[h[a]].y;
    }
    return std::array{static_cast<float>(x), static_cast<float>(y)};
  };
  to.straight = {part(eta_zeta), part(xi_zeta), part(xi_eta), part(all)};
}

/// Returns a bound on slope and on tension over stretch of fibres that are not crowded.
double stiffest_fibre_pa(const FiniteTissue& tissue) {
  const double passive =
      tissue.passive_pa * exact::exp(max_passive_exponent) * 4 / 0.6 * tissue.rest_over_optimal / (exact::exp(4) - 1);
  return tissue.active_pa * tissue.force_slope + passive;
}

}  // namespace

FiniteTissue stepped_tissue(const Material& material) {
  const FiniteTissue usual;
  FiniteTissue tissue;
  tissue.shear_pa = material.young_pa / (2 * (1 + material.poisson));
  tissue.bulk_over_shear = stepped_bulk_over_shear;
  tissue.active_pa = usual.active_pa / usual.shear_pa * tissue.shear_pa;
  tissue.passive_pa = usual.passive_pa / usual.shear_pa * tissue.shear_pa;
  tissue.density_kg_m3 = material.density_kg_m3;
  return tissue;
}

Result<FiniteKernel> make_finite_kernel(const HexahedralMesh& mesh, const StiffnessTerms& linear,
                                        const Material& material) {
  if (auto ok = check_material(material); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_elements(mesh); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_sections(mesh); !ok) return tl::unexpected(ok.error());
  FiniteKernel kernel;
  kernel.tissue = stepped_tissue(material);
  kernel.length_m = mesh.node.back().z - mesh.node.front().z;
  const std::vector<double> areas = section_areas(mesh);
  const double widest = *std::max_element(areas.begin(), areas.end());
  const std::uint32_t layer_elements = mesh.cells[0] * mesh.cells[1];
  for (std::uint32_t e = 0; e < element_count(mesh.cells); ++e) {
    const Hexahedron h = element_nodes(mesh.cells, e);
    const std::uint32_t layer = e / layer_elements;
    const MeanGradient mean = mean_of(mesh, h);
    const HourglassStiffness hourglass = hourglass_stiffness(mean, kernel.tissue.shear_pa);
    const Gradient fibre = direction_along(mesh, h);
    FiniteKernelElement to;
    for (std::size_t a = 0; a < 8; ++a) to.node[a] = h[a] - layer * plane_nodes(mesh.cells);
    set_sums(mesh, h, mean, to);
    for (std::size_t c = 0; c < 3; ++c) to.fibre[c] = static_cast<float>(fibre[c]);
    to.aside2 = static_cast<float>(fibre[0] * fibre[0] + fibre[1] * fibre[1]);
    to.straight2 = static_cast<float>(fibre[2] * fibre[2]);
    double rise = 0;
    for (std::size_t a = 4; a < 8; ++a) {
      for (std::size_t c = 0; c < 3; ++c) rise += mean.gradient[a][c] * fibre[c];
    }
    to.rise = static_cast<float>(rise);
    const double root = 0.5 * (std::sqrt(areas[layer]) + std::sqrt(areas[layer + 1]));
    const double crowding = std::min(max_crowding, widest / (root * root));
    to.volume_m3 = static_cast<float>(mean.volume_m3);
    to.fibre_volume_m3 = static_cast<float>(mean.volume_m3 * crowding);
    to.hourglass_across = static_cast<float>(hourglass.across);
    to.hourglass_along = static_cast<float>(hourglass.along);
    kernel.element.push_back(to);
  }
  const std::uint32_t nodes = plane_nodes(mesh.cells);
  for (std::uint32_t first = 0; first < node_count(mesh.cells); first += nodes) {
    double plane_kg = 0;
    for (std::uint32_t n = first; n < first + nodes; ++n) plane_kg += linear.lumped_mass_kg[n];
    for (std::uint32_t n = first; n < first + nodes; ++n)
      kernel.plane_share.push_back(static_cast<float>(linear.lumped_mass_kg[n] / plane_kg));
  }
  return kernel;
}

StiffnessTerms finite_bound(const HexahedralMesh& mesh, const FiniteKernel& kernel, const StiffnessTerms& linear,
                            const FiniteEnvelope& envelope) {
  const FiniteTissue& tissue = kernel.tissue;
  const double mu = tissue.shear_pa, kappa = mu * tissue.bulk_over_shear;
  const double delta = envelope.cofactor, share = delta / std::numbers::sqrt3;
  constexpr double two_stretches = 2.6;
  const double swelling = (1 + share) * kappa;
  const double shear =
      (1 + 1 / share) * delta * delta * kappa + two_stretches * (kappa * envelope.dilatation + mu) + mu;
  const double tension = stiffest_fibre_pa(tissue);
  StiffnessTerms bound{linear.cells, std::vector<StencilPair>(linear.pair.size()), linear.consistent_mass_kg,
                       linear.lumped_mass_kg};
  for (std::uint32_t e = 0; e < element_count(mesh.cells); ++e) {
    const Hexahedron h = element_nodes(mesh.cells, e);
    const MeanGradient mean = mean_of(mesh, h);
    const HourglassPatterns patterns = hourglass_patterns(mesh, h, mean);
    const HourglassStiffness hourglass = hourglass_stiffness(mean, mu);
    const FiniteKernelElement& own = kernel.element[e];
    const double volume = mean.volume_m3, pull = tension * static_cast<double>(own.fibre_volume_m3);
    Gradient a{};
    for (std::size_t c = 0; c < 3; ++c) a[c] = static_cast<double>(own.fibre[c]);
    const double aside = a[0] * a[0] + a[1] * a[1], straight = a[2] * a[2];
    const auto along_fibre = [&](const Gradient& g) { return g[0] * a[0] + g[1] * a[1] + g[2] * a[2]; };
    for (std::size_t i = 0; i < 8; ++i) {
      for (std::size_t j = 0; j < 8; ++j) {
        const Gradient &g = mean.gradient[i], &other = mean.gradient[j];
        StencilPair& pair = bound.pair[h[i] * stencil_size + slot_between_corners(i, j)];
        add_dilatation(pair, g, other, swelling * volume);
        double shared = 0;
        for (const auto& pattern : patterns) shared += pattern[i] * pattern[j];
        const double fibres = pull * along_fibre(g) * along_fibre(other);
        add_alike(pair,
                  shear * volume * (g[0] * other[0] + g[1] * other[1]) + hourglass.across * shared + fibres * aside,
                  shear * volume * g[2] * other[2] + hourglass.along * shared + fibres * straight);
      }
    }
  }
  return bound;
}

}  // namespace mobil::inline v0_3
