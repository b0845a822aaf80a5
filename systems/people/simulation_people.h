#pragma once
// What a simulation keeps of its people besides their rows: what was asked for, and which muscles are theirs. Bodies
// and plans of muscles follow from that and are made anew where they are needed. Part of the front door
// (systems/simulation.h).

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "components/body.h"
#include "components/leg_muscles.h"
#include "components/muscle.h"
#include "engine/entity.h"

namespace mobil {

/// One of a person's muscles, by side.
struct OwnMuscle {
  Muscle muscle{};
  std::array<Entity, 2> entity{};
};

struct PersonRecord {
  Entity entity{};
  BodyRequest body{};
  bool posed = false;                // their host animates the skeleton: no gait
  std::uint32_t choice = 0;          // of People::choices(); means nothing without muscles
  std::vector<OwnMuscle> muscles{};  // in the table's order; empty without muscles
};

/// Everybody, densely; and what they chose of muscles, each choice once. Pointers are good until somebody comes or
/// goes.
class People {
 public:
  PersonRecord* find(Entity entity) {
    const std::uint32_t at = entity.index < place_.size() ? place_[entity.index] : nobody;
    return at != nobody && all_[at].entity == entity ? &all_[at] : nullptr;
  }
  const PersonRecord* find(Entity entity) const { return const_cast<People*>(this)->find(entity); }
  std::span<PersonRecord> all() { return all_; }
  std::span<const PersonRecord> all() const { return all_; }

  /// Room for so many more, with entity indices below `index_end`: until then `add` takes no memory.
  void reserve(std::size_t more, std::size_t index_end);
  void add(PersonRecord person);
  /// Of somebody who is there. The last one takes their place.
  void remove(Entity entity);
  void clear();

  /// The number of a choice, from now on kept.
  std::uint32_t number_of(const LegMuscles& choice);
  const std::vector<LegMuscles>& choices() const { return choices_; }
  const LegMuscles& choice(const PersonRecord& person) const { return choices_[person.choice]; }

 private:
  static constexpr std::uint32_t nobody = 0xffffffff;

  std::vector<PersonRecord> all_;
  std::vector<std::uint32_t> place_;  // in all_, by entity index
  std::vector<LegMuscles> choices_ = {LegMuscles{}};
};

}  // namespace mobil
