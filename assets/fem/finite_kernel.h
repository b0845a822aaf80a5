#pragma once
// Finite strain in the explicit kernel: one-point elements of the tissue of assets/fem/finite_tissue.h with hourglass
// stiffness, and a stiffness that bounds their tangents.

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

/// κ' over μ in the explicit kernel. 10, 20, 50 keep the volume of 2×2×8 elements to 5, 3 and 1 %, and take steps of
/// 2.5, 1.8 and 1.2 ms; the better the volume is kept, the more elements lock.
inline constexpr double stepped_bulk_over_shear = 20;

/// Returns tissue with the material's shear modulus and density, whose stresses are all in proportion to that modulus.
/// Poisson's ratio enters only through it.
FiniteTissue stepped_tissue(const Material& material);

/// Limit of the series for passive stress σ_P·(e^z − 1)/(e⁴ − 1), z = 4(0.9 λ − 1)/0.6 above 0. Up to this z (λ = 1.26)
/// the kernel has the series to z⁴, beyond it a straight line, so that no stretch makes it stiffer.
inline constexpr double max_passive_exponent = 0.9;

/// Bellies run along bones, and active fibres would straighten bent ones through them (by 4 to 7 mm at full
/// activation). Fibres therefore feel a section's mean sideways displacement only to second order. With q = H·a of an
/// element, w its part from the means of its two planes and a⊥ the fibre's own slope, λ² = |a + q|² − 2·a⊥·w.
/// Neighbours carry their sideways pull on a section at rest; tension still stiffens it like a string. The energy
/// remains a function of displacement.

/// One element of the template's size. All lanes read every number except the nodes'. With ξ, η, ζ = ±1 at the corners,
/// mean gradients of a displacement u follow from the sums Σ ξu, Σ ηu, Σ ζu, Σ ηζu, Σ ξζu, Σ ξηu over the corners.
/// Hourglass patterns follow from Σ ηζu, Σ ξζu, Σ ξηu, Σ ξηζu less a gradient's part of them. Sections are flat, so
/// most factors are 0.
struct FiniteKernelElement {
  std::array<std::uint32_t, 8> node{};  // less the first node of its lower plane
  /// ∂u/∂x and ∂u/∂y over Σ ξu, Σ ηu, Σ ηζu, Σ ξζu; ∂u/∂z over those and Σ ζu, Σ ξηu, 1/m.
  std::array<std::array<float, 4>, 2> across{};
  std::array<float, 6> along{};
  /// Parts of ∂u/∂x and ∂u/∂y in the four sums of the patterns, m.
  std::array<std::array<float, 2>, 4> straight{};
  std::array<float, 3> fibre{};     // direction at its middle, length 1
  float aside2 = 0, straight2 = 0;  // the squares of its parts in the section and along
  float volume_m3 = 0;
  float fibre_volume_m3 = 0;                        // times the crowding of fibres, up to `max_crowding`
  float hourglass_across = 0, hourglass_along = 0;  // HourglassStiffness, N/m
  float rise = 0;  // how far the fibre's ends part when the upper plane moves by 1, 1/m
};

struct FiniteKernel {
  FiniteTissue tissue{};
  double length_m = 0;                       // of the belly at rest
  std::vector<FiniteKernelElement> element;  // in the mesh's order: by layers
  std::vector<float> plane_share;            // each node's part in its plane's mean, by mass
};

/// Makes the kernel's arrays. `linear` is of the same mesh and gives the masses. Fails on a bad material, an inverted
/// element or a section that is not flat, which the error names.
Result<FiniteKernel> make_finite_kernel(const HexahedralMesh& mesh, const StiffnessTerms& linear,
                                        const Material& material);

/// Deformation gradients within which `finite_bound` holds: |cof F − 1| and |J − 1|. Over shortenings of −0.2 to 0.25
/// and all activations, 81 nodes have 0.51 and 0.07, 425 nodes 0.64 and 0.15.
struct FiniteEnvelope {
  double cofactor = 0.65, dilatation = 0.15;
};
/// Clamp of J − 1 in the kernel's pressure, which bounds the pressure far outside of that.
inline constexpr float min_dilatation = -0.4F, max_dilatation = 0.6F;

/// Returns a stiffness (with the masses of `linear`) that, as an operator, bounds every tangent of a belly of any size
/// whose elements are within the envelope. It is proven except for the fibres' response to sections' means, which tests
/// compare. With H = dF the tissue's is
///   μ|H|² + κ'(cof F : H)² + (κ'(J − 1) − μ)·d²J[H, H].
/// Here (cof F : H)² ≤ (1 + ε)(tr H)² + (1 + 1/ε)δ²|H|² with ε = δ/√3, and d²J ≤ 2.6|H|², the sum of the two largest
/// stretches. The fibres' is at most T̄|H·a|², with both slope and tension over stretch below T̄. For slanting fibres,
/// 1/(p·r + q/r) ≤ p/r + q·r (p + q = 1) gives it the form S·(A/r + B + r·C).
StiffnessTerms finite_bound(const HexahedralMesh& mesh, const FiniteKernel& kernel, const StiffnessTerms& linear,
                            const FiniteEnvelope& envelope = {});

}  // namespace mobil::inline v0_3
