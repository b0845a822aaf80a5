#include "assets/fem/finite_element.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace mobil::inline v0_3 {
namespace {

constexpr std::array<std::array<int, 3>, 8> corner_sign = {
    {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}};

using Place = std::array<double, 3>;

Place cross_of(const Place& a, const Place& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot_of(const Place& a, const Place& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Shape functions and their gradients in the element's own coordinates (−1 to 1) at a Gauss point.
struct LocalPoint {
  std::array<double, 8> value;
  Corners gradient;
};

LocalPoint local_point(std::size_t point) {
  const double g = 1 / std::sqrt(3.0);
  LocalPoint p{};
  for (std::size_t a = 0; a < 8; ++a) {
    double factor[3];
    for (std::size_t d = 0; d < 3; ++d) factor[d] = 0.5 * (1 + corner_sign[a][d] * corner_sign[point][d] * g);
    p.value[a] = factor[0] * factor[1] * factor[2];
    for (std::size_t d = 0; d < 3; ++d) {
      p.gradient[a][d] = 0.5 * corner_sign[a][d] * factor[(d + 1) % 3] * factor[(d + 2) % 3];
    }
  }
  return p;
}

/// The volume is Σ over a < b < c of T_abc·det(x_a, x_b, x_c), T antisymmetric. Stored for each pair a > b are the
/// corners c with a T that is not 0.
struct VolumeTerms {
  struct Term {
    std::size_t corner;
    double factor;
  };
  struct Pair {
    std::size_t terms = 0;
    std::array<Term, 6> term{};
  };
  std::array<Pair, 36> pair{};

  VolumeTerms() {
    std::array<LocalPoint, 8> points;
    for (std::size_t q = 0; q < 8; ++q) points[q] = local_point(q);
    for (std::size_t a = 0; a < 8; ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        Pair& into = pair[packed_pair(a, b)];
        for (std::size_t c = 0; c < 8; ++c) {
          if (c == a || c == b) continue;
          double sum = 0;
          for (const LocalPoint& p : points) sum += dot_of(p.gradient[a], cross_of(p.gradient[b], p.gradient[c]));
          if (std::abs(sum) > 1e-12) into.term[into.terms++] = {c, sum};
        }
      }
    }
  }
};
const VolumeTerms& volume_terms() {
  static const VolumeTerms terms;
  return terms;
}

/// The derivative of the volume's gradient at corner a over corner b is w ↦ −w×, w = Σ_c T_abc·x_c.
using PairVectors = std::array<Place, 36>;

double volume_gradient(const Corners& at, PairVectors& w, Corners& gradient) {
  gradient = {};
  const VolumeTerms& terms = volume_terms();
  for (std::size_t a = 0; a < 8; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const auto& pair = terms.pair[packed_pair(a, b)];
      Place sum{};
      for (std::size_t t = 0; t < pair.terms; ++t) {
        const Place& x = at[pair.term[t].corner];
        for (std::size_t d = 0; d < 3; ++d) sum[d] += pair.term[t].factor * x[d];
      }
      w[packed_pair(a, b)] = sum;
      const Place on_a = cross_of(at[b], sum), on_b = cross_of(at[a], sum);
      for (std::size_t d = 0; d < 3; ++d) {
        gradient[a][d] += 0.5 * on_a[d];
        gradient[b][d] -= 0.5 * on_b[d];
      }
    }
  }
  double volume = 0;
  for (std::size_t a = 0; a < 8; ++a) volume += dot_of(at[a], gradient[a]) / 3;
  return volume;
}

}  // namespace

double hexahedron_volume(const Corners& at_m, Corners& gradient_m2) {
  PairVectors w;
  return volume_gradient(at_m, w, gradient_m2);
}

std::vector<double> section_areas(const HexahedralMesh& mesh, const std::vector<double>& displacement_m) {
  const auto [nx, ny, nz] = mesh.cells;
  const auto at = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const std::size_t n = node_index(mesh.cells, i, j, k);
    Place p = {mesh.node[n].x, mesh.node[n].y, 0};
    if (!displacement_m.empty()) p[0] += displacement_m[3 * n], p[1] += displacement_m[3 * n + 1];
    return p;
  };
  std::vector<double> areas(nz + 1);
  for (std::uint32_t k = 0; k <= nz; ++k) {
    for (std::uint32_t j = 0; j < ny; ++j) {
      for (std::uint32_t i = 0; i < nx; ++i) {
        const Place a = at(i, j, k), b = at(i + 1, j, k), c = at(i + 1, j + 1, k), d = at(i, j + 1, k);
        areas[k] += 0.5 * ((c[0] - a[0]) * (d[1] - b[1]) - (c[1] - a[1]) * (d[0] - b[0]));
      }
    }
  }
  return areas;
}

Result<std::vector<FiniteElement>> finite_elements(const HexahedralMesh& mesh, const FiniteTissue& tissue) {
  if (auto ok = check_elements(mesh); !ok) return tl::unexpected(ok.error());
  const std::vector<double> areas = section_areas(mesh);
  const double widest = *std::max_element(areas.begin(), areas.end());
  std::vector<FiniteElement> elements(element_count(mesh.cells));
  for (std::uint32_t e = 0; e < elements.size(); ++e) {
    FiniteElement& element = elements[e];
    element.node = element_nodes(mesh.cells, e);
    const std::size_t layer = e / (mesh.cells[0] * mesh.cells[1]);
    for (std::size_t q = 0; q < 8; ++q) {
      const LocalPoint p = local_point(q);
      Corners jacobian{};  // first three rows are directions in the element, columns are space
      for (std::size_t a = 0; a < 8; ++a) {
        const auto& x = mesh.node[element.node[a]];
        for (std::size_t d = 0; d < 3; ++d) {
          jacobian[d][0] += p.gradient[a][d] * x.x;
          jacobian[d][1] += p.gradient[a][d] * x.y;
          jacobian[d][2] += p.gradient[a][d] * x.z;
        }
      }
      Corners cofactor{};
      for (std::size_t d = 0; d < 3; ++d) cofactor[d] = cross_of(jacobian[(d + 1) % 3], jacobian[(d + 2) % 3]);
      const double volume = dot_of(jacobian[0], cofactor[0]);
      if (!(volume > 0)) {
        return fail(fmt::format("{} is inverted inside: Jacobian {:.3g} m^3, must be above 0; move its corners apart",
                                element_label(mesh.cells, e), volume));
      }
      Corners gradient{};
      for (std::size_t a = 0; a < 8; ++a) {
        for (std::size_t c = 0; c < 3; ++c) {
          for (std::size_t d = 0; d < 3; ++d) gradient[a][c] += p.gradient[a][d] * cofactor[d][c] / volume;
        }
      }
      const double part = 0.5 * (1 + corner_sign[q][2] / std::sqrt(3.0));
      const double root = (1 - part) * std::sqrt(areas[layer]) + part * std::sqrt(areas[layer + 1]);
      element.fibre_volume_m3[q] = volume * std::min(max_crowding, widest / (root * root));
      element.volume_m3 += volume;
      const double along = std::sqrt(dot_of(jacobian[2], jacobian[2]));
      for (std::size_t a = 0; a < 8; ++a) {
        element.fibre[q][a] = dot_of(gradient[a], jacobian[2]) / along;
        for (std::size_t b = 0; b <= a; ++b) {
          element.stretch[packed_pair(a, b)] += volume * dot_of(gradient[a], gradient[b]);
        }
        for (std::size_t b = 0; b < 8; ++b) {
          element.mass_kg[a][b] += tissue.density_kg_m3 * volume * p.value[a] * p.value[b];
        }
      }
    }
  }
  return elements;
}

void element_force(const FiniteElement& element, const FiniteTissue& tissue, const Activity& activity,
                   const Corners& at_m, Corners& force_n, ElementTangent* tangent) {
  PairVectors w;
  Corners swelling;
  const double dilatation = volume_gradient(at_m, w, swelling) / element.volume_m3 - 1;
  const double bulk = tissue.shear_pa * tissue.bulk_over_shear;
  const double pressure = bulk * dilatation - tissue.shear_pa;
  for (std::size_t a = 0; a < 8; ++a) {
    Place sum{};
    for (std::size_t b = 0; b < 8; ++b) {
      const double s = tissue.shear_pa * element.stretch[packed_pair(a, b)];
      for (std::size_t d = 0; d < 3; ++d) sum[d] += s * at_m[b][d];
    }
    for (std::size_t d = 0; d < 3; ++d) force_n[a][d] = sum[d] + pressure * swelling[a][d];
  }
  if (tangent != nullptr) {
    const double stiffness = bulk / element.volume_m3;
    for (std::size_t a = 0; a < 8; ++a) {
      for (std::size_t b = 0; b <= a; ++b) {
        auto& block = (*tangent)[packed_pair(a, b)];
        for (std::size_t r = 0; r < 3; ++r) {
          for (std::size_t c = 0; c < 3; ++c) block[3 * r + c] = stiffness * swelling[a][r] * swelling[b][c];
        }
        const double s = tissue.shear_pa * element.stretch[packed_pair(a, b)];
        block[0] += s, block[4] += s, block[8] += s;
        if (a == b) continue;
        const Place& v = w[packed_pair(a, b)];
        block[1] += pressure * v[2], block[2] -= pressure * v[1];
        block[3] -= pressure * v[2], block[5] += pressure * v[0];
        block[6] += pressure * v[1], block[7] -= pressure * v[0];
      }
    }
  }
  for (std::size_t q = 0; q < 8; ++q) {
    const auto& fibre = element.fibre[q];
    Place along{};
    for (std::size_t a = 0; a < 8; ++a) {
      for (std::size_t d = 0; d < 3; ++d) along[d] += fibre[a] * at_m[a][d];
    }
    const double stretch = std::sqrt(dot_of(along, along));
    const FibreTension tension = fibre_tension(tissue, activity.activation, activity.mean_stretch, stretch);
    if (tension.stress_pa == 0 && tension.slope_pa == 0) continue;
    const double volume = element.fibre_volume_m3[q];
    const double taut = volume * tension.stress_pa / stretch;
    for (std::size_t a = 0; a < 8; ++a) {
      for (std::size_t d = 0; d < 3; ++d) force_n[a][d] += taut * fibre[a] * along[d];
    }
    if (tangent == nullptr) continue;
    std::array<double, 9> core{};
    const double growth = (volume * tension.slope_pa - taut) / (stretch * stretch);
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) core[3 * r + c] = growth * along[r] * along[c] + (r == c ? taut : 0);
    }
    for (std::size_t a = 0; a < 8; ++a) {
      for (std::size_t b = 0; b <= a; ++b) {
        auto& block = (*tangent)[packed_pair(a, b)];
        const double factor = fibre[a] * fibre[b];
        for (std::size_t x = 0; x < 9; ++x) block[x] += factor * core[x];
      }
    }
  }
}

}  // namespace mobil::inline v0_3
