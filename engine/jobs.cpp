#include <mobil/engine/jobs.h>

#include <atomic>
#include <cassert>
#include <exception>

#include <mobil/engine/interrupt.h>

#if defined(__SSE2__)
#include <pmmintrin.h>
#include <xmmintrin.h>
#endif

namespace mobil::inline v0_3 {
namespace {
#if defined(__SSE2__)
constexpr unsigned long flush_bits = _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON, rounding_bits = _MM_ROUND_MASK;
unsigned long control() {
  return _mm_getcsr();
}
void set_control(unsigned long word) {
  _mm_setcsr(static_cast<unsigned>(word));
}
#elif defined(__aarch64__)
constexpr unsigned long flush_bits = 1UL << 24, rounding_bits = 3UL << 22;
unsigned long control() {
  unsigned long word;
  asm volatile("mrs %0, fpcr" : "=r"(word));
  return word;
}
void set_control(unsigned long word) {
  asm volatile("msr fpcr, %0" ::"r"(word));
}
#else
constexpr unsigned long flush_bits = 0, rounding_bits = 0;
unsigned long control() {
  return 0;
}
void set_control(unsigned long) {}
#endif

struct Guarded {
  std::size_t count;
  Jobs::Body body;
  void* context;
  std::atomic<bool> thrown{false};
  std::exception_ptr first;
  InterruptScope* interrupt = InterruptScope::current();
#ifndef NDEBUG
  std::atomic<std::size_t> done{0};
#endif
};
void run_guarded(void* context, std::size_t begin, std::size_t end) noexcept {
  const FloatMode mode;
  Guarded& of = *static_cast<Guarded*>(context);
  assert(begin < end && end <= of.count && "a host's parallel_for gave a range outside of what was asked");
  InterruptScope* const before = InterruptScope::enter(of.interrupt);
  try {
    check_interrupt();
    of.body(of.context, begin, end);
  } catch (...) {
    if (!of.thrown.exchange(true)) of.first = std::current_exception();
  }
  InterruptScope::enter(before);
#ifndef NDEBUG
  of.done += end - begin;
#endif
}
}  // namespace

void run_in_parallel(const Jobs& jobs, std::size_t count, Jobs::Body body, void* context) {
  if (count == 0) return;
  Guarded guarded{count, body, context, {}, {}};
  jobs.parallel_for(jobs.user, count, &run_guarded, &guarded);
  assert(guarded.done == count && "a host's parallel_for left a part out, or did it twice");
  if (guarded.thrown) std::rethrow_exception(guarded.first);
}

FloatMode::FloatMode() : before_(control()) {
  set_control((before_ | flush_bits) & ~rounding_bits);  // zero is to nearest
}

// Only these bits are restored; exception flags raised meanwhile stay raised.
FloatMode::~FloatMode() {
  constexpr unsigned long ours = flush_bits | rounding_bits;
  set_control((control() & ~ours) | (before_ & ours));
}

}  // namespace mobil::inline v0_3
