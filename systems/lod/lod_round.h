#pragma once
// One tick's look at a crowd for level of detail: who is seen, what their muscles need, which method each gets, and who
// wakes or falls asleep.

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

/// What choosing remembers from one tick to the next besides people's rows, as a global of the world: state.
struct LodProgress {
  CostSpectrum crowd, counting;  // of the last round, and of the one under way
  MachineFactor machine;
  /// Of methods as they are; of those counted in this round.
  std::int64_t cost_ps = 0, counted_ps = 0, budget_ps = 0;
  float factor = 1;
  std::uint32_t turn = 0, last_tick = 0;
  std::uint32_t all_sleepers = 1;  // are looked at next
  OrderedBases ordered{};
  Vec3<float> eye_m{}, gaze{};        // of the last look; a gaze of no length: there was no camera
  std::array<float, 4> saw{};         // then: half its angle, rad; reach_m, near_m, asleep_beyond_m
  std::uint32_t sleepers_looked = 0;  // up to which of the sleepers' blocks
  std::uint32_t spare = 0;
};

/// Whether there is anybody to choose for, in the simulation's workspace.
struct ManagedPeople {
  explicit ManagedPeople(std::pmr::memory_resource* memory)
      : tables({type_id<LodState<float>>(), type_id<SleepsManaged>()}, memory) {}

  TableList tables;
};

/// What the host gave, and what choosing works in, which lies in the simulation's workspace.
struct LodWork {
  /// Where a table of people keeps what is needed.
  struct Columns {
    TableColumn<LodRequest> needs;
    TableColumn<LodState> lod_state;
    TableColumn<Pose> pose;
    TableColumn<BodySize> size;
    TableColumn<Gait> gait;  // walkers have this and the next
    TableColumn<StepPlan> plan;
    TableColumn<GaitState> state;
  };
  struct Switch {
    float excess;  // error over tolerance: as it is, to be dearer; as it will be, to be cheaper
    Entity person;
    std::uint8_t muscle, level;
    bool points, active;
    std::int64_t cost_ps;  // more than now
  };

  /// Who wakes without muscles and is to have them: all by one level.
  struct Bare {
    float excess;
    Entity person;
    std::uint32_t level;
    bool points;
  };
  /// Who is compact and is to be whole.
  struct Expanding {
    float excess;
    Entity person;
  };
  /// What looking at some people came to.
  struct Looked {
    std::vector<Switch> dearer, cheaper;
    std::vector<Bare> bare;
    std::vector<Expanding> expanding;
    std::vector<Entity> drowsy, idle, unseen;
    CostSpectrum counting;  // with a budget
    std::int64_t counted_ps = 0;

    void clear();
    void add(const Looked& more);  // all but `counting`
  };

  LodOptions options;
  LodScene scene;
  LodTable lod_table{accuracy_table()};
  BasisOrders orders;
  LodReport report;
  std::size_t tables_seen = 0;  // of those of ManagedPeople
  std::vector<std::pair<Table*, Columns>> tables;
  /// What was decided of those looked at: in this tick, and by each run of blocks of it.
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
  std::vector<std::size_t> sleeping_blocks;  // up to and with a table
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

  /// Muscles of people who woke without them begin on that level.
  Result<void> begin_muscles(std::span<const Entity> people, std::uint32_t level, bool points);
  std::uint32_t wanted(const LodRequest<float>& needs) const;
  /// How much slower this machine is than the one of the table.
  MachineFactor machine() const;
  /// By which tolerances are missed under the budget.
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
  void decide(Entity person, LodState<float>& lod_state, std::uint32_t wanted_muscles, bool compact, Looked& out) const;
  void observe_machine();
  void plan_budget();
  void wake_sleepers();
  void look_at_sleepers();
  void list_all_sleepers();
  std::array<float, 4> sees() const;  // with a camera and a distance of sleep
  LodState<float> begin_tiers(const LegMuscles* choice) const;
  void decide_bare(Entity person, const LodState<float>& lod_state, std::uint32_t wanted_muscles, bool compact,
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
  std::int64_t switching_ps_ = 0;      // spent in it
  float cone_cos_ = 1, cone_sin_ = 0;  // of the camera's half angle
};

}  // namespace mobil::inline v0_3
