#pragma once
// Bellies that move along a few modes (assets/reduction/modal_basis.h), sixteen individuals a block. Each mode is
// integrated exactly.

#include <mobil/components/lanes.h>
#include <mobil/components/muscle.h>
#include "assets/fem/muscle_template.h"
#include "assets/reduction/modal_belly.h"
#include "systems/deformation/deformation.h"

namespace mobil::inline v0_3 {

/// Sixteen bellies of one basis. Each field contains the given number of floats × 16, sixteen lanes per number, aligned
/// to 64 bytes.
///
/// `state` (modal_state_width): X and W of each motion (X₀ W₀ X₁ W₁ …), with one input both over P. All zero is a belly
/// at rest under its present loads. For a tuned belly with frame loads this holds only if A is A₀.
///
/// `motion` (modal_motion_width): a, b, g and, with several inputs, P of each motion (a₀ b₀ g₀ P₀₀ P₀₁ … a₁ …). P of
/// the ends is stored in full. P of the frame's loads is stored in pairs, as upper halves of floats, the even one in
/// the word's lower half. (A tick is limited by memory. The error, 0.2 % at most, affects only swings, because the rest
/// position is in `shape`.) With one input P is only in `shape`. Tuned bellies store 1/ω, ω² − A₀·γ and γ instead of a,
/// b and g.
struct ModalBlock {
  const ModalBasis& basis;
  const BellyScale<Lanes<float>>& scale;
  float* state;
  const float* motion;
  const FrameLoad<Lanes<float>>* frame = nullptr;  // null where the basis has no frame loads
  // Fields of the next block, or null: prefetched, never read. In crowds larger than the caches this makes a
  // tick 2 times and its control points 1.5 times faster.
  const float *next_state = nullptr, *next_motion = nullptr;
};

/// Advances a block by one tick. Motion j of an individual, z̈ + α·ż + ω²·z = ω²·s(t) with s = Σ P·input linear over
/// the tick, is integrated exactly, at any tick. The state is X = ω·(z − s) and W = ż, both continuous. With ṡ over the
/// tick, Y = X + g·ṡ and V = W − ṡ swing freely.
///
///   Y ← a·Y + b·V,   V ← −b·Y + (a − g·b)·V,   g = α/ω,
///   b = e^(−αh/2)·ω·sin(ω_d·h)/ω_d,   a = e^(−αh/2)·(cos(ω_d·h) + (α/2)·sin(ω_d·h)/ω_d),   ω_d² = ω² − α²/4.
///
/// (They are hyperbolic where ω_d² < 0.) A tick reads three numbers per motion in addition to its state. It is
/// unconditionally stable, without period error. A lane's NaN stays in its lane. A belly whose state at the end is not
/// finite, or beyond 1.8e19, restarts at rest, and its lane's bit is set in the result. Uses no heap.
std::uint32_t deform_modal(const ModalBlock& block, const FarFaceDrive& end, float tick_s);

/// Advances bellies with this many modes that are moved only by the end's displacement, `from` to `to`. `state` and
/// `motion` are those of a ModalBlock with one input.
std::uint32_t swing_modal(std::size_t modes, const Lanes<float>& from, const Lanes<float>& to, float tick_s,
                          float* state, const float* motion);

/// Returns α of tuned bellies, 1/s, except for motions so slow that they would creep.
constexpr double tuned_damping_per_s(double activation) {
  return 16 + 60 * activation;
}

/// Advances a block of tuned bellies at `activation` A, 0.01 to 1. Active fibres stiffen and damp the motions:
///
///   ω'² = ω² + (A − A₀)·γ,   α = 16 + 60·A,   z̈ + α·ż + ω'²·(z − s_end) = ω²·s_frame,
///
/// with A₀ = tuned_activation and γ = tension_1_s2. The rest position due to the end's displacement stays the same, and
/// frame loads displace the belly less. α is at most 1.9 times a belly's lowest ω'. The state is X = ω·(z − s) with ω
/// and s of A₀, so placement does not depend on A. Each tick swings z minus its rest position, s_end +
/// (ω²/ω'²)·s_frame. (Wakeling and Nigg, J. Appl. Physiol. 90, 2001: frequency and damping of vibrations rise with
/// force. 16 gives 7 Hz a share of critical damping of 0.18, 16 + 60 gives 15 Hz 0.4; no source measures them.)
std::uint32_t deform_tuned(const ModalBlock& block, const FarFaceDrive& end, const Lanes<float>& activation,
                           float tick_s);

/// Writes positions of the control points at the tick's end to `displacement`, three numbers a node in m, in the
/// muscle's frame, as in BellyBlock (zeros for the origin face).
///
/// `shape` (modal_shape_width) starts with, for each mode k, N numbers of X, E_kj·(P_j)/ω_j (P only with one input),
/// then one of each input, Σ_j E_kj·P_ji (minus Σ_j E_kj·lift_share_j for a held end's displacement): q_k. The rest is
/// only for the report: ω_j of each motion (N), P_j of the first input of each motion (N), the reaction at rest to each
/// input per unit (of a held face; N per unit), and S²·l·α·(ψᵀM₁ψ − |VᵀM₁ψ|²) (kg/s).
///
/// `streamed` writes the displacements past the caches, with the same bits. This is faster if the caches could not keep
/// them until they are read (from about ten thousand bellies on).
struct ControlPoints {
  const float* shape;
  float* displacement;
  bool streamed = false;
  const float* next_shape = nullptr;  // as in ModalBlock
};
void place_control_points(const ModalBlock& block, const ControlPoints& points, const FarFaceDrive& end);

/// Places a belly without its own motion: the static solution for its drive and loads, with the same shapes. `state`
/// and `motion` are not read and can be null.
void place_static(const ModalBlock& block, const ControlPoints& points, const FarFaceDrive& end);

/// Writes the report of the block after its tick and its placing. Volume is that of the mesh of `control`, whose nodes
/// are the control points. It keeps its value if those are null, which is allowed for a held end. The reaction of a
/// held face is the force that moves it, by the lift's virtual work. Otherwise it is the pulling force (for a mesh
/// without end both are the elastic force at the face). Strain energy includes the foundation's, so the sum of both
/// energies is constant in free undamped motion. A null state means a static belly; with several inputs `motion` is
/// still read. Reaction and strain energy of moving tuned bellies are those of the tension of A₀, and the drag in the
/// reaction is that of the basis's damping.
void report_modal(const ModalBlock& block, const MuscleTemplate& control, const ControlPoints& points,
                  const FarFaceDrive& end, float tick_s, BellyReport<Lanes<float>>& report);

}  // namespace mobil::inline v0_3
