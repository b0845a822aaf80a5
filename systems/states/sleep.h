#pragma once
// People fall asleep and wake with all that belongs to them: their muscles go, and begin again on waking.

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

/// What one of many is asked, nothing where that is refused; whether it is another speed, step or style than before;
/// whether they sleep, and must wake for it.
struct AskedWalk {
  std::optional<Gait<float>> gait;
  BodySize<float> size;
  bool walks_otherwise = false, asleep = false, must_wake = false;
};

/// Memory that falling asleep and waking work in, kept from one time to the next, and nothing of it state.
struct SleepWork {
  SleepWork();
  ~SleepWork();

  struct Group {
    const Sleeper* sleeper;
    std::uint32_t table;
    bool packed;
    std::optional<ComponentId> choice;  // what muscles are to be
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
  std::vector<std::uint64_t> owned;           // ids of the library's parts that no sleeper has, ascending
  std::vector<ComponentId> parts;             // of who wakes or falls asleep
  std::vector<std::uint64_t> all_but_choice;  // parts
  std::unique_ptr<WarmingRoom> warming;
  std::vector<AskedWalk> asked;
  std::vector<BodySize<float>> sizes;
  std::vector<Gait<float>> gaits;
  StyleLimitWork styles;
  std::vector<AskedSleeper> asked_sleepers;
  std::vector<Placing> ways;
};

/// What each of these, named once each, is to be asked, where that is possible, within the limits of walks: in
/// `work`; and who must wake for it.
void find_asked(const World& world, const Jobs& jobs, std::span<const WalkChange> changes, const SleepTime& now,
                SleepWork& work, std::vector<Entity>& must_wake);
/// Asks them, who are awake now where they must be. Returns how many cannot walk so, and go on as they were.
std::size_t ask_walks(World& world, const Jobs& jobs, std::span<const WalkChange> changes, const SleepTime& now,
                      SleepWork& work);

/// Walkers, named once each, fall asleep who may (mobil/systems/people/sleepers.h); who has muscles of several methods
/// may not, unless `managed`: they then begin again with the first one's. Of their parts that are among `owned` (ids,
/// sorted) they keep those of `keeps` alone. Returns how many fell asleep. Where memory runs out, nobody did, and what
/// `first` has done is undone, too. Errors: those of `first`.
Result<std::size_t> sleep_people(const MuscleScene& scene, std::span<const Entity> people, bool managed,
                                 std::span<const ComponentId> keeps, std::span<const std::uint64_t> owned,
                                 SleepWork& work, const std::function<Result<void>()>& first = {});
/// Sleepers, named once each, wake where they are, with `more` parts (wake_walkers), and have their forces again.
/// Muscles begin at rest where their person stands in the stride, or `later`: then what they are to be stays on the
/// person's row (kept_choice). Errors: what muscles are refused for; those concerned are awake then, and have none.
/// `then` hears of those whose muscles have begun, choice by choice.
enum class WakingMuscles : std::uint8_t { now, later };
struct Waking {
  WakingMuscles muscles = WakingMuscles::now;
  Woken as = Woken::full_detail;  // compact only with muscles later
};
using MusclesBegun = std::function<void(std::span<const Entity> people, const LegMuscles& choice)>;
Result<void> wake_people(const MuscleScene& scene, std::span<const Entity> people, const Waking& waking,
                         std::span<const ComponentId> more, std::span<const std::uint64_t> owned, SleepWork& work,
                         const MusclesBegun& then = {});
/// What the muscles of a sleeper, or of somebody who woke without them, are to be; nothing where there are none to
/// come, or they are there already.
std::optional<LegMuscles> kept_choice(const World& world, Entity person);
/// Whether a person has muscles, compact ones and those to come included.
bool has_any_muscles(const World& world, Entity person);

}  // namespace mobil::inline v0_3
