#pragma once
// Muscles of people in any state: who is asleep or compact is whole first, and what level of detail remembers follows.
// As the members of Simulation of these names; all or nothing.

#include <mobil/engine/phase.h>
#include "systems/muscles/leg_muscles.h"

namespace mobil::inline v0_3 {

/// People are alive and named once each; messages without the call's name.
Result<void> set_muscles(const Frame& frame, std::span<const Entity> people, const std::optional<LegMuscles>& choice);
Result<void> set_method(const Frame& frame, std::span<const Entity> people, Muscle muscle, const MuscleMethod& method);
/// A name may come twice; `excitation` has a number for each.
Result<void> set_excitation(const Frame& frame, std::span<const Entity> people, Muscle muscle, Side side,
                            std::span<const float> excitation);
/// Method::none where the person has no such muscle.
MuscleMethod method_of(const World& world, Entity person, Muscle muscle);

}  // namespace mobil::inline v0_3
