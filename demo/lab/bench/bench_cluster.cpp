// Costs of ranks: messages, ticks with and without exchange, and a model of more ranks after LogGP (Alexandrov,
// Ionescu, Schauser, Scheiman 1995).

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include <mobil/cluster.h>
#include <mobil/local_transport.h>
#include <mobil/mpi_transport.h>
#include <mobil/people_shard.h>
#include "demo/lab/bench/bench.h"
#include "demo/scene/crowd_people.h"

namespace mobil {
namespace {

/// Times in s, of messages between two ranks and of the work of a tick.
struct ClusterModel {
  // Latency is not a parameter: the first rank is ahead, so no rank waits for a single message.
  double overhead = 0;  // o: time of a rank to send a message
  double per_byte = 0;  // G: additional time for each byte of a long one
  double person = 0;    // of one awake walker, a tick
  double command = 0;   // of the first rank's host, for one command
  // As for people in `mobil crowd`: requests of a person per tick, and bytes of a command.
  double commands_a_person = 0, bytes_a_command = 0;
};

/// Time of a tick of a crowd on several ranks, s. People are spread at random, so the fullest rank has about √(2
/// ln ranks · people / ranks) more than the mean. With fewer cores than ranks, the ranks take turns.
struct ClusterTick {
  double work = 0;    // of the fullest rank
  double serial = 0;  // of the first rank, while all others wait: commands, and sending them down the tree
  double all() const { return work + serial; }
};

ClusterTick predict(const ClusterModel& model, double people, int ranks, int cores) {
  const double turns = std::max(1.0, static_cast<double>(ranks) / cores), mean = people / ranks;
  const double fullest = mean + (ranks > 1 ? std::sqrt(2 * std::log(static_cast<double>(ranks)) * mean) : 0);
  const double commands = model.commands_a_person * people;
  const double children = ranks > 1 ? std::ceil(std::log2(static_cast<double>(ranks))) : 0;
  return {model.person * fullest * turns,
          model.command * commands + children * (model.overhead + model.per_byte * model.bytes_a_command * commands)};
}

/// Returns the maximum number of people whose tick takes no longer than `within_s`.
double people_within(const ClusterModel& model, double within_s, int ranks, int cores) {
  double low = 0, high = 1e12;
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2;
    (predict(model, middle, ranks, cores).all() <= within_s ? low : high) = middle;
  }
  return low;
}

constexpr double cluster_tick_s = 1.0 / 60;
constexpr std::uint32_t shards_a_rank = 4, seed_of_bench = 1;
constexpr int ticks_a_round = 60, usual_rounds = 7;

/// Measurements of one rank. Those of other ranks are shared.
struct ClusterTimes {
  std::vector<std::pair<std::size_t, double>> ping_s;  // by bytes, one way
  double send_s = 0, share_s = 0, sum_s = 0, command_s = 0;
  std::vector<double> alone_s, independent_s, together_s;  // a tick, by round
};

double time_of(int times, const std::function<void()>& work) {
  std::vector<double> all;
  for (int repeat = 0; repeat < 5; ++repeat) {
    const double start = wall_now_s();
    for (int i = 0; i < times; ++i) work();
    all.push_back((wall_now_s() - start) / times);
  }
  return median(all);
}

void time_messages(Ranks& ranks, ClusterTimes& times) {
  for (const std::size_t bytes : {8UL, 1024UL, 16384UL, 131072UL, 1048576UL}) {
    const std::vector<std::byte> message(bytes);
    const int repeats = bytes > 100'000 ? 50 : 500;
    if (ranks.count() > 1 && ranks.rank() < 2) {
      const int other = 1 - ranks.rank();
      const double round_trip_s = time_of(repeats, [&] {
        if (ranks.first()) ranks.send(other, message);
        (void)ranks.receive(other);
        if (!ranks.first()) ranks.send(other, message);
      });
      times.ping_s.emplace_back(bytes, round_trip_s / 2);
    }
    ranks.sum(std::uint64_t{0});
  }
  const std::vector<std::byte> commands(16384), few(64);
  times.share_s = time_of(200, [&] { (void)ranks.share(commands); });
  times.sum_s = time_of(200, [&] { ranks.sum(std::uint64_t{1}); });
  if (ranks.count() > 1 && ranks.rank() < 2) {
    times.send_s = time_of(200, [&] {
      if (ranks.first()) ranks.send(1, few);
    });
    if (!ranks.first())
      for (int i = 0; i < 5 * 200; ++i) (void)ranks.receive(0);
  }
  ranks.sum(std::uint64_t{0});
}

/// Returns requests as often as in `mobil crowd`: one for each person every 15 s.
std::vector<std::byte> draw_commands(std::size_t people, std::uint32_t tick) {
  std::vector<PersonCommand> all;
  CrowdRandom random(seed_of_bench, tick, 0);
  for (std::size_t i = 0; i < people / 900 + 1; ++i) {
    const auto number = static_cast<std::uint64_t>(random.below(people));
    all.push_back(i % 3 == 2 ? walk(number, crowd_speed(random)) : turn(number, random.even(-3, 3)));
  }
  const auto raw = std::as_bytes(std::span(all));
  return {raw.begin(), raw.end()};
}

std::vector<std::byte> everybody(std::size_t people) {
  std::vector<PersonCommand> all;
  const auto side_m = static_cast<float>(std::sqrt(2.5 * static_cast<double>(people)));
  for (std::uint64_t number = 0; number < people; ++number) {
    const CrowdPerson person = crowd_person(seed_of_bench, number, 0);
    const CrowdPlace at = crowd_place(seed_of_bench, number);
    all.push_back(
        come(number, person.body, *person.gait.speed_m_s, at.across * side_m, at.along * side_m, at.heading_rad));
  }
  const auto raw = std::as_bytes(std::span(all));
  return {raw.begin(), raw.end()};
}

/// Times one rank's work, or that of two at once, as independent processes would do it, then the same people with all
/// exchange of ranks. The rounds are interleaved, because other processes use the machine.
Result<void> time_ticks(Ranks& ranks, std::size_t people, int rounds, ClusterTimes& times) {
  const auto count = static_cast<std::uint32_t>(ranks.count());
  const PeopleShardOptions options{.shards = shards_a_rank * count};
  auto cluster = Cluster::begin(ranks, {.shards = options.shards}, [&](std::uint32_t shard) {
    return Result<std::unique_ptr<Shard>>(std::make_unique<PeopleShard>(shard, options));
  });
  if (!cluster) return tl::unexpected(cluster.error());
  cluster->tick(ranks.first() ? everybody(people) : std::vector<std::byte>{});
  const auto own = [&](std::uint32_t tick) {
    const auto commands = draw_commands(people, tick);
    for (std::uint32_t s = 0; s < options.shards; ++s) {
      Shard* const shard = cluster->shard(s);
      if (shard == nullptr) continue;
      (void)shard->apply(commands);
      shard->tick();
    }
  };
  // The shards run ahead of the cluster's count here. Their results do not depend on it.
  std::uint32_t tick = 1;
  const auto round_of = [&](const std::function<void()>& work) {
    ranks.sum(std::uint64_t{0});
    const double start = wall_now_s();
    for (int i = 0; i < ticks_a_round; ++i, ++tick) work();
    ranks.sum(std::uint64_t{0});
    return (wall_now_s() - start) / ticks_a_round;
  };
  for (int round = 0; round < rounds; ++round) {
    times.alone_s.push_back(round_of([&] {
      if (ranks.first()) own(tick);
    }));
    times.independent_s.push_back(round_of([&] { own(tick); }));
    times.together_s.push_back(
        round_of([&] { cluster->tick(ranks.first() ? draw_commands(people, tick) : std::vector<std::byte>{}); }));
  }
  const double start = wall_now_s();
  for (std::uint32_t i = 0; i < 200; ++i) (void)draw_commands(people, i);
  times.command_s = (wall_now_s() - start) / 200 / static_cast<double>(people / 900 + 1);
  return {};
}

void tell(BenchRun& run, const ClusterTimes& times, std::size_t people, int ranks, bool mpi) {
  const std::string between = mpi ? "between processes, by MPI" : "between threads; mpirun -n 2 measures processes";
  const auto add = [&](std::string name, double seconds, double unit_s, const char* unit, std::string bound) {
    run.add_figure(std::move(name), seconds / unit_s, unit, std::move(bound));
  };
  ClusterModel model;
  for (const auto& [bytes, seconds] : times.ping_s)
    add(fmt::format("cluster.ping.{}.us", bytes), seconds, 1e-6, "us", between);
  if (ranks > 1) {
    const auto& [long_bytes, long_s] = times.ping_s.back();
    model.overhead = times.send_s;
    model.per_byte = (long_s - times.ping_s.front().second) / static_cast<double>(long_bytes);
    add("cluster.share.16384.us", times.share_s, 1e-6, "us", fmt::format("to all of {} ranks", ranks));
    add("cluster.sum.us", times.sum_s, 1e-6, "us", "of all ranks, and back");
    add("cluster.send.us", times.send_s, 1e-6, "us", "o: what sending costs the sender");
    add("cluster.byte.ns", model.per_byte, 1e-9, "ns", "G");
  }
  const double alone_s = median(times.alone_s), independent_s = median(times.independent_s),
               together_s = median(times.together_s);
  model.person = alone_s * ranks / static_cast<double>(people);
  model.command = times.command_s;
  model.commands_a_person = 1.0 / 900;
  model.bytes_a_command = sizeof(PersonCommand);
  std::vector<double> kept;
  for (std::size_t i = 0; i < times.together_s.size(); ++i)
    kept.push_back(times.independent_s[i] / times.together_s[i]);
  add("cluster.person.us", model.person, 1e-6, "us",
      fmt::format("a walker's tick; {} people a rank, one rank at work", people / static_cast<std::size_t>(ranks)));
  add("cluster.command.us", model.command, 1e-6, "us", "drawn by the first rank");
  add("cluster.tick.alone.ms", alone_s, 1e-3, "ms", "one rank works, the others wait");
  add("cluster.tick.independent.ms", independent_s, 1e-3, "ms", "all work and exchange nothing");
  add("cluster.tick.together.ms", together_s, 1e-3, "ms", "all work, with commands and meetings");
  add("cluster.kept", median(kept), 1, "1", "independent over together, median of interleaved rounds");
  const int cores = static_cast<int>(run.machine.cores);
  const ClusterTick here = predict(model, static_cast<double>(people), ranks, cores);
  run.notes.push_back(
      fmt::format("model, {} people on {} ranks and {} cores: {:.2f} ms predicted ({:.2f} work, {:.3f} the first "
                  "rank's own), {:.2f} "
                  "measured",
                  people, ranks, cores, 1e3 * here.all(), 1e3 * here.work, 1e3 * here.serial, 1e3 * together_s));
  for (const int more : {64, 1000}) {
    const double most = people_within(model, cluster_tick_s, more, more);
    const ClusterTick tick = predict(model, most, more, more);
    run.notes.push_back(
        fmt::format("model, {} ranks with a core each: {:.3g} walkers awake at 60 Hz; work {:.1f} ms, the first rank's "
                    "own {:.1f} ms",
                    more, most, 1e3 * tick.work, 1e3 * tick.serial));
  }
}

Result<void> measure_rank(Ranks& ranks, std::size_t people, int rounds, ClusterTimes& times) {
  time_messages(ranks, times);
  return time_ticks(ranks, people, rounds, times);
}

}  // namespace

void bench_cluster(BenchRun& run) {
  const int rounds = run.rounds(usual_rounds);
  ClusterTimes times;
  if (started_as_rank()) {
    auto transport = must(mpi_transport());
    Ranks ranks(*transport);
    const std::size_t people = run.people * static_cast<std::size_t>(ranks.count());
    must(ranks.agree(measure_rank(ranks, people, rounds, times)));
    if (ranks.first()) tell(run, times, people, ranks.count(), true);
    return;
  }
  constexpr int threads = 2;
  LocalRanks local(threads);
  const std::size_t people = run.people * threads;
  Result<void> own, others;
  std::thread other([&] {
    ClusterTimes unused;
    Ranks ranks(local[1]);
    others = measure_rank(ranks, people, rounds, unused);
  });
  {
    Ranks ranks(local[0]);
    own = measure_rank(ranks, people, rounds, times);
  }
  other.join();
  must(own);
  tell(run, times, people, threads, false);
  must(others);
}

}  // namespace mobil
