// Pool of mobil/engine/jobs.h. All `Threads` of a process share its workers, so that a thousand simulations need no
// more threads than the machine has. Without threads (WebAssembly) it is only the calling thread.
#include <mobil/engine/jobs.h>

#if defined(__wasm__)

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

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#if defined(__linux__)
#include <sched.h>
#include <unistd.h>
#endif
#if !defined(_WIN32)
#include <pthread.h>
#endif
#if defined(__SSE2__) || defined(_M_X64)
#include <emmintrin.h>
#endif

namespace mobil::inline v0_3 {
namespace {
/// Time for which a thread without work looks for some before it sleeps. Loops of a tick follow each other within tens
/// of microseconds, and waking a thread takes as long: with 20 us small crowds need 1.25 times the time.
constexpr std::chrono::microseconds spin{100};

void pause() {
#if defined(__SSE2__) || defined(_M_X64)
  _mm_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

/// Waits until `done()` or the end of `spin`.
template <class Done>
void spin_until(const Done& done) {
  const auto until = std::chrono::steady_clock::now() + spin;
  do {
    for (int i = 0; i < 16; ++i) {
      if (done()) return;
      pause();
    }
  } while (std::chrono::steady_clock::now() < until);
}

/// Returns the number of processors that this process can use.
std::size_t usable_processors() {
#if defined(__linux__)
  cpu_set_t set;
  if (sched_getaffinity(getpid(), sizeof set, &set) == 0) return static_cast<std::size_t>(CPU_COUNT(&set));
#endif
  return std::max(1U, std::thread::hardware_concurrency());
}

/// Part of a loop. A thread begins with its own share, the same one in every tick, so that its cache has the data.
struct alignas(64) Share {
  std::atomic<std::size_t> next;
  std::size_t end;

  /// Takes a quarter of the rest.
  bool take(std::size_t& first, std::size_t& last) {
    first = next.load(std::memory_order_relaxed);
    do {
      if (first >= end) return false;
      last = first + std::max<std::size_t>(1, (end - first) / 4);
    } while (!next.compare_exchange_weak(first, last, std::memory_order_relaxed));
    return true;
  }
};

/// A call of `parallel_for`, on its caller's stack. The pool's mutex guards the members marked with *.
struct Loop {
  static constexpr std::size_t most_shares = 64;

  Loop(std::size_t count, std::size_t threads, Jobs::Body body_of, void* context_of)
      : body(body_of), context(context_of), shares(std::min({count, threads, most_shares})), wanted(threads - 1) {
    for (std::size_t s = 0; s < shares; ++s) {
      share[s].next.store(count / shares * s + std::min(s, count % shares), std::memory_order_relaxed);
      share[s].end = count / shares * (s + 1) + std::min(s + 1, count % shares);
    }
  }
  /// Runs until all is taken, beginning with this share.
  void run(std::size_t first) {
    for (std::size_t s = 0; s < shares; ++s) {
      std::size_t begin, end;
      while (share[(first + s) % shares].take(begin, end)) body(context, begin, end);
    }
  }

  Jobs::Body body;
  void* context;
  std::size_t shares;
  std::array<Share, most_shares> share;
  std::size_t wanted;                   // * workers that can still join
  std::atomic<std::size_t> helpers{0};  // * workers inside
  bool caller_sleeps = false;           // *
  Loop* next = nullptr;                 // * in the list of loops that want workers
};

class Pool {
 public:
  /// Returns the process's pool, which is never destroyed: hosts' statics can own simulations.
  static Pool& get() {
    static Pool& pool = *new Pool;
    return pool;
  }
  /// Adds a user who wants `workers` of the machine's `processors`.
  void enter(std::size_t workers, std::size_t processors) {
    const std::lock_guard lock(mutex_);
    asked_ += workers;
    processors_ = std::max(processors_, processors);
  }
  /// Removes a user, and ends the workers after the last one.
  void leave(std::size_t workers) {
    std::vector<std::thread> ending;
    {
      const std::lock_guard lock(mutex_);
      asked_ -= workers;
      if (asked_ > 0) return;
      ending.swap(workers_);
      idle_ = 0;
      ++generation_;
    }
    work_.notify_all();
    for (std::thread& worker : ending) worker.join();
  }
  void run(Loop& loop) {
    if (begin(loop)) work_.notify_one();
    loop.run(0);
    end(loop);
  }

 private:
  Pool() {
#if !defined(_WIN32)
    // A child of fork has no workers. It forgets them, with the states of those that wait, and starts its own.
    pthread_atfork([] { get().mutex_.lock(); }, [] { get().mutex_.unlock(); },
                   [] {
                     Pool& pool = get();
                     new (&pool.work_) std::condition_variable;
                     new (&pool.done_) std::condition_variable;
                     new (&pool.workers_) std::vector<std::thread>;
                     pool.first_ = nullptr;
                     pool.idle_ = pool.asleep_ = 0;
                     ++pool.generation_;
                     pool.mutex_.unlock();
                   });
#endif
  }

  /// Offers a loop to workers, and starts missing ones. Returns whether one must be woken.
  bool begin(Loop& loop) {
    const std::lock_guard lock(mutex_);
    try {
      while (idle_ < loop.wanted && workers_.size() < std::min(asked_, processors_ - 1)) {
        workers_.emplace_back([this, index = workers_.size(), generation = generation_] { work(index, generation); });
        ++idle_;
      }
    } catch (const std::exception&) {  // the system has no more threads or memory: fewer do the work
    }
    loop.next = first_;
    first_ = &loop;
    return asleep_ > 0;
  }
  void end(Loop& loop) {
    {
      const std::lock_guard lock(mutex_);
      forget(loop);
    }
    const auto over = [&loop] { return loop.helpers.load(std::memory_order_acquire) == 0; };
    spin_until(over);
    if (over()) return;
    std::unique_lock lock(mutex_);
    loop.caller_sleeps = true;
    done_.wait(lock, over);
  }
  void forget(const Loop& loop) {
    Loop* rest = first_;
    if (rest == &loop) {
      first_ = loop.next;
    } else {
      for (; rest != nullptr; rest = rest->next)
        if (rest->next == &loop) rest->next = loop.next;
    }
  }

  void work(std::size_t index, std::size_t generation) {
    std::unique_lock lock(mutex_);
    for (;;) {
      if (first_ == nullptr) {
        lock.unlock();
        spin_until([this] { return first_.load(std::memory_order_relaxed) != nullptr; });
        lock.lock();
        ++asleep_;
        work_.wait(lock, [&] { return first_ != nullptr || generation != generation_; });
        --asleep_;
      }
      if (generation != generation_) return;
      Loop& loop = *first_;
      ++loop.helpers;
      if (--loop.wanted == 0) first_ = loop.next;
      --idle_;
      // Each woken thread wakes two, while loops want any.
      const std::size_t more = first_ == nullptr ? 0 : std::min<std::size_t>(asleep_, 2);
      lock.unlock();
      for (std::size_t i = 0; i < more; ++i) work_.notify_one();
      loop.run(1 + index);
      lock.lock();
      ++idle_;
      const bool wake = loop.helpers == 1 && loop.caller_sleeps;
      --loop.helpers;  // from here on its caller can return
      if (wake) done_.notify_all();
    }
  }

  std::mutex mutex_;  // of all members below
  std::condition_variable work_, done_;
  std::vector<std::thread> workers_;
  std::atomic<Loop*> first_ = nullptr;  // loops that want workers, the newest first; written under the mutex
  std::size_t asked_ = 0;               // workers that all users want
  std::size_t processors_ = 1;
  std::size_t idle_ = 0;    // workers outside of loops
  std::size_t asleep_ = 0;  // of these, those that wait for work_
  std::size_t generation_ = 0;
};

}  // namespace

struct Threads::Arena {
  Arena(std::size_t asked, std::size_t processors) : count(asked > 0 ? std::min(asked, processors) : processors) {
    if (count > 1) Pool::get().enter(count - 1, processors);
  }
  ~Arena() {
    if (count > 1) Pool::get().leave(count - 1);
  }
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  const std::size_t count;
};

Threads::Threads(int count)
    : arena_(std::make_unique<Arena>(static_cast<std::size_t>(std::max(count, 0)), usable_processors())) {}
Threads::~Threads() = default;
Threads::Threads(Threads&&) noexcept = default;
Threads& Threads::operator=(Threads&&) noexcept = default;

int Threads::count() const {
  return static_cast<int>(arena_->count);
}

Jobs Threads::jobs() const {
  if (count() == 1) return {};
  return {arena_.get(),
          [](void* user, std::size_t count, Jobs::Body body, void* context) {
            const std::size_t threads = std::min(count, static_cast<const Arena*>(user)->count);
            if (count == 0) return;
            if (threads == 1) return body(context, 0, count);
            Loop loop(count, threads, body, context);
            Pool::get().run(loop);
          },
          arena_->count};
}

}  // namespace mobil::inline v0_3

#endif
