#pragma once
// One person with body and muscles, as Simulation::person returns it.

#include <array>
#include <vector>

#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/leg_muscles.h>
#include <mobil/systems/muscles/muscle_ref.h>

namespace mobil::inline v0_3 {

/// One of a person's muscles, with its plan and its entities by side.
struct PersonMuscle {
  MusclePlan plan;
  std::array<Entity, 2> entity;
  MuscleMethod method;  // at present
};

/// A person's requests and all that follows from them.
struct Person {
  Entity entity;
  Body body;
  Gait<float> gait;                   // last request; zeros for posed people
  std::vector<PersonMuscle> muscles;  // in the order of the muscle table; empty without muscles
  LegMuscles leg_muscles;             // requested choice; meaningless without muscles
  bool posed = false;                 // the host animates the skeleton, and the person has no gait
};

}  // namespace mobil::inline v0_3
