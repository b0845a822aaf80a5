#pragma once
// Threads of a tick: the calling thread, a pool, or the host's job system.

#include <cstddef>
#include <memory>

namespace mobil::inline v0_3 {

/// A job system as plain data. `parallel_for` calls `body(context, begin, end)` on disjoint ranges that together are
/// [0, count), on any threads, and returns after all of them. Results do not depend on the ranges. It must not throw
/// (`body` never does), and must live as long as the simulation. If it throws, the tick is incomplete, and the
/// simulation can only be restored or destroyed; restoring tolerates jobs that throw. Builds with assertions check that
/// the whole range is covered once.
struct Jobs {
  using Body = void (*)(void* context, std::size_t begin, std::size_t end);

  void* user = nullptr;
  void (*parallel_for)(void* user, std::size_t count, Body body, void* context) =
      [](void*, std::size_t count, Body body, void* context) { body(context, 0, count); };
  std::size_t threads = 1;  // typical concurrency, for memory and ranges; not a limit
};

/// Runs `body` on ranges of [0, count). Exceptions do not reach the host's job system: all ranges run, then the first
/// exception is rethrown here.
void run_in_parallel(const Jobs& jobs, std::size_t count, Jobs::Body body, void* context);

/// Runs `work(begin, end)` on ranges of [0, count), with exceptions as in run_in_parallel.
template <class Work>
void in_parallel(const Jobs& jobs, std::size_t count, Work work) {
  if (count == 1) return work(std::size_t{0}, std::size_t{1});
  run_in_parallel(
      jobs, count,
      [](void* context, std::size_t begin, std::size_t end) { (*static_cast<Work*>(context))(begin, end); }, &work);
}

/// A pool. One thread runs everything inline and starts no threads; 0 uses all processors of this process. A larger
/// count is reduced to these. All pools of a process share their workers. The first loop starts workers, which sleep
/// between ticks, and the destructor of the last pool joins them. A forked child starts its own.
class Threads {
 public:
  /// Creates a pool of `count` threads, including the caller.
  explicit Threads(int count = 0);
  ~Threads();
  Threads(Threads&&) noexcept;
  Threads& operator=(Threads&&) noexcept;

  /// Returns the number of concurrent threads, including the caller.
  int count() const;
  /// Returns jobs that are valid as long as this pool lives, even after a move.
  Jobs jobs() const;

 private:
  struct Arena;
  std::unique_ptr<Arena> arena_;
};

/// The arithmetic of this thread while it lives: denormals are flushed to zero and results rounded to nearest (on x86
/// and 64-bit ARM). It then restores the previous mode. `run_in_parallel` and the calls that change state use it, so
/// that a host's mode does not change their results.
class FloatMode {
 public:
  FloatMode();
  ~FloatMode();
  FloatMode(const FloatMode&) = delete;
  FloatMode& operator=(const FloatMode&) = delete;

 private:
  unsigned long before_;
};

}  // namespace mobil::inline v0_3
