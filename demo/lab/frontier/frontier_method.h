#pragma once
// A way to deform a muscle, made ready for sixteen individuals; for `mobil frontier`.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <mobil/components/lanes.h>
#include <mobil/engine/error.h>
#include "assets/fem/belly_solver.h"
#include "assets/fem/muscle_template.h"
#include "assets/reduction/reduced_basis.h"
#include "demo/lab/frontier/frontier_walks.h"
#include "systems/muscles/belly_library.h"

namespace mobil {

inline constexpr Cells frontier_points = {2, 2, 8};  // the control points: this mesh's nodes
inline constexpr std::size_t point_width = nodal_width(frontier_points);

/// `fixed_step`: steps of just choice.dt_s, however ticks fall, instead of equal parts of a tick; answers are compared
/// where both meet. `even_steps`: everybody takes the steps of who needs most. The choice's muscles and inertia are not
/// read.
struct FrontierMethod {
  LegMuscles choice;
  bool fixed_step = false, even_steps = false;

  bool reduced() const { return choice.method == Method::reduced; }
  bool moving() const { return !reduced() || choice.reduced.moving; }
  /// Of the mesh that the answer is of.
  const Cells& cells() const { return reduced() ? choice.reduced.cells : choice.cells; }
};

/// What one individual is stepped with. Finite elements have `steps` a tick, and those that solve a solver; the others
/// a basis and their own numbers.
struct FrontierIndividual {
  std::shared_ptr<const MuscleTemplate> shape;
  std::uint32_t steps = 1;
  std::shared_ptr<const BellySolver> solver;
  std::shared_ptr<const ReducedBasis> basis;
  std::vector<float> motion, points;

  bool alike(const FrontierIndividual& other) const {
    return shape == other.shape && steps == other.steps && solver == other.solver && basis == other.basis;
  }
};

/// Makes `own` move along those vectors, with that body's motions.
void set_vectors(FrontierIndividual& own, std::shared_ptr<const ReducedBasis> basis, const ReducedBelly& belly,
                 double damping_per_s);

/// The drive's sixteen, set up as people's muscles are. `loads`: for the frame's too. Fails on a choice out of range,
/// or a step above somebody's critical one.
Result<std::vector<FrontierIndividual>> frontier_individuals(const FrontierDrive& drive, const FrontierMethod& method,
                                                             bool loads, BellyLibrary& library);

/// The muscle's template's mesh in any cells.
Result<HexahedralMesh> frontier_mesh(Muscle muscle, const Cells& cells);

}  // namespace mobil
