#pragma once
// Walkers who slow down on slopes and stairs, and go on as they were asked to where it is level again.

#include <span>
#include <vector>

#include "engine/world.h"
#include "systems/simulation.h"

namespace mobil {

/// Those of `people` whose pace is another than their steepness asks for (Footing::slows_for; assets/gait/slope_pace.h)
/// are asked to change it from the next step on; what they were asked to do on level ground is kept on their rows. Of
/// who avoids others (Course) nothing is asked: Avoidance slows what it wants. `changes` is what this works in.
void slow_down(Simulation& simulation, std::span<const Entity> people, std::vector<WalkChange>& changes);

}  // namespace mobil
