#pragma once
// Waking of sleepers, and components of a walker's row as if its sleeper were awake.

#include <cstdint>
#include <memory>
#include <span>

#include <mobil/engine/jobs.h>
#include <mobil/engine/world.h>
#include <mobil/systems/people/sleepers.h>
#include "systems/people/person_requests.h"

namespace mobil::inline v0_3 {

/// Scratch memory of waking, reused between calls.
struct WakingWork {
  WakingWork();
  ~WakingWork();
  struct Blocks;
  std::unique_ptr<Blocks> blocks;
};
/// State after waking: with a pose, or without (mobil/components/compact.h).
enum class Woken : std::uint8_t { full_detail, compact };
/// Makes sleepers walkers at their places at that tick, with `more` components, which are zero unless sleepers kept
/// them. Each is alive, asleep, and named once.
void wake_walkers(World& world, const Jobs& jobs, std::span<const Entity> people, Woken as, const SleepTime& time,
                  std::span<const ComponentId> more, std::span<const std::uint64_t> owned, WakingWork& work);

/// Creates these steady walkers in another world, in their state at tick `then`.
void create_steady(World& to, const Jobs& jobs, std::span<const Sleeper> walkers, const SleepTime& then,
                   std::span<Entity> entities, WakingWork& work);

/// Return the way of a sleeper to a new place, and move the sleeper by it. The walker who wakes there equals one who
/// was placed awake: bit-exactly, or within rounding during a turn, a stop or a change of speed. `place_sleeper`
/// allocates no memory.
Placing way_of_sleeper(const World& world, const SleepTime& time, const PlaceRequest& to);
void place_sleeper(World& world, Entity person, const SleepTime& time, const Placing& way);

/// Computes a component of a sleeper's row as if awake into `row`, which has its type: Gait, GaitState, StepPlan,
/// BodySize, Physique, Pose, JointAngles, Feet or CentreOfMass. Returns Status::missing for others, or if awake.
Status read_asleep(const World& world, Entity person, const SleepTime& time, std::uint64_t part, void* row);

}  // namespace mobil::inline v0_3
