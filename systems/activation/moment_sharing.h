#pragma once
// Moments at a leg's joints shared among its muscles: of all activations from 0.01 to 1 that make them, those of least
// Σ volume · activation² (Crowninshield & Brand, J. Biomech. 14, 1981, with the square; Happee & van der Helm, J.
// Biomech. 28, 1995, for the volumes). Fibres count as they are at rest, at the length that the tendon leaves them at
// the force that they are asked for: force over length and passive force are in it, force over speed is not.
//
// What muscles cannot make, or are not there for, is a reserve: at the hip iliopsoas and glutei together, 80 N m for
// 0.67 l; at knee and ankle, all of whose muscles are there, 1 N m for 1 l.
//
// Three rounds for the fibres' lengths, from a fifth of their force; in each a number of Newton steps of the dual,
// which has three unknowns and is convex, always. No step changes an activation by more than one; one that leads uphill
// is taken back and shortened.

#include <mobil/components/activation.h>
#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

/// Moments or moment arms, in N m or m: hip and knee extending, ankle plantarflexing.
template <class F>
struct LegMoments {
  F hip, knee, ankle;
};

/// Sixteen legs. By member: `path_m`, the path's length; `arm_m`. Writes `of_most`, force over the isometric one, of
/// each tendon; what is left to the reserves; and how many are asked for all that they can. A NaN stays in its lane.
void share_moments(const LegDesign<Lanes<float>>& design, const Lanes<float>* path_m,
                   const LegMoments<Lanes<float>>* arm_m, const LegMoments<Lanes<float>>& moments_nm,
                   Lanes<float>* of_most, LegMoments<Lanes<float>>& reserve_nm, Lanes<std::uint32_t>& at_most);

}  // namespace mobil::inline v0_3
