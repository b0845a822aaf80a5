#pragma once
// The scene of `mobil crowd`: people on a square, their changes of heading and speed, arrivals and departures, and the
// choice of the near people, who are observed.

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <memory_resource>
#include <optional>
#include <span>
#include <vector>

#include <mobil/avoidance.h>
#include <mobil/engine/error.h>
#include <mobil/lod.h>
#include <mobil/muscle_table.h>
#include <mobil/simulation.h>
#include "demo/scene/crowd_people.h"

namespace mobil {

struct CrowdEffects {
  bool muscles = true, forces = false, inertia = false, line_motion = false, activation = false, avoidance = false;
};

/// Lengths in m, times in s.
struct CrowdRequest {
  std::size_t people = 1000, near = 500;
  int threads = 0;  // 0: one per processor
  double tolerance_m = 0.005, near_tolerance_m = 0.001;
  std::optional<double> budget_s{};  // per tick, for all deformation
  CrowdEffects effects{};
  MuscleSet muscles = usual_muscles();
  double churn_per_s = 0;
  std::size_t burst = 0;  // people replaced in one tick of each second
  bool all_seen = false;
  std::uint64_t seed = 1;
  std::filesystem::path baked{};  // file of `mobil bake`; empty: the default file, or computed
  /// Shard of a crowd on several ranks. It has its own places of the crowd (shard_of) and its part of the near people.
  /// `library`: simulation whose meshes and bases it shares (SimulationOptions::library_of).
  std::uint32_t shard = 0, shards = 1;
  const Simulation* library = nullptr;
};

/// People replaced in one tick: `count` places from `first_place` on, continuing at the start of the list. The new
/// people have consecutive numbers from `first_number` on.
struct CrowdOrders {
  std::uint64_t first_number = 0;
  std::uint32_t first_place = 0, count = 0;
};

/// Generates the orders of a crowd, the same for all of its shards.
struct CrowdDirector {
  std::uint64_t next_number = 0, exchanges = 0;
  double owed = 0;  // people due for replacement by churn

  CrowdOrders order(const CrowdRequest& request, std::uint32_t tick, double tick_s);
};

/// Counts of the host's decisions in one tick.
struct CrowdDecisions {
  std::size_t spawned = 0, despawned = 0, turned = 0, changed_speed = 0, near_changed = 0;
  bool structural() const { return spawned + despawned + near_changed > 0; }
};

/// The host's record of a walker. All other data is derived from the number or stored in the simulation.
struct CrowdWalker {
  Entity entity{};
  std::uint64_t number = 0;
  std::uint32_t place = 0;                  // in the list of the whole crowd
  float x_m = 0, z_m = 0, heading_rad = 0;  // position, at most a second old; requested heading
  float usual_m_s = 0;                      // the party's speed
  std::uint32_t changes = 0;                // number of past changes
  std::int32_t next = -1, before = -1;      // list of walkers whose change is due in the same tick
  std::uint16_t due = 0;                    // ring index of that tick
  std::uint8_t draw = 0, party_place = 0;
  bool near = false, stopped = false, returning = false;

  std::uint64_t party() const { return number - party_place; }  // number of its first member
};

/// Forwards to the default memory resource and counts the bytes in use.
class MeteredMemory : public std::pmr::memory_resource {
 public:
  std::size_t lent() const { return lent_; }

 private:
  void* do_allocate(std::size_t bytes, std::size_t alignment) override {
    void* const memory = std::pmr::get_default_resource()->allocate(bytes, alignment);
    lent_ += bytes;
    return memory;
  }
  void do_deallocate(void* memory, std::size_t bytes, std::size_t alignment) override {
    lent_ -= bytes;
    std::pmr::get_default_resource()->deallocate(memory, bytes, alignment);
  }
  bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override { return this == &other; }

  std::size_t lent_ = 0;
};

/// Returns the side of the square for this many people, m.
double crowd_side_m(std::size_t people);

/// A crowd. Decisions depend on seed and tick only, not on threads or clocks. With a budget, methods depend on the
/// clock.
class CrowdScene {
 public:
  using Progress = std::function<void(const char* what, std::size_t done, std::size_t of)>;

  /// Create an empty scene, and one with all people. Errors: those of the simulation.
  static Result<std::unique_ptr<CrowdScene>> make_empty(const CrowdRequest& request, const Progress& progress = {});
  static Result<std::unique_ptr<CrowdScene>> make(const CrowdRequest& request, const Progress& progress = {});
  CrowdScene(const CrowdScene&) = delete;
  CrowdScene& operator=(const CrowdScene&) = delete;

  /// Changes the number of people.
  Result<void> resize(std::size_t people, const Progress& progress = {});
  /// Runs until methods have been chosen and the excited vibrations have decayed. If `exchanges` is true, the scene's
  /// own director replaces people meanwhile.
  Result<void> settle(const Progress& progress = {}, bool exchanges = true);

  /// The parts of a tick, in this order. `decide` replaces people by the orders of the scene's own director or by the
  /// given ones, and changes headings and speeds. `tick` runs the simulation, which chooses methods.
  Result<CrowdDecisions> decide();
  Result<CrowdDecisions> decide(const CrowdOrders& orders);
  void tick();

  const CrowdRequest& request() const { return request_; }
  Simulation& simulation() { return *simulation_; }
  const Simulation& simulation() const { return *simulation_; }
  const std::vector<CrowdWalker>& walkers() const { return walkers_; }
  double side_m() const { return side_m_; }
  /// Returns the viewer's position, the middle of the square's edge at −z.
  Vec3<float> viewer_m() const { return viewer_m(side_m_); }
  static Vec3<float> viewer_m(double side_m) { return {0, 0, static_cast<float>(-0.5 * side_m)}; }

  /// Returns the number of muscles at each level; the last element counts forced and refused methods.
  std::array<std::size_t, level_count + 1> muscles_by_level() const;
  /// Returns the memory that the simulation has allocated for its people (tables, registers, records), bytes.
  std::size_t bytes_of_people() const;

  /// Saves the scene, and restores a saved one into an empty scene (mobil/systems/cluster/shard.h).
  Result<std::vector<std::byte>> save() const;
  Result<void> restore(std::span<const std::byte> saved);

 private:
  explicit CrowdScene(const CrowdRequest& request);

  Result<void> come(std::span<const std::uint32_t> slots);
  void leave(std::span<const std::uint32_t> slots);
  Result<void> exchange(const CrowdOrders& orders, CrowdDecisions& decisions);
  bool is_own(std::uint32_t place) const;
  std::size_t first_slot_from(std::uint32_t place) const;
  void keep_slot(std::size_t slot);
  Result<void> head_for(const CrowdWalker& walker, float heading_rad);
  Result<void> carry_out(CrowdWalker& walker, CrowdDecisions& decisions);
  void plan(std::size_t slot);
  void forget_plan(std::size_t slot);
  Result<void> look_round(CrowdDecisions& decisions);
  void read_places();
  Result<void> turn_back(CrowdDecisions& decisions);
  Result<void> choose_near(CrowdDecisions& decisions);
  LegMuscles first_muscles() const;

  static constexpr std::size_t ring = 2048;  // maximum number of ticks until a change

  CrowdRequest request_;
  double side_m_ = 0;
  MeteredMemory memory_;
  std::unique_ptr<Simulation> simulation_;
  std::optional<LodOptions> choosing_;  // with muscles
  LegMuscles muscles_;
  std::vector<CrowdWalker> walkers_;    // by place
  std::vector<SpawnRequest> requests_;  // reused
  std::vector<Entity> entities_;
  std::vector<std::uint32_t> slots_, slot_of_;  // people replaced; by entity index
  std::array<std::int32_t, ring> due_{};        // first walker whose change is due in that tick
  std::vector<std::pair<float, std::uint32_t>> distance_;
  CrowdDirector director_;
};

}  // namespace mobil
