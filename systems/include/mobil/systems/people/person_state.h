#pragma once
// How much of a person there is: what states people are in, and the effects that they may have.

#include <cstdint>
#include <optional>

#include <mobil/engine/entity.h>

namespace mobil::inline v0_3 {

class World;

/// `systems/states/README.md` has a table of what each call does to people of each state.
enum class PersonState : std::uint8_t {
  /// A walker with everything.
  full,
  /// A walker in less time and memory, for people whom nobody looks at. The walk and the muscles continue. Compact
  /// people have no pose of their own. Their muscles are fields of the person's row, so the handles of muscles become
  /// stale; new ones come when the person is full again. Simulation::get computes Pose, JointAngles, Feet and
  /// CentreOfMass on request, in some microseconds; PoseWriter computes sixteen people's at a time. each<Pose> skips
  /// them. Control points later are within 4 µm of where they would be. These people cannot become compact: people with
  /// forces, or on terrain; people whose muscles place control points, have effects or parts of the host's, have a
  /// method other than modal or none, or fade.
  compact,
  /// A walker whom nobody sees: the rows go, and a hundred bytes are left from which the person comes back where they
  /// would be, walk, pose and lines to the bit. Muscles go, their handles too; they begin again on waking. A host's own
  /// parts stay. Simulation::get reads a sleeper's body, walk and pose as anybody's (a pose takes some microseconds).
  /// Neither systems nor `each` see sleepers. Nobody falls asleep who turns, changes speed or walks unevenly, nor whose
  /// muscles have several methods. A sleeper wakes who cannot follow what is asked: another style, or a second request
  /// while the first is being carried out.
  asleep,
  /// A person whose host animates the skeleton; neither becomes compact nor falls asleep.
  posed,
};

/// Nothing for a stale handle, and for entities that are not people.
std::optional<PersonState> person_state(const World& world, Entity person);

/// What people have on demand (Simulation::enable).
enum class Feature : std::uint8_t {
  /// Heel strikes, toe-offs, stops and starts (Simulation::events). Compact people are watched as well; who falls
  /// asleep is watched again on waking, and what happened meanwhile is not reported. Not of posed people.
  step_events,
  /// Fat under the skin that wobbles (mobil/components/fat.h), of walkers and posed people; skin shows it
  /// (mobil/skin_writer.h). Compact people and sleepers keep it, and it begins at rest when they are full.
  fat,
  /// Ground reaction and joint moments (mobil/forces.h). Walkers' follow from their step, at once; posed people's from
  /// how their last three poses move, one tick late: give them a pose before every tick, for one that stays is a stop,
  /// and near the origin, for places of single precision are 8 µm apart 64 m from there, which is 0.03 m/s². The masses
  /// of limbs of their own lie where the height has them. People become full for it.
  forces,
};

}  // namespace mobil::inline v0_3
