#pragma once
// The scene of `mobil city`: up to millions of people and a camera that flies, turns and cuts to another place. People
// turn, stop and start, asleep or awake. Those too far away to be seen soon are asleep.

#include <mobil/engine/jobs.h>
#include "demo/crowd/crowd_picture.h"

namespace mobil {

struct AliveRequest {
  std::size_t alive = 1'000'000, in_view = 10'000;
  int threads = 0;
  std::uint64_t seed = 1;
  double cut_every_s = 10;
  bool muscles = true;
  std::filesystem::path baked{};  // file of `mobil bake`; empty: the default file, or computed
  /// Shard of a crowd on several ranks, as in CrowdRequest.
  std::uint32_t shard = 0, shards = 1;
  const Simulation* library = nullptr;
};

/// Returns the renderer's camera for a viewpoint.
Camera picture_from(const Viewpoint& camera);
/// Returns the side of the square on which the people live, m.
double side_of(const AliveRequest& request);
/// Returns the camera at a tick. After each cut it starts at another place, flies straight ahead and swings sideways.
Viewpoint fly(const AliveRequest& request, std::uint32_t tick, double tick_s);

class AliveScene {
 public:
  /// Creates an empty scene; `populate` then spawns all people asleep. Errors: those of the simulation.
  static Result<std::unique_ptr<AliveScene>> make_empty(const AliveRequest& request);
  Result<void> populate();
  AliveScene(const AliveScene&) = delete;
  AliveScene& operator=(const AliveScene&) = delete;

  /// The parts of a tick. `decide` requests the gait changes that are due, sets the camera and returns the number of
  /// changes. `tick` wakes people, puts them to sleep, chooses methods and advances the simulation.
  Result<std::size_t> decide(const Viewpoint& camera);
  void tick() { simulation_->tick(); }

  const Simulation& simulation() const { return *simulation_; }
  Simulation& simulation() { return *simulation_; }

  /// Numbers of people awake, and of those seen.
  struct Count {
    std::size_t awake = 0, seen = 0;
  };
  Count count() const;
  /// Returns the person number of an entity.
  std::uint64_t number_of(Entity entity) const { return walkers_[slot_of_[entity.index]].number; }
  std::size_t people() const { return walkers_.size(); }
  /// Returns the people seen by the camera. `near` is true for people with muscles.
  std::vector<CrowdCamera::Drawn> seen() const;

  /// Saves the scene, and restores a saved one into an empty scene (mobil/systems/cluster/shard.h).
  Result<std::vector<std::byte>> save() const;
  Result<void> restore(std::span<const std::byte> saved);
  /// Returns the memory that the simulation has allocated for its people, bytes.
  std::size_t bytes_of_people() const { return memory_.lent(); }

 private:
  /// A person. All other properties are derived from the number.
  struct Walker {
    Entity entity{};
    std::uint32_t number = 0;
    float heading_rad = 0;  // requested
    std::uint16_t changes = 0;
    std::uint8_t draw = 0;
    bool stopped = false;
  };
  static constexpr std::size_t ring = 2048;  // maximum number of ticks until a change

  explicit AliveScene(const AliveRequest& request);
  Result<void> come(std::size_t first, std::size_t count);
  /// Returns the ring index of the tick of a person's next change.
  std::size_t next_due(std::uint32_t slot) const;
  WalkChange next_change(std::uint32_t slot);
  void keep_slot(std::uint32_t slot);

  AliveRequest request_;
  double side_m_ = 0;
  MeteredMemory memory_;
  Threads threads_;  // the simulation's, and the host's own
  std::unique_ptr<Simulation> simulation_;
  Viewpoint camera_;
  std::vector<Walker> walkers_;
  std::vector<std::uint32_t> slot_of_;                // by entity index
  std::array<std::vector<std::uint32_t>, ring> due_;  // slots
  std::vector<SpawnRequest> requests_;
  std::vector<Entity> entities_;
  std::vector<WalkChange> changes_;
  std::vector<std::size_t> next_due_;  // of each change
};

}  // namespace mobil
