#pragma once
// Finite strain as the explicit kernel steps it: one-point elements of the tissue of assets/fem/finite_tissue.h with
// hourglass stiffness, and a stiffness that their tangents stay below.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/components/muscle.h>
#include <mobil/engine/error.h>
#include "assets/fem/finite_tissue.h"
#include "assets/fem/stiffness_terms.h"

namespace mobil::inline v0_3 {

/// κ' over μ of what is stepped. 10, 20, 50 keep the volume of 2×2×8 elements to 5, 3 and 1 %, and take steps of 2.5,
/// 1.8 and 1.2 ms; the better the volume is kept, the more elements lock.
inline constexpr double stepped_bulk_over_shear = 20;

/// Tissue whose shear modulus and density are the material's; all stresses are in proportion to that modulus. Beyond
/// that modulus Poisson's ratio has no part.
FiniteTissue stepped_tissue(const Material& material);

/// Of passive stress σ_P·(e^z − 1)/(e⁴ − 1), z = 4(0.9 λ − 1)/0.6 above 0, the kernel has the series to z⁴ up to this z
/// (λ = 1.26) and a straight line beyond, so that no stretch makes it stiffer.
inline constexpr double max_passive_exponent = 0.9;

/// Bellies lie along bones, and fibres that pull would straighten bent ones through them (by 4 to 7 mm at full
/// activation). So fibres feel a section's mean displacement sideways to second order alone: with q = H·a of an
/// element, w its part from the means of its two planes and a⊥ the fibre's own slope, λ² = |a + q|² − 2·a⊥·w. What they
/// would pull a section aside with at rest, neighbours carry; tension goes on to stiffen it as a string. The energy is
/// a function of displacement still.

/// One element of the template's size. Every number but the nodes' is read by all lanes. With ξ, η, ζ = ±1 at the
/// corners, the mean gradient of a displacement u follows from the sums Σ ξu, Σ ηu, Σ ζu, Σ ηζu, Σ ξζu, Σ ξηu over the
/// corners, and the hourglass patterns from Σ ηζu, Σ ξζu, Σ ξηu, Σ ξηζu less what of them a gradient has. Sections are
/// flat, so most of the factors are 0.
struct FiniteKernelElement {
  std::array<std::uint32_t, 8> node{};  // less the first node of its lower plane
  /// ∂u/∂x and ∂u/∂y over Σ ξu, Σ ηu, Σ ηζu, Σ ξζu; ∂u/∂z over those and Σ ζu, Σ ξηu, 1/m.
  std::array<std::array<float, 4>, 2> across{};
  std::array<float, 6> along{};
  /// What of the four sums of the patterns ∂u/∂x and ∂u/∂y have, m.
  std::array<std::array<float, 2>, 4> straight{};
  std::array<float, 3> fibre{};     // direction at its middle, length 1
  float aside2 = 0, straight2 = 0;  // the squares of its parts in the section and along
  float volume_m3 = 0;
  float fibre_volume_m3 = 0;                        // times how crowded fibres are, up to `max_crowding`
  float hourglass_across = 0, hourglass_along = 0;  // HourglassStiffness, N/m
  float rise = 0;  // how much the fibre's ends part where the upper plane moves on by 1, 1/m
};

struct FiniteKernel {
  FiniteTissue tissue{};
  double length_m = 0;                       // of the belly at rest
  std::vector<FiniteKernelElement> element;  // in the mesh's order: by layers
  std::vector<float> plane_share;            // of each node in its plane's mean: by mass
};

/// `linear`: the same mesh's, whose masses are shared out. Fails on a bad material, on an inverted element and on a
/// section that is not flat, which it names.
Result<FiniteKernel> make_finite_kernel(const HexahedralMesh& mesh, const StiffnessTerms& linear,
                                        const Material& material);

/// How far deformation gradients go within which `finite_bound` holds: |cof F − 1| and |J − 1|. Met by 81 nodes over
/// shortenings of −0.2 to 0.25 and all activations: 0.51 and 0.07; by 425 nodes 0.64 and 0.15.
struct FiniteEnvelope {
  double cofactor = 0.65, dilatation = 0.15;
};
/// Clamp of J − 1 in what the kernel feels of volume, which bounds the pressure far outside of that.
inline constexpr float min_dilatation = -0.4F, max_dilatation = 0.6F;

/// Stiffness (with the masses of `linear`) that, as an operator, no tangent of a belly of any size exceeds whose
/// elements are within the envelope; proven but for what fibres feel of sections' means, which tests compare. With H =
/// dF the tissue's is
///   μ|H|² + κ'(cof F : H)² + (κ'(J − 1) − μ)·d²J[H, H],
/// where (cof F : H)² ≤ (1 + ε)(tr H)² + (1 + 1/ε)δ²|H|² with ε = δ/√3, and d²J ≤ 2.6|H|², the sum of the two largest
/// stretches; the fibres' at most T̄|H·a|² with both slope and tension over stretch below T̄. Where fibres lie aslant,
/// 1/(p·r + q/r) ≤ p/r + q·r (p + q = 1) gives that the form S·(A/r + B + r·C).
StiffnessTerms finite_bound(const HexahedralMesh& mesh, const FiniteKernel& kernel, const StiffnessTerms& linear,
                            const FiniteEnvelope& envelope = {});

}  // namespace mobil::inline v0_3
