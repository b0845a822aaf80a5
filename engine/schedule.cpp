#include <mobil/schedule.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <stdexcept>

#include "engine/schedule_order.h"

namespace mobil::inline v0_3 {

namespace {

/// Share of a core's own cache for blocks; the rest is for other data of the systems.
constexpr std::size_t tile_bytes = 128 * 1024;

double steady_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

/// One pass over all its blocks, shared by its threads.
struct Schedule::Pass {
  std::span<const System> systems;  // all systems of the schedule
  std::span<const Match> matches;
  std::span<const Tile> tiles;
  const World& world;
  Tick tick;
  double (*clock)();
  std::atomic<std::int64_t>* spent_ns;
  std::atomic<std::uint64_t>* tally;
  std::span<const ChosenRow> chosen;
  std::uint16_t* chosen_lanes;
  std::size_t packed;    // the packed system, if the pass is one
  ScratchPool* scratch;  // null if no system needs any

  void spend(std::size_t system, double seconds) const {
    spent_ns[system].fetch_add(static_cast<std::int64_t>(seconds * 1e9), std::memory_order_relaxed);
  }
};

Schedule::Schedule(std::vector<System> systems, std::vector<TimedPhase> before, std::vector<TimedPhase> after,
                   std::pmr::memory_resource* memory)
    : systems_(std::move(systems)),
      before_(std::move(before)),
      after_(std::move(after)),
      passes_(schedule_passes(systems_)),
      timings_(systems_.size()),
      counted_(systems_.size()),
      matches_(passes_.size()),
      round_(memory),
      chosen_lanes_(memory),
      chosen_(memory),
      scratch_floats_(passes_.size()),
      spent_ns_(std::make_unique<std::atomic<std::int64_t>[]>(systems_.size())),
      tally_(std::make_unique<std::atomic<std::uint64_t>[]>(systems_.size())),
      scratch_(std::make_unique<ScratchPool>(memory)),
      clock_(&steady_now) {
  for (std::size_t p = 0; p < passes_.size(); ++p) tiles_.emplace_back(memory);
}

void Schedule::measure_with(double (*clock)()) {
  clock_ = clock == nullptr ? &steady_now : clock;
}

void Schedule::match(World& world) {
  if (world_ != world.identity()) {
    for (auto& matches : matches_) matches.clear();
    std::fill(scratch_floats_.begin(), scratch_floats_.end(), 0);
    tables_seen_ = 0;
    world_ = world.identity();
  }
  for (; tables_seen_ < world.tables().size(); ++tables_seen_) {
    Table& table = world.tables()[tables_seen_];
    for (std::size_t p = 0; p < passes_.size(); ++p) {
      if (!matches_[p].empty() && matches_[p].back().table == &table) matches_[p].pop_back();  // memory ran out before
      Match match{&table, {}};
      for (std::size_t s = passes_[p].first; s < passes_[p].last; ++s) {
        std::vector<Bound> bound(systems_[s].parameters);
        if (!systems_[s].bind(world, table, bound.data())) continue;
        for (const Bound& b : bound) scratch_floats_[p] = std::max(scratch_floats_[p], b.scratch_floats);
        match.steps.push_back({s, std::move(bound)});
      }
      if (!match.steps.empty()) matches_[p].push_back(std::move(match));
    }
    check_alternatives(table);
  }
}

/// Throws if two alternatives write one component of a table without an order between them.
void Schedule::check_alternatives(const Table& table) const {
  std::vector<const System*> there;
  for (const auto& matches : matches_) {
    if (matches.empty() || matches.back().table != &table) continue;
    for (const Step& step : matches.back().steps)
      if (!systems_[step.system].alternatives.empty()) there.push_back(&systems_[step.system]);
  }
  for (const System* const a : there) {
    for (const System* const b : there) {
      if (a == b || a->alternatives != b->alternatives || std::ranges::count(a->after, b->name) > 0 ||
          std::ranges::count(b->after, a->name) > 0)
        continue;
      for (const Access& write : a->accesses)
        for (const Access& other : b->accesses)
          if (write.mode == Access::Mode::write && other.mode == Access::Mode::write && write.id == other.id)
            throw std::logic_error("schedule: '" + a->name + "' and '" + b->name +
                                   "' are alternatives, and both write " + std::string(write.name) +
                                   " of one table; say which comes second with .after(…)");
    }
  }
}

/// Interleaves the tables' tiles in proportion to their number, so that rows of several tables that look up the same
/// people find them in a cache.
void Schedule::order_tiles(std::size_t pass, std::size_t threads) {
  constexpr std::size_t side_by_side = 2;  // tiles of the longest table in a round
  std::size_t all = 0, most = 0;
  for (Match& m : matches_[pass]) {
    // Large tables have several blocks a tile: reading the clock after each block costs 1/40 of a walker's tick.
    const std::size_t several =
        std::min<std::size_t>(4, m.table->block_count() / (8 * std::max<std::size_t>(threads, 1)));
    m.tile_blocks = std::max({std::size_t{1}, several, tile_bytes / std::max<std::size_t>(1, m.table->block_bytes())});
    all += m.tiles();
    most = std::max(most, m.tiles());
  }
  const std::size_t rounds = (most + side_by_side - 1) / side_by_side;
  round_.assign(rounds + 1, 0);
  const auto each = [&](const auto& f) {
    for (std::size_t m = 0; m < matches_[pass].size(); ++m) {
      const std::size_t count = matches_[pass][m].tiles();
      for (std::size_t t = 0; t < count; ++t) f(m, t, t * rounds / count);
    }
  };
  each([&](std::size_t, std::size_t, std::size_t round) { ++round_[round + 1]; });
  for (std::size_t r = 0; r < rounds; ++r) round_[r + 1] += round_[r];
  tiles_[pass].resize(all);
  each([&](std::size_t m, std::size_t t, std::size_t round) {
    tiles_[pass][round_[round]++] = {static_cast<std::uint32_t>(m),
                                     static_cast<std::uint32_t>(t * matches_[pass][m].tile_blocks)};
  });
}

/// Calls f(match, first block, block after the last) for each of those tiles.
template <class F>
void Schedule::for_tiles(const Pass& pass, std::size_t begin, std::size_t end, const F& f) {
  for (const Tile& tile : pass.tiles.subspan(begin, end - begin)) {
    const Match& match = pass.matches[tile.match];
    f(match, tile.first_block, std::min(tile.first_block + match.tile_blocks, match.table->block_count()));
  }
}

void Schedule::run_tiles(void* context, std::size_t begin, std::size_t end) {
  const Pass& pass = *static_cast<const Pass*>(context);
  const ScratchLease scratch(pass.scratch);
  double before = pass.clock();
  for_tiles(pass, begin, end, [&](const Match& match, std::size_t first, std::size_t last) {
    for (const Step& step : match.steps) {
      const System& system = pass.systems[step.system];
      for (std::size_t b = first; b < last; ++b) {
        system.run({pass.world, *match.table, b, pass.tick, scratch.data(), &pass.tally[step.system]},
                   step.bound.data());
      }
      const double now = pass.clock();
      pass.spend(step.system, now - before);
      before = now;
    }
  });
}

void Schedule::choose_lanes(void* context, std::size_t begin, std::size_t end) {
  const Pass& pass = *static_cast<const Pass*>(context);
  const System& system = pass.systems[pass.packed];
  const double before = pass.clock();
  for_tiles(pass, begin, end, [&](const Match& match, std::size_t first, std::size_t last) {
    for (std::size_t b = first; b < last; ++b) {
      const std::uint32_t lanes = system.choose({pass.world, *match.table, b, pass.tick}, match.steps[0].bound.data());
      pass.chosen_lanes[match.first_block + b] =
          static_cast<std::uint16_t>(lanes & ((1U << match.table->live(b)) - 1U));
    }
  });
  pass.spend(pass.packed, pass.clock() - before);
}

void Schedule::run_chosen(void* context, std::size_t begin, std::size_t end) {
  const Pass& pass = *static_cast<const Pass*>(context);
  const double before = pass.clock();
  for (std::size_t b = begin; b < end; ++b) {
    const std::size_t first = b * lane_count;
    const std::size_t count = std::min(lane_count, pass.chosen.size() - first);
    pass.systems[pass.packed].run_rows(pass.chosen.subspan(first, count), pass.tick);
  }
  pass.spend(pass.packed, pass.clock() - before);
}

void Schedule::run_packed(Pass& pass, std::size_t blocks, const Jobs& jobs) {
  chosen_lanes_.resize(blocks);
  pass.chosen_lanes = chosen_lanes_.data();
  run_in_parallel(jobs, pass.tiles.size(), &choose_lanes, &pass);
  chosen_.clear();
  chosen_.reserve(blocks * lane_count);
  for (const Match& match : pass.matches) {
    const Bound* bound = match.steps[0].bound.data() + systems_[pass.packed].chooser_parameters;
    for (std::size_t b = 0; b < match.table->block_count(); ++b) {
      for (std::uint32_t lanes = chosen_lanes_[match.first_block + b]; lanes != 0; lanes &= lanes - 1)
        chosen_.push_back({match.table->block(b), bound, static_cast<std::uint32_t>(std::countr_zero(lanes))});
    }
  }
  timings_[pass.packed].last_rows = chosen_.size();
  if (chosen_.empty()) return;
  pass.chosen = chosen_;
  run_in_parallel(jobs, (chosen_.size() + lane_count - 1) / lane_count, &run_chosen, &pass);
}

void Schedule::run(World& world, Tick tick, const Jobs& jobs) {
  match(world);
  if (const auto most = std::max_element(scratch_floats_.begin(), scratch_floats_.end());
      most != scratch_floats_.end() && *most > 0) {
    scratch_->prepare(*most, jobs.threads);
  }
  for (std::size_t s = 0; s < systems_.size(); ++s) {
    timings_[s].last_rows = 0;
    spent_ns_[s].store(0, std::memory_order_relaxed);
    tally_[s].store(0, std::memory_order_relaxed);
  }
  // Allocates all memory before any system runs.
  for (std::size_t p = 0; p < passes_.size(); ++p) {
    order_tiles(p, jobs.threads);
    if (!systems_[passes_[p].first].choose) continue;
    std::size_t blocks = 0;
    for (const Match& m : matches_[p]) blocks += m.table->block_count();
    chosen_lanes_.reserve(blocks);
    chosen_.reserve(blocks * lane_count);
  }
  for (std::size_t p = 0; p < passes_.size(); ++p) {
    std::size_t blocks = 0;
    for (Match& m : matches_[p]) {
      m.first_block = blocks;
      blocks += m.table->block_count();
      for (const Step& step : m.steps) timings_[step.system].last_rows += m.table->row_count();
    }
    if (blocks == 0) continue;
    Pass pass{systems_, matches_[p], tiles_[p],        world,
              tick,     clock_,      spent_ns_.get(),  tally_.get(),
              {},       nullptr,     passes_[p].first, scratch_floats_[p] > 0 ? scratch_.get() : nullptr};
    if (systems_[pass.packed].choose) {
      run_packed(pass, blocks, jobs);
    } else {
      run_in_parallel(jobs, tiles_[p].size(), &run_tiles, &pass);
    }
  }
  for (std::size_t s = 0; s < systems_.size(); ++s) {
    Timing& timing = timings_[s];
    ++timing.calls;
    timing.last_seconds = 1e-9 * static_cast<double>(spent_ns_[s].load(std::memory_order_relaxed));
    timing.seconds += timing.last_seconds;
    timing.rows += timing.last_rows;
    counted_[s].last = tally_[s].load(std::memory_order_relaxed);
    counted_[s].all += counted_[s].last;
  }
}

void Schedule::run_phase(TimedPhase& one, const Frame& frame) {
  const double start = clock_();
  one.phase.run(frame);
  one.last_seconds = clock_() - start;
  one.seconds += one.last_seconds;
}

void Schedule::tick(World& world, Tick& tick, Workspace& workspace, const Jobs& jobs) {
  if (ticking_)
    throw std::logic_error("schedule: a phase or a system calls tick or advance; let the host's loop do that");
  const struct Ticking {
    explicit Ticking(bool& is) : is_(is) { is_ = true; }
    ~Ticking() { is_ = false; }
    bool& is_;
  } ticking(ticking_);
  const Frame frame{world, jobs, tick, workspace, *this};
  for (std::size_t p = phases_done_; p < before_.size(); phases_done_ = ++p) run_phase(before_[p], frame);
  run(world, tick, jobs);
  phases_done_ = 0;
  ++tick.index;
  for (TimedPhase& one : after_) run_phase(one, frame);
}

const Timing* Schedule::timing(std::string_view name) const {
  for (std::size_t s = 0; s < systems_.size(); ++s) {
    if (systems_[s].name == name) return &timings_[s];
  }
  return nullptr;
}

void Schedule::reset_timings() {
  std::fill(timings_.begin(), timings_.end(), Timing{});
  for (auto* const phases : {&before_, &after_})
    for (TimedPhase& one : *phases) one.seconds = one.last_seconds = 0;
  std::fill(counted_.begin(), counted_.end(), Counted{});
}

Counted Schedule::tally(std::uint64_t tag) const {
  Counted sum;
  for (std::size_t s = 0; s < systems_.size(); ++s) {
    const auto counts = [&](const Access& access) { return access.mode == Access::Mode::none && access.id == tag; };
    if (std::ranges::none_of(systems_[s].accesses, counts)) continue;
    sum.last += counted_[s].last;
    sum.all += counted_[s].all;
  }
  return sum;
}

std::string_view plain_name(std::string_view type) {
  if (type.ends_with("<float>")) type.remove_suffix(7);
  const auto colon = type.rfind("::");
  return colon == std::string_view::npos ? type : type.substr(colon + 2);
}

namespace {

void list(std::string& text, const System& system, Access::Mode mode, std::string_view verb) {
  std::string before = "; " + std::string(verb) + " ";
  for (const Access& access : system.accesses) {
    if (access.mode != mode) continue;
    text.append(before).append(plain_name(access.name));
    before = ", ";
  }
}
}  // namespace

std::string Schedule::describe() const {
  std::string text;
  for (const TimedPhase& one : before_) text += "before: " + one.phase.name + '\n';
  for (std::size_t s = 0; s < systems_.size(); ++s) {
    text += std::to_string(s + 1) + ". " + systems_[s].name;
    list(text, systems_[s], Access::Mode::read, "reads");
    list(text, systems_[s], Access::Mode::previous, "reads last tick's");
    list(text, systems_[s], Access::Mode::lookup, "looks up");
    list(text, systems_[s], Access::Mode::write, "writes");
    text += '\n';
  }
  for (const TimedPhase& one : after_) text += "after: " + one.phase.name + '\n';
  return text;
}

Result<Schedule> ScheduleBuilder::build(std::pmr::memory_resource* memory) const {
  for (const auto* const phases : {&before_, &after_}) {
    for (auto one = phases->begin(); one != phases->end(); ++one) {
      const auto same_name = [&](const TimedPhase& other) { return other.phase.name == one->phase.name; };
      if (one->phase.name.empty() || !one->phase.run || std::any_of(phases->begin(), one, same_name)) {
        return fail("schedule: phase '" + one->phase.name + "' of module '" + one->module +
                    "' has no name, another phase's name or no function; give it a name of its own and a function");
      }
    }
  }
  const auto order = schedule_order(systems_);
  if (!order) return tl::unexpected(order.error());
  std::vector<System> sorted;
  for (const std::size_t s : *order) sorted.push_back(systems_[s]);
  return Schedule(std::move(sorted), before_, after_, memory);
}

}  // namespace mobil::inline v0_3
