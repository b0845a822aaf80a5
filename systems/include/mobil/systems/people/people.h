#pragma once
// People: their states and features, and requests for many of them.

#include <cstdint>
#include <optional>
#include <span>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/leg_muscles.h>
#include <mobil/engine/archetype.h>
#include <mobil/engine/entity.h>

namespace mobil::inline v0_3 {

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

/// Request for one of many walkers: a position on the ground, m, and a heading (rad about +Y, 0 toward +Z, positive to
/// the left).
struct SpawnRequest {
  BodyRequest body{};
  GaitRequest gait{};
  float x_m = 0, z_m = 0, heading_rad = 0;
  std::optional<LegMuscles> muscles{};
  /// Further parts of the person's row, initially zero: parts of the host, or `managed_parts()` for people whom level
  /// of detail will manage, so that their rows need not move then. The caller owns the memory.
  std::span<const ComponentId> parts{};
};

/// A change of gait and heading for one of many walkers. Unset fields keep their value.
struct WalkChange {
  Entity person;
  std::optional<GaitChange> gait{};
  std::optional<float> heading_rad{};
};

/// New position of a person: point of the walking line next to the supporting foot, m, and heading (rad about +Y).
struct PlaceRequest {
  Entity person;
  float x_m = 0, z_m = 0, heading_rad = 0;
};

}  // namespace mobil::inline v0_3
