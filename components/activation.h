#pragma once
// A muscle that pulls: how hard it is asked to, how hard it does, and how fibres and tendon share its line of action.

#include <array>
#include <cstdint>
#include <string_view>

#include "components/lanes.h"

namespace mobil {

/// Where a muscle's excitation comes from: there is none, and the tendon does not stretch; from the phase of the
/// walker's gait cycle (assets/muscles/excitation_curves.h; who stands and posed people have their standing tone); or
/// from the host (Simulation::set_excitation).
enum class ExcitationSource : std::uint8_t { none, phase, host };
inline constexpr std::array<std::string_view, 3> excitation_source_name = {"none", "phase", "host"};

/// What an excitation and an activation may be: shares of the most that the muscle can.
inline constexpr float least_activation = 0.01F, most_activation = 1;

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
  Whole<F> slack;
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
/// Activation, and the fibre's length over its optimal one.
template <class F>
struct MemberState {
  F activation, fibre;
};

}  // namespace mobil
