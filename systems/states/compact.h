#pragma once
// Walkers become compact and whole again (mobil/components/compact.h).

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <mobil/components/leg_muscles.h>
#include <mobil/engine/error.h>
#include <mobil/engine/world.h>
#include "systems/muscles/leg_muscles.h"
#include "systems/people/compact_pose.h"

namespace mobil::inline v0_3 {

/// Memory that becoming compact and whole works in, kept from one time to the next; nothing of it is state.
struct CompactWork {
  struct Muscle {
    Entity entity;
    std::uint8_t number, side, code;
  };
  /// A person who may become compact: a run of `muscles`.
  struct Person {
    Entity entity;
    std::uint32_t table;
    std::uint32_t first, count;
    std::uint64_t codes;
    Shared<LegMuscles> choice;  // what is kept of it; null where there are no muscles
  };
  /// What a table's muscles are; tables stay as long as their world.
  struct Known {
    bool looked = false;
    std::uint8_t code = 0, number = 0;
    const LegMuscles* tissue = nullptr;
    ModalOptions mesh{};
  };
  std::vector<Known> known;
  std::vector<Muscle> muscles;
  std::vector<Person> people;
  std::vector<Entity> entities, rows;
  std::vector<Lanes<float>> state, motion;
  std::vector<float> row, state_rows;
  FullPoseWork whole;
};

/// Of walkers named once each those become compact who may, and whose muscles, if any, are all drawn by displacement,
/// without effects, without control points, and move along 1 to 30 modes of one mesh, or are static or not simulated
/// at all; nobody with forces or who fades. Returns how many of these are compact now.
std::size_t compact_people(const MuscleScene& scene, std::span<const Entity> people, CompactWork& work);
/// Compact people, named once each, are whole again, their muscles as far as they had come. Errors: what muscles are
/// refused for; those concerned are whole then, without muscles.
Result<void> expand_people(const MuscleScene& scene, std::span<const Entity> people, CompactWork& work);
/// What the muscles of somebody compact are; Method::none where there is no such one.
MuscleMethod compact_method(const World& world, Entity person, Muscle muscle);

}  // namespace mobil::inline v0_3
