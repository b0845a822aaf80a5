// A city on several ranks (mpirun -n 4 city) or on one (city). The first rank decides on arrivals, turns and
// departures; each rank simulates its own shards. The city is saved halfway, and a second run resumes there, as after a
// crash. Both runs end in the same state.
//
// Prints ranks, shards and the state hash of both runs, and exits with 1 if the hashes differ, with 2 on an error.

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <mobil/cluster.h>
#include <mobil/local_transport.h>
#include <mobil/mpi_transport.h>
#include <mobil/people_shard.h>

namespace {

constexpr std::uint32_t shards = 8, ticks = 240;
constexpr std::uint64_t people = 400;

/// Returns the commands of a tick for all shards, as bytes.
std::vector<std::byte> commands(std::uint32_t tick) {
  std::vector<mobil::PersonCommand> all;
  if (tick == 0) {
    for (std::uint64_t number = 0; number < people; ++number) {
      mobil::BodyRequest body;
      body.height_m = 1.6F + 0.001F * static_cast<float>(number % 300);
      body.mass_kg = 23 * body.height_m * body.height_m;
      const auto row = static_cast<float>(number / 20), column = static_cast<float>(number % 20);
      all.push_back(mobil::come(number, body, 1.3F, 2 * column, 2 * row, 0));
    }
  }
  if (tick % 6 == 5) all.push_back(mobil::turn(tick % people, 0.01F * static_cast<float>(tick)));
  if (tick % 50 == 49) all.push_back(mobil::go(7 * tick % people));
  const auto raw = std::as_bytes(std::span(all));
  return {raw.begin(), raw.end()};
}

/// Runs a new or resumed city to the last tick and returns its state hash. `folder`: folder of the snapshots.
mobil::Result<std::uint64_t> live(mobil::Ranks& ranks, const std::filesystem::path& folder, bool resume) {
  mobil::ClusterOptions options;
  options.shards = shards;
  options.folder = folder;
  options.save_every = ticks / 2;
  options.resume = resume;
  options.about = "the example city";
  mobil::PeopleShardOptions people_options;
  people_options.shards = shards;
  auto cluster =
      mobil::Cluster::begin(ranks, options, [&](std::uint32_t shard) -> mobil::Result<std::unique_ptr<mobil::Shard>> {
        return std::make_unique<mobil::PeopleShard>(shard, people_options);
      });
  if (!cluster) return tl::unexpected(cluster.error());
  while (cluster->ticks() < ticks - 1)
    cluster->tick(ranks.first() ? commands(cluster->ticks()) : std::vector<std::byte>{});
  return cluster->state_hash();
}

}  // namespace

int main() {
  mobil::LocalRanks alone;
  std::unique_ptr<mobil::Transport> by_mpi;
  if (mobil::started_as_rank()) {
    auto made = mobil::mpi_transport();
    if (!made) return std::fprintf(stderr, "%s\n", made.error().message.c_str()), 2;
    by_mpi = std::move(*made);
  }
  mobil::Ranks ranks(by_mpi ? *by_mpi : alone[0]);
  // All ranks need access to the folder. This one is local to the machine and named after the first rank's process.
  const auto process = ranks.sum(ranks.first() ? static_cast<std::uint64_t>(getpid()) : 0);
  const auto folder = std::filesystem::temp_directory_path() / ("mobil_city_" + std::to_string(process));
  const auto first = live(ranks, folder, false);
  const auto again = first ? live(ranks, folder, true) : first;
  if (!again) {
    if (ranks.first()) std::fprintf(stderr, "%s\n", again.error().message.c_str());
    return 2;
  }
  if (ranks.first()) {
    std::filesystem::remove_all(folder);
    std::printf("%d rank(s), %u shards: state hash %016llx, and %016llx if resumed halfway\n", ranks.count(), shards,
                static_cast<unsigned long long>(*first), static_cast<unsigned long long>(*again));
  }
  return *first == *again ? 0 : 1;
}
