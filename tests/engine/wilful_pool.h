#pragma once
// An adversarial job system: it cuts ranges at random places and runs them in random order on any number of threads,
// possibly more than the machine has.

#include <algorithm>
#include <atomic>
#include <barrier>
#include <cstddef>
#include <random>
#include <thread>
#include <utility>
#include <vector>

#include <mobil/engine/jobs.h>

namespace mobil {

class WilfulPool {
 public:
  explicit WilfulPool(std::size_t threads, unsigned seed = 1)
      : random_(seed), begin_(static_cast<std::ptrdiff_t>(threads)), end_(static_cast<std::ptrdiff_t>(threads)) {
    for (std::size_t t = 1; t < threads; ++t) {
      workers_.emplace_back([this] {
        for (;;) {
          begin_.arrive_and_wait();
          if (over_) return;
          take_up();
          end_.arrive_and_wait();
        }
      });
    }
  }
  ~WilfulPool() {
    over_ = true;
    begin_.arrive_and_wait();
  }
  WilfulPool(const WilfulPool&) = delete;
  WilfulPool& operator=(const WilfulPool&) = delete;

  /// Returns jobs that report `promised` threads, which can differ from the true number.
  Jobs jobs(std::size_t promised) {
    return {this,
            [](void* user, std::size_t count, Jobs::Body body, void* context) {
              static_cast<WilfulPool*>(user)->run(count, body, context);
            },
            promised};
  }
  Jobs jobs() { return jobs(workers_.size() + 1); }

 private:
  void run(std::size_t count, Jobs::Body body, void* context) {
    cuts_.assign({0, count});
    for (std::size_t i = random_() % (3 * workers_.size() + 4); i > 0; --i) cuts_.push_back(random_() % (count + 1));
    std::sort(cuts_.begin(), cuts_.end());
    ranges_.clear();
    for (std::size_t i = 1; i < cuts_.size(); ++i) {
      if (cuts_[i] > cuts_[i - 1]) ranges_.emplace_back(cuts_[i - 1], cuts_[i]);
    }
    std::shuffle(ranges_.begin(), ranges_.end(), random_);
    body_ = body;
    context_ = context;
    next_ = 0;
    begin_.arrive_and_wait();
    take_up();
    end_.arrive_and_wait();
  }
  void take_up() {
    for (std::size_t i = 0; (i = next_++) < ranges_.size();) body_(context_, ranges_[i].first, ranges_[i].second);
  }

  std::mt19937 random_;
  std::barrier<> begin_, end_;
  bool over_ = false;
  std::vector<std::size_t> cuts_;
  std::vector<std::pair<std::size_t, std::size_t>> ranges_;
  Jobs::Body body_ = nullptr;
  void* context_ = nullptr;
  std::atomic<std::size_t> next_ = 0;
  std::vector<std::jthread> workers_;  // last member: destroyed first
};

/// Returns jobs on one thread that run one part at a time, the last one first, and report `promised` threads.
inline Jobs backwards(std::size_t promised = 1) {
  return {nullptr,
          [](void*, std::size_t count, Jobs::Body body, void* context) {
            for (std::size_t i = count; i-- > 0;) body(context, i, i + 1);
          },
          promised};
}

}  // namespace mobil
