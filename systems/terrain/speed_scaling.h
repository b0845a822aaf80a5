#pragma once
// Speed scaling: walkers slow down on slopes and stairs, and return to the requested walk on level ground.

#include <optional>
#include <span>
#include <vector>

#include <mobil/engine/jobs.h>
#include <mobil/engine/world.h>
#include <mobil/systems/limits/style_limits.h>
#include "assets/gait/slope_pace.h"
#include "systems/people/person_requests.h"

namespace mobil::inline v0_3 {

/// Requests that result from walkers' slopes, and scratch memory to find them, kept between calls.
struct SpeedScaling {
  struct One {
    WalkChange change;
    LevelWalk level;
    Gait<float> before;
    bool has_style;  // its style is checked
  };
  std::vector<One> people;
  std::vector<WalkChange> changes;  // one for each of them
  std::vector<BodySize<float>> sizes;
  std::vector<Gait<float>> gaits;
  StyleLimitWork styles;

  /// Reserves memory for this many people.
  void reserve(std::size_t count) {
    people.reserve(count), changes.reserve(count), sizes.reserve(count), gaits.reserve(count);
  }
};

/// Writes to `to.changes` the requests for those of `people` whose pace differs from that for their steepness
/// (Footing::slows_for; assets/gait/slope_pace.h). Walkers who would need another style at the slower pace are not
/// slowed. Walkers who avoid others (AvoidanceState) are skipped, because Avoidance scales their desired speed. Steps
/// of usual length become those of the slower speed, and longer ones shorten by as much. Shorter ones, as on stair
/// treads, keep their length but become no longer than usual. Marks all who were checked (Footing::looked_at).
/// `steepness` replaces each person's own; then no person is skipped.
void find_slowed(World& world, const Jobs& jobs, std::span<const Entity> people, SpeedScaling& to,
                 std::optional<float> steepness = {});
/// Records, after `change_walks(frame, to.changes)`, the requests of these walkers for level ground.
void keep_slowed(World& world, const SpeedScaling& to);

}  // namespace mobil::inline v0_3
