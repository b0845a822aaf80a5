#pragma once
// Who does the work of a tick: one thread, a pool of ours, or the caller's own job system.

#include <cstddef>
#include <memory>

namespace mobil::inline v0_3 {

/// A job system as plain data. `parallel_for` calls `body(context, begin, end)` on disjoint ranges that together are
/// [0, count), on whatever threads it likes, and returns when all have. Results never depend on how it cuts. It must
/// not throw (`body` never does), and what it runs on must live as long as the simulation: after an exception out of it
/// a tick is half done, and the simulation good for nothing but to be restored or destroyed (restoring copes with jobs
/// that throw). Builds with assertions check that all of the range was worked on, once.
struct Jobs {
  using Body = void (*)(void* context, std::size_t begin, std::size_t end);

  void* user = nullptr;
  void (*parallel_for)(void* user, std::size_t count, Body body, void* context) =
      [](void*, std::size_t count, Body body, void* context) { body(context, 0, count); };
  std::size_t threads = 1;  // about how many work at once, for memory made ready and work cut; more may
};

/// `body` on parts of [0, count), by jobs. What it throws, on whatever thread, is kept from the host's job system: all
/// parts run, then the first exception is thrown here.
void run_in_parallel(const Jobs& jobs, std::size_t count, Jobs::Body body, void* context);

/// `work(begin, end)` on parts of [0, count), likewise.
template <class Work>
void in_parallel(const Jobs& jobs, std::size_t count, Work work) {
  if (count == 1) return work(std::size_t{0}, std::size_t{1});
  run_in_parallel(
      jobs, count,
      [](void* context, std::size_t begin, std::size_t end) { (*static_cast<Work*>(context))(begin, end); }, &work);
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

}  // namespace mobil::inline v0_3
