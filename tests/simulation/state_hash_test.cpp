// One number for the state of all people.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <bit>
#include <numeric>
#include <set>
#include <vector>

#include <mobil/simulation.h>
#include "engine/row_hash.h"
#include "tests/labels.h"
#include "tests/simulation/crowd_play.h"
#include "tests/simulation/people.h"
#include "tests/world_of.h"

MOBIL_TEST_LABELS("threads");

namespace mobil::state_hash_test {
/// Spawns people 0 to count − 1 with muscles in that order.
std::vector<Entity> come(Simulation& simulation, const std::vector<int>& order) {
  std::vector<Entity> people(order.size());
  for (const int who : order) {
    people[static_cast<std::size_t>(who)] = *simulation.spawn(sample_person(who).body, sample_person(who).gait);
    const auto done =
        simulation.set_muscles(people[static_cast<std::size_t>(who)], play::choice_of(static_cast<std::uint64_t>(who)));
    EXPECT_TRUE(done) << done.error().message;
  }
  return people;
}

std::vector<int> numbers(int count) {
  std::vector<int> all(static_cast<std::size_t>(count));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

TEST(StateHash, ChangesWithTimeAndWithAnyPerson) {
  Simulation simulation(sharing());
  const auto people = come(simulation, numbers(5));
  std::set<std::uint64_t> seen;
  const auto is_new = [&] { return seen.insert(simulation.state_hash()).second; };
  EXPECT_TRUE(is_new());
  simulation.tick();
  EXPECT_TRUE(is_new());
  const Entity sixth = *simulation.spawn(sample_person(5).body, sample_person(5).gait);
  EXPECT_TRUE(is_new());
  ASSERT_TRUE(simulation.turn_to(people[1], 0.5F));
  EXPECT_TRUE(is_new());
  ASSERT_TRUE(simulation.set_method(people[0], Muscle::hamstrings, {Method::none}));
  EXPECT_TRUE(is_new());
  ASSERT_EQ(simulation.despawn(sixth), Status::ok);
  EXPECT_TRUE(is_new());
  world_of(simulation).create(BodySize<float>{});  // without an owner
  EXPECT_TRUE(is_new());
}

/// Returns true for words that contain the owner of a row.
bool is_handle(const Table& table, std::uint32_t word) {
  const std::uint32_t owner = table.column(type_id<MuscleOwner<float>>());
  return owner != Table::no_column && word >= owner && word < owner + 2;
}

TEST(StateHash, EveryBitOfEveryWordOfStateCounts) {
  Simulation simulation(sharing());
  come(simulation, numbers(9));
  simulation.tick();
  const std::uint64_t before = simulation.state_hash();
  rc::check([&] {
    auto& tables = world_of(simulation).tables();
    Table& table = tables[*rc::gen::inRange<std::size_t>(0, tables.size())];
    RC_PRE(table.row_count() > 0);
    const auto row = *rc::gen::inRange<std::uint32_t>(0, table.row_count());
    const auto word = *rc::gen::inRange<std::uint32_t>(0, table.words());
    const std::uint32_t bit = std::uint32_t{1} << *rc::gen::inRange(0, 32);
    float* at = table.block(row / lane_count) + word * lane_count + row % lane_count;
    const float kept = *at;
    *at = std::bit_cast<float>(std::bit_cast<std::uint32_t>(kept) ^ bit);
    const std::uint64_t after = simulation.state_hash();
    *at = kept;
    RC_ASSERT((after == before) == is_handle(table, word));
    RC_ASSERT(simulation.state_hash() == before);
  });
}

TEST(StateHash, EmptyLanesDoNotCount) {
  Simulation simulation(sharing());
  come(simulation, {0, 1, 2});
  const std::uint64_t before = simulation.state_hash();
  for (Table& table : world_of(simulation).tables()) {
    if (table.row_count() % lane_count == 0) continue;
    float* block = table.block(table.row_count() / lane_count);
    for (std::uint32_t w = 0; w < table.words(); ++w) block[w * lane_count + table.row_count() % lane_count] += 1;
  }
  EXPECT_EQ(simulation.state_hash(), before);
}

TEST(Bytes, EveryBitAndTheLengthCount) {
  rc::check([](std::vector<std::uint8_t> bytes) {
    const std::uint64_t before = hash_bytes(bytes.data(), bytes.size());
    auto longer = bytes;
    longer.push_back(0);
    RC_ASSERT(hash_bytes(longer.data(), longer.size()) != before);
    if (bytes.empty()) return;
    const auto at = *rc::gen::inRange<std::size_t>(0, bytes.size());
    bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ (1U << *rc::gen::inRange(0, 8)));
    RC_ASSERT(hash_bytes(bytes.data(), bytes.size()) != before);
  });
}

}  // namespace mobil::state_hash_test
