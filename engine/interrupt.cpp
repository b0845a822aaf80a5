#include <mobil/engine/interrupt.h>

#include <utility>

namespace mobil::inline v0_3 {
namespace {

thread_local InterruptScope* innermost = nullptr;  // its address tells threads apart

std::chrono::steady_clock::time_point after(double seconds) {
  return std::chrono::steady_clock::now() +
         std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(seconds));
}

}  // namespace

InterruptScope::InterruptScope(const Interrupt& host)
    : host_(host),
      thread_(&innermost),
      next_(after(host.every_s)),
      outer_(enter(host.stop == nullptr ? current() : this)) {}

InterruptScope::~InterruptScope() {
  enter(outer_);
}

InterruptScope* InterruptScope::current() {
  return innermost;
}

InterruptScope* InterruptScope::enter(InterruptScope* scope) {
  return std::exchange(innermost, scope);
}

void check_interrupt() {
  InterruptScope* const scope = innermost;
  if (scope == nullptr) return;
  if (scope->stopped_.load(std::memory_order_relaxed)) throw Interrupted();
  if (scope->thread_ != &innermost || std::chrono::steady_clock::now() < scope->next_) return;
  if (scope->host_.stop(scope->host_.user) != 0) {
    scope->stopped_.store(true, std::memory_order_relaxed);
    throw Interrupted();
  }
  scope->next_ = after(scope->host_.every_s);
}

}  // namespace mobil::inline v0_3
