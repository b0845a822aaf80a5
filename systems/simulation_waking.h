#pragma once
// Waking in the simulation: sleepers come back with their muscles, and those whom level of detail manages as it needs
// them.

#include <span>

#include <mobil/engine/phase.h>
#include "systems/muscles/sleep.h"

namespace mobil::inline v0_3 {

/// A tick's frame as the scene that changes of muscles take. MuscleMeans must be in the workspace.
MuscleScene scene_of(const Frame& frame);

/// As Simulation::wake. People are alive and named once each; those awake are left alone.
Result<void> wake(const MuscleScene& scene, Workspace& workspace, std::span<const Entity> people,
                  float within_m = 0.005F);
/// Managed sleepers wake, named once each, without muscles; level of detail decides about them from then on.
Result<void> wake_managed(const MuscleScene& scene, SleepWork& work, std::span<const Entity> people, Woken as);
/// Muscles that have just begun get within `within_m` of where they would be (Simulation::wake).
void warm_muscles(const MuscleScene& scene, Workspace& workspace, std::span<const Entity> people,
                  const LegMuscles& choice, float within_m);

/// After the systems: sleepers who have finished a change are steady again; those who cannot be steady wake.
Phase settled_walkers();

}  // namespace mobil::inline v0_3
