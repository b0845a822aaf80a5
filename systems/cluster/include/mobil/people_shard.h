#pragma once
// A shard whose people come, walk and go by commands, each person named by a number that the first rank's host gives.

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include <mobil/lod.h>
#include <mobil/simulation.h>
#include <mobil/systems/cluster/shard.h>

namespace mobil::inline v0_3 {

/// `come`: a person of that body begins to walk there; `go` leaves; `walk`: another speed, 0 to stop; `turn` to a
/// heading; `place` elsewhere at once; `look` moves the camera of all shards, and its number means
/// nothing.
enum class Wish : std::uint32_t { come, go, walk, turn, place, look };

/// One wish, as it travels. Made by the functions below, which say what the values are.
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
/// `asleep_beyond_m`: as LodScene has it; 0: nobody sleeps from then on.
PersonCommand look(const Viewpoint& camera, float tolerance_px, float asleep_beyond_m);

/// What all shards of a crowd share.
struct PeopleShardOptions {
  std::uint32_t shards = 16;  // of the crowd
  /// Of the simulation; give all shards of a rank one library (`library_of`), of a simulation that outlives them.
  SimulationOptions simulation{};
  /// Of everybody who comes; left out: they have none, and nothing is chosen.
  std::optional<LegMuscles> muscles{};
  LodScene scene{};  // until the first `look`
};

class PeopleShard : public Shard {
 public:
  /// Throws std::invalid_argument where options.simulation or options.scene is out of range.
  PeopleShard(std::uint32_t shard, const PeopleShardOptions& options);
  PeopleShard(const PeopleShard&) = delete;
  PeopleShard& operator=(const PeopleShard&) = delete;

  /// Nobody: all come by commands.
  Result<void> populate() override { return {}; }
  std::uint32_t ticks() const override { return simulation_.ticks(); }
  /// PersonCommands one after the other; they are obeyed in their order. A wish that cannot be fulfilled (a number that
  /// is there already or is not, a body or a walk out of range, an unknown wish) is counted as refused. Errors: bytes
  /// that are no whole number of commands.
  Result<void> apply(std::span<const std::byte> commands) override;
  void tick() override;
  std::uint64_t state_sum() const override;
  Result<std::vector<std::byte>> save() const override;
  Result<void> restore(std::span<const std::byte> saved) override;

  /// A stale handle where nobody here has that number.
  Entity find(std::uint64_t number) const;
  /// The people of this shard by their numbers.
  const std::map<std::uint64_t, Entity>& people() const { return people_; }
  /// Wishes that could not be fulfilled so far.
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
  std::optional<PersonCommand> looked_;  // the last one obeyed
  std::uint64_t refused_ = 0;
};

}  // namespace mobil::inline v0_3
