#pragma once
// Interruption of long calls by the host, for example on Ctrl-C.
//
//   const InterruptScope scope({&pressed, [](void* user) { return *static_cast<std::atomic<bool>*>(user) ? 1 : 0; }});
//   simulation.tick(1'000'000);  // throws Interrupted between two ticks

#include <atomic>
#include <chrono>
#include <exception>

namespace mobil::inline v0_3 {

/// The host's function that long calls ask, at most once in `every_s`. A result other than 0 ends the call.
struct Interrupt {
  void* user = nullptr;
  int (*stop)(void* user) = nullptr;
  double every_s = 0.05;
};

/// Thrown by a call that the host has ended. `tick` and `advance` keep the finished ticks. All other calls change no
/// person, and keep shared meshes and bases that are finished.
struct Interrupted final : std::exception {
  const char* what() const noexcept override { return "the host has interrupted the call"; }
};

/// Makes long calls of this thread, and their jobs on other threads, interruptible while it lives. Only this thread
/// calls the host's function.
class InterruptScope {
 public:
  explicit InterruptScope(const Interrupt& host);
  ~InterruptScope();
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;

  /// Returns the innermost scope of this thread; null without one.
  static InterruptScope* current();
  /// Sets the scope that a job of another thread belongs to, and returns the former one.
  static InterruptScope* enter(InterruptScope* scope);

 private:
  friend void check_interrupt();

  Interrupt host_;
  const void* thread_;
  std::chrono::steady_clock::time_point next_;
  std::atomic<bool> stopped_ = false;
  InterruptScope* outer_;
};

/// Keeps this thread's work whole while it lives: no call ends within it.
class WholeScope {
 public:
  WholeScope() = default;
  ~WholeScope() { InterruptScope::enter(interrupted_); }
  WholeScope(const WholeScope&) = delete;
  WholeScope& operator=(const WholeScope&) = delete;

 private:
  InterruptScope* interrupted_ = InterruptScope::enter(nullptr);
};

/// Asks the host whether the call ends, and then throws Interrupted. Long work calls it where memory can run out.
void check_interrupt();

}  // namespace mobil::inline v0_3
