#include <mobil/cluster.h>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "engine/state_hash.h"
#include "systems/cluster/balance.h"

namespace mobil::inline v0_3 {
namespace {

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

Cluster::Cluster(Ranks& ranks, const ClusterOptions& options, Make make)
    : ranks_(&ranks), options_(options), make_(std::move(make)) {}

Result<Cluster> Cluster::begin(Ranks& ranks, const ClusterOptions& options, Make make) {
  if (options.meet_every == 0) return fail("cluster: ranks must meet; give a meet_every of 1 and more");
  if (options.shards < static_cast<std::uint32_t>(ranks.count())) {
    return fail(fmt::format("cluster: {} shards are too few for {} ranks; give at least one a rank", options.shards,
                            ranks.count()));
  }
  if (options.resume && options.folder.empty()) return fail("cluster: a run goes on from a folder; name it");
  Cluster cluster(ranks, options, std::move(make));
  Result<void> own;
  if (ranks.first() && !options.folder.empty()) {
    auto whole = options.resume ? whole_snapshots(options.folder) : std::vector<SavedRun>{};
    auto lock = whole ? FolderLock::take(options.folder) : tl::unexpected(whole.error());
    if (!lock) own = tl::unexpected(lock.error());
    if (lock) cluster.lock_ = std::move(*lock);
    if (own && !options.resume && holds_a_run(options.folder))
      own = fail(
          fmt::format("{}: holds a run already; go on with that one, or name another folder", options.folder.string()));
  }
  if (auto done = ranks.agree(own); !done) return tl::unexpected(done.error());
  const auto done = options.resume ? cluster.restore() : cluster.populate();
  if (!done) return tl::unexpected(done.error());
  if (!options.folder.empty() && !options.resume) {
    if (auto saved = cluster.save(); !saved) return tl::unexpected(saved.error());
  }
  return cluster;
}

Result<void> Cluster::make_own() {
  owner_ = first_owners(options_.shards, ranks_->count());
  shards_.resize(options_.shards);
  cost_us_.assign(options_.shards, 0);
  for (std::uint32_t s = 0; s < options_.shards; ++s) {
    if (owner_[s] != ranks_->rank()) continue;
    auto made = make_(s);
    if (!made) return tl::unexpected(made.error());
    shards_[s] = std::move(*made);
  }
  return {};
}

Result<void> Cluster::populate() {
  Result<void> own = make_own();
  std::uint64_t ticks = 0;
  for (const auto& shard : shards_) {
    if (shard == nullptr || !own) continue;
    own = shard->populate();
    ticks = std::max<std::uint64_t>(ticks, shard->ticks());
    ranks_->alive();
  }
  if (auto done = ranks_->agree(own); !done) return done;
  ticks_ = static_cast<std::uint32_t>(ranks_->most(ticks));
  for (const auto& shard : shards_) {
    while (shard != nullptr && own && shard->ticks() < ticks_) {
      own = shard->apply({});
      if (own) shard->tick();
    }
  }
  return ranks_->agree(own);
}

/// Restores the last snapshot that all ranks can read.
Result<void> Cluster::restore() {
  std::vector<SavedRun> whole;
  Result<void> own;
  if (ranks_->first()) {
    auto found = whole_snapshots(options_.folder);
    if (found) whole = std::move(*found);
    if (!found) own = tl::unexpected(found.error());
    const SavedRun last = found ? whole.front() : SavedRun{};
    if (found && last.about != options_.about)
      own = fail(fmt::format("{}: is of another run: that one was asked for {}, this one for {}",
                             options_.folder.string(), last.about, options_.about));
    if (own && last.shards != options_.shards)
      own = fail(fmt::format("{}: has {} shards, not {}; give as many", options_.folder.string(), last.shards,
                             options_.shards));
  }
  if (auto done = ranks_->agree(own); !done) return done;
  const auto count = ranks_->most(whole.size());
  std::string why;
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto run = unpack_run(ranks_->share(ranks_->first() ? pack(whole[i]) : std::vector<std::byte>{}));
    if (!run) return tl::unexpected(run.error());
    auto done = restore_from(*run);
    if (done) return done;
    if (why.empty()) why = done.error().message;
  }
  return fail(why);
}

Result<void> Cluster::restore_from(const SavedRun& run) {
  ticks_ = run.tick;
  restored_host_ = run.host;
  Result<void> own = make_own();
  for (std::uint32_t s = 0; s < options_.shards && own; ++s) {
    if (shards_[s] == nullptr) continue;
    const auto bytes = read_shard(options_.folder, ticks_, s);
    own = bytes ? shards_[s]->restore(*bytes) : tl::unexpected(bytes.error());
    if (own && shards_[s]->ticks() != ticks_) own = fail(fmt::format("shard {} is of another tick", s));
    ranks_->alive();
  }
  if (auto done = ranks_->agree(own); !done) return done;
  const std::uint64_t hash = state_hash();
  if (hash != run.state_hash)
    return fail(
        fmt::format("{}: what was restored has the state hash {:016x}, and what was saved {:016x}: another "
                    "version or another kind of processor made it",
                    options_.folder.string(), hash, run.state_hash));
  if (ranks_->first()) {
    auto log = CommandLog::resume(options_.folder, ticks_, replay_);
    own = log ? Result<void>() : tl::unexpected(log.error());
    if (log) log_ = std::move(*log);
  }
  saved_tick_ = ticks_;
  return ranks_->agree(own);
}

/// Returns the commands of this tick. The first rank logs new ones before any rank executes them.
std::span<const std::byte> Cluster::commands_of_tick(std::span<const std::byte> commands) {
  if (!ranks_->first()) return ranks_->take_commands(ticks_);
  if (report_.replayed < replay_.size()) {
    commands = replay_[report_.replayed].commands;
    ++report_.replayed;
  } else if (log_) {
    if (auto done = log_->add(ticks_, commands); !done) ranks_->stop("cluster: " + done.error().message);
  }
  ranks_->send_commands(ticks_, commands);
  return commands;
}

std::span<const std::byte> Cluster::tick(std::span<const std::byte> commands) {
  ranks_->at_tick(ticks_);
  const auto now = commands_of_tick(commands);
  carried_out_.assign(now.begin(), now.end());
  const Stopwatch work;
  for (std::uint32_t s = 0; s < shards_.size(); ++s) {
    if (shards_[s] == nullptr) continue;
    const Stopwatch one;
    if (auto done = shards_[s]->apply(carried_out_); !done)
      ranks_->stop(
          fmt::format("cluster: shard {} on rank {} at tick {}: {}", s, ranks_->rank(), ticks_, done.error().message));
    shards_[s]->tick();
    cost_us_[s] += static_cast<std::uint64_t>(1e6 * one.seconds());
    ranks_->alive();
  }
  report_.worked_s += work.seconds();
  ++report_.ticks;
  ++ticks_;
  if (ticks_ % options_.meet_every == 0) ranks_->sum(std::uint64_t{0});
  if (options_.balance_every > 0 && ticks_ % options_.balance_every == 0) balance();
  if (!options_.folder.empty() && options_.save_every != 0 && ticks_ % options_.save_every == 0) {
    if (auto done = save(); !done) ranks_->stop("cluster: " + done.error().message);
  }
  return carried_out_;
}

std::uint64_t Cluster::state_hash() {
  std::uint64_t sum = 0;
  for (const auto& shard : shards_)
    if (shard != nullptr) sum += shard->state_sum();
  return state_hash_of(ranks_->sum(sum), ticks_);
}

Result<void> Cluster::save() {
  if (options_.folder.empty()) return fail("cluster: a snapshot needs a folder; name one (ClusterOptions::folder)");
  if (saved_tick_ == ticks_) return {};
  const Stopwatch time;
  Result<void> own;
  for (std::uint32_t s = 0; s < shards_.size() && own; ++s) {
    if (shards_[s] == nullptr) continue;
    const auto bytes = shards_[s]->save();
    own = bytes ? write_shard(options_.folder, ticks_, s, *bytes) : tl::unexpected(bytes.error());
    if (bytes) report_.bytes_saved += bytes->size();
    ranks_->alive();
  }
  const std::uint64_t hash = state_hash();
  if (auto done = ranks_->agree(own); !done) return done;
  if (ranks_->first()) write_snapshot(hash, own);
  if (auto done = ranks_->agree(own); !done) return done;
  saved_tick_ = ticks_;
  ++report_.snapshots;
  report_.saving_s += time.seconds();
  return {};
}

/// Starts a new log with the commands still to be repeated, then writes the index. Every complete snapshot therefore
/// has its log. The old log is used until then.
void Cluster::write_snapshot(std::uint64_t hash, Result<void>& own) {
  auto log = CommandLog::begin(options_.folder, ticks_, std::span(replay_).subspan(report_.replayed));
  if (!log) {
    own = tl::unexpected(log.error());
    return;
  }
  own = write_index(options_.folder, {ticks_, options_.shards, hash, options_.about,
                                      options_.host ? options_.host() : std::vector<std::byte>{}});
  if (own) log_ = std::move(*log);
}

/// Moves shards between ranks. All ranks compute the same plan from the costs of all shards.
void Cluster::balance() {
  ranks_->sum(cost_us_);
  for (const ShardMove& move : plan_moves(owner_, cost_us_, ranks_->count())) {
    auto& shard = shards_[move.shard];
    Result<void> own;
    if (move.from == ranks_->rank()) {
      const auto bytes = shard->save();
      if (!bytes) ranks_->stop(fmt::format("cluster: shard {} cannot move: {}", move.shard, bytes.error().message));
      ranks_->send(move.to, *bytes);
      shard.reset();
    }
    if (move.to == ranks_->rank()) {
      auto made = make_(move.shard);
      own = made ? (*made)->restore(ranks_->receive(move.from)) : tl::unexpected(made.error());
      if (!own) ranks_->stop(fmt::format("cluster: shard {} cannot move: {}", move.shard, own.error().message));
      shard = std::move(*made);
    }
    owner_[move.shard] = move.to;
    ++report_.moved;
  }
  std::ranges::fill(cost_us_, 0);
}

ClusterReport Cluster::report() const {
  ClusterReport report = report_;
  report.waited_s = ranks_->waited_s();
  report.bytes_sent = ranks_->bytes_sent();
  return report;
}

}  // namespace mobil::inline v0_3
