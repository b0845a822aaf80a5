#pragma once
// Who does the work of a tick: one thread, a pool of ours, or the caller's own job system.

#include <atomic>
#include <cassert>
#include <cstddef>
#include <memory>
#include <type_traits>

namespace mobil {

/// A job system as plain data. `parallel_for` calls `body(context, begin, end)` on disjoint ranges that together are
/// [0, count), on whatever threads it likes, and returns when all have. Results never depend on how it cuts. It must
/// not throw, and what it runs on must live as long as the simulation: after an exception out of it a tick is half
/// done, and the simulation good for nothing but to be restored or destroyed (restoring copes with jobs that throw).
/// Builds with assertions check that all of the range was worked on, once.
struct Jobs {
  using Body = void (*)(void* context, std::size_t begin, std::size_t end);

  void* user = nullptr;
  void (*parallel_for)(void* user, std::size_t count, Body body, void* context) =
      [](void*, std::size_t count, Body body, void* context) { body(context, 0, count); };
  std::size_t threads = 1;  // about how many work at once, for memory made ready and work cut; more may
};

/// `work(begin, end)` on parts of [0, count), by jobs.
template <class Work>
void in_parallel(const Jobs& jobs, std::size_t count, Work work) {
  if (count == 0) return;
  if (count == 1) return work(std::size_t{0}, std::size_t{1});
#ifndef NDEBUG
  std::atomic<std::size_t> done{0};
  auto counted = [&](std::size_t begin, std::size_t end) {
    assert(begin < end && end <= count && "a host's parallel_for gave a range outside of what was asked");
    work(begin, end);
    done += end - begin;
  };
#else
  auto& counted = work;
#endif
  using Counted = std::remove_reference_t<decltype(counted)>;
  jobs.parallel_for(
      jobs.user, count,
      [](void* context, std::size_t begin, std::size_t end) { (*static_cast<Counted*>(context))(begin, end); },
      &counted);
#ifndef NDEBUG
  assert(done == count && "a host's parallel_for left a part out, or did it twice");
#endif
}

/// A pool (oneTBB). One thread runs everything inline and starts nothing; 0 means as many as the machine has. More than
/// the machine has are allowed and not used.
class Threads {
 public:
  /// A pool of `count` threads, the caller among them.
  explicit Threads(int count = 0);
  ~Threads();
  Threads(Threads&&) noexcept;
  Threads& operator=(Threads&&) noexcept;

  /// How many threads work at once, the caller among them.
  int count() const;
  /// Valid as long as this pool lives, also after it has been moved.
  Jobs jobs() const;

 private:
  struct Arena;
  std::unique_ptr<Arena> arena_;
};

/// While one lives, this thread's arithmetic takes denormal numbers for zero (on x86 and 64-bit ARM); after it the
/// thread does what it did before.
class FlushDenormals {
 public:
  FlushDenormals();
  ~FlushDenormals();
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned long before_;
};

}  // namespace mobil
