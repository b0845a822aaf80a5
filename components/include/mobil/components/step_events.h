#pragma once
// Events in a walker's steps within a tick.

#include <cstddef>
#include <cstdint>

namespace mobil::inline v0_3 {

/// A foot lands; a foot leaves the ground; a person who walked, or stepped in place, stands; a standing person starts
/// to step.
enum class StepEventKind : std::uint8_t { heel_strike, toe_off, stopped, started };

/// Events of one walker in a tick, in order of time. Published (mobil/engine/archetype.h) by people with step events.
struct StepEvents {
  struct One {
    std::uint16_t at;  // units of the walker's clock (systems/gait/gait.h) since the tick began
    StepEventKind kind;
    std::uint8_t side;
    float x_m, z_m, heading_rad;
  };
  static constexpr std::size_t most = 7;  // more than fit into a tick of any length

  std::uint16_t count;
  /// For the step at the tick's start, if it ends in the tick: time of its end in units of `at`; 1 if a foot moved in
  /// it; 1 if a foot landed at its end; the side of that foot.
  std::uint16_t ends_at, moved, lands, landing_side;
  /// Valid in the first of a block's sixteen rows: bits of the lanes whose steps end, and of those with events.
  std::uint16_t ending, telling;
  One of[most];
};
static_assert(sizeof(StepEvents) == 128);

}  // namespace mobil::inline v0_3
