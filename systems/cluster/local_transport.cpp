#include <mobil/local_transport.h>

#include <deque>
#include <map>
#include <mutex>
#include <tuple>
#include <utility>

#include "engine/row_hash.h"

namespace mobil::inline v0_3 {

/// Messages in transit.
struct LocalRanks::Post {
  struct Letter {
    std::vector<std::byte> bytes;
    std::uint64_t looks = 0;  // remaining `take` calls before it arrives
  };

  std::mutex mutex;
  std::map<std::tuple<int, int, Channel>, std::deque<Letter>> box;  // by sender, receiver, channel
  std::uint64_t seed = 0, sent = 0;
  std::string stopped;  // message of `stop`; empty before
};

class LocalRanks::End : public Transport {
 public:
  End(Post& post, int rank, int ranks) : post_(post), rank_(rank), ranks_(ranks) {}

  int rank() const override { return rank_; }
  int ranks() const override { return ranks_; }

  void send(int to, Channel channel, std::span<const std::byte> bytes) override {
    const std::lock_guard lock(post_.mutex);
    check();
    constexpr std::uint64_t max_looks = 50;
    const std::uint64_t looks = post_.seed == 0 ? 0 : mix64(post_.seed ^ mix64(++post_.sent)) % max_looks;
    post_.box[{rank_, to, channel}].push_back({{bytes.begin(), bytes.end()}, looks});
  }

  bool take(int from, Channel channel, std::vector<std::byte>& bytes) override {
    const std::lock_guard lock(post_.mutex);
    check();
    auto& box = post_.box[{from, rank_, channel}];
    if (box.empty()) return false;
    if (box.front().looks > 0) {
      --box.front().looks;
      return false;
    }
    bytes = std::move(box.front().bytes);
    box.pop_front();
    return true;
  }

  [[noreturn]] void stop(const std::string& line) override {
    const std::lock_guard lock(post_.mutex);
    if (post_.stopped.empty()) post_.stopped = line;
    throw RanksStopped(post_.stopped);
  }

 private:
  void check() const {
    if (!post_.stopped.empty()) throw RanksStopped(post_.stopped);
  }

  Post& post_;
  int rank_, ranks_;
};

LocalRanks::LocalRanks(int ranks, std::uint64_t delay_seed) : post_(std::make_unique<Post>()) {
  post_->seed = delay_seed;
  for (int rank = 0; rank < ranks; ++rank) ends_.push_back(std::make_unique<End>(*post_, rank, ranks));
}

LocalRanks::~LocalRanks() = default;

Transport& LocalRanks::operator[](int rank) {
  return *ends_.at(static_cast<std::size_t>(rank));
}

}  // namespace mobil::inline v0_3
