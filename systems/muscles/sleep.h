#pragma once
// People fall asleep and wake with all that belongs to them: their muscles go, and begin again on waking.

#include <span>
#include <vector>

#include "components/muscle.h"
#include "engine/error.h"
#include "engine/world.h"
#include "systems/muscles/leg_muscles.h"
#include "systems/people/sleepers.h"

namespace mobil {

/// Memory that falling asleep and waking work in, kept from one time to the next, and nothing of it state.
struct SleepWork {
  WakingWork waking;
  std::vector<Sleeper> sleepers;
  std::vector<Entity> rows, restless;
  std::vector<std::uint64_t> keeps;  // ids of parts
};

/// Walkers, named once each, fall asleep who may (systems/people/sleepers.h); who has muscles of several methods may
/// not, unless `managed`: they then begin again with the first one's. Of their parts that are among `owned` (ids,
/// sorted) they keep those of `keeps` alone. Returns how many sleep now.
std::size_t sleep_people(const MuscleScene& scene, std::span<const Entity> people, bool managed,
                         std::span<const KeyPart> keeps, std::span<const std::uint64_t> owned, SleepWork& work);
/// Sleepers, named once each, wake where they are; their forces, and muscles at rest where they stand in the stride.
/// Errors: what muscles are refused for; those concerned are awake then, and have none.
Result<void> wake_people(const MuscleScene& scene, std::span<const Entity> people, std::span<const std::uint64_t> owned,
                         SleepWork& work);
/// What a sleeper's muscles are to be; nothing where there are none.
std::optional<LegMuscles> sleeper_choice(const World& world, Entity person);

}  // namespace mobil
