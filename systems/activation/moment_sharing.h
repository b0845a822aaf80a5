#pragma once
// Distributes moments at a leg's joints among its muscles.

#include <mobil/components/activation.h>
#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

/// Moments or moment arms, in N m or m: hip and knee extending, ankle plantarflexing.
template <class F>
struct LegMoments {
  F hip, knee, ankle;
};

/// Distributes the moments of sixteen legs. Out of all activations from 0.01 to 1 that produce the moments, it chooses
/// those that minimize Σ volume · activation² (Crowninshield & Brand, J. Biomech. 14, 1981, with the square; Happee &
/// van der Helm, J. Biomech. 28, 1995, for the volumes). Fibres are at rest, at the length that the tendon leaves them
/// at the requested force. Force over length and passive force are included, force over speed is not.
///
/// Reserves supply the moments that the muscles cannot make. At the hip they stand for iliopsoas and glutei together,
/// 80 N m for 0.67 l. At knee and ankle, where all muscles exist, they are 1 N m for 1 l.
///
/// Fibre lengths take three rounds, starting from a fifth of the isometric force. Each round runs a fixed number of
/// Newton steps of the dual, which is convex with three unknowns. The first step changes no activation by more than
/// one. This limit grows after each accepted step. A step that leads uphill is undone and shortened.
///
/// `path_m` is the path length and `arm_m` the moment arm of each member. `of_most` receives the force of each tendon
/// over its isometric force, `reserve_nm` the moments left to the reserves, and `at_most` the number of members at full
/// activation. A NaN stays in its lane.
void share_moments(const LegDesign<Lanes<float>>& design, const Lanes<float>* path_m,
                   const LegMoments<Lanes<float>>* arm_m, const LegMoments<Lanes<float>>& moments_nm,
                   Lanes<float>* of_most, LegMoments<Lanes<float>>& reserve_nm, Lanes<std::uint32_t>& at_most);

}  // namespace mobil::inline v0_3
