#pragma once
// One person with body and muscles, as Simulation::person makes it.

#include <array>
#include <vector>

#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/leg_muscles.h>
#include <mobil/systems/muscles/muscle_ref.h>

namespace mobil::inline v0_3 {

/// One of a person's muscles, by side, with its plan.
struct PersonMuscle {
  MusclePlan plan;
  std::array<Entity, 2> entity;
  MuscleMethod method;  // as it is
};

/// One person with all that follows from what was asked for.
struct Person {
  Entity entity;
  Body body;
  Gait<float> gait;                   // as last asked for; zeros of posed people
  std::vector<PersonMuscle> muscles;  // in the table's order; empty without muscles
  LegMuscles leg_muscles;             // as asked for; means nothing without muscles
  bool posed = false;                 // its host animates the skeleton: no gait
};

}  // namespace mobil::inline v0_3
