#pragma once
// Calls for muscles of people in any state, as declared in Simulation; each changes all people or none. Sleepers and
// compact people become full first, and the state of level of detail is updated.

#include <mobil/engine/phase.h>
#include "systems/muscles/leg_muscles.h"

namespace mobil::inline v0_3 {

/// People must be alive and named once each. Messages lack the call's name.
Result<void> set_muscles(const Frame& frame, std::span<const Entity> people, const std::optional<LegMuscles>& choice);
Result<void> set_method(const Frame& frame, std::span<const Entity> people, Muscle muscle, const MuscleMethod& method);
/// A person can be named twice; `excitation` has a number for each entry.
Result<void> set_excitation(const Frame& frame, std::span<const Entity> people, Muscle muscle, Side side,
                            std::span<const float> excitation);
/// Returns the method of a person's muscle; Method::none if the person does not have it.
MuscleMethod method_of(const World& world, Entity person, Muscle muscle);

}  // namespace mobil::inline v0_3
