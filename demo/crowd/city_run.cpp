// `mobil city`, and `mobil crowd` on several ranks or in several shards.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <mobil/muscle_library.h>
#include <mobil/png.h>
#include <mobil/schedule.h>
#include <mobil/shard_bytes.h>
#include <mobil/step_report.h>
#include <mobil/systems/cluster/ranks.h>
#include <mobil/systems/render/camera.h>
#include "demo/bake/baked_file.h"
#include "demo/crowd/city_shard.h"
#include "demo/measure/measure.h"
#include "demo/program/commands.h"
#include "demo/program/console.h"
#include "demo/program/progress.h"

namespace mobil {
namespace {

/// Draws a picture of the people of all ranks. Each rank sends poses and bodies of its visible people and, for the
/// nearest, bones and muscles. The first rank, the only one with `pictures`, draws and writes the file. The picture is
/// the same for any number of ranks. Errors stop all ranks.
void take_picture(Ranks& ranks, Cluster& cluster, const Camera& camera, std::optional<CrowdCamera>& pictures,
                  const std::filesystem::path& file) {
  ranks.between_ticks();
  std::vector<PicturedPerson> seen;
  std::map<std::uint64_t, std::pair<const Simulation*, Entity>> where;
  each_shard(cluster, [&](CityShard& shard) {
    const auto people = shard.people();
    for (const auto& person : people) where.emplace(person.number, std::pair{&shard.simulation(), person.entity});
    const auto own = CrowdCamera::see(shard.simulation(), camera, people);
    seen.insert(seen.end(), own.begin(), own.end());
  });
  const auto all_seen = ranks.gather(std::as_bytes(std::span(seen)));
  seen.clear();
  for (const auto& bytes : all_seen) {
    const auto some = PlainReader(bytes).take_many<PicturedPerson>(bytes.size() / sizeof(PicturedPerson));
    seen.insert(seen.end(), some.begin(), some.end());
  }
  arrange(seen);
  PlainBytes chosen;
  for (std::size_t i = 0; i < std::min(seen.size(), max_legs) && seen[i].near != 0; ++i) chosen.put(seen[i].number);
  const auto numbers = ranks.share(chosen.bytes());
  PlainBytes own_legs;
  CrowdLegs makes;
  for (const std::uint64_t number :
       PlainReader(numbers).take_many<std::uint64_t>(numbers.size() / sizeof(std::uint64_t))) {
    const auto found = where.find(number);
    if (found == where.end()) continue;
    const auto legs = makes.of(*found->second.first, found->second.second, number);
    if (!legs) ranks.stop("mobil city: --capture: " + legs.error().message);
    ranks.alive();
    const auto packed = pack_legs(**legs);
    own_legs.put(number);
    own_legs.put(std::uint64_t{packed.size()});
    own_legs.put_all(std::span<const std::byte>(packed));
  }
  std::map<std::uint64_t, WalkRecording> legs;
  for (const auto& bytes : ranks.gather(own_legs.bytes())) {
    for (PlainReader reader(bytes); !reader.whole();) {
      std::uint64_t number = 0, size = 0;
      reader.take(number);
      reader.take(size);
      auto one = unpack_legs(reader.take_many<std::byte>(static_cast<std::size_t>(size)));
      if (!one) ranks.stop("mobil city: --capture: " + one.error().message);
      legs.emplace(number, std::move(*one));
    }
  }
  if (!ranks.first()) return;
  CrowdCamera::Legs drawn;
  for (const auto& [number, recording] : legs) drawn.emplace(number, &recording);
  Image image;
  auto done = pictures->draw(camera, seen, drawn, image);
  if (done) done = write_png(file.string(), image, PngEffort::small);
  if (!done) ranks.stop("mobil city: --capture: " + done.error().message);
  show("");
  say_written(file);
}

constexpr std::uint32_t city_hash_every = 60;  // ticks
constexpr double city_live_every_s = 0.25;
/// Number of pictures of a city, spread over the ticks of a run, each in a numbered file.
constexpr std::uint32_t city_pictures = 3;

std::filesystem::path numbered(const std::filesystem::path& file, std::uint32_t number) {
  return file.parent_path() / fmt::format("{}_{}{}", file.stem().string(), number, file.extension().string());
}

/// State of the first rank's host, apart from the shards.
struct Host {
  CrowdDirector director;
  std::uint32_t first_tick = unknown, spare = 0;  // the first that is measured

  static constexpr std::uint32_t unknown = std::numeric_limits<std::uint32_t>::max();
};

std::vector<std::byte> orders_of(const CrowdOptions& options, std::uint32_t tick, double tick_s, Host& host) {
  PlainBytes bytes;
  if (options.alive) {
    bytes.put(fly(*options.alive, tick, tick_s));
  } else if (const auto orders = host.director.order(options.crowd, tick, tick_s); orders.count > 0) {
    bytes.put(orders);
  }
  return bytes.bytes();
}

void measure(const CrowdOptions& options, Ranks& ranks, Cluster& cluster, const CityCounts& counts, Host& host,
             CityRun& run, CityPart& own) {
  const auto ticks = static_cast<std::uint32_t>(std::max(1L, std::lround(options.seconds / run.tick_s)));
  own.ticks.reserve(ticks);
  double live_s = wall_now_s();
  std::optional<CrowdCamera> pictures;
  if (!options.capture.empty() && ranks.first()) {
    auto made = CrowdCamera::create();
    if (!made) ranks.stop("mobil city: --capture: " + made.error().message);
    pictures = std::move(*made);
  }
  while (cluster.ticks() < run.first_tick + ticks) {
    const CityCounts counted = counts;
    const ClusterReport before = cluster.report();
    const double cpu_s = process_cpu_now_s(), start_s = wall_now_s();
    cluster.tick(ranks.first() ? orders_of(options, cluster.ticks(), run.tick_s, host) : std::vector<std::byte>{});
    const ClusterReport after = cluster.report();
    run.wall_s += wall_now_s() - start_s - (after.saving_s - before.saving_s);
    CrowdTick& tick = own.ticks.emplace_back();
    tick.wall_ms = 1e3 * (after.worked_s - before.worked_s);
    // Processor time of saving is not measured separately, so a tick with a snapshot uses wall-clock time.
    tick.cpu_ms = after.snapshots == before.snapshots ? 1e3 * (process_cpu_now_s() - cpu_s) : tick.wall_ms;
    tick.host_ms = 1e3 * (counts.host_s - counted.host_s);
    tick.lod_ms = 1e3 * (counts.lod_s - counted.lod_s);
    if ((cluster.ticks() - run.first_tick) % city_hash_every == 0 || cluster.ticks() == run.first_tick + ticks)
      run.hashes.push_back(cluster.state_hash());
    const std::uint32_t since = cluster.ticks() - run.first_tick;
    for (std::uint32_t i = 0; options.alive && !options.capture.empty() && i < city_pictures; ++i) {
      if (since != (2 * i + 1) * ticks / (2 * city_pictures)) continue;
      const Viewpoint camera = fly(*options.alive, cluster.ticks() - 1, run.tick_s);
      take_picture(ranks, cluster, picture_from(camera), pictures, numbered(options.capture, i + 1));
    }
    if (!ranks.first() || wall_now_s() < live_s) continue;
    show(fmt::format("tick {}/{}  p50 {:.2f} ms  p99 {:.2f} ms  (first of {} ranks)", cluster.ticks() - run.first_tick,
                     ticks, percentile_ms(own.ticks, 0.5), percentile_ms(own.ticks, 0.99), ranks.count()));
    live_s = wall_now_s() + city_live_every_s;
  }
  show("");
  if (run.hashes.empty()) run.hashes.push_back(cluster.state_hash());  // a resumed run that was already complete
  run.last_tick = cluster.ticks();
  if (!options.alive && !options.capture.empty())
    take_picture(ranks, cluster, crowd_camera(run.side_m), pictures, options.capture);
}

/// Adds the state and system times of this rank's shards.
void add_state(Cluster& cluster, CityRun& run, CityPart& own) {
  const auto ticks = static_cast<double>(std::max<std::size_t>(own.ticks.size(), 1));
  each_shard(cluster, [&](CityShard& shard) {
    add(own.state, shard.state());
    const Schedule& schedule = std::as_const(shard.simulation()).schedule();
    own.system_ms.resize(schedule.systems().size());
    if (run.systems.empty())
      for (const auto& system : schedule.systems()) run.systems.push_back({system.name, 0});
    for (std::size_t s = 0; s < schedule.systems().size(); ++s)
      own.system_ms[s] += 1e3 * schedule.timings()[s].seconds / ticks;
  });
}

/// Computes or loads meshes and bases on the first rank and sends them to the others, which would compute the same.
Result<void> prepare(const CrowdOptions& options, Ranks& ranks, Simulation& library, const Cluster::Make& make) {
  Result<void> own;
  if (ranks.first()) {
    show("preparing");
    own = load_baked_option(library, options.alive ? options.alive->baked : options.crowd.baked);
    if (own && ranks.count() > 1) {
      const auto shard = make(0);  // fills the library
      if (!shard) own = tl::unexpected(shard.error());
    }
  }
  if (auto done = ranks.agree(own); !done || ranks.count() == 1) return done;
  const auto baked = ranks.share(ranks.first() ? library.muscle_library().bake() : std::vector<std::byte>{});
  if (!ranks.first()) own = library.muscle_library().load(baked);
  if (!own)
    own =
        fail(fmt::format("rank {} cannot use the data that the first rank prepared ({}); run on processors of one kind",
                         ranks.rank(), own.error().message));
  return ranks.agree(own);
}

}  // namespace

Result<void> run_city(const CrowdOptions& asked, Ranks& ranks) {
  CrowdOptions options = asked;
  if (options.cluster.shards == 0) {  // as many as in the run that is resumed
    const auto saved = ranks.first() ? whole_snapshots(options.cluster.folder) : Result<std::vector<SavedRun>>{};
    auto found = ranks.agree(saved ? Result<void>() : tl::unexpected(saved.error()));
    if (!found) return found;
    options.cluster.shards = static_cast<std::uint32_t>(ranks.most(ranks.first() ? saved->front().shards : 0));
  }
  Simulation library;  // without people; owns the data shared by this rank's shards, including ones that move here
  CityCounts counts;
  const Cluster::Make make = city_shards(options, library, counts);
  if (auto done = prepare(options, ranks, library, make); !done) return done;
  Host host;
  host.director.next_number = options.crowd.people;
  ClusterOptions cluster_options = options.cluster;
  cluster_options.host = [&] {
    PlainBytes bytes;
    bytes.put(host);
    return bytes.bytes();
  };
  if (ranks.first()) show("making shards");
  auto cluster = Cluster::begin(ranks, cluster_options, make);
  if (ranks.first()) show("");
  if (!cluster) return tl::unexpected(cluster.error());
  if (options.cluster.resume && ranks.first()) {
    PlainReader reader(cluster->restored_host());
    reader.take(host);
    if (!reader.whole()) ranks.stop("mobil city: the snapshot is of another version");
  }
  if (host.first_tick == Host::unknown) host.first_tick = cluster->ticks();

  CityRun run;
  CityPart own;
  run.tick_s = library.tick_s();
  run.first_tick = static_cast<std::uint32_t>(ranks.sum(std::uint64_t{ranks.first() ? host.first_tick : 0}));
  run.side_m = options.alive ? side_of(*options.alive) : crowd_side_m(options.crowd.people);
  each_shard(*cluster, [](CityShard& shard) { shard.simulation().schedule().reset_timings(); });
  const ClusterReport begun = cluster->report();
  counts = {};
  measure(options, ranks, *cluster, counts, host, run, own);
  own.counts = counts;
  own.report = cluster->report();
  own.report.waited_s -= begun.waited_s;
  own.report.bytes_sent -= begun.bytes_sent;
  own.peak_bytes = peak_bytes();
  add_state(*cluster, run, own);
  for (const auto& bytes : ranks.gather(pack(own))) {
    auto part = unpack_part(bytes);
    if (!part) ranks.stop("mobil city: " + part.error().message);
    run.parts.push_back(std::move(*part));
  }
  Result<void> written;
  if (ranks.first()) {
    put_together(run);
    write_output(city_text(run, options));
    if (!options.report.empty()) written = write_result("--report", options.report, city_json(run, options));
  }
  return ranks.agree(written);
}

}  // namespace mobil
