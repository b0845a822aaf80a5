#pragma once
// Which systems run, on what, and in which order: all read off their signatures (mobil/engine/access.h).
//
//   ScheduleBuilder systems;
//   systems.add("gait", &gait).add("kinematics", &kinematics).add("sway", &sway).after("kinematics");
//   Result<Schedule> schedule = systems.build();
//   schedule->run(world, {1.0F / 60, 0}, threads.jobs());
//
// Order: who reads a component runs after who writes it; who reads it as Previous runs before. Where `after` says
// otherwise, `after` wins. Two writers of one component need an `after`, be it on different tables, or are
// alternatives. Ties go by the order of adding, so that the order is always the same. That is so of each block: systems
// that need nothing of other blocks (no Lookup between them) go over one block after the other together, while it is in
// a cache.

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
#include <mobil/engine/packed.h>
#include <mobil/engine/phase.h>
#include <mobil/engine/scratch.h>
#include <mobil/engine/world.h>

namespace mobil::inline v0_3 {

/// A system with its type taken off.
struct System {
  std::string name;
  std::string module{};          // that it belongs to (mobil/engine/module.h); may be empty
  std::vector<Access> accesses;  // of its parameters
  std::size_t parameters = 0;
  std::vector<std::string> after;  // names of systems, or of alternatives, that must have run
  std::string alternatives{};      // name of a set of systems of which no table has two that write one component
  bool (*bind)(const World&, const Table&, Bound*) = nullptr;
  std::function<void(const BlockView&, const Bound*)> run;
  /// Packed systems only: which lanes of a block, as bits; and the work on at most sixteen rows.
  std::function<std::uint32_t(const BlockView&, const Bound*)> choose;
  std::function<void(std::span<const ChosenRow>, Tick)> run_rows;
  std::size_t chooser_parameters = 0;  // what is bound begins with them
};

/// A type's name (Access::name) as people say it: "mobil::Pose<float>" is Pose.
std::string_view plain_name(std::string_view type);

/// Ticks, rows worked on and time of a system in all, and the last tick's. Rows are entities: of a packed system those
/// chosen. Time is that of all threads together. Where no table is a system's, its code does not run and takes no time.
struct Timing {
  std::uint64_t calls = 0;
  std::uint64_t rows = 0;
  double seconds = 0;
  std::uint64_t last_rows = 0;
  double last_seconds = 0;
};

/// A phase, its module, and the calling thread's time in it: in all, and in the last tick.
struct TimedPhase {
  Phase phase;
  std::string module;
  double seconds = 0, last_seconds = 0;
};

/// What systems added to their Tally: in the last tick, and in all since timings were last reset.
struct Counted {
  std::uint64_t last = 0, all = 0;
};

/// Systems that run block by block, one after the other while a block is in a cache, before any other of the order:
/// `first` up to before `last` of the order. A packed system is a pass of its own.
struct SystemRange {
  std::size_t first, last;
};

class Schedule {
 public:
  /// One tick. In each pass some neighbouring blocks at a time go through all the systems whose tables they are in.
  /// Takes memory only when tables have been made since the last run, another world comes along, or more threads work
  /// at once, more rows may be chosen or tables have more blocks than ever before. Denormals are zero while a system
  /// runs.
  void run(World& world, Tick tick, const Jobs& jobs = {});

  /// A whole tick: phases before the systems, `run`, and phases after them. `tick.index` grows by one once the systems
  /// have run. Throws what phases throw (mobil/engine/phase.h); the next tick then begins with the phase that threw.
  void tick(World& world, Tick& tick, Workspace& workspace, const Jobs& jobs = {});
  /// After the world became another one, as by a restored snapshot: the next tick begins with its first phase. Within a
  /// phase it changes nothing of the tick under way.
  void begin_anew() { phases_done_ = 0; }

  /// In the order of running.
  std::span<const System> systems() const { return systems_; }
  std::span<const TimedPhase> before() const { return before_; }
  std::span<const TimedPhase> after() const { return after_; }
  std::span<const SystemRange> passes() const { return passes_; }
  std::span<const Timing> timings() const { return timings_; }
  /// Null when there is no system of that name.
  const Timing* timing(std::string_view name) const;
  /// Sets timings and tallies to zero.
  void reset_timings();
  /// The sum over all systems that take a Tally<Tag>.
  template <class Tag>
  Counted tally() const {
    return tally(type_id<Tag>());
  }
  /// What time is read from, s; nullptr: the machine's steady clock. A clock of the calling thread's processor time
  /// says what systems cost while others use the machine.
  void measure_with(double (*clock)());

  /// The order as text, a line a phase or system: what a system reads and writes.
  std::string describe() const;

 private:
  friend class ScheduleBuilder;
  /// A system on a table.
  struct Step {
    std::size_t system;
    std::vector<Bound> bound;
  };
  /// What a pass does to a table: some blocks at a time, a tile, so that they stay in a cache.
  struct Match {
    Table* table;
    std::vector<Step> steps;
    std::size_t tile_blocks = 1, first_block = 0;  // this tick; the latter among all of the pass

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
  std::size_t phases_done_ = 0;  // of those before the systems, in a tick that did not get further
  bool ticking_ = false;
  std::vector<SystemRange> passes_;
  std::vector<Timing> timings_;
  std::vector<Counted> counted_;                           // by system
  std::vector<std::vector<Match>> matches_;                // by pass
  std::vector<std::pmr::vector<Tile>> tiles_;              // by pass, in the order of this tick
  std::pmr::vector<std::uint32_t> round_;                  // where each round of tiles ends, kept for its memory
  std::pmr::vector<std::uint16_t> chosen_lanes_;           // by block of a packed system that runs, kept for its memory
  std::pmr::vector<ChosenRow> chosen_;                     // the same as rows
  std::vector<std::size_t> scratch_floats_;                // by pass, the most that a table of it needs
  std::unique_ptr<std::atomic<std::int64_t>[]> spent_ns_;  // by system, this tick
  std::unique_ptr<std::atomic<std::uint64_t>[]> tally_;    // the same
  std::unique_ptr<ScratchPool> scratch_;
  double (*clock_)();
  std::size_t tables_seen_ = 0;
  std::shared_ptr<const char> world_;
};

/// Collects systems, by module, and orders them.
class ScheduleBuilder {
 public:
  /// Systems added from now on are that module's.
  void begin_module(std::string name) { module_ = std::move(name); }

  /// A free function or a lambda whose parameters are those of mobil/engine/access.h. It is called from several threads
  /// at once, for different blocks.
  template <class F>
  ScheduleBuilder& add(std::string name, F function) {
    systems_.push_back(erase(std::move(name), std::move(function), Signature<F>{}));
    systems_.back().module = module_;
    return *this;
  }
  /// A packed system (mobil/engine/packed.h): `choose` takes a block like any system, writes nothing, and returns the
  /// lanes to work on as bits; `function` takes components and the tick alone.
  template <class Choose, class F>
  ScheduleBuilder& add_packed(std::string name, Choose choose, F function) {
    systems_.push_back(erase_packed(std::move(name), choose, function, Signature<Choose>{}, Signature<F>{}));
    systems_.back().module = module_;
    return *this;
  }
  /// The system added last runs after that one, or after all alternatives of that name.
  ScheduleBuilder& after(std::string name) {
    systems_.back().after.push_back(std::move(name));
    return *this;
  }
  /// The system added last is one of the alternatives of that name: they may write one component without an order among
  /// each other, for no table has two of them. A tick that finds such a table throws std::logic_error, which names
  /// both.
  ScheduleBuilder& one_of(std::string alternatives) {
    systems_.back().alternatives = std::move(alternatives);
    return *this;
  }

  /// Phases run in the order of adding.
  ScheduleBuilder& before(Phase phase) {
    before_.push_back({std::move(phase), module_});
    return *this;
  }
  ScheduleBuilder& after_all(Phase phase) {
    after_.push_back({std::move(phase), module_});
    return *this;
  }

  /// Fails on two systems or phases of one name, on an `after` that names no system, on a system that takes a component
  /// twice and writes it, on two writers without an order that are no alternatives, and on cycles. `memory` serves the
  /// systems' scratch memory and the lists of chosen rows; it is asked by one thread at a time, perhaps during a run,
  /// and must outlive the schedule.
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
    for (const Access& read : {Parameter<C>::access()...}) {  // the chooser may read what the function writes
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
