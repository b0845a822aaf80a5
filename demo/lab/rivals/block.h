#pragma once
// The paper's block by the textbook: trilinear elements, 2×2×2 Gauss points, its fixed components removed.

#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <vector>

#include "demo/lab/rivals/rival.h"

namespace rivals {

inline constexpr int nodes_across = 3, nodes_along = 9;
inline constexpr int nodes_a_plane = nodes_across * nodes_across, nodes = nodes_a_plane * nodes_along;
inline constexpr int moving = 3 * (nodes - nodes_a_plane);  // components: 216
inline constexpr double cube_m = 0.015, density = 1000, young_pa = 1.06667e4, poisson = 0.3333;

struct Element {
  int node[8];  // x fastest
};
std::vector<Element> elements();

/// K (all structural entries kept, 9702), lumped M and each component's share of a traction over the far face, for a
/// block `across` times as wide and `along` times as long.
struct Block {
  Eigen::SparseMatrix<double, Eigen::RowMajor> stiffness;
  Eigen::VectorXd mass, share_x, share_z;
};
Block make_block(double across, double along);

/// Axial pull on the far face during a step, N, and the factor of muscle `m`. A part of it, `sideways`, is sideways.
double pull_n(int step);
double strength(int m);
inline constexpr double sideways = 0.05;

/// Returns the mean axial and sideways displacement of the far face, m.
Eigen::Vector2d far_mean(const Block& block, const Eigen::VectorXd& u);
/// Returns the static deflection under the constant force `pull` and its sideways part.
Eigen::VectorXd deflection(const Block& block, double pull);

}  // namespace rivals
