#include "engine/jobs.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>

#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif
#if defined(__SSE2__)
#include <pmmintrin.h>
#include <xmmintrin.h>
#endif

namespace mobil {

struct Threads::Arena {
  explicit Arena(int count) : arena(count) {}
  tbb::task_arena arena;
};

namespace {
/// ThreadSanitizer cannot see how oneTBB synchronises, because oneTBB is not built with it. These two calls declare it:
/// all bodies of a loop run after what the caller did before, and before what it does next.
#if defined(__SANITIZE_THREAD__)
void before(char* point) {
  __tsan_release(point);
}
void after(char* point) {
  __tsan_acquire(point);
}
#else
void before(char*) {}
void after(char*) {}
#endif

int threads_for(int asked) {
  const int available = tbb::info::default_concurrency();
  return asked > 0 ? std::min(asked, available) : available;
}
}  // namespace

Threads::Threads(int count) : arena_(std::make_unique<Arena>(threads_for(count))) {}
Threads::~Threads() = default;
Threads::Threads(Threads&&) noexcept = default;
Threads& Threads::operator=(Threads&&) noexcept = default;

int Threads::count() const {
  return arena_->arena.max_concurrency();
}

Jobs Threads::jobs() const {
  if (count() == 1) return {};
  return {arena_.get(),
          [](void* user, std::size_t count, Jobs::Body body, void* context) {
            char begin, end;
            before(&begin);
            static_cast<Arena*>(user)->arena.execute([=, begin = &begin, end = &end] {
              tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count), [=](const auto& range) {
                after(begin);
                body(context, range.begin(), range.end());
                before(end);
              });
            });
            after(&end);
          },
          static_cast<std::size_t>(count())};
}

namespace {
#if defined(__SSE2__)
constexpr unsigned long flush_bits = _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON;
unsigned long control() {
  return _mm_getcsr();
}
void set_control(unsigned long word) {
  _mm_setcsr(static_cast<unsigned>(word));
}
#elif defined(__aarch64__)
constexpr unsigned long flush_bits = 1UL << 24;
unsigned long control() {
  unsigned long word;
  asm volatile("mrs %0, fpcr" : "=r"(word));
  return word;
}
void set_control(unsigned long word) {
  asm volatile("msr fpcr, %0" ::"r"(word));
}
#else
constexpr unsigned long flush_bits = 0;
unsigned long control() {
  return 0;
}
void set_control(unsigned long) {}
#endif
}  // namespace

FlushDenormals::FlushDenormals() : before_(control()) {
  set_control(before_ | flush_bits);
}

// Only the two bits go back: exception flags that were raised meanwhile stay raised.
FlushDenormals::~FlushDenormals() {
  set_control((control() & ~flush_bits) | (before_ & flush_bits));
}

}  // namespace mobil
