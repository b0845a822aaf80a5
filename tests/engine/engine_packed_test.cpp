// Packed systems: chosen rows are processed as if alone and written back; all other rows keep their bits.
#include <mobil/engine/packed.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <mutex>
#include <string>
#include <vector>

#include <mobil/schedule.h>
#include "tests/engine/engine_counting_memory.h"
#include "tests/engine/wilful_pool.h"
#include "tests/labels.h"

MOBIL_TEST_LABELS("threads");

namespace mobil::engine_packed_test {
/// A choice flag, and a number that identifies the row.
template <class F>
struct Choice {
  UInt32<F> chosen, number;
};
/// Several words, some of them integers.
template <class F>
struct Value {
  F x, y[2];
  UInt32<F> count;
};
template <class F>
struct Given {
  F x[2];
};
template <class F>
struct Other {
  F x;
};
struct Nodes {};
struct Substeps {};

using Choices = Choice<Lanes<float>>;
using Values = Value<Lanes<float>>;
using Givens = Given<Lanes<float>>;

std::uint32_t asked(const Choices& choice) {
  std::uint32_t bits = 0;
  for (std::size_t l = 0; l < lane_count; ++l) bits |= (choice.chosen[l] & 1U) << l;
  return bits;
}

/// Returns the expected result of one row. Other lanes have no effect on it.
Value<float> worked_on(const Value<float>& v, const Given<float>& g, const Choice<float>& c, float tick_s) {
  return {v.x * 1.5F + g.x[0], {v.y[1] - tick_s, g.x[1] * v.y[0]}, v.count * 3 + c.number};
}

void work(const Givens& given, const Choices& choice, Values& value, float tick_s) {
  for (std::size_t l = 0; l < lane_count; ++l) {
    const Value<float> v = {value.x[l], {value.y[0][l], value.y[1][l]}, value.count[l]};
    const auto next = worked_on(v, {{given.x[0][l], given.x[1][l]}}, {choice.chosen[l], choice.number[l]}, tick_s);
    value.x[l] = next.x;
    value.y[0][l] = next.y[0];
    value.y[1][l] = next.y[1];
    value.count[l] = next.count;
  }
}

template <class Row>
std::array<std::uint32_t, sizeof(Row) / 4> words(const Row& row) {
  return std::bit_cast<std::array<std::uint32_t, sizeof(Row) / 4>>(row);
}

/// A world of rows in several tables, and the values they were created with.
struct Population {
  World world;
  std::vector<Entity> all;
  std::vector<Choice<float>> choice;
  std::vector<Value<float>> value;
  std::vector<Given<float>> given;

  explicit Population(std::pmr::memory_resource* memory = std::pmr::get_default_resource()) : world(memory) {}

  void add(bool chosen, unsigned table) {
    const auto i = static_cast<std::uint32_t>(all.size());
    const auto x = static_cast<float>(i);
    choice.push_back({chosen ? 1U : 0U, i + 7});
    value.push_back({x * 0.25F - 3, {1 / (x + 1), x}, i * 77});
    given.push_back({{x * 0.125F, -x}});
    // These components come after others, so that they are at different words.
    const Value<float>& v = value.back();
    const Given<float>& g = given.back();
    const Choice<float>& c = choice.back();
    switch (table % 5) {
      case 0:
        all.push_back(world.create(c, v, g));
        break;
      case 1:
        all.push_back(world.create(c, v, g, Other<float>{x}));
        break;
      case 2:
        all.push_back(world.create(c, v, g, FieldWidth<Nodes>{5}));
        break;
      case 3:
        all.push_back(world.create(c, v, g, TagValue<Substeps>{table}));
        break;
      default:
        all.push_back(world.create(c, v, g, FieldWidth<Nodes>{2}, Other<float>{x}, TagValue<Substeps>{table}));
    }
  }
};

/// Adds at most two hundred rows, with any fraction of them chosen.
void populate(Population& people) {
  const auto count = *rc::gen::inRange(0U, 200U);
  const auto tables = *rc::gen::inRange(1U, 6U);
  const auto of_eight = *rc::gen::inRange(0, 9);
  const auto choices = *rc::gen::container<std::vector<int>>(count, rc::gen::inRange(0, 8));
  for (unsigned i = 0; i < count; ++i) people.add(choices[i] < of_eight, i % tables);
}

Schedule packed() {
  auto schedule = ScheduleBuilder().add_packed("packed", &asked, &work).build();
  if (!schedule) throw std::logic_error(schedule.error().message);
  return std::move(*schedule);
}

RC_GTEST_PROP(EnginePacked, OnlyChosenRowsChange, ()) {
  Population people;
  populate(people);
  Schedule schedule = packed();
  std::uint64_t rows = 0;
  for (std::uint32_t tick = 0; tick < 3; ++tick) {
    schedule.run(people.world, {0.5F, tick});
    for (std::size_t i = 0; i < people.all.size(); ++i) {
      Value<float>& value = people.value[i];
      if (people.choice[i].chosen == 1) value = worked_on(value, people.given[i], people.choice[i], 0.5F);
      rows += people.choice[i].chosen;
      RC_ASSERT(words(*people.world.get<Value>(people.all[i])) == words(value));
      RC_ASSERT(words(*people.world.get<Given>(people.all[i])) == words(people.given[i]));
      RC_ASSERT(words(*people.world.get<Choice>(people.all[i])) == words(people.choice[i]));
    }
    RC_ASSERT(schedule.timing("packed")->rows == rows);
  }
  schedule.reset_timings();
  RC_ASSERT(schedule.timing("packed")->rows == 0U);
}

RC_GTEST_PROP(EnginePacked, EachChosenRowIsPassedOnceInFullBlocks, ()) {
  Population people;
  populate(people);
  struct Seen {
    std::mutex mutex;
    std::vector<std::uint32_t> numbers;
    std::size_t blocks = 0;
  } seen;
  // Lanes without a row are copies of the first lane.
  const auto note = [&seen](const Choices& choice, Tick) {
    const std::scoped_lock lock(seen.mutex);
    ++seen.blocks;
    for (std::size_t l = 0; l < lane_count; ++l) {
      if (l == 0 || choice.number[l] != choice.number[0]) seen.numbers.push_back(choice.number[l]);
    }
  };
  auto schedule = ScheduleBuilder().add_packed("note", &asked, note).build();
  schedule->run(people.world, {});
  std::vector<std::uint32_t> expected;
  for (const auto& c : people.choice) {
    if (c.chosen == 1) expected.push_back(c.number);
  }
  std::sort(seen.numbers.begin(), seen.numbers.end());
  RC_ASSERT(seen.numbers == expected);
  RC_ASSERT(seen.blocks == (expected.size() + lane_count - 1) / lane_count);
}

TEST(EnginePacked, ParkedLanesAreNeverChosen) {
  const auto everybody = +[](const Choices&) { return ~0U; };  // a function pointer
  for (unsigned count = 0; count <= 2 * lane_count + 1; ++count) {
    Population people;
    for (unsigned i = 0; i < count; ++i) people.add(false, i % 2);
    auto schedule = ScheduleBuilder().add_packed("all", everybody, &work).build();
    schedule->run(people.world, {});
    EXPECT_EQ(schedule->timing("all")->rows, count);
    for (unsigned i = 0; i < count; i += 3) EXPECT_EQ(people.world.destroy(people.all[i]), Status::ok);
    schedule->reset_timings();
    schedule->run(people.world, {});
    EXPECT_EQ(schedule->timing("all")->rows, count - (count + 2) / 3);  // removed rows are not chosen either
  }
}

RC_GTEST_PROP(EnginePacked, SameBitsOnAnyThreadsAndAnyCut, ()) {
  Population people;
  populate(people);
  const Threads one(1), two(2), three(3);
  for (const Jobs& jobs : {Jobs{}, backwards(), one.jobs(), two.jobs(), three.jobs()}) {
    Population same;
    for (std::size_t i = 0; i < people.all.size(); ++i)
      same.add(people.choice[i].chosen == 1, static_cast<unsigned>(i));
    Schedule schedule = packed();
    for (std::uint32_t tick = 0; tick < 2; ++tick) schedule.run(same.world, {0.25F, tick}, jobs);
    for (std::size_t i = 0; i < same.all.size(); ++i) {
      Value<float> value = people.value[i];
      for (int tick = 0; tick < 2 && people.choice[i].chosen == 1; ++tick) {
        value = worked_on(value, people.given[i], people.choice[i], 0.25F);
      }
      RC_ASSERT(words(*same.world.get<Value>(same.all[i])) == words(value));
    }
  }
}

RC_GTEST_PROP(EnginePacked, ResultIsIndependentOfOtherRows, ()) {
  // The row with others in its block, and alone with the same words.
  Population crowd;
  populate(crowd);
  RC_PRE(!crowd.all.empty());
  const auto i = *rc::gen::inRange<std::size_t>(0, crowd.all.size());
  Schedule schedule = packed();
  schedule.run(crowd.world, {0.5F, 0});
  World world;
  const Entity alone = world.create(crowd.choice[i], crowd.value[i], crowd.given[i]);
  Schedule other = packed();
  other.run(world, {0.5F, 0});
  RC_ASSERT(words(*world.get<Value>(alone)) == words(*crowd.world.get<Value>(crowd.all[i])));
}

std::string order_of(const ScheduleBuilder& builder) {
  const auto schedule = builder.build();
  if (!schedule) return schedule.error().message;
  std::string names;
  for (const System& system : schedule->systems()) names += (names.empty() ? "" : " ") + system.name;
  return names;
}

TEST(EnginePacked, OrderFollowsFromReadsAndWrites) {
  const auto give = [](Givens&) {};
  const auto choose = [](Choices&) {};
  const auto read = [](const Values&, Other<Lanes<float>>&) {};
  ScheduleBuilder systems;
  systems.add("read", read).add_packed("packed", &asked, &work).add("give", give).add("choose", choose);
  EXPECT_EQ(order_of(systems), "give choose packed read");

  // Components that only the chooser reads count as well.
  const auto only_given = [](const Givens&, Values&) {};
  EXPECT_EQ(order_of(ScheduleBuilder().add_packed("packed", &asked, only_given).add("choose", choose)),
            "choose packed");
  // The chooser can read a component that the function writes.
  const auto by_value = +[](const Values&) { return 0U; };
  EXPECT_EQ(order_of(ScheduleBuilder().add("read", read).add_packed("packed", by_value, &work)), "packed read");
  // Two writers need an `after`, packed or not.
  const auto write = [](Values&) {};
  EXPECT_NE(order_of(ScheduleBuilder().add("write", write).add_packed("packed", &asked, &work)).find("both write"),
            std::string::npos);
  EXPECT_EQ(order_of(ScheduleBuilder().add_packed("packed", &asked, &work).after("write").add("write", write)),
            "write packed");
  const auto schedule = ScheduleBuilder().add_packed("packed", &asked, only_given).build();
  EXPECT_EQ(schedule->describe(), "1. packed; reads Given, Choice; writes Value\n");
}

TEST(EnginePacked, TablesWithoutARequiredComponentAreSkipped) {
  World world;
  const Value<float> value{1, {2, 3}, 4};
  const Entity no_choice = world.create(value, Given<float>{});
  const Entity no_given = world.create(value, Choice<float>{1, 0});
  const Entity whole = world.create(value, Given<float>{}, Choice<float>{1, 0});
  Schedule schedule = packed();
  schedule.run(world, {1, 0});
  EXPECT_EQ(schedule.timing("packed")->rows, 1U);
  EXPECT_EQ(words(*world.get<Value>(no_choice)), words(value));
  EXPECT_EQ(words(*world.get<Value>(no_given)), words(value));
  EXPECT_NE(words(*world.get<Value>(whole)), words(value));
  // A row that moves to another table is found there.
  EXPECT_EQ(world.add(no_given, Given<float>{}), Status::ok);
  EXPECT_EQ(world.remove<Choice>(whole), Status::ok);
  schedule.run(world, {1, 1});
  EXPECT_EQ(schedule.timing("packed")->rows, 2U);
  EXPECT_NE(words(*world.get<Value>(no_given)), words(value));
}

}  // namespace mobil::engine_packed_test
