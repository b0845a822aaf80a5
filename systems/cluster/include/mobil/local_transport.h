#pragma once
// Ranks in one process, one thread each, for tests and for shards without MPI.

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <vector>

#include <mobil/systems/cluster/transport.h>

namespace mobil::inline v0_3 {

/// Thrown by `stop`, and afterwards by calls of other ranks to their transports.
struct RanksStopped : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The ranks of one process, each with its own transport.
class LocalRanks {
 public:
  /// A `delay_seed` other than 0 delays each message by a random number of `take` calls.
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
