#pragma once
// Bellies that move along a few modes (assets/reduction/modal_basis.h), sixteen individuals a block. Motion j of an
// individual, z̈ + α·ż + ω²·z = ω²·s(t) with s = Σ P·input linear over the tick, is integrated exactly, at any tick.
// Kept are X = ω·(z − s) and W = ż, both continuous. With ṡ over the tick, Y = X + g·ṡ and V = W − ṡ swing freely,
//   Y ← a·Y + b·V,   V ← −b·Y + (a − g·b)·V,   g = α/ω,
//   b = e^(−αh/2)·ω·sin(ω_d·h)/ω_d,   a = e^(−αh/2)·(cos(ω_d·h) + (α/2)·sin(ω_d·h)/ω_d),   ω_d² = ω² − α²/4
// (hyperbolic where ω_d² < 0). Three numbers a motion are all that a tick reads besides its state. Unconditionally
// stable, without period error.
//
// Of tuned bellies fibres that pull stiffen and damp the motions. With activation A over the tick
//   ω'² = ω² + (A − A₀)·γ,   α = 16 + 60·A,   z̈ + α·ż + ω'²·(z − s_end) = ω²·s_frame,
// A₀ = tuned_activation, γ = tension_1_s2: what the end's displacement makes of a belly at rest stays, under the loads
// of the frame it gives way less. α is at most 1.9 times a belly's lowest ω'. Kept is X = ω·(z − s), ω and s those of
// A₀, so that it is placed alike whatever A; each tick swings what is left of z when its place in rest, s_end +
// (ω²/ω'²)·s_frame, is taken away. (Wakeling and Nigg, J.
// Appl. Physiol. 90, 2001: frequency and damping of vibrations rise with force. 16 gives 7 Hz a share of critical
// damping of 0.18, 16 + 60 gives 15 Hz 0.4; no source measures them.)

#include <mobil/components/lanes.h>
#include <mobil/components/muscle.h>
#include "assets/fem/muscle_template.h"
#include "assets/reduction/modal_belly.h"
#include "systems/deformation/deformation.h"

namespace mobil::inline v0_3 {

/// Sixteen bellies of one basis; every field holds that many floats × 16, sixteen lanes at each, aligned to 64 bytes.
///
/// `state` (modal_state_width): X and W of each motion (X₀ W₀ X₁ W₁ …); with one input both over P. All zero is a
/// belly at rest under whatever loads it, about to be moved; a tuned one that the frame loads only where A is A₀.
/// `motion` (modal_motion_width): of each motion a, b, g and, with several inputs, its P (a₀ b₀ g₀ P₀₀ P₀₁ … a₁ …):
/// those of the ends as they are, those of the frame's loads two a word, as upper halves of floats, the even one in the
/// word's lower half. (Memory is what a tick waits for; that they are 0.2 % off at most is so of swings alone, for the
/// place in rest is in `shape`.) With one input P is left to `shape`. Of tuned bellies 1/ω, ω² − A₀·γ and γ take
/// the places of a, b and g.
struct ModalBlock {
  const ModalBasis& basis;
  const BellyScale<Lanes<float>>& scale;
  float* state;
  const float* motion;
  const FrameLoad<Lanes<float>>* frame = nullptr;  // null where the basis has no frame loads
  // Where the next block to be worked on has the same, or null: meanwhile fetched, never used. Of crowds that no cache
  // holds it takes half off a tick and a third off its control points.
  const float *next_state = nullptr, *next_motion = nullptr;
};

/// One tick of a block. A lane's NaN stays in its lane. A belly whose state is not finite, or beyond 1.8e19, at the end
/// begins at rest, and its lane is one of the bits returned. No heap.
std::uint32_t deform_modal(const ModalBlock& block, const FarFaceDrive& end, float tick_s);

/// The same of bellies of so many modes that the end's displacement alone moves, from and to: `state` and `motion` as
/// in a ModalBlock with one input.
std::uint32_t swing_modal(std::size_t modes, const Lanes<float>& from, const Lanes<float>& to, float tick_s,
                          float* state, const float* motion);

/// α of tuned bellies, 1/s, where no motion is so slow that it would creep.
constexpr double tuned_damping_per_s(double activation) {
  return 16 + 60 * activation;
}

/// The same of a block of tuned bellies, which pull as hard as `activation` says, 0.01 to 1.
std::uint32_t deform_tuned(const ModalBlock& block, const FarFaceDrive& end, const Lanes<float>& activation,
                           float tick_s);

/// Where the control points are at the tick's end: `displacement`, three a node in m, muscle's frame, as in BellyBlock
/// (the origin face's are written too: zero).
///
/// `shape` (modal_shape_width): for each vector k N numbers of X, E_kj·(P_j)/ω_j (P with one input alone), then one
/// of each input, Σ_j E_kj·P_ji (less Σ_j E_kj·lift_share_j for a held end's displacement): q_k. Then, for the report
/// alone, ω_j of each motion (N), P_j of the first input of each motion (N), the reaction in rest to each input per
/// unit (of a held face; N per unit), and S²·l·α·(ψᵀM₁ψ − |VᵀM₁ψ|²) (kg/s).
///
/// `streamed`: the displacements are written past the caches, which is faster where these could not keep them until
/// somebody reads them (some ten thousand bellies); the same bits.
struct ControlPoints {
  const float* shape;
  float* displacement;
  bool streamed = false;
  const float* next_shape = nullptr;  // as ModalBlock's
};
void place_control_points(const ModalBlock& block, const ControlPoints& points, const FarFaceDrive& end);

/// Where a belly without motion of its own is: the static answer to what drives and loads it, with the same shapes
/// (`state` and `motion` are not touched and may be null).
void place_static(const ModalBlock& block, const ControlPoints& points, const FarFaceDrive& end);

/// What the block did, after its tick and its placing. Volume is that of the mesh of `control`, whose nodes the control
/// points are; it stays what it was where those are null, as they may be of a held end. Reaction: of a held face the
/// force that moves it, by the lift's virtual work; else what pulls (of a mesh without end both are the elastic force
/// at the face). Strain energy includes the foundation's, so that both energies' sum is constant in free undamped
/// motion. A null state is that of a static belly; with several inputs `motion` is read all the same. Of tuned bellies
/// that move reaction and strain energy are those of the tension of A₀, and the drag in the reaction is that of the
/// basis's damping.
void report_modal(const ModalBlock& block, const MuscleTemplate& control, const ControlPoints& points,
                  const FarFaceDrive& end, float tick_s, BellyReport<Lanes<float>>& report);

}  // namespace mobil::inline v0_3
