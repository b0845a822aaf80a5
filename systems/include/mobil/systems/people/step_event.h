#pragma once
// What happens in the steps of people who are watched: for sounds, dust, footprints and a game's own counting.

#include <cstdint>

#include <mobil/components/lanes.h>
#include <mobil/components/segments.h>
#include <mobil/components/step_events.h>
#include <mobil/engine/entity.h>

namespace mobil::inline v0_3 {

/// What happened in a walker's steps.
struct StepEvent {
  Entity person;
  StepEventKind kind;
  /// The foot that came to the ground or left it; that came down last before somebody stood; that goes first.
  Side side;
  /// Time of the event: (tick − 1 + part) · tick_s seconds after the beginning. `tick` counts from 1, as
  /// Simulation::ticks does. `part` is 0 to 1, in units of the walker's clock (a 32768th of a tick).
  std::uint32_t tick;
  float part;
  /// On the ground, m: of a foot the point under its ankle when it lies flat, the same as it comes down and as it
  /// leaves; of who stops or starts the point of the walking line.
  Vec3<float> place_m;
  /// Where the foot points, of who stops or starts the body; rad about +Y, 0 toward +Z, positive to the left.
  float heading_rad;
};

}  // namespace mobil::inline v0_3
