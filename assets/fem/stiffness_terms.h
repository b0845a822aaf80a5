#pragma once
// The stiffness and mass of a belly, assembled once per template and scaled to every individual.
//
// A mesh scaled by S across (x, y) and l along (z), r = S / l, has the mass S²·l·M₁ and the stiffness
//   K = S·(A/r + B + r·C).
// A collects the products of two gradients across, B of one across and one along, C of two along (E and ν inside).
// A occupies xx, xy, yx, yy, zz of the 3×3 coupling of two nodes, B xz, yz, zx, zy, C xx, yy, zz: twelve numbers a
// pair.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/components/muscle.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Coupling of a node's force (first letter) to a neighbour's displacement (second), N/m in the template's size.
struct StencilPair {
  double a_xx, a_xy, a_yx, a_yy, a_zz;
  double b_xz, b_yz, b_zx, b_zy;
  double c_xx, c_yy, c_zz;
};

inline constexpr std::size_t stencil_size = 27;

/// Returns the place in a node's stencil of the neighbour at offset (dx, dy, dz), each −1, 0 or 1.
constexpr std::size_t stencil_slot(int dx, int dy, int dz) {
  const int slot = (dz + 1) * 9 + (dy + 1) * 3 + dx + 1;
  return static_cast<std::size_t>(slot);
}

/// Returns the slot of an element's corner b as seen from its corner a.
std::size_t slot_between_corners(std::size_t a, std::size_t b);

/// Unconstrained operators of a template. `pair[27·node + slot]` and `consistent_mass_kg[27·node + slot]` couple a node
/// to its neighbour at that slot (zero if it does not exist). `lumped_mass_kg[node]` is the row sum, whose total is
/// exactly density × volume.
struct StiffnessTerms {
  Cells cells{};
  std::vector<StencilPair> pair;
  std::vector<double> consistent_mass_kg;
  std::vector<double> lumped_mass_kg;
};

/// Fails unless density is 1–1e6 kg/m³, Young's modulus 1–1e12 Pa and Poisson's ratio −0.99–0.4999; names the range.
Result<void> check_material(const Material& material);

/// ε of the hourglass stiffness ε·4μ·V·Σ|∇N|²/8 of one-point elements. Flanagan and Belytschko's λ + 2μ, which is 4μ at
/// ν = ⅓, grows without bound towards ν = ½ and locks there. At ν = 0.49 a clamped 2×2×8 block bent sideways is 64 %
/// too stiff with it, 3 % too soft with 4μ. The sideways flexibility of that block and of a tapering, bent one differs
/// from refined meshes, ν from ⅓ to 0.49, by +13 and +13 % with 0.03. It differs by +5 and −7 % with 0.05, −11 and −31
/// % with 0.1. Full integration has −15 and −24 % at ν = ⅓, −46 and −66 % at 0.49, B-bar −3 and −11 %.
inline constexpr double hourglass_share = 0.05;

/// Assembles trilinear isotropic elements; all kinds have masses at 2×2×2 Gauss points. `full` has 2×2×2 Gauss points.
/// `bbar` takes the dilatation's mean over the element (Hughes, The Finite Element Method, 1987, sections 3 and 4.5).
/// `one_point` has mean gradients and hourglass stiffness (Flanagan and Belytschko, Int. J. Numer. Meth. Eng. 17,
/// 1981). Fails on a bad material or an inverted element, which the error names.
Result<StiffnessTerms> assemble(const HexahedralMesh& mesh, const Material& material, Element element = Element::full);

/// Returns the 3×3 coupling (row-major) of a pair in a body scaled by S across and l along, N/m.
std::array<double, 9> stiffness_block(const StencilPair& pair, double across, double along);

/// Calls f(neighbour, slot) for every neighbour of node (i, j, k) that exists, itself included, x fastest.
template <class F>
void for_each_neighbour(const Cells& cells, std::uint32_t i, std::uint32_t j, std::uint32_t k, F&& f) {
  const auto low = [](std::uint32_t a) { return a > 0 ? -1 : 0; };
  const auto high = [](std::uint32_t a, std::uint32_t n) { return a < n ? 1 : 0; };
  const auto plus = [](std::uint32_t a, int d) { return static_cast<std::uint32_t>(static_cast<int>(a) + d); };
  for (int dz = low(k); dz <= high(k, cells[2]); ++dz) {
    for (int dy = low(j); dy <= high(j, cells[1]); ++dy) {
      for (int dx = low(i); dx <= high(i, cells[0]); ++dx) {
        f(node_index(cells, plus(i, dx), plus(j, dy), plus(k, dz)), stencil_slot(dx, dy, dz));
      }
    }
  }
}

/// Calls f(i, j, k) for every node in the order of their numbers.
template <class F>
void for_each_node(const Cells& cells, F&& f) {
  for (std::uint32_t k = 0; k <= cells[2]; ++k) {
    for (std::uint32_t j = 0; j <= cells[1]; ++j) {
      for (std::uint32_t i = 0; i <= cells[0]; ++i) f(i, j, k);
    }
  }
}

}  // namespace mobil::inline v0_3
