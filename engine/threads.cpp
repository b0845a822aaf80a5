// Pool of mobil/engine/jobs.h. It is oneTBB's, or only the calling thread if built without oneTBB (MOBIL_PORTABLE).
#include <mobil/engine/jobs.h>

#if defined(MOBIL_PORTABLE)

namespace mobil::inline v0_3 {

struct Threads::Arena {};

Threads::Threads(int) {}
Threads::~Threads() = default;
Threads::Threads(Threads&&) noexcept = default;
Threads& Threads::operator=(Threads&&) noexcept = default;

int Threads::count() const {
  return 1;
}

Jobs Threads::jobs() const {
  return {};
}

}  // namespace mobil::inline v0_3

#else

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>

#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

namespace mobil::inline v0_3 {

struct Threads::Arena {
  explicit Arena(int count) : arena(count) {}
  tbb::task_arena arena;
};

namespace {
/// ThreadSanitizer cannot see oneTBB's synchronisation, because oneTBB is built without it. These two calls declare it:
/// all bodies of a loop run after the caller's earlier work and before its later work.
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

}  // namespace mobil::inline v0_3

#endif
