#pragma once
// Walkers who slow down on slopes and stairs, and go on as they were asked to where it is level again.

#include <span>
#include <vector>

#include "engine/world.h"
#include "systems/people/person.h"

namespace mobil {

/// What those of `people` are to be asked for, in `changes`, whose pace is another than their steepness asks for
/// (Footing::slows_for; assets/gait/slope_pace.h). What they were asked to do on level ground is kept on their rows. Of
/// who avoids others (Course) nothing is asked: Avoidance slows what it wants.
void find_slowed(World& world, std::span<const Entity> people, std::vector<WalkChange>& changes);
/// Records the gaits that these walkers have now, after `Simulation::change_walks`. A gait that differs later is a new
/// request of the host.
void keep_slowed(World& world, std::span<const WalkChange> changes);

}  // namespace mobil
