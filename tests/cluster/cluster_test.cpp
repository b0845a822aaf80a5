#include <mobil/cluster.h>

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <mobil/anthropometry.h>
#include <mobil/people_shard.h>
#include "engine/row_hash.h"
#include "tests/cluster/local_run.h"

namespace mobil {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t shards = 8;

class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "mobil_cluster_XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~Folder() { fs::remove_all(path_); }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// Returns the commands of the first rank's host: spawns, removals, turns and changes of gait, drawn from the tick.
std::vector<std::byte> commands_of(std::uint32_t tick, std::uint64_t people, bool camera) {
  std::vector<PersonCommand> all;
  const auto draw = [&](std::uint64_t stream) { return mix64(mix64(tick) ^ stream); };
  const auto part = [&](std::uint64_t stream) { return static_cast<float>(draw(stream) % 10000) * 1e-4F; };
  if (tick == 0) {
    for (std::uint64_t n = 0; n < people; ++n) {
      const auto own = [&](std::uint64_t what) { return static_cast<float>(mix64(n ^ what << 32) % 1000) * 1e-3F; };
      BodyRequest body{.height_m = 1.70F + 0.1F * own(1), .mass_kg = 66 + 12 * own(2)};
      body.sex = n % 2 == 0 ? Sex::man : Sex::woman;
      body.age_y = 20 + 60 * own(7);
      all.push_back(come(n, body, 1.1F + 0.5F * own(3), 60 * own(4) - 30, 60 * own(5) - 30, 6 * own(6) - 3));
    }
  }
  all.push_back(turn(draw(1) % people, 6 * part(2) - 3));
  all.push_back(walk(draw(3) % people, tick % 5 == 0 ? 0 : 1 + 0.6F * part(4)));
  if (tick % 3 == 0) all.push_back(go(draw(5) % people));
  if (tick % 3 == 1) all.push_back(come(draw(6) % (2 * people), {}, 1.3F, 20 * part(7), 20 * part(8), 0));
  if (tick % 7 == 0) all.push_back(place(draw(9) % people, 10 * part(10), 10 * part(11), part(12)));
  if (camera && tick % 10 == 0) {
    Viewpoint view{.position_m = {20 * part(13) - 10, 1.7F, 20 * part(14) - 10}, .reach_m = 12};
    view.forward = {std::sin(6 * part(15)), 0, std::cos(6 * part(15))};
    all.push_back(look(view, 2, 6));
  }
  all.push_back(turn(1'000'000 + tick, 0));  // of a person who does not exist: refused
  const auto raw = std::as_bytes(std::span(all));
  return {raw.begin(), raw.end()};
}

struct Asked {
  int ranks = 1;
  std::uint32_t ticks = 60, balance_every = 0, shards_of_crowd = shards;
  std::uint64_t people = 120, delay_seed = 0;
  bool muscles = false, resume = false;
  fs::path folder{};
  std::uint32_t save_every = 0;
  std::uint32_t logged_until = 0;
  std::optional<std::uint32_t> die_at{};  // the last rank stops the run there
  bool host_knows_replayed = true;        // false: the host gives no commands for ticks replayed from the log
};

struct Came {
  std::uint64_t hash = 0, people = 0, refused = 0, asleep = 0, with_muscles = 0;
  ClusterReport report;  // of the first rank
  std::string stopped;
};

Result<std::unique_ptr<Shard>> make_shard(const Asked& asked, std::uint32_t shard, const Simulation& library) {
  PeopleShardOptions options{.shards = asked.shards_of_crowd, .simulation = {.library_of = &library}};
  if (asked.muscles) {
    options.muscles = LegMuscles{};
    options.muscles->muscles = {};
    options.muscles->muscles.set(static_cast<std::size_t>(Muscle::hamstrings));
    options.muscles->method = Method::none;
    options.scene.muscles = options.muscles->muscles;
    options.scene.compact_unseen = true;
  }
  auto made = std::make_unique<PeopleShard>(shard, options);
  return made;
}

Came run(const Asked& asked) {
  Came came;
  std::atomic<std::uint64_t> people = 0, refused = 0, asleep = 0, with_muscles = 0;
  came.stopped = on_ranks(
      asked.ranks,
      [&](Ranks& ranks) {
        const Simulation library;      // empty: shared resources stay when shards move away
        std::unique_ptr<Shard> first;  // keeps the library alive, because shards can move away
        auto cluster = Cluster::begin(ranks,
                                      {.shards = asked.shards_of_crowd,
                                       .meet_every = 16,
                                       .balance_every = asked.balance_every,
                                       .folder = asked.folder,
                                       .save_every = asked.save_every,
                                       .resume = asked.resume,
                                       .about = "a test"},
                                      [&](std::uint32_t shard) { return make_shard(asked, shard, library); });
        if (!cluster) ranks.stop(cluster.error().message);
        while (cluster->ticks() < asked.ticks) {
          if (asked.die_at && ranks.rank() == asked.ranks - 1 && cluster->ticks() == *asked.die_at)
            ranks.stop("killed");
          const bool silent = !asked.host_knows_replayed && cluster->ticks() < asked.logged_until;
          cluster->tick(ranks.first() && !silent ? commands_of(cluster->ticks(), asked.people, asked.muscles)
                                                 : std::vector<std::byte>{});
        }
        const std::uint64_t hash = cluster->state_hash();
        for (std::uint32_t s = 0; s < asked.shards_of_crowd; ++s) {
          const auto* shard = static_cast<PeopleShard*>(cluster->shard(s));
          if (shard == nullptr) continue;
          people += shard->people().size();
          refused += shard->refused();
          for (const auto& [number, entity] : shard->people()) {
            asleep += (shard->simulation().state(entity) == PersonState::asleep) ? 1 : 0;
            with_muscles += shard->simulation().muscles(entity).empty() ? 0 : 1;
          }
        }
        if (ranks.first()) {
          came.hash = hash;
          came.report = cluster->report();
        }
      },
      asked.delay_seed);
  came.people = people;
  came.refused = refused;
  came.asleep = asleep;
  came.with_muscles = with_muscles;
  return came;
}

TEST(Cluster, AnyNumberOfRanksGivesTheSameBits) {
  const Came one = run({});
  EXPECT_EQ(one.stopped, "");
  EXPECT_GT(one.people, 100U);
  EXPECT_GE(one.refused, 60U) << "commands to nobody are counted";
  for (const int ranks : {2, 3, 7}) {
    const Came other = run({.ranks = ranks, .delay_seed = static_cast<std::uint64_t>(ranks)});
    EXPECT_EQ(other.stopped, "");
    EXPECT_EQ(other.hash, one.hash) << ranks << " ranks";
    EXPECT_EQ(other.people, one.people);
    EXPECT_EQ(other.refused, one.refused);
  }
}

TEST(Cluster, ManyShardsMatchOneSimulation) {
  const Came one = run({.shards_of_crowd = 1}), five = run({.ranks = 2, .shards_of_crowd = 5});
  EXPECT_EQ(one.stopped + five.stopped, "");
  EXPECT_EQ(one.hash, five.hash);
}

TEST(Cluster, RanksGiveTheSameBitsWithMusclesAndSleepers) {
  const Came one = run({.ticks = 90, .people = 60, .muscles = true});
  EXPECT_EQ(one.stopped, "");
  const Came three = run({.ranks = 3, .ticks = 90, .people = 60, .delay_seed = 5, .muscles = true});
  EXPECT_EQ(three.hash, one.hash);
  EXPECT_GT(one.asleep, 0U);
  EXPECT_GT(one.with_muscles, 0U);
}

TEST(Cluster, MovingShardsToIdleRanksKeepsTheBits) {
  const Came one = run({});
  const Came moved = run({.ranks = 3, .balance_every = 5});
  EXPECT_EQ(moved.stopped, "");
  EXPECT_EQ(moved.hash, one.hash);
  EXPECT_GT(moved.report.moved, 0U) << "8 shards on 3 ranks are uneven";
}

TEST(Cluster, RunResumesFromItsLastSnapshotOnAnyRanks) {
  const Came whole = run({});
  for (const bool muscles : {false, true}) {
    const Asked undisturbed{.muscles = muscles};
    const std::uint64_t hash = muscles ? run(undisturbed).hash : whole.hash;
    const Folder folder;
    Asked asked{.ranks = 2, .muscles = muscles, .folder = folder.path(), .save_every = 20, .die_at = 53};
    EXPECT_EQ(run(asked).stopped, "killed");
    asked.die_at.reset();
    asked.resume = true;
    for (const int ranks : {3, 1, 2}) {
      asked.ranks = ranks;
      asked.save_every = 0;
      const Came went_on = run(asked);
      EXPECT_EQ(went_on.stopped, "");
      EXPECT_EQ(went_on.hash, hash) << ranks << " ranks, " << (muscles ? "with" : "without") << " muscles";
      EXPECT_GE(went_on.report.replayed, 13U) << "commands of ticks 40 to 52 were logged";
    }
  }
}

/// The host does not repeat what was logged. Only the log can restore it.
TEST(Cluster, KilledWhileResumingLosesNothing) {
  const std::uint64_t hash = run({}).hash;
  const Folder folder;
  Asked asked{.ranks = 2, .folder = folder.path(), .save_every = 0, .die_at = 45};
  EXPECT_EQ(run(asked).stopped, "killed");
  asked.resume = true;
  asked.host_knows_replayed = false;
  asked.logged_until = 45;
  asked.save_every = 7;  // snapshots while logged commands are still being repeated
  for (const std::uint32_t die_at : {10U, 16U, 30U}) {
    asked.die_at = die_at;
    EXPECT_EQ(run(asked).stopped, "killed");
  }
  asked.die_at.reset();
  asked.ranks = 3;
  const Came went_on = run(asked);
  EXPECT_EQ(went_on.stopped, "");
  EXPECT_EQ(went_on.hash, hash);
}

TEST(Cluster, SnapshotAtOnceAfterResumingChangesNothing) {
  const Folder folder;
  Asked asked{.ticks = 20, .people = 20, .folder = folder.path(), .save_every = 0};
  const std::uint64_t hash = run(asked).hash;
  asked.resume = true;
  on_ranks(1, [&](Ranks& ranks) {
    const Simulation library;
    auto cluster = Cluster::begin(ranks, {.shards = shards, .folder = folder.path(), .resume = true, .about = "a test"},
                                  [&](std::uint32_t shard) { return make_shard(asked, shard, library); });
    ASSERT_TRUE(cluster);
    EXPECT_TRUE(cluster->save());
  });
  asked.host_knows_replayed = false;
  asked.logged_until = 20;
  EXPECT_EQ(run(asked).hash, hash);
}

TEST(Cluster, DamagedSnapshotFallsBackToTheOneBefore) {
  const std::uint64_t hash = run({}).hash;
  const Folder folder;
  Asked asked{.ranks = 2, .folder = folder.path(), .save_every = 20, .die_at = 53};
  EXPECT_EQ(run(asked).stopped, "killed");
  fs::resize_file(folder.path() / "tick_0000000040" / "shard_0001", 100);
  asked.die_at.reset();
  asked.resume = true;
  asked.host_knows_replayed = false;
  asked.logged_until = 53;
  const Came went_on = run(asked);
  EXPECT_EQ(went_on.stopped, "");
  EXPECT_EQ(went_on.hash, hash);
  EXPECT_GE(went_on.report.replayed, 33U) << "the logs of both snapshots";
}

TEST(Cluster, AlteredRecordIsRefused) {
  const Folder folder;
  Asked asked{.folder = folder.path(), .save_every = 0, .die_at = 30};
  EXPECT_EQ(run(asked).stopped, "killed");
  const fs::path log = folder.path() / "tick_0000000000" / "commands";
  const auto size = fs::file_size(log);
  {
    std::fstream altered(log, std::ios::in | std::ios::out | std::ios::binary);
    altered.seekp(static_cast<std::streamoff>(size / 2));
    altered.put('!');
  }
  asked.die_at.reset();
  asked.resume = true;
  EXPECT_NE(run(asked).stopped.find("was altered, or ticks are missing before it; `truncate"), std::string::npos);
  EXPECT_EQ(fs::file_size(log), size);
}

TEST(Cluster, ForeignFilesInTheFolderStay) {
  const Folder folder;
  EXPECT_EQ(run({.ticks = 50, .people = 10, .folder = folder.path(), .save_every = 10}).stopped, "");
  std::ofstream(folder.path() / "tick_0000000040" / "notes") << "of somebody else";
  Asked asked{.ticks = 100, .people = 10, .resume = true, .folder = folder.path(), .save_every = 10};
  EXPECT_EQ(run(asked).stopped, "");
  EXPECT_TRUE(fs::exists(folder.path() / "tick_0000000040" / "notes"));
  EXPECT_FALSE(fs::exists(folder.path() / "tick_0000000040" / "index"));
}

TEST(Cluster, TwoRunsCannotShareAFolder) {
  const Folder folder;
  const auto held = FolderLock::take(folder.path());
  ASSERT_TRUE(held);
  EXPECT_NE(run({.people = 10, .folder = folder.path()}).stopped.find("another run is writing there"),
            std::string::npos);
}

TEST(Cluster, UnfinishedWritesAreDropped) {
  const std::uint64_t hash = run({}).hash;
  const Folder folder;
  Asked asked{.ranks = 2, .folder = folder.path(), .save_every = 20, .die_at = 53};
  EXPECT_EQ(run(asked).stopped, "killed");
  const fs::path last = folder.path() / "tick_0000000040";
  const auto log = fs::file_size(last / "commands");
  fs::resize_file(last / "commands", log - 11);               // in the middle of a record
  fs::create_directories(folder.path() / "tick_0000000060");  // a snapshot without its index
  std::ofstream(folder.path() / "tick_0000000060" / "shard_0001") << "half a sh";
  asked.die_at.reset();
  asked.resume = true;
  EXPECT_EQ(run(asked).hash, hash);
}

TEST(Cluster, MismatchesAreRefusedInOneLine) {
  const Folder folder;
  Asked asked{.ranks = 2, .ticks = 20, .people = 30, .folder = folder.path(), .save_every = 10};
  EXPECT_EQ(run(asked).stopped, "");
  EXPECT_NE(run(asked).stopped.find("holds a run already; go on with that one"), std::string::npos);
  asked.resume = true;
  asked.shards_of_crowd = 9;
  EXPECT_NE(run(asked).stopped.find("has 8 shards, not 9; give as many"), std::string::npos);
  asked.shards_of_crowd = shards;
  const fs::path file = folder.path() / "tick_0000000020" / "shard_0003";
  {
    std::fstream altered(file, std::ios::in | std::ios::out | std::ios::binary);
    altered.seekp(300);
    altered.put('!');
  }
  fs::remove_all(folder.path() / "tick_0000000010");  // the only snapshot
  EXPECT_NE(run(asked).stopped.find("shard_0003: a message was altered"), std::string::npos);
  fs::remove(file);
  EXPECT_NE(run(asked).stopped.find("shard_0003: cannot be read"), std::string::npos);
  asked.folder = folder.path() / "nothing here";
  EXPECT_NE(run(asked).stopped.find("no snapshot is there; name the folder"), std::string::npos);
  EXPECT_NE(run({.ranks = 3, .shards_of_crowd = 2}).stopped.find("2 shards are too few for 3 ranks"),
            std::string::npos);
}

TEST(Cluster, OldSnapshotsAreRemoved) {
  const Folder folder;
  EXPECT_EQ(run({.ranks = 2, .ticks = 50, .people = 10, .folder = folder.path(), .save_every = 10}).stopped, "");
  std::size_t found = 0;
  for (const auto& entry : fs::directory_iterator(folder.path())) {
    if (entry.path().filename() == "lock") continue;
    EXPECT_TRUE(entry.path().filename() == "tick_0000000040" || entry.path().filename() == "tick_0000000050");
    ++found;
  }
  EXPECT_EQ(found, 2U);
}

TEST(PeopleShard, RefusesInvalidCommandsUnchanged) {
  PeopleShard shard(0, {.shards = 1});
  const float nan = std::nanf("");
  std::vector<PersonCommand> bad = {come(1, {.height_m = 9}, 1, 0, 0, 0),
                                    come(1, {}, nan, 0, 0, 0),
                                    come(1, {}, 1, nan, 0, 0),
                                    walk(1, 1),
                                    go(1),
                                    look({}, 1, 0)};
  bad.push_back(come(1, {}, 1.2F, 0, 0, 0));
  bad.back().value[5] = 77;  // not a constitution
  bad.push_back(go(1));
  bad.back().wish = static_cast<Wish>(99);
  const std::uint64_t before = shard.state_sum();
  ASSERT_TRUE(shard.apply(std::as_bytes(std::span(bad))));
  EXPECT_EQ(shard.refused(), bad.size());
  EXPECT_EQ(shard.state_sum(), before);
  EXPECT_FALSE(shard.apply(std::as_bytes(std::span(bad)).first(65))) << "no whole command";
  const std::vector twice = {come(2, {}, 1, 0, 0, 0), come(2, {}, 1, 0, 0, 0)};
  ASSERT_TRUE(shard.apply(std::as_bytes(std::span(twice))));
  EXPECT_EQ(shard.people().size(), 1U) << "a number is one person's";
}

TEST(PeopleShard, KeepsAges) {
  PeopleShard shard(0, {.shards = 1});
  std::vector commands = {come(1, typical_body(Sex::woman, 8.5F), 1, 0, 0, 0), come(2, {}, 1, 3, 0, 0),
                          come(3, {.age_y = 5}, 1, 6, 0, 0)};
  commands[1].value[11] = 0;  // as recorded before ages
  ASSERT_TRUE(shard.apply(std::as_bytes(std::span(commands))));
  EXPECT_EQ(shard.refused(), 1U);
  PeopleShard restored(0, {.shards = 1});
  ASSERT_TRUE(restored.restore(*shard.save()));
  for (const PeopleShard* one : {&shard, &restored}) {
    EXPECT_EQ(one->simulation().person(one->find(1))->body.request.age_y, 8.5F);
    EXPECT_EQ(one->simulation().person(one->find(2))->body.request.age_y, usual_age_y);
  }
}

}  // namespace
}  // namespace mobil
