#pragma once
// Changes of walkers from full to compact and back (mobil/components/compact.h).

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

/// Scratch memory of compact_people and expand_people, reused between calls; none of it is state.
struct CompactWork {
  struct Muscle {
    Entity entity;
    std::uint8_t number, side, code;
  };
  /// A person who can become compact, with a range of `muscles`.
  struct Person {
    Entity entity;
    std::uint32_t table;
    std::uint32_t first, count;
    std::uint64_t codes;
    Shared<LegMuscles> choice;  // the part that is kept; null without muscles
  };
  /// Kind of a table's muscles; tables live as long as their world.
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

/// Makes walkers, named once each, compact where possible. Their muscles must be driven by displacement, without
/// effects, fades or control points, with 1 to 30 modes of one mesh, static, or not simulated. Skips people with forces
/// or Footing. Returns how many of the walkers are compact now.
std::size_t compact_people(const MuscleScene& scene, std::span<const Entity> people, CompactWork& work);
/// Makes compact people, named once each, full; muscles keep their state. Errors: those with which muscles are refused;
/// the people concerned are full then, without muscles.
Result<void> expand_people(const MuscleScene& scene, std::span<const Entity> people, CompactWork& work);
/// Returns the method of a compact person's muscle; Method::none if the person does not have it.
MuscleMethod compact_method(const World& world, Entity person, Muscle muscle);

}  // namespace mobil::inline v0_3
