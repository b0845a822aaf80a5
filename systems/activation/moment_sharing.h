#pragma once
// Distributes moments at a leg's joints among its muscles.

#include <mobil/components/activation.h>
#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

/// Returns the moment of the hip's passive tissue of a leg of the published size, N m, flexing (Riener & Edrich,
/// Identification of passive elastic joint moments in the lower extremities, J. Biomech. 32, 1999). Their measurement
/// includes relaxed muscles, whose own passive force is small in walking.
double passive_hip_nm(double hip_flexion_rad, double knee_flexion_rad);

/// Leg whose moments are shared: path length and moment arm of each line, flexion of its joints, size over the
/// published.
struct SharedLeg {
  const Lanes<float>* path_m;
  const LegMoments<Lanes<float>>* arm_m;
  LegFlexion<Lanes<float>> flexion_rad;
  Lanes<float> size;
};

/// Distributes the moments of sixteen legs, less those of the hip's passive tissue. Out of all activations from 0.01 to
/// 1 that produce the moments, it chooses those that minimize Σ volume · activation² (Crowninshield & Brand, J.
/// Biomech. 14, 1981, with the square; Happee & van der Helm, J. Biomech. 28, 1995, for the volumes). Fibres are at
/// rest, at the length that the tendon leaves them at the force of the last ticks. Force over length and passive force
/// are included, force over speed is not.
///
/// Reserves supply the moments that the muscles cannot make: 2 N m cost as much as a litre of muscle at activation 1.
///
/// A tick runs a fixed number of Newton steps of the dual, which is convex with five unknowns. It starts at `price`,
/// the last tick's solution, and writes its own there. The first step changes no activation by more than one. This
/// limit grows after each accepted step. A step that leads uphill is undone and shortened. `smooth_of_most` are the
/// tendons' forces over their isometric force, half of which are the last tick's.
///
/// `of_most` receives the force of each tendon over its isometric force, `left_nm` the moments left to the reserves,
/// and `at_most` the number of lines at full activation. A NaN stays in its lane.
void share_moments(const LegDesign<Lanes<float>>& design, const SharedLeg& leg,
                   const LegMoments<Lanes<float>>& moments_nm, LegMoments<Lanes<float>>& price,
                   Lanes<float>* smooth_of_most, Lanes<float>* of_most, LegMoments<Lanes<float>>& left_nm,
                   Lanes<std::uint32_t>& at_most);

}  // namespace mobil::inline v0_3
