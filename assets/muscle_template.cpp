#include "assets/muscle_template.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

namespace mobil {
namespace {

/// ∫N dA of each node of the far face, as parts of their sum (2×2 Gauss points on each quadrilateral).
std::vector<float> far_shares(const HexahedralMesh& mesh) {
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
  std::vector<float> share;
  for (const double a : area) share.push_back(static_cast<float>(a / total));
  return share;
}

std::array<double, KernelArrays::individual_words> words_of(const StencilPair& p) {
  return {p.a_xx, p.a_xy, p.a_yx, p.a_yy, p.a_zz, p.b_xz, p.b_yz, p.b_zx, p.b_zy, p.c_xx, p.c_yy, p.c_zz};
}

/// Appends one node's row, rounded, and what its own coupling lacks for the row (first plane included) to sum to zero.
template <std::size_t count>
void push_row(const StiffnessTerms& terms, std::uint32_t i, std::uint32_t j, std::uint32_t k,
              std::array<double, count> (*words)(const StencilPair&), std::vector<float>& row,
              std::vector<float>& rest) {
  const std::uint32_t node = node_index(terms.cells, i, j, k);
  std::array<double, count> own{};
  std::size_t own_at = 0;
  for_each_neighbour(terms.cells, i, j, k, [&](std::uint32_t m, std::size_t slot) {
    const auto exact = words(terms.pair[node * stencil_size + slot]);
    const bool fixed = m < plane_nodes(terms.cells);
    if (m == node) own_at = row.size();
    for (std::size_t w = 0; w < count; ++w) {
      const auto rounded = static_cast<float>(exact[w]);
      if (m != node) own[w] -= fixed ? exact[w] : static_cast<double>(rounded);
      if (!fixed) row.push_back(rounded);
    }
  });
  for (std::size_t w = 0; w < count; ++w) {
    row[own_at + w] = static_cast<float>(own[w]);
    rest.push_back(static_cast<float>(own[w] - static_cast<double>(row[own_at + w])));
  }
}

KernelArrays make_kernel_arrays(const HexahedralMesh& mesh, const StiffnessTerms& terms) {
  KernelArrays kernel;
  const Cells& cells = mesh.cells;
  kernel.plane_pair.assign(cells[2] + 1, 0);
  kernel.individual_rest.assign(plane_nodes(cells) * KernelArrays::individual_words, 0);
  kernel.shared_rest.assign(plane_nodes(cells) * KernelArrays::shared_words, 0);
  for_each_node(cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    if (k == 0) return;
    if (i == 0 && j == 0) kernel.plane_pair[k] = kernel.shared.size() / KernelArrays::shared_words;
    push_row<KernelArrays::individual_words>(terms, i, j, k, words_of, kernel.individual, kernel.individual_rest);
    push_row<KernelArrays::shared_words>(
        terms, i, j, k, [](const StencilPair& p) { return stiffness_block(p, 1, 1); }, kernel.shared,
        kernel.shared_rest);
  });
  for (std::size_t n = 0; n < mesh.node.size(); ++n) {
    kernel.mass_kg.push_back(static_cast<float>(terms.lumped_mass_kg[n]));
    kernel.inverse_mass.push_back(static_cast<float>(1 / terms.lumped_mass_kg[n]));
    for (const double x : {mesh.node[n].x, mesh.node[n].y, mesh.node[n].z}) {
      kernel.rest_m.push_back(static_cast<float>(x));
    }
  }
  kernel.far_share = far_shares(mesh);
  kernel.skin = boundary_quads(cells);
  kernel.volume_m3 = static_cast<float>(volume(mesh));
  return kernel;
}

}  // namespace

Result<MuscleTemplate> make_muscle_template(HexahedralMesh mesh, const Material& material,
                                            const MuscleOptions& options) {
  if (!(options.damping_per_s >= 0 && options.damping_per_s <= 1000)) {
    return fail(fmt::format("mass damping {} 1/s must lie between 0 and 1000", options.damping_per_s));
  }
  if (!(options.lowest_ratio >= 0.1 && options.highest_ratio <= 10 && options.lowest_ratio <= options.highest_ratio)) {
    return fail(fmt::format("ratios of scales from {} to {} must ascend within 0.1 to 10", options.lowest_ratio,
                            options.highest_ratio));
  }
  auto terms = assemble(mesh, material);
  if (!terms) return tl::unexpected(terms.error());
  auto steps = tabulate_critical_steps(*terms, options.far_end, options.lowest_ratio, options.highest_ratio);
  auto kernel = make_kernel_arrays(mesh, *terms);
  kernel.damping_per_s = static_cast<float>(options.damping_per_s);
  return MuscleTemplate{std::move(mesh), material, options, std::move(*terms), std::move(steps), std::move(kernel)};
}

}  // namespace mobil
