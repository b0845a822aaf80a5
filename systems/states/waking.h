#pragma once
// Sleepers who are walkers again, and what a walker's row would be if its sleeper were awake.

#include <cstdint>
#include <memory>
#include <span>

#include <mobil/engine/jobs.h>
#include <mobil/engine/world.h>
#include <mobil/systems/people/person_requests.h>
#include <mobil/systems/people/sleepers.h>

namespace mobil::inline v0_3 {

/// Memory that waking works in, kept from one time to the next.
struct WakingWork {
  WakingWork();
  ~WakingWork();
  struct Blocks;
  std::unique_ptr<Blocks> blocks;
};
/// As which they wake: with a pose, or without (mobil/components/compact.h).
enum class Woken : std::uint8_t { full_detail, compact };
/// Sleepers become walkers where they are at that tick, with `more` parts: of zeros, where they did not keep them. Each
/// is alive, asleep, and named once.
void wake_walkers(World& world, const Jobs& jobs, std::span<const Entity> people, Woken as, const SleepTime& time,
                  std::span<const ComponentId> more, std::span<const std::uint64_t> owned, WakingWork& work);

/// The same steady walkers, as they were at that tick, as people of another world.
void create_steady(World& to, const Jobs& jobs, std::span<const Sleeper> walkers, const SleepTime& then,
                   std::span<Entity> entities, WakingWork& work);

/// The way of a sleeper who is put elsewhere, and then to go it: what is woken there is who was awake and put there, to
/// the bit; who turns, stops or changes speed at the time is so within rounding. `place_sleeper` takes no memory.
Placing way_of_sleeper(const World& world, const SleepTime& time, const PlaceRequest& to);
void place_sleeper(World& world, Entity person, const SleepTime& time, const Placing& way);

/// A part of a walker's row as it would be if nobody had slept: Gait, GaitState, StepPlan, BodySize, Physique, Pose,
/// JointAngles, Feet or CentreOfMass, `row` being one of them. Status::missing where there is no such part or nobody
/// is asleep.
Status read_asleep(const World& world, Entity person, const SleepTime& time, std::uint64_t part, void* row);

}  // namespace mobil::inline v0_3
