#pragma once
// Muscles that begin, on one person or on many at once, sixteen to a block.

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
#include <mobil/systems/people/spawn.h>
#include "systems/bellies/belly_library.h"
#include "systems/muscles/muscle_size.h"

namespace mobil::inline v0_3 {

/// The present tick, and what muscles share.
struct MuscleTime {
  std::uint32_t tick;
  double tick_s;
};

/// Muscles of a choice in range begin on people who are in the world and have none of them, at rest where these stand
/// (with inertia under the load of that moment). `size`: of each muscle chosen, in the table's order, person after
/// person. Entities are appended to `made` as they come, for which there is room:
/// after an error, or when memory runs out, the caller undoes them. Errors: a fixed step above an individual's critical
/// step, which names the muscle and the limit.
tl::expected<void, NotMade> begin_muscles(World& world, BellyLibrary& library, const LegMuscles& choice,
                                          const MuscleTime& time, const Jobs& jobs, std::span<const Entity> people,
                                          std::span<const MuscleSize> size, std::vector<Entity>& made);

}  // namespace mobil::inline v0_3
