#include "assets/finite/control_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "assets/reduction/dense.h"
#include "engine/eigen.h"

namespace mobil::inline v0_3 {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

Result<void> check_nested(const Cells& fine, const Cells& control) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (control[axis] >= 1 && fine[axis] % control[axis] == 0) continue;
    return fail(fmt::format("a mesh of {}x{}x{} cells has not all nodes of {}x{}x{}; take whole multiples", fine[0],
                            fine[1], fine[2], control[0], control[1], control[2]));
  }
  if (control[2] < 2) return fail("control cells of one layer have no point to move; take 2 or more along");
  return {};
}

struct Between {
  std::uint32_t lower;
  double part;
};

/// Returns the control plane below a fine mesh's plane on one axis, evenly spread, and the part of the way to the next.
Between place_between(std::uint32_t fine_index, std::uint32_t fine_cells, std::uint32_t control_cells) {
  const std::uint32_t each = fine_cells / control_cells;
  const std::uint32_t lower = std::min(fine_index / each, control_cells - 1);
  return {lower, static_cast<double>(fine_index - lower * each) / each};
}

/// Returns control points × nodes: shape functions of the control cells at the nodes of a fine mesh.
MatrixXd shape_functions(const HexahedralMesh& fine, const Cells& control) {
  MatrixXd shape = MatrixXd::Zero(static_cast<Index>(node_count(control)), static_cast<Index>(fine.node.size()));
  const Cells& cells = fine.cells;
  const std::uint32_t layer = cells[2] / control[2];
  const auto height = [&](std::uint32_t k) { return fine.node[node_index(cells, 0, 0, k)].z; };
  for (std::uint32_t k = 0; k <= cells[2]; ++k) {
    Between z = place_between(k, cells[2], control[2]);
    const double from = height(z.lower * layer), to = height((z.lower + 1) * layer);
    z.part = (height(k) - from) / (to - from);
    for (std::uint32_t j = 0; j <= cells[1]; ++j) {
      const Between y = place_between(j, cells[1], control[1]);
      for (std::uint32_t i = 0; i <= cells[0]; ++i) {
        const Between x = place_between(i, cells[0], control[0]);
        const auto node = static_cast<Index>(node_index(cells, i, j, k));
        for (std::uint32_t corner = 0; corner < 8; ++corner) {
          const std::uint32_t a = corner & 1U, b = corner >> 1U & 1U, c = corner >> 2U;
          const double share = (a ? x.part : 1 - x.part) * (b ? y.part : 1 - y.part) * (c ? z.part : 1 - z.part);
          if (share == 0) continue;
          shape(static_cast<Index>(node_index(control, x.lower + a, y.lower + b, z.lower + c)), node) += share;
        }
      }
    }
  }
  return shape;
}

Corners moved_corners(const HexahedralMesh& mesh, const Hexahedron& h, const std::vector<double>& u) {
  Corners at;
  for (std::size_t a = 0; a < 8; ++a) {
    const auto& x = mesh.node[h[a]];
    at[a] = {x.x + u[3 * h[a]], x.y + u[3 * h[a] + 1], x.z + u[3 * h[a] + 2]};
  }
  return at;
}

/// Returns the first of the points between the ends, and their number.
std::pair<Index, Index> inner_points(const Cells& cells) {
  const auto plane = static_cast<Index>(plane_nodes(cells));
  return {plane, plane * (static_cast<Index>(cells[2]) - 1)};
}

}  // namespace

Result<ControlMesh> make_control_mesh(const FiniteBelly& belly, const Cells& cells) {
  const Cells& fine = belly.mesh.cells;
  if (auto ok = check_nested(fine, cells); !ok) return tl::unexpected(ok.error());
  ControlMesh points;
  points.mesh.cells = cells;
  for (std::uint32_t k = 0; k <= cells[2]; ++k) {
    for (std::uint32_t j = 0; j <= cells[1]; ++j) {
      for (std::uint32_t i = 0; i <= cells[0]; ++i) {
        points.mesh.node.push_back(belly.mesh.node[node_index(fine, i * (fine[0] / cells[0]), j * (fine[1] / cells[1]),
                                                              k * (fine[2] / cells[2]))]);
      }
    }
  }
  const MatrixXd shape = shape_functions(belly.mesh, cells);
  points.moment = MatrixXd::Zero(shape.rows(), shape.cols());
  for (const FiniteElement& element : belly.elements) {
    for (std::size_t a = 0; a < 8; ++a) {
      const auto to = static_cast<Index>(element.node[a]);
      for (std::size_t b = 0; b < 8; ++b) {
        points.moment.col(to) += element.mass_kg[a][b] * shape.col(static_cast<Index>(element.node[b]));
      }
    }
  }
  points.mass = product(points.moment, transposed(shape));
  const auto [first, count] = inner_points(cells);
  points.inner = points.mass.block(first, first, count, count).llt().matrixL();
  return points;
}

std::vector<double> nearest_points(const ControlMesh& points, const std::vector<double>& displacement_m) {
  using Places = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
  const Eigen::Map<const Places> fine(displacement_m.data(), points.moment.cols(), 3);
  std::vector<double> result(3 * points.mesh.node.size());
  Eigen::Map<Places> shown(result.data(), points.moment.rows(), 3);
  const auto [first, count] = inner_points(points.mesh.cells);
  const Index plane = first;
  shown.topRows(plane) = fine.topRows(1).replicate(plane, 1);
  shown.bottomRows(plane) = fine.bottomRows(1).replicate(plane, 1);
  MatrixXd right = points.moment * fine - points.mass * shown;
  MatrixXd inner = right.middleRows(first, count);
  points.inner.triangularView<Eigen::Lower>().solveInPlace(inner);
  points.inner.triangularView<Eigen::Lower>().transpose().solveInPlace(inner);
  shown.middleRows(first, count) = inner;
  return result;
}

double enclosed_volume(const HexahedralMesh& mesh, const std::vector<double>& displacement_m) {
  const std::vector<double> none(displacement_m.size());
  double now = 0, rest = 0;
  Corners gradient;
  for (std::uint32_t e = 0; e < element_count(mesh.cells); ++e) {
    const Hexahedron h = element_nodes(mesh.cells, e);
    now += hexahedron_volume(moved_corners(mesh, h, displacement_m), gradient);
    rest += hexahedron_volume(moved_corners(mesh, h, none), gradient);
  }
  return now / rest;
}

Result<void> keep_volume(const ControlMesh& points, std::vector<double>& displacement_m, double ratio) {
  const HexahedralMesh& mesh = points.mesh;
  const auto [first, count] = inner_points(mesh.cells);
  const double rest = volume(mesh);
  for (int step = 0; step < 8; ++step) {
    const double missing = (ratio - enclosed_volume(mesh, displacement_m)) * rest;
    if (std::abs(missing) < 1e-9 * rest) return {};
    MatrixXd slope = MatrixXd::Zero(static_cast<Index>(mesh.node.size()), 3);
    Corners gradient;
    for (std::uint32_t e = 0; e < element_count(mesh.cells); ++e) {
      const Hexahedron h = element_nodes(mesh.cells, e);
      hexahedron_volume(moved_corners(mesh, h, displacement_m), gradient);
      for (std::size_t a = 0; a < 8; ++a) {
        for (std::size_t d = 0; d < 3; ++d) slope(static_cast<Index>(h[a]), static_cast<Index>(d)) += gradient[a][d];
      }
    }
    MatrixXd inner = slope.middleRows(first, count);
    points.inner.triangularView<Eigen::Lower>().solveInPlace(inner);
    const double gain = inner.squaredNorm();
    points.inner.triangularView<Eigen::Lower>().transpose().solveInPlace(inner);
    for (Index i = 0; i < count; ++i) {
      for (Index d = 0; d < 3; ++d) {
        displacement_m[static_cast<std::size_t>(3 * (first + i) + d)] += missing / gain * inner(i, d);
      }
    }
  }
  return fail("the control points' volume could not be kept; the shape is too far from that at rest");
}

std::vector<double> sampled_points(const Cells& fine, const Cells& control, const std::vector<double>& displacement_m) {
  std::vector<double> result;
  for (std::uint32_t k = 0; k <= control[2]; ++k) {
    for (std::uint32_t j = 0; j <= control[1]; ++j) {
      for (std::uint32_t i = 0; i <= control[0]; ++i) {
        const std::size_t n =
            node_index(fine, i * (fine[0] / control[0]), j * (fine[1] / control[1]), k * (fine[2] / control[2]));
        result.insert(result.end(), displacement_m.begin() + static_cast<std::ptrdiff_t>(3 * n),
                      displacement_m.begin() + static_cast<std::ptrdiff_t>(3 * n + 3));
      }
    }
  }
  return result;
}

}  // namespace mobil::inline v0_3
