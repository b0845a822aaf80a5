#pragma once
// Bellies that move along a few vectors (assets/reduced_basis.h), sixteen individuals a block. Motion j of an
// individual, z̈ + α·ż + ω²·z = ω²·s(t) with s = Σ P·input linear over the tick, is integrated exactly, at any tick.
// With z = s − (α/ω²)·ṡ + Y/ω, and V = d(Y/ω)/dt, a tick is: where the inputs' rates changed by Δ, V −= P·Δ and Y +=
// g·P·Δ, then
//   Y ← a·Y + b·V,   V ← −b·Y + (a − g·b)·V,   g = α/ω,
//   b = e^(−αh/2)·ω·sin(ω_d·h)/ω_d,   a = e^(−αh/2)·(cos(ω_d·h) + (α/2)·sin(ω_d·h)/ω_d),   ω_d² = ω² − α²/4
// (hyperbolic where ω_d² < 0). Three numbers a motion are all that a tick reads besides its state. Unconditionally
// stable, without period error.

#include <cstddef>
#include <cstdint>

#include "assets/reduced_basis.h"
#include "components/lanes.h"
#include "components/muscle.h"
#include "systems/deformation/deformation.h"

namespace mobil {

/// Sixteen bellies of one basis; every field holds that many floats × 16, sixteen lanes at each, aligned to 64 bytes.
///
/// `state` (reduced_state_width): Y and V of each motion, then the inputs' rates of the last tick, per s. All zero is a
/// belly at rest under whatever loads it, about to be moved. `motion` (reduced_motion_width): a, b, g of each motion;
/// with several inputs, P of each after them (with one, P is left to `shape`).
struct ReducedBlock {
  const ReducedBasis& basis;
  const BellyScale<Lanes<float>>& scale;
  float* state;
  const float* motion;
  const FrameLoad<Lanes<float>>* frame = nullptr;  // null where the basis has no frame loads
};

/// One tick of a block. A lane's NaN stays in its lane. No heap.
void deform_reduced(const ReducedBlock& block, const EndDrive& end, float tick_s);

/// Where the control points are at the tick's end: `displacement`, three a node in m, muscle's frame, as in BellyBlock
/// (the origin face's are zero). `shape` (reduced_shape_width): for each vector N numbers of Y − g·ṡ, then one of each
/// input. With `report`, energies, elongation, reaction and volume (of the control points' mesh `muscle`) too.
struct ControlPoints {
  const float* shape;
  float* displacement;
};
void place_control_points(const ReducedBlock& block, const ControlPoints& points, const EndDrive& end, float tick_s);

/// Where a belly without motion of its own is: the static answer to what drives and loads it, with the same shapes
/// (`state` and `motion` are not touched and may be null).
void place_static(const ReducedBlock& block, const ControlPoints& points, const EndDrive& end);

}  // namespace mobil
