#pragma once
// A simulation's content as one number, and people who are added to one.

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <vector>

#include <mobil/components/step_plan.h>
#include <mobil/engine/world.h>
#include <mobil/simulation.h>
#include "tests/simulation/people.h"

namespace mobil {

inline std::uint64_t fnv(std::uint64_t hash, std::uint32_t word) {
  return (hash ^ word) * 0x100000001b3;
}

/// Hashes every word of an entity's row, except the owner (a handle) of a muscle.
inline std::uint64_t hash_row(const World& world, Entity entity, std::uint64_t hash) {
  const auto place = world.find(entity);
  if (!place) return fnv(hash, 0xdead);
  for (const ComponentId& part : place.table->key()) {
    const bool steps =
        part.id == type_id<Substeps>() || part.id == type_id<SolvedSteps>() || part.id == type_id<FiniteSteps>();
    if (steps) hash = fnv(hash, static_cast<std::uint32_t>(part.value));
    if (!has_column(part.kind) || part.id == type_id<MuscleOwner<float>>()) continue;
    std::vector<std::uint32_t> words(part.value);
    const auto width = static_cast<std::uint32_t>(part.value);
    place.table->read(place.row, place.table->column(part.id), width, words.data());
    for (const std::uint32_t word : words) hash = fnv(hash, word);
  }
  return hash;
}

inline std::uint64_t hash_person(const Simulation& simulation, Entity person) {
  std::uint64_t hash = hash_row(simulation.world(), person, 0xcbf29ce484222325);
  if (simulation.state(person) == PersonState::asleep) {  // its row stays in place
    const GaitState<float> state = *simulation.get<GaitState>(person);
    std::uint32_t words[sizeof(state) / 4];
    std::memcpy(words, &state, sizeof(state));
    for (const std::uint32_t word : words) hash = fnv(hash, word);
  }
  for (std::size_t g = 0; g < usual_muscle_count; ++g) {
    for (const Side side : {Side::right, Side::left}) {
      hash = hash_row(simulation.world(), simulation.muscle(person, static_cast<Muscle>(g), side), hash);
    }
  }
  return hash;
}

inline std::size_t rows(const World& world) {
  std::size_t sum = 0;
  for (const Table& table : world.tables()) sum += table.row_count();
  return sum;
}

inline std::size_t rows_with(const World& world, std::uint64_t part) {
  std::size_t sum = 0;
  for (const Table& table : world.tables()) sum += find_component(table.key(), part) != nullptr ? table.row_count() : 0;
  return sum;
}
template <template <class> class C>
std::size_t rows_with(const World& world) {
  return rows_with(world, type_id<C<float>>());
}

/// Hashes all entities, including handles, table by table.
inline std::uint64_t hash_world(const Simulation& simulation) {
  std::uint64_t hash = fnv(0xcbf29ce484222325, static_cast<std::uint32_t>(rows(simulation.world())));
  for (const Table& table : simulation.world().tables()) {
    for (std::uint32_t row = 0; row < table.row_count(); ++row) {
      const Entity entity = table.entities(row / lane_count)[row % lane_count];
      hash = hash_row(simulation.world(), entity, fnv(fnv(hash, entity.index), entity.generation));
    }
  }
  return hash;
}

template <template <class> class... C>
bool same_parts(const Simulation& a, Entity in_a, const Simulation& b, Entity in_b) {
  const auto same = [](const auto& x, const auto& y) { return x && y && std::memcmp(&*x, &*y, sizeof(*x)) == 0; };
  return (same(a.get<C>(in_a), b.get<C>(in_b)) && ...);
}
/// Returns true if two people's gaits are equal to the bit.
inline bool walk_alike(const Simulation& a, Entity in_a, const Simulation& b, Entity in_b) {
  return same_parts<Gait, GaitState, StepPlan, Pose, JointAngles, Feet, CentreOfMass, BodySize, Physique>(a, in_a, b,
                                                                                                          in_b);
}

inline Entity join(Simulation& simulation, const SamplePerson& sample, bool muscles = true) {
  const auto person = simulation.spawn(sample.body, sample.gait);
  EXPECT_TRUE(person) << person.error().message;
  if (!person) return {};
  if (muscles) {
    const auto added = simulation.set_muscles(*person);
    EXPECT_TRUE(added) << added.error().message;
  }
  return *person;
}

}  // namespace mobil
