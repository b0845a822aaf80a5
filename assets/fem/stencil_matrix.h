#pragma once
// A matrix over all displacements of a mesh that couples each node to its neighbours, by rows of nodes.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "assets/fem/stiffness_terms.h"

namespace mobil::inline v0_3 {

class StencilMatrix {
 public:
  StencilMatrix() = default;
  /// `block(n, m, slot)` returns the 3×3 coupling, row-major, of node n's forces to its neighbour m's displacements.
  template <class Block>
  StencilMatrix(const Cells& cells, const Block& block) {
    fill(cells, block);
  }

  /// Replaces the matrix in the same memory.
  template <class Block>
  void fill(const Cells& cells, const Block& block) {
    first_.clear();
    coupling_.clear();
    coupling_.reserve(stencil_size * node_count(cells));
    for_each_node(cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
      const std::uint32_t n = node_index(cells, i, j, k);
      first_.push_back(coupling_.size());
      for_each_neighbour(cells, i, j, k, [&](std::uint32_t m, std::size_t slot) { add(m, block(n, m, slot)); });
    });
    first_.push_back(coupling_.size());
  }

  /// y = K·x, three numbers a node.
  void multiply(const std::vector<double>& x, std::vector<double>& y) const;

 private:
  /// Columns of a 3×3 block, each padded to the width of a machine vector.
  struct Coupling {
    std::array<std::array<double, 4>, 3> column;
    std::size_t of;  // the neighbour's first displacement
  };
  void add(std::uint32_t neighbour, const std::array<double, 9>& block);

  std::vector<std::size_t> first_;  // coupling of a node, and the end
  std::vector<Coupling> coupling_;
};

}  // namespace mobil::inline v0_3
