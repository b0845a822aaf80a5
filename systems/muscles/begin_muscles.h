#pragma once
// Creation of muscles, on one person or on many at once, sixteen to a block.

#include <cstddef>
#include <cstdint>
#include <span>
#include <tl/expected.hpp>
#include <vector>

#include <mobil/components/leg_frames.h>
#include <mobil/components/muscle.h>
#include <mobil/engine/error.h>
#include <mobil/engine/jobs.h>
#include <mobil/engine/world.h>
#include "systems/bellies/belly_library.h"
#include "systems/muscles/muscle_size.h"
#include "systems/people/spawn.h"

namespace mobil::inline v0_3 {

/// Number of the current tick, and its length.
struct MuscleTime {
  std::uint32_t tick;
  double tick_s;
};

/// Creates the muscles of a valid choice for people in the world who have none of them. Bellies start at rest in the
/// current pose, with inertia under the current load. `size` has an entry for each chosen muscle in the table's order,
/// person by person. Appends entities to `made`, which must have room; after an error, or if memory runs out, the
/// caller undoes them. Errors: a fixed step above an individual's critical step; the message names muscle and limit.
tl::expected<void, NotMade> begin_muscles(World& world, BellyLibrary& library, const LegMuscles& choice,
                                          const MuscleTime& time, const Jobs& jobs, std::span<const Entity> people,
                                          std::span<const MuscleSize> size, std::vector<Entity>& made);

}  // namespace mobil::inline v0_3
