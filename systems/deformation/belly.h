#pragma once
// One muscle's belly: what it shares with others, and what is its own.

#include <cstdint>
#include <memory>
#include <vector>

#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/components/leg_muscles.h>
#include "assets/fem/axial_stiffness.h"
#include "assets/fem/belly_solver.h"
#include "assets/fem/muscle_template.h"
#include "assets/finite/finite_shape.h"
#include "assets/reduction/modal_basis.h"
#include "assets/reduction/modal_belly.h"

namespace mobil::inline v0_3 {

struct MuscleLines;  // systems/lines/muscle_lines.h

/// What all people share whose muscles of a kind are alike but for size.
struct BellyTemplate {
  LegMuscles choice;
  Muscle muscle{};
  std::shared_ptr<const MuscleTemplate> shape;
  std::shared_ptr<const MuscleLines> lines;
  AxialStiffness axial;
  StaticStretch stretch;                      // of the template's own size
  std::shared_ptr<const FiniteShape> finite;  // made when first asked for
};

/// What muscles of one choice and about one size share. Those of alike ones share a table.
struct SharedBelly {
  const BellyTemplate* shape = nullptr;
  std::uint32_t steps = 1;                     // a tick
  std::shared_ptr<const BellySolver> solver;   // of ICD, CAA and static
  std::shared_ptr<const BellySolver> resting;  // of the shape that a belly with inertia begins with; else null
  std::shared_ptr<const ModalBasis> basis;     // of modal
  std::shared_ptr<const FiniteShape> finite;   // of who shows finite strain, or steps it and pulls

  friend bool operator==(const SharedBelly&, const SharedBelly&) = default;
};

/// One muscle of one person.
struct Belly : SharedBelly {
  MusclePlan plan;
  std::shared_ptr<const ModalBelly> motions;  // of modal: this body's own
  std::vector<float> motion, rest_shape;      // and its rows, ModalMotion and ModalShape
};

}  // namespace mobil::inline v0_3
