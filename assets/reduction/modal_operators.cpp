#include "assets/reduction/modal_operators.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <mobil/engine/interrupt.h>
#include "assets/fem/kernel_arrays.h"
#include "assets/reduction/dense.h"
#include "engine/eigen.h"

namespace mobil::inline v0_3 {
namespace {

using Eigen::Index;

Index row_of(std::uint32_t node, std::size_t component) {
  return 3 * static_cast<Index>(node) + static_cast<Index>(component);
}

double mass_between(const StiffnessTerms& terms, std::uint32_t node, std::uint32_t other, std::size_t slot) {
  return 0.5 *
         (terms.consistent_mass_kg[node * stencil_size + slot] + (node == other ? terms.lumped_mass_kg[node] : 0.0));
}

/// Returns a coupling, 3×3, row-major.
std::array<double, 9> coupling(const StiffnessTerms& terms, const OperatorMix& mix, std::uint32_t node,
                               std::uint32_t other, std::size_t slot) {
  const StencilPair& p = terms.pair[node * stencil_size + slot];
  const double mass =
      0.5 * (terms.consistent_mass_kg[node * stencil_size + slot] + (node == other ? terms.lumped_mass_kg[node] : 0.0));
  const auto [a, b, c, across, along] = mix;
  return {a * p.a_xx + c * p.c_xx + across * mass, a * p.a_xy, b * p.b_xz, a * p.a_yx,
          a * p.a_yy + c * p.c_yy + across * mass, b * p.b_yz, b * p.b_zx, b * p.b_zy,
          a * p.a_zz + c * p.c_zz + along * mass};
}

std::size_t moving_nodes(const Cells& cells, FarEnd end) {
  return std::size_t{node_count(cells)} - plane_nodes(cells) * (end == FarEnd::held ? 2U : 1U);
}

std::size_t band_reach(const Cells& cells) {
  return 3 * (std::size_t{plane_nodes(cells)} + cells[0] + 2) + 2;
}

}  // namespace

OperatorMix stiffness_over_mass(double across, double along, double foundation_1_s2) {
  const double ratio = across / along, size = across * along;
  return {1 / (ratio * size), 1 / size, ratio / size, foundation_1_s2, 0};
}

Columns applied(const StiffnessTerms& terms, const OperatorMix& mix, Eigen::Ref<const Columns> fields) {
  Columns result = Columns::Zero(fields.rows(), fields.cols());
  const Index width = fields.cols();
  for_each_node(terms.cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    check_interrupt();
    const std::uint32_t n = node_index(terms.cells, i, j, k);
    for_each_neighbour(terms.cells, i, j, k, [&](std::uint32_t m, std::size_t slot) {
      const auto block = coupling(terms, mix, n, m, slot);
      for (std::size_t r = 0; r < 3; ++r) {
        double* const to = &result(row_of(n, r), 0);
        for (std::size_t c = 0; c < 3; ++c) {
          const double factor = block[3 * r + c];
          if (factor == 0) continue;
          const double* const from = fields.data() + row_of(m, c) * fields.outerStride();
          for (Index w = 0; w < width; ++w) to[w] += factor * from[w];
        }
      }
    });
  });
  return result;
}

Columns mass_times(const StiffnessTerms& terms, Eigen::Ref<const Columns> fields) {
  // a node's three rows are adjacent unless the columns are part of more
  if (fields.outerStride() != fields.cols()) return mass_times(terms, Columns(fields));
  Columns result = Columns::Zero(fields.rows(), fields.cols());
  const Index width = 3 * fields.cols();
  for_each_node(terms.cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    check_interrupt();
    const std::uint32_t n = node_index(terms.cells, i, j, k);
    double* const to = result.data() + n * width;
    for_each_neighbour(terms.cells, i, j, k, [&](std::uint32_t m, std::size_t slot) {
      const double mass = mass_between(terms, n, m, slot);
      const double* const from = fields.data() + m * width;
      for (Index w = 0; w < width; ++w) to[w] += mass * from[w];
    });
  });
  return result;
}

Eigen::MatrixXd inner(Eigen::Ref<const Columns> left, Eigen::Ref<const Columns> right) {
  constexpr Index piece = 96;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(left.cols(), right.cols());
  for (Index row = 0; row < left.rows(); row += piece) {
    check_interrupt();
    const Index rows = std::min(piece, left.rows() - row);
    add_inner(left.middleRows(row, rows), right.middleRows(row, rows), sum);
  }
  return sum;
}

MovingOperator::MovingOperator(const StiffnessTerms& terms, FarEnd end, const OperatorMix& mix)
    : first_(row_of(plane_nodes(terms.cells), 0)),
      rows_(3 * static_cast<Index>(moving_nodes(terms.cells, end))),
      factor_(static_cast<std::size_t>(rows_), band_reach(terms.cells)) {
  const Cells& cells = terms.cells;
  const std::uint32_t first = plane_nodes(cells), last = first + static_cast<std::uint32_t>(moving_nodes(cells, end));
  for_each_node(cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const std::uint32_t n = node_index(cells, i, j, k);
    if (n < first || n >= last) return;
    for_each_neighbour(cells, i, j, k, [&](std::uint32_t m, std::size_t slot) {
      if (m < n || m >= last) return;
      const auto block = coupling(terms, mix, n, m, slot);
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t r = m == n ? c : 0; r < 3; ++r) {
          if (!moves(cells, end, n, c) || !moves(cells, end, m, r)) continue;
          factor_.at(3 * std::size_t{m - first} + r, 3 * std::size_t{n - first} + c) = block[3 * c + r];
        }
      }
    });
    for (std::size_t c = 0; c < 3; ++c) {
      if (moves(cells, end, n, c)) continue;
      const std::size_t row = 3 * std::size_t{n - first} + c;
      factor_.at(row, row) = 1;
      still_.push_back(static_cast<Index>(row));
    }
  });
  definite_ = factor_.factorise();
}

void MovingOperator::solve(Eigen::Ref<Columns> loads) const {
  loads.topRows(first_).setZero();
  loads.bottomRows(loads.rows() - first_ - rows_).setZero();
  auto moving = loads.middleRows(first_, rows_);
  for (const Index row : still_) moving.row(row).setZero();
  factor_.solve(moving);
}

void hold(const Cells& cells, FarEnd end, Eigen::Ref<Columns> fields) {
  for (std::uint32_t n = 0; n < node_count(cells); ++n) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (!moves(cells, end, n, c)) fields.row(row_of(n, c)).setZero();
    }
  }
}

Columns far_step(const Cells& cells) {
  Columns step = Columns::Zero(row_of(node_count(cells), 0), 1);
  for (std::uint32_t n = first_insertion_node(cells); n < node_count(cells); ++n) step(row_of(n, 2), 0) = 1;
  return step;
}

Columns far_traction(const HexahedralMesh& mesh, bool all_axes) {
  const std::vector<double> share = far_shares(mesh);
  const std::size_t first = all_axes ? 0 : 2;
  Columns load = Columns::Zero(row_of(node_count(mesh.cells), 0), all_axes ? 3 : 1);
  for (std::uint32_t i = 0; i < plane_nodes(mesh.cells); ++i) {
    for (std::size_t c = first; c < 3; ++c) {
      load(row_of(first_insertion_node(mesh.cells) + i, c), static_cast<Index>(c - first)) = share[i];
    }
  }
  return load;
}

Columns frame_fields(const HexahedralMesh& mesh, double across, double along) {
  Columns fields = Columns::Zero(row_of(node_count(mesh.cells), 0), 12);
  for (std::uint32_t n = 0; n < node_count(mesh.cells); ++n) {
    const Vec3<double>& p = mesh.node[n];
    const double place[3] = {across * p.x, across * p.y, along * p.z};
    for (std::size_t i = 0; i < 3; ++i) {
      fields(row_of(n, i), static_cast<Index>(i)) = 1;
      for (std::size_t j = 0; j < 3; ++j) fields(row_of(n, i), static_cast<Index>(3 + 3 * i + j)) = place[j];
    }
  }
  return fields;
}

HexahedralMesh every_other(const HexahedralMesh& mesh) {
  HexahedralMesh coarse{{mesh.cells[0] / 2, mesh.cells[1] / 2, mesh.cells[2] / 2}, {}};
  for_each_node(coarse.cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    coarse.node.push_back(mesh.node[nested_node(mesh.cells, coarse.cells, i, j, k)]);
  });
  return coarse;
}

Columns every_other(const Cells& cells, const Columns& fields) {
  const Cells coarse = {cells[0] / 2, cells[1] / 2, cells[2] / 2};
  Columns taken(row_of(node_count(coarse), 0), fields.cols());
  for_each_node(coarse, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const Index to = row_of(node_index(coarse, i, j, k), 0), from = row_of(nested_node(cells, coarse, i, j, k), 0);
    taken.middleRows<3>(to) = fields.middleRows<3>(from);
  });
  return taken;
}

}  // namespace mobil::inline v0_3
