#pragma once
// States of people, and the features that they can have.

#include <cstdint>
#include <optional>

#include <mobil/engine/entity.h>

namespace mobil::inline v0_3 {

class World;

/// State of a person. `systems/states/README.md` has a table of the effect of each call on people of each state.
enum class PersonState : std::uint8_t {
  /// A walker with pose and muscles.
  full,
  /// An unseen walker at lower cost in time and memory. Walk and muscles continue. Compact people store no pose:
  /// Simulation::get computes Pose, JointAngles, Feet and CentreOfMass on request, in some microseconds, and PoseWriter
  /// computes sixteen people at a time. each<Pose> skips them. Muscles are fields of the person's row, so their handles
  /// become stale, and a full person gets new ones. Control points are then within 4 µm of those of a person who stayed
  /// full. Not possible for people with forces or on terrain, and for people whose muscles place control points, have
  /// effects or parts of the host, have a method other than modal or none, or fade.
  compact,
  /// An unseen walker whose rows are freed. About 100 bytes are kept, from which walk, pose and lines of action are
  /// reconstructed bit-exactly on waking. Muscles are removed and their handles become stale; new ones start on waking.
  /// A host's own parts stay. Simulation::get returns a sleeper's body, walk and pose (a pose takes some microseconds).
  /// Systems and `each` skip sleepers. Not possible for people who turn, change speed or walk unevenly, or whose
  /// muscles have several methods. A sleeper wakes for a request that cannot be carried out asleep: another style, or a
  /// second request during the first.
  asleep,
  /// A person whose skeleton the host animates. Never becomes compact or falls asleep.
  posed,
};

/// Returns a person's state; nothing for a stale handle and for entities that are not people.
std::optional<PersonState> person_state(const World& world, Entity person);

/// Optional features of people (Simulation::enable).
enum class Feature : std::uint8_t {
  /// Heel strikes, toe-offs, stops and starts (Simulation::events). Compact people have events as well. Sleepers have
  /// them again after waking, and events during sleep are not reported. Not available for posed people.
  step_events,
  /// Wobbling of subcutaneous fat (mobil/components/fat.h) of walkers and posed people, displayed by the skin
  /// (mobil/skin_writer.h). Compact people and sleepers keep the feature; it starts at rest when they become full.
  fat,
  /// Ground reaction and joint moments (mobil/forces.h). People become full for it. A walker's forces follow from the
  /// step without delay. Those of a posed person follow from the last three poses, one tick late. Set a pose before
  /// every tick, because a repeated pose is a stop, and stay near the origin: at 64 m positions are 8 µm apart, which
  /// is 0.03 m/s². With individual limb lengths, masses stay where the height puts them.
  forces,
};

}  // namespace mobil::inline v0_3
