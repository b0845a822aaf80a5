// Threads and their floating-point modes.
#include <mobil/engine/jobs.h>

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cfenv>
#include <limits>
#include <new>
#include <thread>
#include <vector>

#include <mobil/schedule.h>
#include "tests/labels.h"

MOBIL_TEST_LABELS("threads");

namespace mobil::engine_jobs_test {
template <class F>
struct Faint {
  F x;
};

/// Returns half of the smallest normal number, computed at run time.
float half_of_smallest() {
  volatile float smallest = std::numeric_limits<float>::min();
  return smallest * 0.5F;
}
float twice_a_denormal() {
  volatile float denormal = std::numeric_limits<float>::denorm_min();
  return denormal * 2.0F;
}

#if defined(__SSE2__) || defined(__aarch64__)
TEST(EngineJobs, DenormalsAreZeroInsideAndBackOutside) {
  ASSERT_GT(half_of_smallest(), 0.0F);
  {
    const FloatMode mode;
    EXPECT_EQ(half_of_smallest(), 0.0F);
    EXPECT_EQ(twice_a_denormal(), 0.0F);
    {
      const FloatMode again;
      EXPECT_EQ(half_of_smallest(), 0.0F);
    }
    EXPECT_EQ(half_of_smallest(), 0.0F);
  }
  EXPECT_GT(half_of_smallest(), 0.0F);
  EXPECT_GT(twice_a_denormal(), 0.0F);
}

/// Returns how this thread's arithmetic rounds. (std::fegetround reads another unit's mode on x86.)
int rounding() {
  volatile float one = 1, tiny = 1e-10F;
  const bool up = one + tiny > 1, down = one - tiny < 1, toward_zero = -one + tiny > -1;
  return up ? FE_UPWARD : !down ? FE_TONEAREST : toward_zero ? FE_TOWARDZERO : FE_DOWNWARD;
}

TEST(EngineJobs, RoundingIsToNearestInsideAndBackOutside) {
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO, FE_TONEAREST}) {
    ASSERT_EQ(std::fesetround(mode), 0);
    int inside = -1;
    {
      const FloatMode ours;
      inside = rounding();
    }
    const int after = rounding();
    std::fesetround(FE_TONEAREST);
    EXPECT_EQ(inside, FE_TONEAREST);
    EXPECT_EQ(after, mode);
  }
}

TEST(EngineJobs, SystemsRunWithoutDenormalsOnEveryThreadAndCallersKeepTheirs) {
  World world;
  std::vector<Entity> all;
  for (int i = 0; i < 2000; ++i) all.push_back(world.create(Faint<float>{1}));
  auto schedule = ScheduleBuilder()
                      .add("faint",
                           [](Faint<Lanes<float>>& faint) {
                             for (float& x : faint.x.lane) x = half_of_smallest() + twice_a_denormal();
                           })
                      .build();
  const Threads threads(2);
  schedule->run(world, {}, threads.jobs());
  for (const Entity e : all) EXPECT_EQ(world.get<Faint>(e)->x, 0.0F);
  std::atomic<int> lost = 0;  // threads of the pool that do not flush denormals
  const Jobs jobs = threads.jobs();
  jobs.parallel_for(
      jobs.user, 1000,
      [](void* context, std::size_t, std::size_t) {
        if (half_of_smallest() <= 0.0F) ++*static_cast<std::atomic<int>*>(context);
      },
      &lost);
  EXPECT_EQ(lost, 0);
  EXPECT_GT(half_of_smallest(), 0.0F);
}
#endif

TEST(EngineJobs, EveryIndexRunsOnce) {
  for (const int count : {0, 1, 2, 3}) {
    Threads first(count);
    const Jobs jobs = first.jobs();
    const Threads moved = std::move(first);
    for (const std::size_t size : {1U, 7U, 1000U}) {
      std::vector<int> done(size, 0);
      jobs.parallel_for(
          jobs.user, size,
          [](void* context, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) ++(*static_cast<std::vector<int>*>(context))[i];
          },
          &done);
      EXPECT_EQ(done, std::vector<int>(size, 1));
    }
  }
}

TEST(EngineJobs, EmptyRangesStartNoJob) {
  const Jobs never{nullptr, [](void*, std::size_t, Jobs::Body, void*) { ADD_FAILURE() << "asked"; }, 2};
  in_parallel(never, 0, [](std::size_t, std::size_t) { ADD_FAILURE() << "worked"; });
  run_in_parallel(
      never, 0, [](void*, std::size_t, std::size_t) { ADD_FAILURE() << "worked"; }, nullptr);
}

/// A host's own threads, one a part. No exception can leave them.
TEST(EngineJobs, ExceptionsOfJobsReachTheCaller) {
  const Jobs own{nullptr,
                 [](void*, std::size_t count, Jobs::Body body, void* context) {
                   std::vector<std::thread> threads;
                   for (std::size_t i = 0; i < count; ++i) threads.emplace_back(body, context, i, i + 1);
                   for (std::thread& thread : threads) thread.join();
                 },
                 4};
  const Threads pool(2);
  for (const Jobs& jobs : {own, pool.jobs(), Jobs{}}) {
    for (int round = 0; round < 50; ++round) {
      std::array<std::atomic<int>, 8> begun{};
      const auto work = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) ++begun[i];
        if (begin <= 5 && 5 < end) throw std::bad_alloc();
      };
      EXPECT_THROW(in_parallel(jobs, begun.size(), work), std::bad_alloc);
      for (const auto& times : begun) EXPECT_EQ(times, 1);
    }
  }
}
}  // namespace mobil::engine_jobs_test
