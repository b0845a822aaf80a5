#pragma once
// Walkers who keep out of each other's way. A host says where each wants to go; at every heel strike Avoidance chooses
// the next step toward there, of those that are clear of everybody else.
//
//   Simulation simulation;
//   simulation.avoidance().manage(person);                     // goes on as it was asked to
//   simulation.avoidance().set_walls({{{-5, 2.5F}, {5, 2.5F}}});
//   simulation.avoidance().set_desired_velocity({{person, 1.3F, heading_rad}});  // whenever the wish changes
//   simulation.advance(frame_seconds);
//
// Everybody's *reservation* is where they will be through the step under way and the quickest stop after it. A step is
// taken only where it and the stop after it are clear of all reservations; else a walker does what its reservation
// says, which everybody else has kept clear of. So by induction nobody walks into anybody, in whatever order they
// choose.
//
// Requests are state on the person's row (mobil/components/avoidance.h); reservations follow from the world. Walls,
// discs and options are no state: a simulation that restores a snapshot keeps its own. People whose ground is more
// than 1.5 m higher or lower than the slopes on which both walk lead to are on another floor, and in nobody's way.
// Decisions depend on the world, walls and discs alone, not on threads or rows. Who is managed is asked for speed and
// heading through Avoidance: what change_gait and turn_to ask lasts until the next step.

#include <cstddef>
#include <cstdint>
#include <span>

#include <mobil/components/avoidance.h>
#include <mobil/engine/entity.h>
#include <mobil/engine/error.h>
#include <mobil/engine/phase.h>
#include <mobil/systems/avoidance/obstacles.h>

namespace mobil::inline v0_3 {

/// What somebody wants: to walk at that speed, 0 or one that their gait may have, and that heading (rad, about +Y).
struct DesiredVelocity {
  Entity person;
  float speed_m_s, heading_rad;
};

/// How much room people keep. What is out of range is taken as the end that is nearer.
struct AvoidanceOptions {
  /// Half the breadth that two people keep clear of each other, of the height: 0.18 m at 1.72 m, which is the trunk's
  /// and that of shoulders that are turned by 40°. 0.02 to 0.5.
  float radius_h = 0.105F;
  /// How far two may overlap who have waited, m: clothes and arms give way. 0 to 0.2.
  float overlap_m = 0.03F;
  /// Half the breadth of the shoulders with the arms, of the height: 0.22 m. Walkers keep it clear of walls, of discs
  /// and of people who are not managed. A walker who comes nearer to another managed one turns the shoulders.
  /// `radius_h` to 0.5: at `radius_h` nobody turns them.
  float shoulders_h = 0.128F;
};

/// What was chosen in all ticks of the last `advance` or `tick`: people looked at in the last of them; how often a step
/// was chosen; of these by whom who kept to their reservation, and who gave way to somebody that chose at the same
/// time; who stood though they want to walk.
struct AvoidanceReport {
  std::size_t people = 0, chose = 0, kept_reservation = 0, yielded = 0, waiting = 0;
};

struct AvoidanceWork;  // systems/avoidance/avoidance.cpp

/// What keeps people of a simulation out of each other's way (Simulation::avoidance). Each tick chooses for those whose
/// next step begins in it, and how far shoulders turn. Takes memory only as crowds grow.
class Avoidance {
 public:
  explicit Avoidance(const Frame& frame) : frame_(frame) {}

  /// Of people managed from now on their room; of all others the rest. Errors: a value that is not a number; nothing has changed.
  Result<void> set_options(const AvoidanceOptions& options);

  /// From now on this walker avoids others, and wants what it was last asked to do; who is managed already goes on to
  /// want what they want, with the room of these options. Errors: a stale handle, a posed person (Status::missing);
  /// nothing has changed.
  Result<void> manage(Entity person);
  /// The same of many, each named once; all or none.
  Result<void> manage(std::span<const Entity> people);
  /// No more; walkers keep the gait they have, and face their way. A walker whom only a slope slows down takes the gait
  /// they wish for once it ends; one who wishes to stand keeps the gait they have. Errors: a stale handle, somebody who
  /// is not managed.
  Result<void> release(Entity person);
  Result<void> release(std::span<const Entity> people);
  /// All or none. Errors: a stale handle, somebody who is not managed (Status::missing), a speed that their gait cannot
  /// have, a heading not within ±10000; nothing has changed.
  Result<void> set_desired_velocity(std::span<const DesiredVelocity> wishes);

  /// Instead of those before. Errors: a place that is not finite; nothing has changed.
  Result<void> set_walls(std::span<const Wall> walls);
  Result<void> set_discs(std::span<const Disc> discs);

  /// What was chosen in all ticks of the last `advance` or `tick`.
  const AvoidanceReport& report() const;

 private:
  AvoidanceWork& work() const;

  Frame frame_;
};

}  // namespace mobil::inline v0_3
