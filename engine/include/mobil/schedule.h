#pragma once
// Systems of a tick and their order, derived from their signatures (mobil/engine/access.h).
//
//   ScheduleBuilder systems;
//   systems.add("gait", &gait).add("kinematics", &kinematics).add("sway", &sway).after("kinematics");
//   Result<Schedule> schedule = systems.build();
//   schedule->run(world, {1.0F / 60, 0}, threads.jobs());
//
// Order: systems that read a component run after those that write it; systems that read Previous<C> run before those
// that write C. An `after` overrides both. Two writers of one component need an `after`, even on different tables, or
// must be alternatives. Ties are resolved by the order of adding, so the order is always the same.
//
// Passes: consecutive systems form one pass as long as they need only their own rows. A system begins a new pass in two
// cases: it looks up (Lookup, LookupPublished) a part that the present pass writes, or writes one that the present pass
// looks up. A packed system (mobil/engine/packed.h) is a pass of its own. Threads wait for each other only between
// passes. For walkers:
//
//   phases ─► steps ahead, gait ─► replan ─► turn, … kinematics, … ─► lines of action, … deformation, … ─► phases
//   1 thread  pass                 packed    pass                     pass                                 1 thread
//
// Tiles: a pass cuts each matching table into tiles of neighbouring blocks. A tile has about 128 kB, so that it fits
// into a core's own cache, but at least one block. In large tables a tile has up to four blocks even if they exceed 128
// kB.
//
//   table A  │ b0 b1 │ b2 b3 │ b4 b5 │ b6 b7 │     4 tiles of 2 blocks of 16 rows:  A0 A1 A2 A3;
//   table B  │ b0 │ b1 │                           2 tiles of 1 block, wider rows:  B0 B1.
//
// Tiles of all tables are interleaved in proportion to their numbers, so that rows of one person's muscles are
// processed at about the same time: A0 A1 B0, A2 A3 B1. The job system distributes ranges of that list. A thread takes
// each tile through all systems that match its table.
//
//   A0:  lines of action(b0, b1) ─► activation(b0, b1) ─► deformation(b0, b1) ─► …     then A1, B0, …
//
// A packed system first chooses lanes, tile by tile. It then runs on the chosen rows, sixteen at a time.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <memory_resource>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <mobil/engine/access.h>
#include <mobil/engine/error.h>
#include <mobil/engine/jobs.h>
#include <mobil/engine/module.h>
#include <mobil/engine/packed.h>
#include <mobil/engine/phase.h>
#include <mobil/engine/scratch.h>
#include <mobil/engine/world.h>

namespace mobil::inline v0_3 {

/// A type-erased system.
struct System {
  std::string name;
  std::string module{};          // its module (mobil/engine/module.h); can be empty
  std::vector<Access> accesses;  // of its parameters
  std::size_t parameters = 0;
  std::vector<std::string> after;  // names of systems or alternatives that run before it
  std::string alternatives{};      // name of its set; in no table do two of a set write one component
  bool (*bind)(const World&, const Table&, Bound*) = nullptr;
  std::function<void(const BlockView&, const Bound*)> run;
  /// Packed systems only: the chosen lanes of a block, as bits; and the work on at most sixteen rows.
  std::function<std::uint32_t(const BlockView&, const Bound*)> choose;
  std::function<void(std::span<const ChosenRow>, Tick)> run_rows;
  std::size_t chooser_parameters = 0;  // the first of `bound` are the chooser's
};

/// Returns a type's name (Access::name) without namespace and scalar: "mobil::Pose<float>" is Pose.
std::string_view plain_name(std::string_view type);

/// Ticks, rows and time of a system: totals, and those of the last tick. Rows are those that the system processed; a
/// packed system counts the chosen rows. Time is the sum over all threads, and 0 for a system that matches no table.
struct Timing {
  std::uint64_t calls = 0;
  std::uint64_t rows = 0;
  double seconds = 0;
  std::uint64_t last_rows = 0;
  double last_seconds = 0;
};

/// A phase, its module, and the calling thread's time in it: total, and in the last tick.
struct TimedPhase {
  Phase phase;
  std::string module;
  double seconds = 0, last_seconds = 0;
};

/// Count of a Tally: in the last tick, and in total since timings were last reset.
struct Counted {
  std::uint64_t last = 0, all = 0;
};

/// A pass: the systems from `first` to before `last` of the order, which run tile by tile. A packed system is a pass of
/// its own.
struct SystemRange {
  std::size_t first, last;
};

class Schedule {
 public:
  /// Runs one tick. In each pass, tiles of neighbouring blocks go through all systems that match their table. Allocates
  /// only if there are new tables or another world, or more threads, chosen rows or blocks than in any earlier tick.
  /// Denormals are flushed to zero while a system runs.
  void run(World& world, Tick tick, const Jobs& jobs = {});

  /// Runs a whole tick: phases before the systems, `run`, and phases after them. `tick.index` is incremented after the
  /// systems. Throws what phases throw (mobil/engine/phase.h); the next tick then begins with the phase that threw.
  void tick(World& world, Tick& tick, Workspace& workspace, const Jobs& jobs = {});
  /// Makes the next tick begin with its first phase even if an earlier tick threw. Used if the world was replaced, for
  /// example by a restored snapshot. It does not affect a tick in progress.
  void begin_anew() { phases_done_ = 0; }

  /// In running order.
  std::span<const System> systems() const { return systems_; }
  std::span<const TimedPhase> before() const { return before_; }
  std::span<const TimedPhase> after() const { return after_; }
  std::span<const SystemRange> passes() const { return passes_; }
  std::span<const Timing> timings() const { return timings_; }
  /// Returns null if no system has that name.
  const Timing* timing(std::string_view name) const;
  /// Sets timings and tallies to zero.
  void reset_timings();
  /// Returns the sum over all systems that take a Tally<Tag>.
  template <class Tag>
  Counted tally() const {
    return tally(type_id<Tag>());
  }
  /// Sets the clock of timings, s; nullptr: the steady clock. On a loaded machine only a clock of the calling thread's
  /// processor time measures systems correctly.
  void measure_with(double (*clock)());

  /// Returns the order as text, one line a phase or system with its reads and writes.
  std::string describe() const;

 private:
  friend class ScheduleBuilder;
  /// A system bound to a table.
  struct Step {
    std::size_t system;
    std::vector<Bound> bound;
  };
  /// A table in a pass, with the systems that match it. Its blocks are processed in tiles.
  struct Match {
    Table* table;
    std::vector<Step> steps;
    std::size_t tile_blocks = 1, first_block = 0;  // this tick; `first_block` counts all blocks of the pass

    std::size_t tiles() const { return (table->block_count() + tile_blocks - 1) / tile_blocks; }
  };
  struct Tile {
    std::uint32_t match, first_block;  // in its table
  };
  struct Pass;
  static void run_tiles(void* pass, std::size_t begin, std::size_t end);
  static void choose_lanes(void* pass, std::size_t begin, std::size_t end);
  static void run_chosen(void* pass, std::size_t begin, std::size_t end);
  template <class F>
  static void for_tiles(const Pass& pass, std::size_t begin, std::size_t end, const F& f);
  void run_packed(Pass& pass, std::size_t blocks, const Jobs& jobs);

  Schedule(std::vector<System> systems, std::vector<TimedPhase> before, std::vector<TimedPhase> after,
           std::pmr::memory_resource* memory);
  void run_phase(TimedPhase& one, const Frame& frame);
  void match(World& world);
  void check_alternatives(const Table& table) const;
  void order_tiles(std::size_t pass, std::size_t threads);
  Counted tally(std::uint64_t tag) const;

  std::vector<System> systems_;
  std::vector<TimedPhase> before_, after_;
  std::size_t phases_done_ = 0;  // of `before_`, if an earlier attempt at this tick threw
  bool ticking_ = false;
  std::vector<SystemRange> passes_;
  std::vector<Timing> timings_;
  std::vector<Counted> counted_;                           // by system
  std::vector<std::vector<Match>> matches_;                // by pass
  std::vector<std::pmr::vector<Tile>> tiles_;              // by pass, in the order of this tick
  std::pmr::vector<std::uint32_t> round_;                  // end of each round of tiles, kept for its memory
  std::pmr::vector<std::uint16_t> chosen_lanes_;           // by block of a running packed system, kept for its memory
  std::pmr::vector<ChosenRow> chosen_;                     // the same as rows
  std::vector<std::size_t> scratch_floats_;                // by pass, the maximum of its tables
  std::unique_ptr<std::atomic<std::int64_t>[]> spent_ns_;  // by system, this tick
  std::unique_ptr<std::atomic<std::uint64_t>[]> tally_;    // the same
  std::unique_ptr<ScratchPool> scratch_;
  double (*clock_)();
  std::size_t tables_seen_ = 0;
  std::shared_ptr<const char> world_;
};

/// Collects systems by module and orders them.
class ScheduleBuilder {
 public:
  /// Assigns all systems added later to that module.
  void begin_module(std::string name) { module_ = std::move(name); }

  /// Adds a free function or a lambda whose parameters are those of mobil/engine/access.h. Several threads call it at
  /// once, for different blocks.
  template <class F>
  ScheduleBuilder& add(std::string name, F function) {
    systems_.push_back(erase(std::move(name), std::move(function), Signature<F>{}));
    systems_.back().module = module_;
    return *this;
  }
  /// Adds a packed system (mobil/engine/packed.h). `choose` takes a block like any system, writes nothing, and returns
  /// the lanes to work on as bits. `function` takes only components and the tick.
  template <class Choose, class F>
  ScheduleBuilder& add_packed(std::string name, Choose choose, F function) {
    systems_.push_back(erase_packed(std::move(name), choose, function, Signature<Choose>{}, Signature<F>{}));
    systems_.back().module = module_;
    return *this;
  }
  /// Orders the system added last after that one, or after all alternatives of that name.
  ScheduleBuilder& after(std::string name) {
    systems_.back().after.push_back(std::move(name));
    return *this;
  }
  /// Makes the system added last one of the alternatives of that name. Alternatives can write one component without an
  /// order, because no table matches two of them. A tick that finds such a table throws std::logic_error with both
  /// names.
  ScheduleBuilder& one_of(std::string alternatives) {
    systems_.back().alternatives = std::move(alternatives);
    return *this;
  }

  /// Adds a phase before or after the systems; phases run in the order of adding.
  ScheduleBuilder& before(Phase phase) {
    before_.push_back({std::move(phase), module_});
    return *this;
  }
  ScheduleBuilder& after_all(Phase phase) {
    after_.push_back({std::move(phase), module_});
    return *this;
  }

  /// Orders the systems and returns the schedule. Errors: two systems or phases of one name; an `after` that names no
  /// system; a system with two parameters of one component that it writes; two writers without an order that are not
  /// alternatives; a cycle. `memory` allocates scratch memory and lists of chosen rows, and must outlive the schedule.
  /// One thread at a time uses it, possibly while systems run.
  Result<Schedule> build(std::pmr::memory_resource* memory = std::pmr::get_default_resource()) const;

 private:
  template <class F, class... P>
  static System erase(std::string name, F function, Parameters<P...>) {
    static_assert((is_scratch<P> + ... + 0) <= 1, "scratch memory once");
    static_assert((is_tally<P> + ... + 0) <= 1, "one tally");
    System system;
    system.name = std::move(name);
    system.accesses = {Parameter<P>::access()...};
    system.parameters = sizeof...(P);
    system.bind = [](const World& world, const Table& table, [[maybe_unused]] Bound* bound) {
      return (Parameter<P>::bind(world, table, *bound++) && ...);
    };
    system.run = [function = std::move(function)](const BlockView& view, [[maybe_unused]] const Bound* bound) {
      [&]<std::size_t... i>(std::index_sequence<i...>) {
        function(Parameter<P>::make(view, bound[i])...);
      }
      (std::index_sequence_for<P...>{});
    };
    return system;
  }

  template <class Choose, class F, class... C, class... P>
  static System erase_packed(std::string name, Choose choose, F function, Parameters<C...>, Parameters<P...>) {
    static_assert(!(is_scratch<C> || ...) && !(is_tally<C> || ...),
                  "a chooser has no scratch memory and counts nothing");
    System system;
    system.name = std::move(name);
    system.accesses = {Parameter<P>::access()...};
    for (const Access& read : {Parameter<C>::access()...}) {  // the chooser can read what the function writes
      const auto same = [&](const Access& a) { return a.id == read.id; };
      if (std::none_of(system.accesses.begin(), system.accesses.end(), same)) system.accesses.push_back(read);
    }
    system.parameters = sizeof...(C) + sizeof...(P);
    system.chooser_parameters = sizeof...(C);
    system.bind = [](const World& world, const Table& table, Bound* bound) {
      return (Parameter<C>::bind(world, table, *bound++) && ...) && (Parameter<P>::bind(world, table, *bound++) && ...);
    };
    system.choose = [choose](const BlockView& view, const Bound* bound) {
      return [&]<std::size_t... i>(std::index_sequence<i...>) {
        return choose(Parameter<C>::make(view, bound[i])...);
      }
      (std::index_sequence_for<C...>{});
    };
    system.run_rows = [function](std::span<const ChosenRow> rows, Tick tick) {
      run_packed<P...>(function, rows, tick);
    };
    return system;
  }

  std::vector<System> systems_;
  std::vector<TimedPhase> before_, after_;
  std::string module_;
};

}  // namespace mobil::inline v0_3
