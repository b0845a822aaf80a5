#pragma once
// A shard controlled by commands. Each person has a number that the first rank's host assigns.

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include <mobil/lod.h>
#include <mobil/simulation.h>
#include <mobil/systems/cluster/shard.h>

namespace mobil::inline v0_3 {

/// Kind of a command. `come` spawns a person with a body, position and speed; `go` removes one; `walk` sets a speed, 0
/// to stop; `turn` sets a heading; `place` moves a person at once. `look` sets the camera of all shards and ignores its
/// number.
enum class Wish : std::uint32_t { come, go, walk, turn, place, look };

/// One command as it is sent. The functions below make it and name its values (m, rad about +Y, m/s).
struct PersonCommand {
  std::uint64_t number = 0;
  Wish wish = Wish::come;
  std::uint32_t spare = 0;
  std::array<float, 12> value{};
};
PersonCommand come(std::uint64_t number, const BodyRequest& body, float speed_m_s, float x_m, float z_m,
                   float heading_rad);
PersonCommand go(std::uint64_t number);
PersonCommand walk(std::uint64_t number, float speed_m_s);
PersonCommand turn(std::uint64_t number, float heading_rad);
PersonCommand place(std::uint64_t number, float x_m, float z_m, float heading_rad);
/// `asleep_beyond_m` is that of LodScene; 0 leaves it unset.
PersonCommand look(const Viewpoint& camera, float tolerance_px, float asleep_beyond_m);

/// Options of all shards of a crowd.
struct PeopleShardOptions {
  std::uint32_t shards = 16;  // of the crowd
  /// Options of each simulation. All shards of a rank should share a `library_of` that outlives them.
  SimulationOptions simulation{};
  /// Muscles of all people. If unset, people have no muscles, and level of detail is not used.
  std::optional<LegMuscles> muscles{};
  LodScene scene{};  // until the first `look`
};

class PeopleShard : public Shard {
 public:
  /// Throws std::invalid_argument if options.simulation or options.scene is out of range.
  PeopleShard(std::uint32_t shard, const PeopleShardOptions& options);
  PeopleShard(const PeopleShard&) = delete;
  PeopleShard& operator=(const PeopleShard&) = delete;

  /// Does nothing, because all people are spawned by commands.
  Result<void> populate() override { return {}; }
  std::uint32_t ticks() const override { return simulation_.ticks(); }
  /// Executes PersonCommands in their order. Commands that cannot be executed are counted as refused: an existing or
  /// unknown number, a body or a walk out of range, an unknown kind. Errors: bytes that are not a whole number of
  /// commands.
  Result<void> apply(std::span<const std::byte> commands) override;
  void tick() override;
  std::uint64_t state_sum() const override;
  Result<std::vector<std::byte>> save() const override;
  Result<void> restore(std::span<const std::byte> saved) override;

  /// Returns the person with that number; a stale handle if this shard has no such person.
  Entity find(std::uint64_t number) const;
  /// People of this shard by number.
  const std::map<std::uint64_t, Entity>& people() const { return people_; }
  /// Number of refused commands so far.
  std::uint64_t refused() const { return refused_; }
  const Simulation& simulation() const { return simulation_; }

 private:
  bool obey(const PersonCommand& command);
  bool obey_come(const PersonCommand& command);
  bool obey_look(const PersonCommand& command);

  std::uint32_t shard_;
  PeopleShardOptions options_;
  Simulation simulation_;
  std::map<std::uint64_t, Entity> people_;
  std::optional<PersonCommand> looked_;  // the last executed `look`
  std::uint64_t refused_ = 0;
};

}  // namespace mobil::inline v0_3
