#pragma once
// Collision avoidance between walkers. The host sets the desired velocity of each. At every heel strike Avoidance
// chooses the next step toward it, among steps that are clear of all other people, walls and discs.
//
//   Simulation simulation;
//   simulation.avoidance().manage(person);                     // keeps its requested gait as desired velocity
//   simulation.avoidance().set_walls({{{-5, 2.5F}, {5, 2.5F}}});
//   simulation.avoidance().set_desired_velocity({{person, 1.3F, heading_rad}});  // whenever it changes
//   simulation.advance(frame_seconds);
//
// A *reservation* is the path of a walker through the current step and the quickest stop after it. A walker takes a
// step only if that step, and the stop after it, are clear of all reservations. If no step is, the walker follows its
// own reservation, which all others have kept clear. By induction no managed walkers collide, in any order of choices.
//
// Desired velocities are state on the person's row (mobil/components/avoidance.h), and reservations follow from the
// world. Walls, discs and options are not state: a simulation that restores a snapshot keeps its own. Two people are on
// different floors, and ignore each other, if their height difference exceeds that of the slopes they walk on by 1.5 m.
// Decisions depend on the world, walls and discs alone, not on threads or rows. Speed and heading of managed people are
// set through Avoidance: requests by change_gait and turn_to last until the next step.

#include <cstddef>
#include <cstdint>
#include <span>

#include <mobil/components/avoidance.h>
#include <mobil/engine/entity.h>
#include <mobil/engine/error.h>
#include <mobil/engine/phase.h>
#include <mobil/systems/avoidance/obstacles.h>

namespace mobil::inline v0_3 {

/// Desired velocity of a person: a speed, 0 or one that the gait can have, and a heading (rad about +Y).
struct DesiredVelocity {
  Entity person;
  float speed_m_s, heading_rad;
};

/// Distances that people keep. Values are clamped to their ranges.
struct AvoidanceOptions {
  /// Half the breadth that two managed walkers keep clear of each other, as a fraction of height, 0.02 to 0.5. The
  /// default is 0.18 m at 1.72 m, which fits the trunk and shoulders turned by 40°.
  float radius_h = 0.105F;
  /// Maximum overlap of two walkers after waiting, m, 0 to 0.2, because clothes and arms yield.
  float overlap_m = 0.03F;
  /// Half the breadth of the shoulders with the arms, as a fraction of height, `radius_h` to 0.5. The default is 0.22 m
  /// at 1.72 m. Walkers keep it clear of walls, discs and people who are not managed. Closer to another managed walker
  /// they turn their shoulders; if equal to `radius_h`, they never do.
  float shoulders_h = 0.128F;
};

/// Counts of all ticks of the last `advance` or `tick`; `people` are those managed in the last tick. `chose` counts
/// steps. The others count steps that kept the reservation, yielded to one chosen in the same tick, or waited.
struct AvoidanceReport {
  std::size_t people = 0, chose = 0, kept_reservation = 0, yielded = 0, waiting = 0;
};

struct AvoidanceWork;  // systems/avoidance/avoidance.cpp

/// Interface to a simulation's collision avoidance (Simulation::avoidance). Each tick chooses the steps that begin in
/// it, and the rotation of shoulders. It allocates only when crowds grow. A call that fails changes nothing.
class Avoidance {
 public:
  explicit Avoidance(const Frame& frame) : frame_(frame) {}

  /// Sets the options. `radius_h` and `shoulders_h` of managed walkers apply from their next `manage`; all else applies
  /// at once. Errors: a value that is not a finite number.
  Result<void> set_options(const AvoidanceOptions& options);

  /// Manages a walker from now on. The desired velocity is the last requested gait and heading. A walker who is managed
  /// already keeps the desired velocity and gets the present options. A sleeper wakes. Errors: a stale handle, a posed
  /// person (Status::missing).
  Result<void> manage(Entity person);
  /// Manages many walkers, all or none. Errors: those of one walker, a person named twice.
  Result<void> manage(std::span<const Entity> people);
  /// Stops managing walkers, all or none. They keep their present gait and face their way. A walker slowed by a slope
  /// alone returns to the desired gait when the slope ends, unless the desired speed is 0. Errors: a stale handle, a
  /// person who is not managed (Status::missing) or is named twice.
  Result<void> release(Entity person);
  Result<void> release(std::span<const Entity> people);
  /// Sets desired velocities, all or none. Errors: a stale handle, a person who is not managed (Status::missing), a
  /// speed out of the gait's range, a heading not within ±10000.
  Result<void> set_desired_velocity(std::span<const DesiredVelocity> wishes);

  /// Replaces all walls or discs. Errors: a position not within 1000 km; a top that is not above the bottom; a disc
  /// whose radius is negative or not finite, or whose velocity exceeds 1000 m/s.
  Result<void> set_walls(std::span<const Wall> walls);
  Result<void> set_discs(std::span<const Disc> discs);

  /// Returns the counts of all ticks of the last `advance` or `tick`.
  const AvoidanceReport& report() const;

 private:
  AvoidanceWork& work() const;

  Frame frame_;
};

}  // namespace mobil::inline v0_3
