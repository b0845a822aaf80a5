// A steady tick allocates no memory, neither from the world's resource nor from the heap.
#include <gtest/gtest.h>

#include <vector>

#include <mobil/schedule.h>
#include "tests/engine/counting_heap.h"
#include "tests/engine/engine_counting_memory.h"
#include "tests/labels.h"

MOBIL_TEST_LABELS("threads");

namespace mobil::engine_memory_test {
template <class F>
struct A {
  F x;
};
template <class F>
struct B {
  F x;
};
struct Nodes {};
struct Substeps {};

void grow(A<Lanes<float>>& a, float tick_s) {
  for (float& x : a.x.lane) x += tick_s;
}
void spread(const A<Lanes<float>>& a, Field<Nodes> nodes, const Lookup<A>& lookup, Rows rows) {
  for (std::size_t l = 0; l < lane_count; ++l) nodes.data[l] = a.x[l] + *lookup.find(rows.entity[l]);
}
void gather(Field<const Nodes> nodes, B<Lanes<float>>& b) {
  for (std::size_t l = 0; l < lane_count; ++l) b.x[l] += nodes.data[l];
}

TEST(EngineMemory, ASteadyTickTakesNone) {
  const std::size_t at_start = heap_requests;
  CountingMemory memory;
  World world(&memory);
  std::vector<Entity> all;
  for (unsigned i = 0; i < 500; ++i) {
    all.push_back(world.create(A<float>{}, B<float>{}, FieldWidth<Nodes>{3}, TagValue<Substeps>{i % 4}));
  }
  auto schedule = ScheduleBuilder().add("gather", &gather).add("spread", &spread).add("grow", &grow).build();
  ASSERT_GT(heap_requests, at_start);  // the counter counts

  for (const int count : {1, 2}) {
    const Threads threads(count);
    for (int i = 0; i < 3; ++i) schedule->run(world, {0.5F, 0}, threads.jobs());
    const std::size_t heap_before = heap_requests, lent_before = memory.requests;
    for (std::uint32_t i = 0; i < 200; ++i) {
      schedule->run(world, {0.5F, i}, threads.jobs());
      // one is destroyed, one is created, and one changes tables and back
      EXPECT_EQ(world.destroy(all[i]), Status::ok);
      all[i] = world.create(A<float>{}, B<float>{}, FieldWidth<Nodes>{3}, TagValue<Substeps>{i % 4});
      EXPECT_EQ(world.set(all[i + 1], TagValue<Substeps>{i % 4}), Status::ok);
      EXPECT_EQ(world.set(all[i + 1], TagValue<Substeps>{(i + 1) % 4}), Status::ok);
    }
    EXPECT_EQ(heap_requests, heap_before) << count << " threads";
    EXPECT_EQ(memory.requests, lent_before) << count << " threads";
  }
  EXPECT_GT(world.get<B>(all[499])->x, 0.0F);
}
}  // namespace mobil::engine_memory_test
