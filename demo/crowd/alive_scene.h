#pragma once
// Very many people who are alive, of whom a camera sees some: who is too far away to be seen soon sleeps. The camera
// flies, turns, and cuts to another place; people turn, stop and go on, asleep or awake.

#include <mobil/engine/jobs.h>
#include "demo/crowd/crowd_picture.h"

namespace mobil {

struct AliveRequest {
  std::size_t alive = 1'000'000, in_view = 10'000;
  int threads = 0;
  std::uint64_t seed = 1;
  double cut_every_s = 10;
  bool muscles = true;
  std::filesystem::path baked{};  // of `mobil bake`; empty: made here
  /// Of a crowd on several ranks: as in a CrowdRequest.
  std::uint32_t shard = 0, shards = 1;
  const Simulation* library = nullptr;
};

/// What such a camera sees, as a picture has it.
Camera picture_from(const Viewpoint& camera);
/// The side of the square that they live on, m.
double side_of(const AliveRequest& request);
/// From a place of its own after each cut: ahead, and turning to and fro.
Viewpoint fly(const AliveRequest& request, std::uint32_t tick, double tick_s);

class AliveScene {
 public:
  /// With nobody in it; and then with everybody, asleep. Errors: what the simulation refuses.
  static Result<std::unique_ptr<AliveScene>> make_empty(const AliveRequest& request);
  Result<void> populate();
  AliveScene(const AliveScene&) = delete;
  AliveScene& operator=(const AliveScene&) = delete;

  /// The parts of a tick: what people do next and where the camera is; who wakes, who falls asleep, which methods; the
  /// simulation. Returns how many were asked for something.
  Result<std::size_t> decide(const Viewpoint& camera);
  LodReport choose();
  void tick() { simulation_->tick(); }

  const Simulation& simulation() const { return *simulation_; }
  Simulation& simulation() { return *simulation_; }

  /// Who is awake, and of them who is seen.
  struct Count {
    std::size_t awake = 0, seen = 0;
  };
  Count count() const;
  /// Person number of an entity.
  std::uint64_t number_of(Entity entity) const { return walkers_[slot_of_[entity.index]].number; }
  std::size_t people() const { return walkers_.size(); }
  /// Whom the camera sees; near is who has muscles.
  std::vector<CrowdCamera::Drawn> seen() const;

  /// All of it as bytes, and an empty one made of them (mobil/systems/cluster/shard.h).
  Result<std::vector<std::byte>> save() const;
  Result<void> restore(std::span<const std::byte> saved);
  /// What the simulation holds in memory of its people.
  std::size_t bytes_of_people() const { return memory_.lent(); }

 private:
  /// One who lives; all else is drawn from the number.
  struct Walker {
    Entity entity{};
    std::uint32_t number = 0;
    float heading_rad = 0;  // asked for
    std::uint16_t changes = 0;
    std::uint8_t draw = 0;
    bool stopped = false;
  };
  static constexpr std::size_t ring = 2048;  // ticks ahead that a change may lie

  explicit AliveScene(const AliveRequest& request);
  Result<void> come(std::size_t first, std::size_t count);
  /// In which of the ring's ticks somebody's next change comes.
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
  std::vector<std::size_t> next_due_;  // of each of them
};

}  // namespace mobil
