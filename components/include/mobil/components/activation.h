#pragma once
// Active muscles: excitation, activation, and the division of a line of action into fibres and tendon.

#include <cstddef>
#include <cstdint>

#include <mobil/components/lanes.h>
#include <mobil/components/leg_frames.h>

namespace mobil::inline v0_3 {

/// Range of excitations and activations, as fractions of the muscle's maximum.
inline constexpr float min_activation = 0.01F, max_activation = 1;

/// Excitation and activation of a muscle, both from 0.01 to 1. In a group they are means over its members, weighted by
/// volume. With ExcitationSource::host `excitation` is the host's last request, for all members.
template <class F>
struct Activation {
  F excitation, activation;
};

/// The muscle as one fibre and one tendon in line (systems/activation/musculotendon.h). Lengths in m and the pennation
/// angle in rad are a group's means by volume. `force_n` is the tendon force, a group's sum. `belly_m` is the belly's
/// elongation relative to relaxed standing: the line's elongation less the tendon's. `slack` counts members with a
/// slack tendon.
template <class F>
struct Musculotendon {
  F fibre_m, tendon_m, pennation_rad, force_n, belly_m;
  UInt32<F> slack;
};

/// Run-time sized columns, a few floats for each of the row's members: length of its path, m, written with the line of
/// action; constants (MemberDesign); state (MemberState).
struct MemberLength {};
struct MemberDesignField {};
struct MemberStateField {};

/// Constants of one member: the fibre's optimal length, the tendon's slack length, the constant distance between the
/// fibres' two sheets (pennation), and the belly's length in relaxed standing, all m; the isometric force at optimal
/// length, N.
template <class F>
struct MemberDesign {
  F fibre_m, tendon_m, height_m, rest_belly_m, force_n;
};
/// All lines of a leg (`member_muscles`, both legs alike) and the leg's size relative to the published one. Used for
/// people whose muscles follow the moments.
inline constexpr std::size_t leg_member_count = 39;
template <class F>
struct LegDesign {
  MemberDesign<F> member[leg_member_count];
  LegScale<F> scale;
};
/// Forces requested of the tendons, relative to the isometric force. Right leg first.
struct AskedForces {
  struct alignas(64) Leg {
    float of_most[leg_member_count];
  };
  Leg leg[2];
};
/// Moments at a leg's joints, N m, or moment arms about them, m: hip extending, abducting and rotating inward, knee
/// extending, ankle plantarflexing.
inline constexpr std::size_t leg_moment_count = 5;
template <class F>
struct LegMoments {
  F hip, hip_abduction, hip_rotation, knee, ankle;
};
/// Flexion of hip and knee, rad.
template <class F>
struct LegFlexion {
  F hip, knee;
};
/// Moments that the muscles do not produce, N m. `at_most`: number of lines at full activation. Index 0 right, 1 left.
template <class F>
struct MomentReserve {
  LegMoments<F> left_nm[2];
  UInt32<F> at_most[2];
};
/// From where the next tick continues to share a leg's moments: the rise of the cost with each moment; and the tendons'
/// forces, smoothed, relative to the isometric force. Index 0 right, 1 left.
template <class F>
struct SharingProgress {
  LegMoments<F> price[2];
  F of_most[2][leg_member_count];
};

/// Activation, and the fibre's length relative to its optimal one.
template <class F>
struct MemberState {
  F activation, fibre;
};

}  // namespace mobil::inline v0_3
