#pragma once
// Level of detail in one tick. Finds people in view and the needs of their muscles, chooses methods, and wakes people
// or puts them to sleep.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <mobil/each.h>
#include <mobil/engine/table_list.h>
#include <mobil/lod.h>
#include "systems/lod/basis_orders.h"
#include "systems/muscles/leg_muscles.h"

namespace mobil::inline v0_3 {

/// State that choosing keeps between ticks, in addition to people's rows: a global of the world.
struct LodProgress {
  CostSpectrum crowd, counting;  // of the last round, and of the one under way
  MachineFactor machine;
  /// Predicted costs of current methods: of all people, and of those counted in this round.
  std::int64_t cost_ps = 0, counted_ps = 0, budget_ps = 0;
  float factor = 1;
  std::uint32_t turn = 0, last_tick = 0;
  std::uint32_t all_sleepers = 1;  // 1: check all sleepers next
  OrderedBases ordered{};
  Vec3<float> eye_m{}, gaze{};        // at the last look; without a camera `gaze` has length 0
  std::array<float, 4> saw{};         // at the last look: half-angle, rad; reach_m, near_m, asleep_beyond_m
  std::uint32_t sleepers_looked = 0;  // next of the sleepers' blocks
  std::uint32_t spare = 0;
};

/// Tables of managed people, awake or asleep, in the simulation's workspace.
struct ManagedPeople {
  explicit ManagedPeople(std::pmr::memory_resource* memory)
      : tables({type_id<LodState<float>>(), type_id<SleepsManaged>()}, memory) {}

  TableList tables;
};

/// The host's settings and scratch memory of choosing, in the simulation's workspace.
struct LodWork {
  /// Columns of a table of people.
  struct Columns {
    TableColumn<LodRequest> needs;
    TableColumn<LodState> lod_state;
    TableColumn<Pose> pose;
    TableColumn<BodySize> size;
    TableColumn<Gait> gait;  // walkers have this and the next two
    TableColumn<StepPlan> plan;
    TableColumn<GaitState> state;
  };
  struct Switch {
    float excess;  // error over tolerance: current for dearer switches, future for cheaper ones
    Entity person;
    std::uint8_t muscle, level;
    bool points, active;
    std::int64_t cost_ps;  // in addition to the current cost
  };

  /// A person who woke without muscles and needs them, all at one level.
  struct Bare {
    float excess;
    Entity person;
    std::uint32_t level;
    bool points;
  };
  /// A compact person who must become full.
  struct Expanding {
    float excess;
    Entity person;
  };
  /// Decisions for the evaluated people.
  struct Looked {
    std::vector<Switch> dearer, cheaper;
    std::vector<Bare> bare;
    std::vector<Expanding> expanding;
    std::vector<Entity> drowsy, idle, unseen;
    CostSpectrum counting;  // only with a budget
    std::int64_t counted_ps = 0;

    void clear();
    void add(const Looked& more);  // all except `counting`
  };

  LodOptions options;
  LodScene scene;
  LodTable lod_table{accuracy_table()};
  BasisOrders orders;
  LodReport report;
  std::size_t tables_seen = 0;  // of ManagedPeople
  std::vector<std::pair<Table*, Columns>> tables;
  /// Decisions of this tick, and of each of its runs of blocks.
  Looked now;
  std::vector<Looked> looked;
  struct BlockOf {
    std::uint32_t table, block;
  };
  std::vector<BlockOf> blocks;
  struct WakingSleeper {
    float order;
    Entity person;
    bool seen;
  };
  std::vector<Table*> sleeping_tables;
  std::vector<std::size_t> sleeping_blocks;  // cumulative, including the table's own
  std::vector<std::uint16_t> near_lanes;
  std::vector<WakingSleeper> waking;
  std::vector<Entity> people;
};

class LodRound {
 public:
  explicit LodRound(const Frame& frame)
      : frame_(frame),
        world_(frame.world),
        work_(frame.workspace.get<LodWork>()),
        progress_(frame.world.global<LodProgress>()) {}

  void run();

  /// Gives people who woke without muscles their muscles, on this level.
  Result<void> begin_muscles(std::span<const Entity> people, std::uint32_t level, bool points);
  std::uint64_t wanted(const LodRequest<float>& needs) const;
  /// Returns how much slower this machine is than the one on which the table was measured.
  MachineFactor machine() const;
  /// Returns the factor by which tolerances are exceeded under the budget.
  float factor() const { return progress_.factor; }

 private:
  using Columns = LodWork::Columns;
  using Switch = LodWork::Switch;
  using Bare = LodWork::Bare;
  using Looked = LodWork::Looked;
  using Expanding = LodWork::Expanding;
  using WakingSleeper = LodWork::WakingSleeper;

  BellyLibrary& library() const { return *frame_.workspace.get<MuscleMeans>().library; }
  void choose();
  void add_report();
  void find_tables();
  std::size_t look_at_the_awake();
  void evaluate(Table& table, const Columns& at, std::size_t block, Looked& out) const;
  void decide(Entity person, LodState<float>& lod_state, std::uint64_t wanted_muscles, bool compact, Looked& out) const;
  void observe_machine();
  void plan_budget();
  void wake_sleepers();
  void look_at_sleepers();
  void list_all_sleepers();
  std::array<float, 4> sees() const;  // needs a camera and asleep_beyond_m
  LodState<float> begin_tiers(const LegMuscles* choice) const;
  void decide_bare(Entity person, const LodState<float>& lod_state, std::uint64_t wanted_muscles, bool compact,
                   Looked& out) const;
  void begin_muscles();
  void end_muscles();
  void put_to_sleep();
  static Vec3<float> pelvis_of(const Table& table, const Columns& at, std::size_t block, std::uint32_t lane);
  void decide_compact(Entity person, bool compact, const LodState<float>& lod_state, bool settled, float excess,
                      Looked& out) const;
  void make_full();
  void make_compact();
  void carry_out();
  void change_first(std::span<const Switch> all, std::int64_t max_ps, bool within_budget);
  bool change(const Switch& one);
  bool at_hand(const Switch& one, std::uint32_t level, bool order);

  const Frame& frame_;
  World& world_;
  LodWork& work_;
  LodProgress& progress_;
  LodReport report_{};                 // of this tick
  std::int64_t switching_ps_ = 0;      // spent on switches in this tick
  float cone_cos_ = 1, cone_sin_ = 0;  // of the camera's half-angle
};

}  // namespace mobil::inline v0_3
