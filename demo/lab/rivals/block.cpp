#include "demo/lab/rivals/block.h"

#include <Eigen/SparseCholesky>
#include <cmath>

namespace rivals {
namespace {

using Matrix24 = Eigen::Matrix<double, 24, 24>;

/// Returns the element stiffness of a box with edges a × a × c.
Matrix24 element_stiffness(double a, double c) {
  const double lambda = young_pa * poisson / ((1 + poisson) * (1 - 2 * poisson)), mu = young_pa / (2 * (1 + poisson));
  Eigen::Matrix<double, 6, 6> elasticity = Eigen::Matrix<double, 6, 6>::Zero();
  elasticity.topLeftCorner<3, 3>().setConstant(lambda);
  elasticity.diagonal() << lambda + 2 * mu, lambda + 2 * mu, lambda + 2 * mu, mu, mu, mu;
  const Eigen::Vector3d edge(a, a, c);
  Matrix24 sum = Matrix24::Zero();
  for (int g = 0; g < 8; ++g) {
    Eigen::Vector3d at;
    for (int d = 0; d < 3; ++d) at[d] = ((g >> d & 1) != 0 ? 1 : -1) / std::sqrt(3.0);
    Eigen::Matrix<double, 6, 24> strain = Eigen::Matrix<double, 6, 24>::Zero();
    for (int n = 0; n < 8; ++n) {
      Eigen::Vector3d sign, gradient;
      for (int d = 0; d < 3; ++d) sign[d] = (n >> d & 1) != 0 ? 1 : -1;
      for (int d = 0; d < 3; ++d) {
        const int e = (d + 1) % 3, f = (d + 2) % 3;
        gradient[d] = sign[d] * (1 + sign[e] * at[e]) * (1 + sign[f] * at[f]) / (4 * edge[d]);
      }
      auto b = strain.middleCols<3>(3 * n);
      b(0, 0) = b(3, 1) = b(5, 2) = gradient[0];
      b(1, 1) = b(3, 0) = b(4, 2) = gradient[1];
      b(2, 2) = b(4, 1) = b(5, 0) = gradient[2];
    }
    sum += strain.transpose() * elasticity * strain * (a * a * c / 8);
  }
  return sum;
}

}  // namespace

std::vector<Element> elements() {
  std::vector<Element> all;
  for (int k = 0; k + 1 < nodes_along; ++k) {
    for (int j = 0; j + 1 < nodes_across; ++j) {
      for (int i = 0; i + 1 < nodes_across; ++i) {
        Element e{};
        for (int n = 0; n < 8; ++n) {
          e.node[n] = ((k + (n >> 2)) * nodes_across + j + (n >> 1 & 1)) * nodes_across + i + (n & 1);
        }
        all.push_back(e);
      }
    }
  }
  return all;
}

Block make_block(double across, double along) {
  const double a = across * cube_m, c = along * cube_m;
  const Matrix24 part = element_stiffness(a, c);
  const int fixed = 3 * nodes_a_plane;
  Block block;
  block.mass = block.share_x = block.share_z = Eigen::VectorXd::Zero(moving);
  std::vector<Eigen::Triplet<double>> entries;
  for (const Element& e : elements()) {
    for (int row = 0; row < 24; ++row) {
      const int r = 3 * e.node[row / 3] + row % 3 - fixed;
      if (r < 0) continue;
      block.mass[r] += density * a * a * c / 8;
      for (int column = 0; column < 24; ++column) {
        const int s = 3 * e.node[column / 3] + column % 3 - fixed;
        if (s >= 0) entries.emplace_back(r, s, part(row, column));
      }
    }
  }
  block.stiffness.resize(moving, moving);
  block.stiffness.setFromTriplets(entries.begin(), entries.end());
  for (int n = 0; n < nodes_a_plane; ++n) {
    const auto weight = [](int i) { return i == 0 || i + 1 == nodes_across ? 0.25 : 0.5; };
    const int at = moving - 3 * nodes_a_plane + 3 * n;
    block.share_x[at] = block.share_z[at + 2] = weight(n % nodes_across) * weight(n / nodes_across);
  }
  return block;
}

double pull_n(int step) {
  const double t = step * step_s;
  return 0.2 * (1 - std::cos(2 * M_PI * 1.3 * t)) + 0.05 * std::sin(2 * M_PI * 7 * t);
}

double strength(int m) {
  return 1 + 0.5 * m / muscles;
}

Eigen::Vector2d far_mean(const Block& block, const Eigen::VectorXd& u) {
  return {block.share_z.dot(u), block.share_x.dot(u)};
}

Eigen::VectorXd deflection(const Block& block, double pull) {
  const Eigen::SparseMatrix<double> k = block.stiffness;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(k);
  return factor.solve(pull * (block.share_z + sideways * block.share_x));
}

}  // namespace rivals
