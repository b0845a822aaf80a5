#include "assets/fem/kernel_arrays.h"

#include <array>
#include <cmath>

namespace mobil::inline v0_3 {

std::vector<double> far_shares(const HexahedralMesh& mesh) {
  const std::uint32_t first = first_insertion_node(mesh.cells);
  std::vector<double> area(plane_nodes(mesh.cells));
  double total = 0;
  const double g = 1 / std::sqrt(3.0);
  for (const Quad& quad : insertion_quads(mesh.cells)) {
    for (int point = 0; point < 4; ++point) {
      const double s = point % 2 == 0 ? -g : g, t = point < 2 ? -g : g;
      const double n[4] = {(1 - s) * (1 - t) / 4, (1 + s) * (1 - t) / 4, (1 + s) * (1 + t) / 4, (1 - s) * (1 + t) / 4};
      const double ns[4] = {-(1 - t) / 4, (1 - t) / 4, (1 + t) / 4, -(1 + t) / 4};
      const double nt[4] = {-(1 - s) / 4, -(1 + s) / 4, (1 + s) / 4, (1 - s) / 4};
      double u[3] = {}, v[3] = {};
      for (std::size_t a = 0; a < 4; ++a) {
        const auto& p = mesh.node[quad[a]];
        const double x[3] = {p.x, p.y, p.z};
        for (std::size_t c = 0; c < 3; ++c) {
          u[c] += ns[a] * x[c];
          v[c] += nt[a] * x[c];
        }
      }
      const double patch = std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
      total += patch;
      for (std::size_t a = 0; a < 4; ++a) area[quad[a] - first] += n[a] * patch;
    }
  }
  for (double& a : area) a /= total;
  return area;
}

namespace {

constexpr std::size_t own_slot = stencil_slot(0, 0, 0);

/// Returns the node at that slot of node n's stencil, which must exist.
std::uint32_t neighbour(const Cells& cells, std::uint32_t n, std::size_t slot) {
  const auto offset = [slot](std::size_t unit) { return static_cast<std::int64_t>(slot / unit % 3) - 1; };
  return static_cast<std::uint32_t>(n + offset(1) + offset(3) * (cells[0] + 1) + offset(9) * plane_nodes(cells));
}

/// `count` numbers a pair.
template <std::size_t count>
using Words = std::array<double, count>;

/// Words of a pair that a kernel reads, and the index of each in the transposed pair.
struct IndividualWords {
  static constexpr std::size_t count = KernelArrays::individual_words;
  static constexpr std::array<std::size_t, count> transposed = {0, 2, 1, 3, 4, 7, 8, 5, 6, 9, 10, 11};
  static Words<count> of(const StencilPair& p) {
    return {p.a_xx, p.a_xy, p.a_yx, p.a_yy, p.a_zz, p.b_xz, p.b_yz, p.b_zx, p.b_zy, p.c_xx, p.c_yy, p.c_zz};
  }
};
struct SharedWords {
  static constexpr std::size_t count = KernelArrays::shared_words;
  static constexpr std::array<std::size_t, count> transposed = {0, 3, 6, 1, 4, 7, 2, 5, 8};
  static Words<count> of(const StencilPair& p) { return stiffness_block(p, 1, 1); }
};

/// Returns the rows of the moving nodes as the kernels read them.
template <class Kind>
std::vector<float> rows(const StiffnessTerms& terms) {
  const Cells& cells = terms.cells;
  const std::uint32_t fixed = plane_nodes(cells);
  std::vector<std::array<float, Kind::count>> single(terms.pair.size());
  for (std::size_t at = 0; at < terms.pair.size(); ++at) {
    const auto exact = Kind::of(terms.pair[at]);
    for (std::size_t w = 0; w < Kind::count; ++w) single[at][w] = static_cast<float>(exact[w]);
  }
  std::vector<float> row;
  for_each_node(cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const std::uint32_t n = node_index(cells, i, j, k);
    if (n < fixed) return;
    Words<Kind::count> own{};
    std::array<std::size_t, Kind::count> weakest{};  // slot of a neighbour whose own row follows later
    for_each_neighbour(cells, i, j, k, [&](std::uint32_t m, std::size_t slot) {
      if (m == n) return;
      const std::size_t at = n * stencil_size + slot;
      const auto exact = Kind::of(terms.pair[at]);
      for (std::size_t w = 0; w < Kind::count; ++w) {
        own[w] -= m < fixed ? exact[w] : static_cast<double>(single[at][w]);
        const auto size = [&](std::size_t s) { return std::abs(single[n * stencil_size + s][w]); };
        if (m > n && (weakest[w] == 0 || size(slot) < size(weakest[w]))) weakest[w] = slot;
      }
    });
    for (std::size_t w = 0; w < Kind::count; ++w) {
      const auto value = static_cast<float>(0.5 * (own[w] + own[Kind::transposed[w]]));
      single[n * stencil_size + own_slot][w] = value;
      if (weakest[w] == 0 || Kind::transposed[w] != w) continue;
      float& taken = single[n * stencil_size + weakest[w]][w];
      taken = static_cast<float>(static_cast<double>(taken) + own[w] - static_cast<double>(value));
      const std::uint32_t m = neighbour(cells, n, weakest[w]);
      single[m * stencil_size + stencil_size - 1 - weakest[w]][w] = taken;
    }
    for_each_neighbour(cells, i, j, k, [&](std::uint32_t m, std::size_t slot) {
      if (m < fixed) return;
      const auto& words = single[n * stencil_size + slot];
      row.insert(row.end(), words.begin(), words.end());
    });
  });
  return row;
}

}  // namespace

KernelArrays make_kernel_arrays(const HexahedralMesh& mesh, const StiffnessTerms& terms) {
  const Cells& cells = mesh.cells;
  KernelArrays kernel;
  kernel.individual = rows<IndividualWords>(terms);
  kernel.shared = rows<SharedWords>(terms);
  kernel.plane_pair.assign(cells[2] + 1, 0);
  for_each_node(cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    if (k == 0) return;
    if (i == 0 && j == 0) kernel.plane_pair[k] = kernel.consistent_mass_kg.size();
    const std::uint32_t n = node_index(cells, i, j, k);
    for_each_neighbour(cells, i, j, k, [&](std::uint32_t m, std::size_t slot) {
      if (m < plane_nodes(cells)) return;
      kernel.consistent_mass_kg.push_back(static_cast<float>(terms.consistent_mass_kg[n * stencil_size + slot]));
    });
  });
  for (std::size_t n = 0; n < mesh.node.size(); ++n) {
    kernel.mass_kg.push_back(static_cast<float>(terms.lumped_mass_kg[n]));
    kernel.inverse_mass.push_back(static_cast<float>(1 / terms.lumped_mass_kg[n]));
    for (const double x : {mesh.node[n].x, mesh.node[n].y, mesh.node[n].z}) {
      kernel.rest_m.push_back(static_cast<float>(x));
    }
  }
  for (const double share : far_shares(mesh)) kernel.far_share.push_back(static_cast<float>(share));
  kernel.skin = boundary_quads(cells);
  kernel.volume_m3 = static_cast<float>(volume(mesh));
  return kernel;
}

}  // namespace mobil::inline v0_3
