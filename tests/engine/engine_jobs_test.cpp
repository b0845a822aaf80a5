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

#if defined(__linux__)
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#endif

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
  const bool up = one + tiny > 1, down = one - tiny<1, toward_zero = -one + tiny> - 1;
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

/// Counts each of `size` indices in a loop of `jobs`, and checks that all ran once.
void run_each_once(const Jobs& jobs, std::size_t size) {
  std::vector<std::atomic<int>> done(size);
  in_parallel(jobs, size, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) ++done[i];
  });
  for (const auto& times : done) ASSERT_EQ(times, 1);
}

TEST(EngineJobs, LoopsInLoopsOfSeveralThreadsAtOnce) {
  const Threads pool(3), other(2);
  const Jobs jobs = pool.jobs(), inner = other.jobs();
  std::vector<std::jthread> hosts;
  for (int host = 0; host < 3; ++host) {
    hosts.emplace_back([&] {
      for (std::size_t round = 0; round < 30; ++round) {
        in_parallel(jobs, 1 + round % 7, [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) run_each_once(i % 2 == 0 ? jobs : inner, 1 + 5 * i);
        });
      }
    });
  }
}

TEST(EngineJobs, PoolsComeAndGoOnSeveralThreadsAtOnce) {
  std::vector<std::jthread> hosts;
  for (int host = 0; host < 3; ++host) {
    hosts.emplace_back([] {
      for (int round = 0; round < 20; ++round) run_each_once(Threads(2).jobs(), 10);
    });
  }
}

#if defined(__linux__)
std::size_t threads_of_process() {
  std::size_t count = 0;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) count += !task.path().empty();
  return count;
}

TEST(EngineJobs, AThousandPoolsShareTheThreadsOfOneAndEndThem) {
  const std::size_t before = threads_of_process();
  const std::size_t workers = static_cast<std::size_t>(Threads().count()) - 1;
  {
    std::vector<Threads> pools;
    for (int i = 0; i < 1000; ++i) {
      pools.emplace_back();
      EXPECT_EQ(threads_of_process(), before + (i == 0 ? 0 : workers));  // workers start in the first loop
      run_each_once(pools.back().jobs(), 4 * workers + 4);
    }
  }
  while (threads_of_process() != before)
    std::this_thread::yield();  // the kernel removes a joined thread a little later
}

TEST(EngineJobs, ThreadsAreThoseOfTheProcessesAffinity) {
  cpu_set_t all, first;
  ASSERT_EQ(sched_getaffinity(0, sizeof all, &all), 0);
  CPU_ZERO(&first);
  for (unsigned i = 0; i < CPU_SETSIZE && CPU_COUNT(&first) == 0; ++i)
    if (CPU_ISSET(i, &all)) CPU_SET(i, &first);
  ASSERT_EQ(sched_setaffinity(0, sizeof first, &first), 0);
  const int least = Threads().count(), most = Threads(7).count();
  ASSERT_EQ(sched_setaffinity(0, sizeof all, &all), 0);
  EXPECT_EQ(least, 1);
  EXPECT_EQ(most, 1);
  EXPECT_EQ(Threads().count(), CPU_COUNT(&all));
}

#if !defined(__SANITIZE_THREAD__)  // it ends children that start threads
TEST(EngineJobs, AForkedChildStartsItsOwnThreads) {
  const Threads pool(2);
  const Jobs jobs = pool.jobs();
  run_each_once(jobs, 100);
  std::atomic<bool> over = false;
  std::jthread busy([&] {  // so that some forks are during a loop
    while (!over) run_each_once(jobs, 10);
  });
  for (int round = 0; round < 20; ++round) {
    const pid_t child = ::fork();
    if (child == 0) {
      int done = 0;
      for (int i = 0; i < 3; ++i) {
        const Threads own(2);
        std::atomic<int> sum = 0;
        for (const Jobs& of : {jobs, own.jobs()})
          in_parallel(of, 100, [&](std::size_t begin, std::size_t end) { sum += static_cast<int>(end - begin); });
        done += sum;
      }
      ::_exit(done == 600 ? 0 : 1);
    }
    int status = -1;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
  }
  over = true;
}
#endif
#endif
}  // namespace mobil::engine_jobs_test
