#pragma once
// One belly at finite strain in double precision, written as its energy. Forces and tangents are finite differences of
// it. Gradients come from the exact volume of trilinear elements, sizes from a scaled mesh. No array of the kernel is
// used.

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include "assets/fem/finite_element.h"
#include "assets/fem/finite_kernel.h"
#include "assets/fem/hexahedron_points.h"
#include "assets/fem/stiffness_terms.h"

namespace mobil {

class FiniteOracle {
 public:
  FiniteOracle(HexahedralMesh of, const FiniteTissue& law) : mesh(std::move(of)), tissue(law) {
    const std::vector<double> areas = section_areas(mesh);
    double widest = 0;
    for (const double area : areas) widest = std::max(widest, area);
    Material material;
    material.density_kg_m3 = tissue.density_kg_m3;
    mass_kg = assemble(mesh, material).value().lumped_mass_kg;
    for (std::uint32_t e = 0; e < element_count(mesh.cells); ++e) {
      const Hexahedron h = element_nodes(mesh.cells, e);
      const std::size_t layer = e / (mesh.cells[0] * mesh.cells[1]);
      const double root = 0.5 * (std::sqrt(areas[layer]) + std::sqrt(areas[layer + 1]));
      elements_.push_back(element(h, std::min(max_crowding, widest / (root * root))));
    }
  }

  HexahedralMesh mesh;
  FiniteTissue tissue;
  double pulling = 0, mean_stretch = 1;  // activation plus the effect of slackness; mean of the whole belly
  std::vector<double> mass_kg;

  /// Returns the energy, J, of a displacement of three components a node. Fibre energy is measured from λ = 1.
  double energy(const std::vector<double>& u) const {
    const std::vector<std::array<double, 2>> means = plane_means(u);
    double sum = 0;
    for (std::size_t e = 0; e < elements_.size(); ++e) sum += energy_of(e, u, means);
    return sum;
  }
  /// Returns −∂energy/∂u of one component, by a central difference. `u` is unchanged afterwards.
  double force(std::vector<double>& u, std::size_t i) const {
    constexpr double h = 1e-6;
    const double at = u[i];
    u[i] = at + h;
    const double more = energy(u);
    u[i] = at - h;
    const double less = energy(u);
    u[i] = at;
    return (less - more) / (2 * h);
  }
  /// Returns the largest |cof F − 1| and |J − 1| of all elements.
  FiniteEnvelope reach(const std::vector<double>& u) const {
    FiniteEnvelope reach{0, 0};
    for (const Element& e : elements_) {
      const Square F = gradient_of(e, u);
      double square = 0;
      for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = 0; c < 3; ++c) {
          const double off = cofactor(F, r, c) - (r == c ? 1 : 0);
          square += off * off;
        }
      }
      reach.cofactor = std::max(reach.cofactor, std::sqrt(square));
      reach.dilatation = std::max(reach.dilatation, std::abs(determinant(F) - 1));
    }
    return reach;
  }

  /// Returns the mass-weighted mean sideways displacement of each plane of nodes.
  std::vector<std::array<double, 2>> plane_means(const std::vector<double>& u) const {
    const std::size_t nodes = plane_nodes(mesh.cells);
    std::vector<std::array<double, 2>> means(mesh.cells[2] + 1);
    for (std::size_t k = 0; k < means.size(); ++k) {
      double mass = 0;
      for (std::size_t n = k * nodes; n < (k + 1) * nodes; ++n) {
        mass += mass_kg[n];
        for (std::size_t c = 0; c < 2; ++c) means[k][c] += mass_kg[n] * u[3 * n + c];
      }
      for (double& m : means[k]) m /= mass;
    }
    return means;
  }

 private:
  using Square = std::array<std::array<double, 3>, 3>;
  struct Element {
    Hexahedron node;
    std::size_t layer;
    double volume, crowding;
    Corners gradient;
    std::array<std::array<double, 8>, 4> pattern;
    double hourglass;
    std::array<double, 3> fibre;
  };

  Element element(const Hexahedron& h, double crowding) const {
    Element e{h, h[0] / plane_nodes(mesh.cells), 0, crowding, {}, {}, 0, {}};
    Corners at;
    for (std::size_t a = 0; a < 8; ++a) at[a] = {mesh.node[h[a]].x, mesh.node[h[a]].y, mesh.node[h[a]].z};
    e.volume = hexahedron_volume(at, e.gradient);
    double squares = 0;
    for (auto& g : e.gradient) {
      for (double& x : g) {
        x /= e.volume;
        squares += x * x;
      }
    }
    e.hourglass = hourglass_share * 4 * tissue.shear_pa * e.volume * squares / 8;
    for (std::size_t a = 0; a < 8; ++a) {
      const auto [x, y, z] = hexahedron_corner[a];
      const std::array<int, 4> modes = {y * z, z * x, x * y, x * y * z};
      for (std::size_t m = 0; m < 4; ++m) e.pattern[m][a] = modes[m];
    }
    for (auto& pattern : e.pattern) {
      std::array<double, 3> moment{};
      for (std::size_t a = 0; a < 8; ++a) {
        for (std::size_t c = 0; c < 3; ++c) moment[c] += pattern[a] * at[a][c];
      }
      for (std::size_t a = 0; a < 8; ++a) {
        for (std::size_t c = 0; c < 3; ++c) pattern[a] -= moment[c] * e.gradient[a][c];
      }
    }
    double length = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t a = 0; a < 8; ++a) e.fibre[c] += (a < 4 ? -1 : 1) * at[a][c];
      length += e.fibre[c] * e.fibre[c];
    }
    for (double& x : e.fibre) x /= std::sqrt(length);
    return e;
  }

  Square gradient_of(const Element& e, const std::vector<double>& u) const {
    Square F{};
    for (std::size_t r = 0; r < 3; ++r) {
      F[r][r] = 1;
      for (std::size_t a = 0; a < 8; ++a) {
        for (std::size_t c = 0; c < 3; ++c) F[r][c] += u[3 * e.node[a] + r] * e.gradient[a][c];
      }
    }
    return F;
  }
  static double cofactor(const Square& F, std::size_t r, std::size_t c) {
    const std::size_t s = (r + 1) % 3, t = (r + 2) % 3, e = (c + 1) % 3, f = (c + 2) % 3;
    return F[s][e] * F[t][f] - F[s][f] * F[t][e];
  }
  static double determinant(const Square& F) {
    return F[0][0] * cofactor(F, 0, 0) + F[0][1] * cofactor(F, 0, 1) + F[0][2] * cofactor(F, 0, 2);
  }

  /// Returns the integral of fibre_tension's stress over the stretch, from 1.
  double held(double stretch) const {
    const auto to = [&](double s) {
      const double floor_at = mean_stretch - (1 - tissue.min_share) / tissue.force_slope;
      const double share = 1 + tissue.force_slope * (s - mean_stretch);
      const double active = s > floor_at ? share * share / (2 * tissue.force_slope)
                                         : tissue.min_share * tissue.min_share / (2 * tissue.force_slope) +
                                               tissue.min_share * (s - floor_at);
      constexpr double steepness = 4, strain = 0.6;
      const double z = std::max(0.0, steepness * (tissue.rest_over_optimal * s - 1) / strain);
      const double slope = steepness * tissue.rest_over_optimal / strain;
      return pulling * tissue.active_pa * active +
             tissue.passive_pa * (std::expm1(z) - z) / slope / std::expm1(steepness);
    };
    return to(stretch) - to(1);
  }

  double energy_of(std::size_t number, const std::vector<double>& u,
                   const std::vector<std::array<double, 2>>& means) const {
    const Element& e = elements_[number];
    const Square F = gradient_of(e, u);
    double square = 0, hourglass = 0, fibre = 0, rise = 0, sway = 0;
    for (std::size_t r = 0; r < 3; ++r) {
      double along = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        square += F[r][c] * F[r][c];
        along += F[r][c] * e.fibre[c];
      }
      fibre += along * along;
      for (const auto& pattern : e.pattern) {
        double amount = 0;
        for (std::size_t a = 0; a < 8; ++a) amount += pattern[a] * u[3 * e.node[a] + r];
        hourglass += 0.5 * e.hourglass * amount * amount;
      }
    }
    for (std::size_t a = 4; a < 8; ++a) {
      for (std::size_t c = 0; c < 3; ++c) rise += e.gradient[a][c] * e.fibre[c];
    }
    for (std::size_t c = 0; c < 2; ++c) sway += e.fibre[c] * rise * (means[e.layer + 1][c] - means[e.layer][c]);
    const double swelling = determinant(F) - 1, mu = tissue.shear_pa;
    const double density =
        mu / 2 * (square - 3) - mu * swelling + mu * tissue.bulk_over_shear / 2 * swelling * swelling;
    return e.volume * (density + e.crowding * held(std::sqrt(fibre - 2 * sway))) + hourglass;
  }

  std::vector<Element> elements_;
};

}  // namespace mobil
