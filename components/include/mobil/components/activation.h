#pragma once
// A muscle that pulls: how hard it is asked to, how hard it does, and how fibres and tendon share its line of action.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <mobil/components/lanes.h>
#include <mobil/components/leg_frames.h>

namespace mobil::inline v0_3 {

/// Where a muscle's excitation comes from: there is none, and the tendon does not stretch; from the phase of the
/// walker's gait cycle (assets/muscles/excitation_curves.h; who stands and posed people have their standing tone);
/// from the host (Simulation::set_excitation); or from the moments at the leg's joints (JointMoments), shared among its
/// muscles as costs them least.
enum class ExcitationSource : std::uint8_t { none, phase, host, moments };
inline constexpr std::array<std::string_view, 4> excitation_source_name = {"none", "phase", "host", "moments"};

/// What an excitation and an activation may be: shares of the most that the muscle can.
inline constexpr float min_activation = 0.01F, max_activation = 1;

/// How hard a muscle is asked to pull and how hard it does, both from 0.01 to 1. Of a group: means of its members', by
/// their volumes. With ExcitationSource::host `excitation` is what the host asked for last, of all its members.
template <class F>
struct Activation {
  F excitation, activation;
};

/// The muscle as one fibre and one tendon in line (systems/activation/musculotendon.h): lengths, m, and the fibre's
/// angle to the tendon, rad, of a group means by volume; the force that the tendon passes on, N, of a group the sum;
/// how much farther apart the belly's ends are than in who stands relaxed, m: what the tendon has left of the line's
/// lengthening; and how many of its members have a slack tendon.
template <class F>
struct Musculotendon {
  F fibre_m, tendon_m, pennation_rad, force_n, belly_m;
  UInt32<F> slack;
};

/// Run-time sized columns, a few floats for each of the row's members: length of its path, m, written with the line of
/// action; what it is (MemberDesign); how it is (MemberState).
struct MemberLength {};
struct MemberDesignField {};
struct MemberStateField {};

/// One member's words in these columns: the fibre's optimal length, the tendon's slack length, the height that the
/// fibres keep between their sheets (constant thickness), the belly's length in who stands relaxed, all m; the
/// isometric force at optimal length, N.
template <class F>
struct MemberDesign {
  F fibre_m, tendon_m, height_m, rest_belly_m, force_n;
};
/// Of a person whose muscles follow the moments, all single muscles of a leg (`member_muscles`, both legs alike): what
/// they are, and the leg's size over the published one.
inline constexpr std::size_t leg_member_count = 13;
template <class F>
struct LegDesign {
  MemberDesign<F> member[leg_member_count];
  LegScale<F> scale;
};
/// What their tendons are to pull with, of the isometric force. Right leg first.
struct AskedForces {
  struct alignas(64) Leg {
    float of_most[leg_member_count];
  };
  Leg leg[2];
};
/// What of the moments the muscles do not make, N m, signs as in JointMoments: at the hip mostly iliopsoas and glutei,
/// which are not among them; and how many muscles of the leg are asked for all they can. Index 0 right, 1 left.
template <class F>
struct MomentReserve {
  F hip_nm[2], knee_nm[2], ankle_nm[2];
  UInt32<F> at_most[2];
};

/// Activation, and the fibre's length over its optimal one.
template <class F>
struct MemberState {
  F activation, fibre;
};

}  // namespace mobil::inline v0_3
