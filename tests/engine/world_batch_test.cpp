// Entities created and destroyed in batches match those created and destroyed singly.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <new>
#include <numeric>
#include <vector>

#include <mobil/engine/world.h>
#include "engine/state_hash.h"
#include "tests/engine/engine_counting_memory.h"
#include "tests/engine/wilful_pool.h"

namespace mobil::world_batch_test {
template <class F>
struct Place3 {
  Vec3<F> at;
};
template <class F>
struct Age {
  UInt32<F> ticks;
};
struct Points {};
struct Kind {};
struct Mark {};

constexpr std::uint32_t width = 5;

struct Values {
  float x;
  std::uint32_t age;
  float first_point;

  friend bool operator==(const Values&, const Values&) = default;
};

Values values_of(int seed) {
  return {0.5F * static_cast<float>(seed), static_cast<std::uint32_t>(seed) * 7U, static_cast<float>(seed) + 100};
}

Values read(const World& world, Entity entity) {
  std::vector<float> points(width);
  EXPECT_EQ(world.get_field<Points>(entity, points), Status::ok);
  const auto place = world.get<Place3>(entity);
  const auto age = world.get<Age>(entity);
  EXPECT_TRUE(place && age);
  if (!place || !age) return {};
  EXPECT_EQ(place->at.y, -place->at.x);
  for (std::size_t i = 1; i < width; ++i) EXPECT_EQ(points[i], points[0] + static_cast<float>(i));
  return {place->at.x, age->ticks, points[0]};
}

/// Creates `count` entities of one kind with the values of first, first + 1, …
std::vector<Entity> create(World& world, std::uint64_t kind, int first, std::size_t count, const Jobs& jobs) {
  const std::size_t blocks = (count + lane_count - 1) / lane_count;
  std::vector<Place3<Lanes<float>>> place(blocks);
  std::vector<Age<Lanes<float>>> age(blocks);
  std::vector<Lanes<float>> points(blocks * width);
  for (std::size_t i = 0; i < count; ++i) {
    const auto [x, ticks, point] = values_of(first + static_cast<int>(i));
    const std::size_t b = i / lane_count, l = i % lane_count;
    place[b].at.x[l] = x;
    place[b].at.y[l] = -x;
    place[b].at.z[l] = 1;
    age[b].ticks[l] = ticks;
    for (std::size_t w = 0; w < width; ++w) points[b * width + w][l] = point + static_cast<float>(w);
  }
  const PartValue parts[] = {{component_id<Place3>(), place.data()},
                             {component_id<Age>(), age.data()},
                             {component_id(FieldWidth<Points>{width}), points.data()},
                             part_value(TagValue<Kind>{kind})};
  std::vector<Entity> made(count);
  world.create_many(parts, made, jobs);
  return made;
}

Entity create_one(World& world, std::uint64_t kind, int seed) {
  const auto [x, ticks, point] = values_of(seed);
  const Entity entity =
      world.create(Place3<float>{{x, -x, 1}}, Age<float>{ticks}, FieldWidth<Points>{width}, TagValue<Kind>{kind});
  std::vector<float> points(width);
  std::iota(points.begin(), points.end(), point);
  EXPECT_EQ(world.set_field<Points>(entity, points), Status::ok);
  return entity;
}

/// Checks that rows are dense, every entity is where the register expects it, and empty lanes copy the first lane.
void check_tables(const World& world, std::size_t alive) {
  std::size_t rows = 0;
  for (const Table& table : world.tables()) {
    rows += table.row_count();
    for (std::uint32_t row = 0; row < table.row_count(); ++row) {
      const Entity entity = table.entities(row / lane_count)[row % lane_count];
      const auto place = world.find(entity);
      ASSERT_EQ(place.table, &table);
      ASSERT_EQ(place.row, row);
    }
    if (table.block_count() == 0) continue;
    const std::size_t last = table.block_count() - 1;
    for (std::size_t lane = table.live(last); lane < lane_count; ++lane) {
      ASSERT_EQ(table.entities(last)[lane], table.entities(last)[0]);
      for (std::size_t w = 0; w < table.words(); ++w) {
        ASSERT_EQ(std::memcmp(table.block(last) + w * lane_count, table.block(last) + w * lane_count + lane, 4), 0);
      }
    }
  }
  ASSERT_EQ(rows, alive);
}

RC_GTEST_PROP(WorldBatch, BatchMatchesSingleEntities, ()) {
  World many, single;
  std::vector<Entity> in_many, in_single;
  int seed = 0;
  const int rounds = *rc::gen::inRange(1, 12);
  for (int round = 0; round < rounds; ++round) {
    const auto kind = static_cast<std::uint64_t>(*rc::gen::inRange(0, 3));
    const auto count = static_cast<std::size_t>(*rc::gen::inRange(0, 60));
    const Jobs jobs = *rc::gen::arbitrary<bool>() ? backwards(3) : Jobs{};
    for (const Entity entity : create(many, kind, seed, count, jobs)) in_many.push_back(entity);
    for (std::size_t i = 0; i < count; ++i) {
      in_single.push_back(create_one(single, kind, seed + static_cast<int>(i)));
    }
    seed += static_cast<int>(count);
    std::vector<Entity> leave_many;
    std::vector<std::size_t> stay;
    const int share = *rc::gen::inRange(0, 101);
    for (std::size_t i = 0; i < in_many.size(); ++i) {
      if (*rc::gen::inRange(0, 100) >= share) {
        stay.push_back(i);
        continue;
      }
      leave_many.push_back(in_many[i]);
      RC_ASSERT(single.destroy(in_single[i]) == Status::ok);
    }
    RC_ASSERT(many.destroy_many(leave_many, jobs) == Status::ok);
    for (const Entity gone : leave_many) RC_ASSERT(!many.alive(gone));
    std::vector<Entity> a, b;
    for (const std::size_t i : stay) {
      a.push_back(in_many[i]);
      b.push_back(in_single[i]);
    }
    in_many = a;
    in_single = b;
    RC_ASSERT(in_many == in_single);  // the same handles
    for (std::size_t i = 0; i < in_many.size(); ++i) {
      RC_ASSERT(read(many, in_many[i]) == read(single, in_single[i]));
    }
    check_tables(many, in_many.size());
    RC_ASSERT(!::testing::Test::HasFailure());
  }
}

TEST(WorldBatch, StaleOrRepeatedHandlesAreRefusedUnchanged) {
  World world;
  const auto people = create(world, 0, 0, 40, {});
  const Entity gone = create_one(world, 1, 7);
  ASSERT_EQ(world.destroy(gone), Status::ok);
  for (const std::vector<Entity>& wrong :
       {std::vector<Entity>{people[3], people[5], people[3]}, {people[0], gone}, {Entity{}}}) {
    EXPECT_EQ(world.destroy_many(wrong), Status::stale_entity);
    check_tables(world, people.size());
    for (int i = 0; i < 40; ++i) EXPECT_EQ(read(world, people[static_cast<std::size_t>(i)]), values_of(i));
  }
  EXPECT_EQ(world.destroy_many({}), Status::ok);
}

TEST(WorldBatch, WithoutMemoryTheWorldIsUnchanged) {
  bool done = false;
  for (std::size_t granted = 0; !done; ++granted) {
    CountingMemory memory;
    World world(&memory);
    const auto before = create(world, 0, 0, 21, {});
    memory.refuse_after = granted;
    try {
      create(world, granted % 2, 100, 300, {});
      done = true;
    } catch (const std::bad_alloc&) {
    }
    memory.refuse_after = SIZE_MAX;
    check_tables(world, done ? 321 : 21);
    for (int i = 0; i < 21; ++i) EXPECT_EQ(read(world, before[static_cast<std::size_t>(i)]), values_of(i));
    ASSERT_LT(granted, 200U);
  }
}

template <class F>
struct Badge {
  F value;
};

/// Checks that lanes without a row copy the first lane of the last block.
void expect_parked(const World& world) {
  for (const Table& table : world.tables()) {
    if (table.row_count() % lane_count == 0) continue;
    const float* const block = table.block(table.block_count() - 1);
    for (std::size_t w = 0; w < table.words(); ++w) {
      for (std::size_t lane = table.row_count() % lane_count; lane < lane_count; ++lane)
        ASSERT_EQ(std::memcmp(&block[w * lane_count + lane], &block[w * lane_count], 4), 0) << "word " << w;
    }
  }
}

RC_GTEST_PROP(WorldBatch, BatchChangeOfArchetypeMatchesSingleChanges, ()) {
  const auto count = *rc::gen::inRange<std::size_t>(1, 90);
  const auto there = *rc::gen::inRange<std::size_t>(0, 40);
  World together, single;
  const std::vector<Entity> all = create(together, 1, 0, count, backwards(3));
  RC_ASSERT(create(single, 1, 0, count, {}) == all);
  for (World* const world : {&together, &single}) {
    for (std::size_t i = 0; i < there; ++i)
      world->create(Place3<float>{}, Age<float>{}, Badge<float>{}, TagValue<Kind>{1});
  }
  std::vector<Entity> some;
  for (const Entity entity : all)
    if (*rc::gen::inRange(0, 3) > 0) some.push_back(entity);
  std::vector<Badge<Lanes<float>>> badge((some.size() + lane_count - 1) / lane_count);
  for (std::size_t i = 0; i < some.size(); ++i)
    badge[i / lane_count].value[i % lane_count] = static_cast<float>(some[i].index) + 0.25F;
  constexpr std::array owned = {type_id<Points>()};
  together.change_archetype(some, std::array{PartValue{component_id<Badge>(), badge.data()}}, owned, backwards(3));
  for (const Entity entity : some) {
    const Badge<float> own{static_cast<float>(entity.index) + 0.25F};
    RC_ASSERT(single.remake_from(entity, std::array{part_value(own)}, owned) == Status::ok);
  }
  for (const Entity entity : all) {
    RC_ASSERT(together.has<Badge>(entity) == single.has<Badge>(entity));
    RC_ASSERT(together.has<Points>(entity) == single.has<Points>(entity));
    RC_ASSERT(together.get<Age>(entity)->ticks == single.get<Age>(entity)->ticks);
    RC_ASSERT(together.get<Place3>(entity)->at.x == single.get<Place3>(entity)->at.x);
    if (single.has<Badge>(entity)) {
      RC_ASSERT(together.get<Badge>(entity)->value == single.get<Badge>(entity)->value);
    }
    if (single.has<Points>(entity)) {
      RC_ASSERT(read(together, entity) == read(single, entity));
    }
  }
  expect_parked(together);
  expect_parked(single);
}

/// A component that is given and already present exists once.
TEST(WorldBatch, GivenAndPresentComponentExistsOnce) {
  World world;
  const std::vector<Entity> all = create(world, 1, 0, 20, {});
  const Age<float> older{77};
  ASSERT_EQ(world.remake_from(all[3], std::array{part_value(older)}, {}), Status::ok);
  EXPECT_EQ(world.get<Age>(all[3])->ticks, 77U);
  const std::array some = {all[3], all[5], all[19]};
  const auto age = world.get<Age>(all[5])->ticks;
  world.change_archetype(some,
                         std::array{PartValue{component_id<Age>(), nullptr}, PartValue{component_id<Badge>(), nullptr}},
                         {}, backwards(3));
  EXPECT_EQ(world.get<Age>(all[3])->ticks, 77U);
  EXPECT_EQ(world.get<Age>(all[5])->ticks, age) << "what is there keeps its value";
  for (const Entity entity : some) {
    EXPECT_TRUE(world.has<Badge>(entity));
    const Archetype& key = world.find(entity).table->key();
    EXPECT_EQ(std::adjacent_find(key.begin(), key.end(),
                                 [](const ComponentId& a, const ComponentId& b) { return a.id == b.id; }),
              key.end());
  }
  expect_parked(world);
}

/// Some entities are changed piecewise, others are created, and some of those get one more component. Without a commit
/// nothing has changed; with one, the result is as without a transaction.
RC_GTEST_PROP(WorldBatch, TransactionIsCommittedOrUndone, ()) {
  const auto count = *rc::gen::inRange<std::size_t>(1, 90), more = *rc::gen::inRange<std::size_t>(0, 40);
  const bool kept = *rc::gen::inRange(0, 2) == 1;
  World world, twin;
  const std::vector<Entity> all = create(world, 1, 0, count, backwards(3));
  create(twin, 1, 0, count, {});
  std::vector<Entity> some;
  for (const Entity entity : all)
    if (*rc::gen::inRange(0, 3) > 0) some.push_back(entity);
  const auto change = [&](World& of) {
    constexpr std::array owned = {type_id<Points>()};
    const std::size_t half = some.size() / 2;
    for (const auto piece : {std::span(some).first(half), std::span(some).subspan(half)})
      of.change_archetype(piece, std::array{PartValue{component_id<Badge>(), nullptr}}, owned, backwards(3));
    for (std::size_t i = 0; i < some.size(); i += 3) of.add(some[i], TagValue<Mark>{7});
    create(of, 3, 0, more, backwards(3));
    create(of, 4, 0, more, {});
  };
  const std::uint64_t before = state_hash(world, {});
  {
    World::Transaction transaction(world, backwards(3));
    change(world);
    if (kept) transaction.commit();
  }
  if (kept) {
    change(twin);
  } else {
    RC_ASSERT(state_hash(world, {}) == before);
  }
  RC_ASSERT(state_hash(world, {}) == state_hash(twin, {}));
  for (const Entity entity : all) {
    RC_ASSERT(world.get<Age>(entity)->ticks == twin.get<Age>(entity)->ticks);
    RC_ASSERT(world.has<Points>(entity) == twin.has<Points>(entity));
  }
  RC_ASSERT(world.create(Age<float>{}) == twin.create(Age<float>{}));
  expect_parked(world);
}

/// A nested transaction is undone if it is not committed, or if the outer one is not.
RC_GTEST_PROP(WorldBatch, NestedTransactionIsPartOfTheOuterOne, ()) {
  const auto count = *rc::gen::inRange<std::size_t>(1, 60);
  const bool outer_kept = *rc::gen::arbitrary<bool>(), inner_kept = *rc::gen::arbitrary<bool>();
  World world, twin;
  const std::vector<Entity> all = create(world, 1, 0, count, backwards(3));
  create(twin, 1, 0, count, {});
  const std::size_t half = all.size() / 2;
  const auto mark = [&](World& of, std::span<const Entity> some) {
    of.change_archetype(some, std::array{PartValue{component_id<Badge>(), nullptr}}, {}, backwards(3));
  };
  const auto outer_change = [&](World& of) {
    create(of, 3, 0, 5, {});
    mark(of, std::span(all).first(half));
  };
  const auto inner_change = [&](World& of) {
    create(of, 4, 0, 7, {});
    mark(of, std::span(all).subspan(half));
  };
  {
    World::Transaction outer(world, backwards(3));
    outer_change(world);
    {
      World::Transaction inner(world, backwards(3));
      inner_change(world);
      if (inner_kept) inner.commit();
    }
    if (outer_kept) outer.commit();
  }
  if (outer_kept) outer_change(twin);
  if (outer_kept && inner_kept) inner_change(twin);
  RC_ASSERT(state_hash(world, {}) == state_hash(twin, {}));
  RC_ASSERT(world.create(Age<float>{}) == twin.create(Age<float>{}));
  expect_parked(world);
}

}  // namespace mobil::world_batch_test
