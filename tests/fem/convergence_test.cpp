// Mesh refinement with a manufactured solution: a prescribed displacement on the boundary and the matching body force.
// The error in the L2 norm falls with the square of the element size, for every kind of element.
#include <gtest/gtest.h>

#include "engine/eigen.h"

#include <Eigen/SparseCholesky>
#include <array>
#include <cmath>
#include <vector>

#include "assets/fem/stiffness_terms.h"
#include "tests/fem/oracle.h"

namespace mobil::convergence_test {
using Point = Eigen::Vector3d;
using Sparse = Eigen::SparseMatrix<double>;

/// Three plane waves, one a component.
struct Waves {
  std::array<Point, 3> wave = {Point{35, -20, 28}, Point{18, 30, -25}, Point{-24, 16, 33}};  // rad/m
  std::array<double, 3> phase = {0.3, 1.1, -0.7};
  std::array<double, 3> height_m = {0.002, -0.0015, 0.001};

  double angle(std::size_t c, const Point& x) const { return wave[c].dot(x) + phase[c]; }

  Point displacement(const Point& x) const {
    Point u;
    for (std::size_t c = 0; c < 3; ++c) u(static_cast<Eigen::Index>(c)) = height_m[c] * std::sin(angle(c, x));
    return u;
  }

  /// −div σ = −(λ + μ)·∇(div u) − μ·∇²u, N/m³.
  Point body_force(const Point& x, const Material& m) const {
    const double lambda = m.young_pa * m.poisson / ((1 + m.poisson) * (1 - 2 * m.poisson));
    const double mu = m.young_pa / (2 * (1 + m.poisson));
    Point f = Point::Zero();
    for (std::size_t c = 0; c < 3; ++c) {
      const auto own = static_cast<Eigen::Index>(c);
      const double u = height_m[c] * std::sin(angle(c, x));
      f += (lambda + mu) * wave[c](own) * u * wave[c];
      f(own) += mu * wave[c].squaredNorm() * u;
    }
    return f;
  }
};

template <class F>
void for_each_gauss_point(const HexahedralMesh& mesh, F&& f) {
  const double g = std::sqrt(0.6);
  const std::array<double, 3> place = {-g, 0, g}, weight = {5.0 / 9, 8.0 / 9, 5.0 / 9};
  for (std::uint32_t e = 0; e < element_count(mesh.cells); ++e) {
    const Hexahedron h = element_nodes(mesh.cells, e);
    for (std::size_t i = 0; i < 27; ++i) {
      const std::size_t a = i % 3, b = i / 3 % 3, c = i / 9;
      const oracle::Shape s = oracle::shape_at(mesh, h, place[a], place[b], place[c]);
      Point x = Point::Zero();
      for (std::size_t n = 0; n < 8; ++n) {
        const auto& p = mesh.node[h[n]];
        x += s.n(static_cast<Eigen::Index>(n)) * Point(p.x, p.y, p.z);
      }
      f(h, s.n, x, weight[a] * weight[b] * weight[c] * s.jacobian);
    }
  }
}

/// √(∫|u − exact|² / ∫|exact|²).
double error_of(const HexahedralMesh& mesh, const Material& material, Element kind, const Waves& exact = {}) {
  const auto terms = assemble(mesh, material, kind);
  const auto size = static_cast<Eigen::Index>(3 * mesh.node.size());
  Eigen::VectorXd u(size), load = Eigen::VectorXd::Zero(size);
  for_each_gauss_point(mesh, [&](const Hexahedron& h, const auto& n, const Point& x, double volume) {
    const Point f = volume * exact.body_force(x, material);
    for (std::size_t a = 0; a < 8; ++a) {
      load.segment<3>(static_cast<Eigen::Index>(3 * h[a])) += n(static_cast<Eigen::Index>(a)) * f;
    }
  });
  std::vector<Eigen::Index> place(3 * mesh.node.size(), -1);
  Eigen::Index inner = 0;
  const Cells& cells = mesh.cells;
  for_each_node(cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const std::uint32_t n = node_index(cells, i, j, k);
    const auto& p = mesh.node[n];
    u.segment<3>(3 * n) = exact.displacement({p.x, p.y, p.z});
    if (i == 0 || i == cells[0] || j == 0 || j == cells[1] || k == 0 || k == cells[2]) return;
    for (std::size_t c = 0; c < 3; ++c) place[3 * n + c] = inner++;
  });
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd rest = Eigen::VectorXd::Zero(inner);
  for_each_node(cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const std::uint32_t n = node_index(cells, i, j, k);
    if (place[3 * n] < 0) return;
    rest.segment<3>(place[3 * n]) += load.segment<3>(3 * n);
    for_each_neighbour(cells, i, j, k, [&](std::uint32_t m, std::size_t slot) {
      const auto block = stiffness_block(terms->pair[n * stencil_size + slot], 1, 1);
      for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = 0; c < 3; ++c) {
          const auto row = place[3 * n + r], column = place[3 * m + c];
          if (column >= 0) entries.emplace_back(row, column, block[3 * r + c]);
          if (column < 0) rest(row) -= block[3 * r + c] * u(static_cast<Eigen::Index>(3 * m + c));
        }
      }
    });
  });
  Sparse stiffness(inner, inner);
  stiffness.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd solved = Eigen::SimplicialLLT<Sparse>(stiffness).solve(rest);
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (place[i] >= 0) u(static_cast<Eigen::Index>(i)) = solved(place[i]);
  }
  double wrong = 0, all = 0;
  for_each_gauss_point(mesh, [&](const Hexahedron& h, const auto& n, const Point& x, double volume) {
    const Point right = exact.displacement(x);
    Point mine = Point::Zero();
    for (std::size_t a = 0; a < 8; ++a) {
      mine += n(static_cast<Eigen::Index>(a)) * u.segment<3>(static_cast<Eigen::Index>(3 * h[a]));
    }
    wrong += volume * (mine - right).squaredNorm();
    all += volume * right.squaredNorm();
  });
  return std::sqrt(wrong / all);
}

HexahedralMesh block(std::uint32_t n) {
  return *make_block({n, n, 2 * n}, 0.06 / n);
}

HexahedralMesh graded_belly(std::uint32_t n) {
  const std::vector<LatticeStation> stations = {{0, 0, 0, 0.02F, 0.03F}, {1, 0.03F, -0.01F, 0.035F, 0.025F}};
  return *bend_block({n, n, 2 * n}, stations, 0.12, {1.5, 2});
}

/// Returns a twisted block whose inner nodes are displaced by up to a fifth of a cell.
HexahedralMesh distorted_block(std::uint32_t n) {
  HexahedralMesh mesh = block(n);
  std::uint32_t seed = 1;
  const auto jitter = [&] {
    seed = seed * 1664525U + 1013904223U;
    return (static_cast<double>(seed >> 8U) / 16777216.0 - 0.5) * 0.4 * 0.06 / n;
  };
  for_each_node(mesh.cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    auto& p = mesh.node[node_index(mesh.cells, i, j, k)];
    if (i > 0 && i < n && j > 0 && j < n && k > 0 && k < 2 * n) p = {p.x + jitter(), p.y + jitter(), p.z + jitter()};
    const double turn = 5 * p.z;
    p = {std::cos(turn) * p.x - std::sin(turn) * p.y, std::sin(turn) * p.x + std::cos(turn) * p.y, p.z};
  });
  return mesh;
}

void expect_second_order(Element kind) {
  for (HexahedralMesh (*shape)(std::uint32_t) : {block, graded_belly, distorted_block}) {
    const double coarse = error_of(shape(4), Material{}, kind), fine = error_of(shape(8), Material{}, kind);
    const double order = std::log2(coarse / fine);
    EXPECT_GT(order, 1.8) << coarse << " " << fine;
    EXPECT_LT(order, 2.4) << coarse << " " << fine;
    EXPECT_LT(fine, 0.03);
  }
}

TEST(Convergence, FullIntegrationIsOfSecondOrder) {
  expect_second_order(Element::full);
}

TEST(Convergence, BbarIsOfSecondOrder) {
  expect_second_order(Element::bbar);
}

TEST(Convergence, OnePointIsOfSecondOrder) {
  expect_second_order(Element::one_point);
}

TEST(Convergence, BbarAndOnePointStayAccurateNearIncompressibility) {
  Waves incompressible;
  for (std::size_t c = 0; c < 3; ++c) incompressible.wave[c](static_cast<Eigen::Index>(c)) = 0;
  Material wet;
  wet.poisson = 0.4999;
  const auto growth = [&](Element kind) {
    return error_of(graded_belly(6), wet, kind, incompressible) /
           error_of(graded_belly(6), Material{}, kind, incompressible);
  };
  EXPECT_LT(growth(Element::bbar), 1.2);
  EXPECT_LT(growth(Element::one_point), 1.2);
}

}  // namespace mobil::convergence_test
