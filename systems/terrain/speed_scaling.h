#pragma once
// Walkers who slow down on slopes and stairs, and go on as they were asked to where it is level again.

#include <optional>
#include <span>
#include <vector>

#include <mobil/engine/jobs.h>
#include <mobil/engine/world.h>
#include <mobil/systems/limits/style_limits.h>
#include <mobil/systems/people/person_requests.h>
#include "assets/gait/slope_pace.h"

namespace mobil::inline v0_3 {

/// What walkers are asked for because of their slopes, and what finding that works in, kept from one time to the next.
struct Slowing {
  struct One {
    WalkChange change;
    LevelWalk level;
    Gait<float> before;
    bool has_style;  // that is looked at
  };
  std::vector<One> people;
  std::vector<WalkChange> changes;  // of each of them
  std::vector<BodySize<float>> sizes;
  std::vector<Gait<float>> gaits;
  StyleLimitWork styles;

  /// Takes memory for so many.
  void reserve(std::size_t count) {
    people.reserve(count), changes.reserve(count), sizes.reserve(count), gaits.reserve(count);
  }
};

/// Finds, in `to.changes`, what those of `people` are to be asked for whose pace is another than their steepness asks
/// for (Footing::slows_for; assets/gait/slope_pace.h). Who would have to walk in another style at the slower pace is
/// not slowed. Who avoids others (AvoidanceState) is left out: Avoidance slows what it wants. Steps of usual length
/// become those of the slower speed and longer ones shorten as much; shorter ones stay as they are, as on the treads of
/// stairs, but become no longer than usual. All that were looked at are marked (Footing::looked_at). `steepness`: of
/// all, instead of each one's own; then nobody is left out.
void find_slowed(World& world, const Jobs& jobs, std::span<const Entity> people, Slowing& to,
                 std::optional<float> steepness = {});
/// Records, after `change_walks(frame, to.changes)`, what these walkers were asked to do on level ground.
void keep_slowed(World& world, const Slowing& to);

}  // namespace mobil::inline v0_3
