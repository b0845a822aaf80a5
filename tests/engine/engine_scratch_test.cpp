// Scratch memory of systems, and components that only some tables have.
#include <mobil/engine/scratch.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <set>
#include <thread>
#include <vector>

#include <mobil/schedule.h>
#include "tests/engine/counting_heap.h"
#include "tests/engine/engine_counting_memory.h"
#include "tests/labels.h"

MOBIL_TEST_LABELS("threads");

namespace mobil::engine_scratch_test {
template <class F>
struct A {
  F x;
};
template <class F>
struct Extra {
  F x;
};
struct Floats {};

TEST(ScratchPool, NoTwoHoldersShareABuffer) {
  CountingMemory memory;
  {
    ScratchPool pool(&memory);
    pool.prepare(1000, 2);
    std::vector<std::thread> threads;
    std::atomic<int> clashes = 0;
    for (int t = 0; t < 4; ++t) {
      threads.emplace_back([&, mark = static_cast<float>(t)] {
        for (int i = 0; i < 2000; ++i) {
          const ScratchLease lease(&pool);
          std::fill_n(lease.data(), pool.floats(), mark);
          if (i % 16 == 0) std::this_thread::yield();
          clashes += std::any_of(lease.data(), lease.data() + pool.floats(), [&](float x) { return x != mark; });
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(clashes, 0);
    EXPECT_LE(pool.count(), 4U);
  }
  EXPECT_EQ(memory.lent(), 0U);
}

TEST(ScratchPool, GrowsOnRequestAndNeverShrinks) {
  CountingMemory memory;
  ScratchPool pool(&memory);
  EXPECT_EQ(memory.requests, 0U);
  pool.prepare(100, 3);
  EXPECT_EQ(pool.count(), 3U);
  const std::size_t requests = memory.requests;
  pool.prepare(50, 1);
  for (int round = 0; round < 3; ++round) {
    const ScratchLease a(&pool), b(&pool), c(&pool);
    const std::set<float*> distinct{a.data(), b.data(), c.data()};
    EXPECT_EQ(distinct.size(), 3U);
    for (float* data : distinct) EXPECT_EQ(reinterpret_cast<std::uintptr_t>(data) % 64, 0U);
  }
  EXPECT_EQ(memory.requests, requests);
  {
    const ScratchLease a(&pool), b(&pool), c(&pool), d(&pool);
    EXPECT_EQ(pool.count(), 4U);
  }
  pool.prepare(200, 1);
  EXPECT_EQ(pool.count(), 4U);
  EXPECT_GE(pool.floats(), 200U);
  EXPECT_EQ(ScratchLease(nullptr).data(), nullptr);
}

TEST(ScratchPool, WithoutFloatsMakesNoEmptyRequest) {
  CountingMemory memory;
  ScratchPool pool(&memory);
  pool.prepare(0, 2);
  EXPECT_EQ(pool.count(), 2U);
  EXPECT_EQ(ScratchLease(&pool).data(), nullptr);
  pool.prepare(8, 1);
  EXPECT_NE(ScratchLease(&pool).data(), nullptr);
}

TEST(ScratchPool, AFailedGrowthLeavesItUsable) {
  CountingMemory memory;
  ScratchPool pool(&memory);
  pool.prepare(100, 1);
  const ScratchLease held(&pool);
  for (const std::size_t granted : {0U, 1U}) {
    memory.refuse_after = granted;
    EXPECT_THROW(ScratchLease{&pool}, std::bad_alloc);
  }
  memory.refuse_after = SIZE_MAX;
  const ScratchLease another(&pool);
  EXPECT_NE(another.data(), held.data());
}

/// Sums its lanes in scratch memory.
void work(A<Lanes<float>>& a, Scratch<Floats> scratch) {
  if (scratch.data == nullptr) return;
  std::fill_n(scratch.data, scratch.floats, a.x[0] + 1);
  a.x[0] = scratch.data[scratch.floats - 1];
}

TEST(Scratch, HasTheTablesSizeAndIsNullWithoutOne) {
  World world;
  const Entity none = world.create(A<float>{}), zero = world.create(A<float>{}, TagValue<Floats>{0});
  std::vector<Entity> some;
  for (const std::uint64_t floats : {1U, 16U, 5000U})
    some.push_back(world.create(A<float>{}, TagValue<Floats>{floats}));
  std::vector<std::size_t> seen;
  auto schedule = ScheduleBuilder()
                      .add("look", [&](const A<Lanes<float>>&, Scratch<Floats> s) { seen.push_back(s.floats); })
                      .add("work", &work)
                      .build();
  ASSERT_TRUE(schedule);
  schedule->run(world, {1, 0});
  EXPECT_EQ(seen, (std::vector<std::size_t>{0, 0, 1, 16, 5000}));
  for (const Entity e : some) EXPECT_EQ(world.get<A>(e)->x, 1);
  EXPECT_EQ(world.get<A>(none)->x, 0);
  EXPECT_EQ(world.get<A>(zero)->x, 0);
  some.push_back(world.create(A<float>{}, TagValue<Floats>{9000}));  // a table that needs more
  schedule->run(world, {1, 1});
  EXPECT_EQ(world.get<A>(some.back())->x, 1);
  EXPECT_EQ(world.get<A>(some.front())->x, 2);
}

TEST(Scratch, MoreThreadsThanPromisedAreServed) {
  World world;
  for (unsigned i = 0; i < 40 * lane_count; ++i) world.create(A<float>{static_cast<float>(i)}, TagValue<Floats>{100});
  auto schedule = ScheduleBuilder().add("work", &work).build();
  const Jobs crowd{nullptr, [](void*, std::size_t count, Jobs::Body body, void* context) {
                     std::vector<std::thread> threads;
                     for (std::size_t i = 0; i < count; ++i) threads.emplace_back([=] { body(context, i, i + 1); });
                     for (std::thread& thread : threads) thread.join();
                   }};
  schedule->run(world, {1, 0}, crowd);
  for (const Table& table : world.tables()) {
    for (std::size_t b = 0; b < table.block_count(); ++b) {
      EXPECT_EQ(table.block(b)[0], static_cast<float>(b * lane_count + 1));
    }
  }
}

TEST(Maybe, IsSetWhereTheTableHasTheComponent) {
  World world;
  const Entity plain = world.create(A<float>{1}), more = world.create(A<float>{1}, Extra<float>{5});
  world.create(Extra<float>{7});
  int blocks = 0;
  auto schedule = ScheduleBuilder()
                      .add("add",
                           [&](A<Lanes<float>>& a, Maybe<Extra> extra) {
                             ++blocks;
                             if (extra.block != nullptr) a.x[0] += extra.block->x[0];
                           })
                      .build();
  schedule->run(world, {1, 0});
  EXPECT_EQ(blocks, 2);
  EXPECT_EQ(world.get<A>(plain)->x, 1);
  EXPECT_EQ(world.get<A>(more)->x, 6);
}

TEST(Maybe, CountsAsARead) {
  const auto look = [](Maybe<Extra>, A<Lanes<float>>&) {};
  const auto write = [](Extra<Lanes<float>>&) {};
  const auto schedule = ScheduleBuilder().add("look", look).add("write", write).build();
  ASSERT_TRUE(schedule);
  EXPECT_EQ(schedule->systems()[0].name, "write");
  EXPECT_FALSE(ScheduleBuilder().add("both", [](Maybe<Extra>, Extra<Lanes<float>>&) {}).build());
}

}  // namespace mobil::engine_scratch_test
