#pragma once
// Falling asleep and waking of people with all that belongs to them. Muscles are removed, and restart on waking.

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <mobil/components/muscle.h>
#include <mobil/engine/error.h>
#include <mobil/engine/world.h>
#include <mobil/systems/limits/style_limits.h>
#include <mobil/systems/people/sleepers.h>
#include "systems/muscles/leg_muscles.h"
#include "systems/states/waking.h"

namespace mobil::inline v0_3 {

class WarmingRoom;  // systems/states/warm_muscles.h

/// Request to one of many walkers. `gait` is empty if refused. `walks_otherwise`: speed, step or style changes.
/// `must_wake`: the sleeper must wake for the request.
struct AskedWalk {
  std::optional<Gait<float>> gait;
  BodySize<float> size;
  bool walks_otherwise = false, asleep = false, must_wake = false;
};

/// Scratch memory of falling asleep and waking, reused between calls; none of it is state.
struct SleepWork {
  SleepWork();
  ~SleepWork();

  struct Group {
    const Sleeper* sleeper;
    std::uint32_t table;
    bool packed;
    std::optional<ComponentId> choice;  // of muscles on waking
  };

  WakingWork waking;
  FallingAsleep falling;
  std::vector<Group> groups;
  std::vector<const Sleeper*> together;
  std::vector<Sleeper> sleepers;
  struct Sleeping {
    Entity entity;
    const LegMuscles* choice;
    bool forces, watched, fat;
  };
  std::vector<Sleeping> waking_people;
  std::vector<Entity> rows, restless, asleep, managed, alike;
  UnsettledTables unsettled;
  std::vector<std::uint64_t> owned;           // ids of the library's components that no sleeper has, ascending
  std::vector<ComponentId> parts;             // of people who wake or fall asleep
  std::vector<std::uint64_t> all_but_choice;  // `owned` without LegMuscles
  std::unique_ptr<WarmingRoom> warming;
  std::vector<AskedWalk> asked;
  std::vector<BodySize<float>> sizes;
  std::vector<Gait<float>> gaits;
  StyleLimitWork styles;
  std::vector<AskedSleeper> asked_sleepers;
  std::vector<Placing> ways;
};

/// Computes the requested gait of each walker, named once, within the limits of walks, into `work`. Lists sleepers who
/// must wake for their request.
void find_asked(const World& world, const Jobs& jobs, std::span<const WalkChange> changes, const SleepTime& now,
                SleepWork& work, std::vector<Entity>& must_wake);
/// Applies the requests after waking. Returns the number of walkers whose request is refused; they continue unchanged.
std::size_t ask_walks(World& world, const Jobs& jobs, std::span<const WalkChange> changes, const SleepTime& now,
                      SleepWork& work);

/// Puts walkers, named once each, to sleep where possible (mobil/systems/people/sleepers.h). Walkers with muscles of
/// several methods stay awake unless `managed`; muscles then restart with the first one's method. Sleepers keep only
/// `keeps` of the components in `owned` (ids, sorted). Returns the number of new sleepers. If memory runs out, no
/// walker sleeps, and the changes by `first` are undone. Errors: those of `first`.
Result<std::size_t> sleep_people(const MuscleScene& scene, std::span<const Entity> people, bool managed,
                                 std::span<const ComponentId> keeps, std::span<const std::uint64_t> owned,
                                 SleepWork& work, const std::function<Result<void>()>& first = {});
/// Wakes sleepers, named once each, at their current places, with `more` components (wake_walkers) and their forces.
/// Muscles start at rest in the current pose, or `later`: then their choice stays on the person's row (kept_choice).
/// Errors: those with which muscles are refused; the people concerned are awake then, without muscles. Calls `then`
/// with people whose muscles have started, choice by choice.
enum class WakingMuscles : std::uint8_t { now, later };
struct Waking {
  WakingMuscles muscles = WakingMuscles::now;
  Woken as = Woken::full_detail;  // compact only with muscles later
};
using MusclesBegun = std::function<void(std::span<const Entity> people, const LegMuscles& choice)>;
Result<void> wake_people(const MuscleScene& scene, std::span<const Entity> people, const Waking& waking,
                         std::span<const ComponentId> more, std::span<const std::uint64_t> owned, SleepWork& work,
                         const MusclesBegun& then = {});
/// Returns the choice kept for a sleeper's muscles, or for those of a person who woke without them. Returns nothing
/// without a kept choice, or if the muscles exist.
std::optional<LegMuscles> kept_choice(const World& world, Entity person);
/// Returns true if a person has muscles, including compact ones and those kept for later.
bool has_any_muscles(const World& world, Entity person);

}  // namespace mobil::inline v0_3
