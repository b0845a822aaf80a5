#pragma once
// Step events of people with Feature::step_events, for sounds, dust, footprints and a game's own counting.

#include <cstdint>

#include <mobil/components/lanes.h>
#include <mobil/components/segments.h>
#include <mobil/components/step_events.h>
#include <mobil/engine/entity.h>

namespace mobil::inline v0_3 {

/// One event of a walker's steps.
struct StepEvent {
  Entity person;
  StepEventKind kind;
  /// Heel strike and toe-off: the foot. Stop: the foot that came down last. Start: the foot that moves first.
  Side side;
  /// Time of the event: (tick − 1 + part) · tick_s seconds after the start. `tick` counts from 1, as Simulation::ticks
  /// does. `part` is 0 to 1, in units of the walker's clock (a 32768th of a tick).
  std::uint32_t tick;
  float part;
  /// Position on the ground, m. For a foot it is the point under the ankle of the flat foot, equal at heel strike and
  /// toe-off; for a stop or start it is the point of the walking line.
  Vec3<float> place_m;
  /// Heading of the foot, or of the body at a stop or start; rad about +Y, 0 toward +Z, positive to the left.
  float heading_rad;
};

}  // namespace mobil::inline v0_3
