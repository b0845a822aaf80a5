#pragma once
// How far a reduced belly can be from the full model of its mesh: a number at every tick that the error never exceeds.
//
// The certificate is of the reduction alone: of u = ψ·w + V·q against all displacements of the mesh that V was made on,
// with that mesh's own stiffness and mass (half lumped, half consistent), both integrated exactly. It therefore needs a
// basis without the mesh's correction; what the mesh itself is off by is measured (against finer ones), not bounded.
//
// Over the mass S²·l, with K(r, p) of reduction_constants.h, the full model is M₁·(ü + α·u̇) + K·u = f. In a wider space
// W (V and the slow vibrations of three bodies, reduction_space.h) a belly's better motion ũ is found: what W's
// Galerkin problem has at rest under the inputs and their rates, and the vibrations y_j of those of its eigenvectors
// E_j that are nearly the mesh's own. Then u − u_V = (ũ − u_V) + e, the first known exactly, and e belongs to the
// residual
//   R = ρ₀·input + ρ₁·rate + Σ ρ_j·y_j,   ρ_j = ω_j²·M₁E_j − K·E_j,
// all orthogonal to W. With e = K⁻¹R + d, at a tick's beginning, where the inputs' rates change, d and ḋ jump by known
// fields, and within it M₁·(d̈ + α·ḋ) + K·d = −M₁·K⁻¹(R̈ + α·Ṙ) = M₁·K⁻¹(Σ ω_j²·ρ_j·y_j − α·ρ₀·rate). Under mass
// damping e^(αt/2)·d swings undamped with K − (α²/4)·M₁, whose energy only the right side changes, so that with
// D² = |d|²_K + |ḋ|²_M + α·(d, ḋ)_M
//   D ← e^(−αh/2)·(D + |jump|) + ∫ e^(−α(h−t)/2)·|K⁻¹(…)|_M dt,
//   |u − u_V|_K ≤ √(|ũ − u_V|²_K + |R|²_K⁻¹) + √(D² + (α/2)²·D_M²),
// D_M ≥ |d|_M the same one step weaker: M₁ times a jump of speed in K⁻¹, of displacement in M₁. The integral is at most
// √h times the root of that of the square, which is a quadratic form of the vibrations' amplitudes. Norms of residuals
// are such forms too: their Gram matrices are made once per basis, in double, of K₀⁻¹ times each affine term, in the
// energy of K₀ and in M₁; for a body
//   |ρ|²_K⁻¹ ≤ (p/least)·|ρ|²_K₀⁻¹,   |K⁻¹ρ|_M ≤ p·|K₀⁻¹ρ|_M + (ε/ω₁)·√p·|ρ|_K₀⁻¹,   ε² = max x²/(1 + x),
// x from least − 1 to most − 1, by the proven range least·K₀ ≤ p·K ≤ most·K₀.
// Three walks of four muscle groups on 4x4x16 cells, 12 vectors (triceps 8), a space of 64, four sizes up to the ends
// of the range: the bound is 1.5 times the error at least, 4 to 11 times it in the median; in m, 4 to 29 times. It sums
// what single kicks leave unresolved as if all pushed one way, so it is dullest where the input is smooth and the mesh
// coarse (hamstrings in 2x2x8 cells, error below 1 %: 50). 3 to 9 us a tick; 2 to 10 ms a belly. Rozza, Huynh and
// Patera, Arch. Comput. Methods Eng. 15, 2008 (residuals' norms offline and online, coercivity bounds).

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/engine/error.h>
#include "assets/reduction/reduced_basis.h"

namespace mobil {

struct ReductionTables;

/// What bounds of all bellies of one basis share; immutable, and cheap to copy.
struct ReductionBound {
  std::shared_ptr<const ReductionTables> tables;
};

/// `fields`: what make_reduced_basis handed out with `basis` on the same mesh. `space`: vectors of the wider space,
/// from the basis's own number to 160; the more, the sharper and the dearer. Fails, in one line, on a corrected basis,
/// fields that are not the basis's, a space out of range, or where no range of stiffness can be proven.
Result<ReductionBound> make_reduction_bound(const HexahedralMesh& fine, const Material& material, Element element,
                                            const ReducedBasis& basis, std::span<const double> fields,
                                            std::uint32_t space = 64);

/// The proven range of this body's stiffness over that of the basis's middle: least·K₀ ≤ p·K ≤ most·K₀; and what its
/// slowest vibration's ω is at least, 1/s.
struct BodyRange {
  double least, most, slowest_1_s;
};
BodyRange body_range(const ReductionBound& bound, double across, double along);

/// At the end of a tick. Energy norms √(eᵀ·K·e) in √J. `energy` never falls below that of the reduced displacement's
/// error; `own` is the reduced displacement's. `rms_m`: never below √(eᵀMe/mass), the error's root mean square over the
/// belly. `rounding` is
/// what `energy` has in it for kernels in single precision: 1e-5 of the largest `own` yet, which fades as vibrations
/// do.
struct ReductionError {
  double energy = 0, own = 0, rms_m = 0, rounding = 0;
};

struct BoundedMotion;

/// One belly: its reduced motion in double, and what that can be off by.
class BoundedBelly {
 public:
  /// Fails on a size outside the basis's range, one for which the range of stiffness cannot be proven to be above 0,
  /// and damping outside 0 < α < 2ω₁ (times 0.99).
  static Result<BoundedBelly> make(const ReductionBound& bound, double across, double along, double damping_per_s);
  BoundedBelly(BoundedBelly&&) noexcept;
  BoundedBelly& operator=(BoundedBelly&&) noexcept;
  ~BoundedBelly();

  /// At rest under `inputs` (input_count of them, as ReducedOptions says; m or N, then FrameLoad's twelve).
  ReductionError start(std::span<const double> inputs);
  /// Inputs go linearly from where they were to `inputs` in tick_s (above 0). Another tick_s than the last one costs as
  /// much as a hundred ticks.
  ReductionError step(std::span<const double> inputs, double tick_s);

  /// The reduced coordinates q of the basis's vectors now, m: the twin that the bound is of.
  std::vector<double> coordinates() const;
  /// Vibrations of the wider space that are followed.
  std::size_t followed() const;

 private:
  explicit BoundedBelly(std::unique_ptr<BoundedMotion> motion);
  std::unique_ptr<BoundedMotion> motion_;
};

}  // namespace mobil
