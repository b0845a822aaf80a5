#pragma once
// Ranks as threads of a test.

#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <mobil/local_transport.h>
#include <mobil/systems/cluster/ranks.h>

namespace mobil {

/// Runs `work` on each of `ranks` ranks. Returns the reason it was stopped, or an empty string.
inline std::string on_ranks(int ranks, const std::function<void(Ranks&)>& work, std::uint64_t delay_seed = 0,
                            double silence_s = 60) {
  LocalRanks local(ranks, delay_seed);
  std::vector<std::thread> threads;
  std::vector<std::string> stopped(static_cast<std::size_t>(ranks));
  for (int r = 0; r < ranks; ++r) {
    threads.emplace_back([&, r] {
      try {
        Ranks own(local[r], silence_s);
        work(own);
      } catch (const RanksStopped& why) {
        stopped[static_cast<std::size_t>(r)] = why.what();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::string& line : stopped)
    if (!line.empty()) return line;
  return {};
}

}  // namespace mobil
