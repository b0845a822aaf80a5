#pragma once
// Ranks in one process, each used by a thread of its own: for tests, and for shards without MPI.

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <vector>

#include <mobil/systems/cluster/transport.h>

namespace mobil::inline v0_3 {

/// Thrown by `stop`, and by what other ranks do with their transports afterwards.
struct RanksStopped : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The ranks of one process, each with its end of the transport.
class LocalRanks {
 public:
  /// With a `delay_seed` other than 0 messages arrive late, by numbers of looks that are drawn from it.
  explicit LocalRanks(int ranks = 1, std::uint64_t delay_seed = 0);
  ~LocalRanks();
  LocalRanks(const LocalRanks&) = delete;
  LocalRanks& operator=(const LocalRanks&) = delete;

  Transport& operator[](int rank);

 private:
  struct Post;
  class End;
  std::unique_ptr<Post> post_;
  std::vector<std::unique_ptr<End>> ends_;
};

}  // namespace mobil::inline v0_3
