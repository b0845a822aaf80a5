#pragma once
// One muscle's belly: shared data and its own.

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

/// Data shared by all people whose muscles of a kind differ only in size.
struct BellyTemplate {
  LegMuscles choice;
  Muscle muscle{};
  std::shared_ptr<const MuscleTemplate> shape;
  std::shared_ptr<const MuscleLines> lines;
  AxialStiffness axial;
  StaticStretch stretch;                      // for the template's own size
  std::shared_ptr<const FiniteShape> finite;  // built on first request
};

/// Data shared by muscles of one choice and about one size. Muscles with equal data share a table.
struct SharedBelly {
  const BellyTemplate* shape = nullptr;
  std::uint32_t steps = 1;                     // per tick
  std::shared_ptr<const BellySolver> solver;   // for ICD, CAA and static
  std::shared_ptr<const BellySolver> resting;  // for the first shape of a belly with inertia; otherwise null
  std::shared_ptr<const ModalBasis> basis;     // for modal
  std::shared_ptr<const FiniteShape> finite;   // for shown finite strain, or stepped finite strain with activation

  friend bool operator==(const SharedBelly&, const SharedBelly&) = default;
};

/// The belly of one muscle of one person.
struct Belly : SharedBelly {
  MusclePlan plan;
  std::shared_ptr<const ModalBelly> motions;  // for modal: this body's own
  std::vector<float> motion, rest_shape;      // and its rows, ModalMotion and ModalShape
};

}  // namespace mobil::inline v0_3
