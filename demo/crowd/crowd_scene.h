#pragma once
// A crowd on a square: who is there, where they turn and how fast they walk, who is near enough to be looked at, who
// leaves and who comes.

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
#include <mobil/simulation.h>
#include "demo/scene/crowd_people.h"

namespace mobil {

struct CrowdEffects {
  bool muscles = true, forces = false, inertia = false, line_motion = false, activation = false, avoidance = false;
};

/// Lengths in m, times in s.
struct CrowdRequest {
  std::size_t people = 1000, near = 500;
  int threads = 0;  // 0: as many as the machine has
  double tolerance_m = 0.005, near_tolerance_m = 0.001;
  std::optional<double> budget_s{};  // a tick, of all deformation
  CrowdEffects effects{};
  double churn_per_s = 0;
  std::size_t burst = 0;  // leave and come in one tick of each second
  bool all_seen = false;
  std::uint64_t seed = 1;
  std::filesystem::path baked{};  // of `mobil bake`; empty: made here
  /// Of a crowd on several ranks this is one shard: of all places those that are its own (shard_of), and of all who are
  /// near its part. `library`: whose meshes and bases it shares (SimulationOptions::library_of).
  std::uint32_t shard = 0, shards = 1;
  const Simulation* library = nullptr;
};

/// Who leaves in a tick, by places, and who comes in their stead: so many from that place on, round the end of the
/// list.
struct CrowdOrders {
  std::uint64_t first_number = 0;
  std::uint32_t first_place = 0, count = 0;
};

/// Gives the orders of a crowd, the same for all of its shards.
struct CrowdDirector {
  std::uint64_t next_number = 0, exchanges = 0;
  double owed = 0;  // people that churn is behind

  CrowdOrders order(const CrowdRequest& request, std::uint32_t tick, double tick_s);
};

/// What the host decided in one tick.
struct CrowdDecisions {
  std::size_t spawned = 0, despawned = 0, turned = 0, changed_speed = 0, near_changed = 0;
  bool structural() const { return spawned + despawned + near_changed > 0; }
};

/// A walker, as the host records it. All else follows from the number or lies in the simulation.
struct CrowdWalker {
  Entity entity{};
  std::uint64_t number = 0;
  std::uint32_t place = 0;                  // in the list of the whole crowd
  float x_m = 0, z_m = 0, heading_rad = 0;  // where they were a second ago at most; where they are to go
  std::uint32_t changes = 0;                // of theirs that have been
  std::int32_t next = -1, before = -1;      // whose change comes in the same tick
  std::uint16_t due = 0;                    // that tick's place in the ring
  std::uint8_t draw = 0;
  bool near = false, stopped = false, returning = false;
};

/// Decisions depend on the seed and the ticks that were: never on threads or clocks. With a budget methods follow the
/// clock.
/// The default memory, and how much of it is lent.
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

/// The side of the square that so many walk on, m.
double crowd_side_m(std::size_t people);

class CrowdScene {
 public:
  using Progress = std::function<void(const char* what, std::size_t done, std::size_t of)>;

  /// With nobody in it; and with everybody. Errors: what the simulation refuses.
  static Result<std::unique_ptr<CrowdScene>> make_empty(const CrowdRequest& request, const Progress& progress = {});
  static Result<std::unique_ptr<CrowdScene>> make(const CrowdRequest& request, const Progress& progress = {});
  CrowdScene(const CrowdScene&) = delete;
  CrowdScene& operator=(const CrowdScene&) = delete;

  /// Another number of people from here on.
  Result<void> resize(std::size_t people, const Progress& progress = {});
  /// Runs on until methods have been chosen and what that excited has died away. `exchanges`: whether people come and
  /// go meanwhile, by the scene's own director.
  Result<void> settle(const Progress& progress = {}, bool exchanges = true);

  /// The parts of a tick, in this order: who comes and goes by its own director's orders or by others', who turns; the
  /// simulation, which chooses methods.
  Result<CrowdDecisions> decide();
  Result<CrowdDecisions> decide(const CrowdOrders& orders);
  void tick();

  const CrowdRequest& request() const { return request_; }
  Simulation& simulation() { return *simulation_; }
  const Simulation& simulation() const { return *simulation_; }
  const std::vector<CrowdWalker>& walkers() const { return walkers_; }
  double side_m() const { return side_m_; }
  /// Where the viewer stands: in the middle of the square's edge at −z.
  Vec3<float> viewer_m() const { return viewer_m(side_m_); }
  static Vec3<float> viewer_m(double side_m) { return {0, 0, static_cast<float>(-0.5 * side_m)}; }

  /// Muscles by the level that they are on; the last is of those that were refused another.
  std::array<std::size_t, level_count + 1> muscles_by_level() const;
  /// What the simulation holds in memory of its people: tables, registers, records.
  std::size_t bytes_of_people() const;

  /// All of it as bytes, and an empty one made of them (mobil/systems/cluster/shard.h).
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

  static constexpr std::size_t ring = 2048;  // ticks ahead that a change may lie

  CrowdRequest request_;
  double side_m_ = 0;
  MeteredMemory memory_;
  std::unique_ptr<Simulation> simulation_;
  std::optional<LodOptions> choosing_;  // with muscles
  LegMuscles muscles_;
  std::vector<CrowdWalker> walkers_;    // by place
  std::vector<SpawnRequest> requests_;  // kept for their memory
  std::vector<Entity> entities_;
  std::vector<std::uint32_t> slots_, slot_of_;  // who leaves and comes; by entity index
  std::array<std::int32_t, ring> due_{};        // first walker whose change comes in that tick
  std::vector<std::pair<float, std::uint32_t>> distance_;
  CrowdDirector director_;
};

}  // namespace mobil
