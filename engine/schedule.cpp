#include "engine/schedule.h"

#include <algorithm>
#include <bit>
#include <chrono>

#include "engine/schedule_order.h"

namespace mobil {

/// One system's run over all its blocks, shared by the threads that do it.
struct Schedule::Pass {
  const System& system;
  const std::vector<Match>& matches;
  const World& world;
  Tick tick;
  const std::vector<ChosenRow>& chosen;
  ScratchPool* scratch;  // null where the system needs none
};

Schedule::Schedule(std::vector<System> systems, std::pmr::memory_resource* memory)
    : systems_(std::move(systems)),
      timings_(systems_.size()),
      matches_(systems_.size()),
      scratch_floats_(systems_.size()),
      scratch_(std::make_unique<ScratchPool>(memory)) {}

void Schedule::match(World& world) {
  if (world_ != world.identity()) {
    for (auto& matches : matches_) matches.clear();
    std::fill(scratch_floats_.begin(), scratch_floats_.end(), 0);
    tables_seen_ = 0;
    world_ = world.identity();
  }
  for (; tables_seen_ < world.tables().size(); ++tables_seen_) {
    Table& table = world.tables()[tables_seen_];
    for (std::size_t s = 0; s < systems_.size(); ++s) {
      std::vector<Bound> bound(systems_[s].parameters);
      if (!systems_[s].bind(world, table, bound.data())) continue;
      for (const Bound& b : bound) scratch_floats_[s] = std::max(scratch_floats_[s], b.scratch_floats);
      matches_[s].push_back({&table, 0, std::move(bound)});
    }
  }
}

void Schedule::run_blocks(void* context, std::size_t begin, std::size_t end) {
  const FlushDenormals flush;
  const Pass& pass = *static_cast<const Pass*>(context);
  const ScratchLease scratch(pass.scratch);
  auto match = std::upper_bound(pass.matches.begin(), pass.matches.end(), begin,
                                [](std::size_t block, const Match& m) { return block < m.first_block; }) -
               1;
  for (std::size_t b = begin; b < end; ++b) {
    while (b - match->first_block >= match->table->block_count()) ++match;
    pass.system.run({pass.world, *match->table, b - match->first_block, pass.tick, scratch.data()},
                    match->bound.data());
  }
}

void Schedule::run_chosen(void* context, std::size_t begin, std::size_t end) {
  const FlushDenormals flush;
  const Pass& pass = *static_cast<const Pass*>(context);
  const std::span<const ChosenRow> rows = pass.chosen;
  for (std::size_t b = begin; b < end; ++b) {
    const std::size_t first = b * lane_count;
    pass.system.run_rows(rows.subspan(first, std::min(lane_count, rows.size() - first)), pass.tick);
  }
}

void Schedule::choose_rows(const System& system, const std::vector<Match>& matches, const World& world, Tick tick) {
  const FlushDenormals flush;
  chosen_.clear();
  std::size_t rows = 0;
  for (const Match& match : matches) rows += match.table->row_count();
  chosen_.reserve(rows);
  for (const Match& match : matches) {
    for (std::size_t b = 0; b < match.table->block_count(); ++b) {
      std::uint32_t bits = system.choose({world, *match.table, b, tick}, match.bound.data());
      bits &= (1U << match.table->live(b)) - 1U;
      for (; bits != 0; bits &= bits - 1)
        chosen_.push_back({match.table->block(b), match.bound.data() + system.chooser_parameters,
                           static_cast<std::uint32_t>(std::countr_zero(bits))});
    }
  }
}

void Schedule::run(World& world, Tick tick, const Jobs& jobs) {
  match(world);
  if (const auto most = std::max_element(scratch_floats_.begin(), scratch_floats_.end());
      most != scratch_floats_.end() && *most > 0) {
    scratch_->prepare(*most, jobs.threads);
  }
  for (std::size_t s = 0; s < systems_.size(); ++s) {
    Timing& timing = timings_[s];
    ++timing.calls;
    timing.last_rows = 0;
    timing.last_seconds = 0;
    std::size_t blocks = 0;
    for (Match& m : matches_[s]) {
      m.first_block = blocks;
      blocks += m.table->block_count();
      timing.last_rows += m.table->row_count();
    }
    if (blocks == 0) continue;
    const auto start = std::chrono::steady_clock::now();
    Pass pass{systems_[s], matches_[s], world, tick, chosen_, scratch_floats_[s] > 0 ? scratch_.get() : nullptr};
    if (systems_[s].choose) {
      choose_rows(systems_[s], matches_[s], world, tick);
      timing.last_rows = chosen_.size();
      blocks = (chosen_.size() + lane_count - 1) / lane_count;
      if (blocks > 0) jobs.parallel_for(jobs.user, blocks, &run_chosen, &pass);
    } else {
      jobs.parallel_for(jobs.user, blocks, &run_blocks, &pass);
    }
    timing.last_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    timing.seconds += timing.last_seconds;
    timing.rows += timing.last_rows;
  }
}

const Timing* Schedule::timing(std::string_view name) const {
  for (std::size_t s = 0; s < systems_.size(); ++s) {
    if (systems_[s].name == name) return &timings_[s];
  }
  return nullptr;
}

void Schedule::reset_timings() {
  std::fill(timings_.begin(), timings_.end(), Timing{});
}

namespace {
/// "mobil::Pose<float>" as people say it: Pose.
std::string_view short_name(std::string_view name) {
  if (name.ends_with("<float>")) name.remove_suffix(7);
  const auto colon = name.rfind("::");
  return colon == std::string_view::npos ? name : name.substr(colon + 2);
}

void list(std::string& text, const System& system, Access::Mode mode, std::string_view verb) {
  std::string before = "; " + std::string(verb) + " ";
  for (const Access& access : system.accesses) {
    if (access.mode != mode) continue;
    text.append(before).append(short_name(access.name));
    before = ", ";
  }
}
}  // namespace

std::string Schedule::describe() const {
  std::string text;
  for (std::size_t s = 0; s < systems_.size(); ++s) {
    text += std::to_string(s + 1) + ". " + systems_[s].name;
    list(text, systems_[s], Access::Mode::read, "reads");
    list(text, systems_[s], Access::Mode::previous, "reads last tick's");
    list(text, systems_[s], Access::Mode::lookup, "looks up");
    list(text, systems_[s], Access::Mode::write, "writes");
    text += '\n';
  }
  return text;
}

Result<Schedule> ScheduleBuilder::build(std::pmr::memory_resource* memory) const {
  const auto order = schedule_order(systems_);
  if (!order) return tl::unexpected(order.error());
  std::vector<System> sorted;
  for (const std::size_t s : *order) sorted.push_back(systems_[s]);
  return Schedule(std::move(sorted), memory);
}

}  // namespace mobil
