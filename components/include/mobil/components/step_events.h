#pragma once
// What comes to pass in a walker's steps within a tick.

#include <cstddef>
#include <cstdint>

namespace mobil::inline v0_3 {

/// A foot comes to the ground; a foot leaves it; somebody who walked, or stepped where they stood, stands; somebody who
/// stood begins to step.
enum class StepEventKind : std::uint8_t { heel_strike, toe_off, stopped, started };

/// What came to pass in one walker's steps in a tick, in that order. Published (mobil/engine/archetype.h) by who is
/// watched.
struct StepEvents {
  struct One {
    std::uint16_t at;  // units of the walker's clock (systems/gait/gait.h) since the tick began
    StepEventKind kind;
    std::uint8_t side;
    float x_m, z_m, heading_rad;
  };
  static constexpr std::size_t most = 7;  // more than a tick of any length holds

  std::uint16_t count;
  /// Of the step that the tick began in, where it ends in the tick: when, in units of `at`; whether a foot moved in it,
  /// and one came to the ground at its end; which that was.
  std::uint16_t ends_at, moved, lands, landing_side;
  /// Of the first of a block's sixteen rows: bits of the lanes whose steps end, and of those to whom something came to
  /// pass. Rows of other lanes mean nothing.
  std::uint16_t ending, telling;
  One of[most];
};
static_assert(sizeof(StepEvents) == 128);

}  // namespace mobil::inline v0_3
