#pragma once
// Muscles that begin on many people at once, sixteen to a block. Part of the front door (systems/simulation.h).

#include <cstddef>
#include <span>
#include <tl/expected.hpp>
#include <vector>

#include "components/leg_frames.h"
#include "components/muscle.h"
#include "engine/error.h"
#include "engine/jobs.h"
#include "engine/world.h"
#include "systems/muscles/simulation_muscles.h"
#include "systems/people/simulation_people.h"

namespace mobil {

/// `work(begin, end)` on parts of [0, count), by jobs.
template <class Work>
void in_parallel(const Jobs& jobs, std::size_t count, Work work) {
  if (count == 0) return;
  if (count == 1) return work(std::size_t{0}, std::size_t{1});
  jobs.parallel_for(
      jobs.user, count,
      [](void* context, std::size_t begin, std::size_t end) { (*static_cast<Work*>(context))(begin, end); }, &work);
}

/// Of a person's muscle what its rows say of its size.
struct MuscleSize {
  BellyScale<float> scale{};
  LegScale<float> leg_scale{};
  float rest_length_m = 0;
};
MuscleSize size_of(const MusclePlan& plan);

/// Whether muscles of that choice begin together: lines alone, and reduced bellies that feel nothing of their frames'
/// motion.
bool begin_together(const LegMuscles& choice);

/// What could not be made, and of which of the people.
struct NotMade {
  std::size_t person = 0;
  Error error;
};

/// People of one choice (checked, of those that begin together) who are in the world and have no muscles. `size` and
/// `own`: one of each muscle chosen, in the table's order, person after person. Entities are appended to `made` as they
/// come, for which there is room: after an error, or when memory runs out, the caller undoes them.
tl::expected<void, NotMade> begin_muscles(World& world, BellyLibrary& library, const LegMuscles& choice, float tick_s,
                                          const Jobs& jobs, std::span<const Entity> people,
                                          std::span<const MuscleSize> size, std::span<OwnMuscle> own,
                                          std::vector<Entity>& made);

}  // namespace mobil
