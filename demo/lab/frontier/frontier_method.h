#pragma once
// A way to deform a muscle, made ready for sixteen individuals, and what moves and loads them: recorded from walking
// people, the same for every method. For `mobil frontier`.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/components/body.h>
#include <mobil/components/lanes.h>
#include <mobil/components/muscle.h>
#include <mobil/engine/error.h>
#include "assets/fem/belly_solver.h"
#include "assets/fem/muscle_template.h"
#include "assets/reduction/modal_basis.h"
#include "systems/bellies/belly_library.h"

namespace mobil {

inline constexpr double frontier_tick_s = 1.0 / 60;

struct FrontierWalk {
  BodyRequest body;
  float speed_m_s;
};

/// What a belly of each lane feels of its frame at one moment, as FrameLoad.
struct FrontierFrame {
  Vec3<Lanes<float>> constant;
  Mat3<Lanes<float>> gradient;
};

/// Sixteen right legs' bellies of one muscle, a walk each; walks that are fewer are repeated. Displacement of the far
/// end (m) and load of the frame a tick, both linear between ticks. All begin at rest without load: over the first
/// second displacement and load grow smoothly to their values. From tick `first` on answers are compared.
struct FrontierDrive {
  Muscle muscle;
  std::size_t walks;  // of the lanes, how many are walks of their own
  std::vector<MusclePlan> plan;
  BellyScale<Lanes<float>> scale;
  std::vector<Lanes<float>> end_m;
  std::vector<FrontierFrame> frame;
  std::size_t first;

  std::size_t ticks() const { return end_m.size() - 1; }
  /// At a time between ticks; from and to over the time from `from_s` to `to_s`.
  EndDrive<Lanes<float>> end(double from_s, double to_s) const;
  FrameLoad<Lanes<float>> load(double from_s, double to_s) const;
};

/// Five bodies, light to heavy, at 0.9, 1.4 and 2.0 m/s each, and one more.
std::vector<FrontierWalk> frontier_walks();

/// Of each muscle what up to sixteen walkers' right legs do: `seconds` that are compared, after the beginning. Fails
/// without walks or with more than sixteen, on a body or a speed out of range, or less than a tick's time.
std::vector<FrontierDrive> record_walks(std::span<const Muscle> muscles, std::span<const FrontierWalk> walks,
                                        double seconds);

inline constexpr Cells frontier_points = {2, 2, 8};  // the control points: this mesh's nodes
inline constexpr std::size_t point_width = nodal_width(frontier_points);

/// `fixed_step`: steps of just choice.dt_s, however ticks fall, instead of equal parts of a tick; answers are compared
/// where both meet. The choice's muscles and inertia are not read.
struct FrontierMethod {
  LegMuscles choice;
  bool fixed_step = false;

  bool modal() const { return choice.method == Method::modal; }
  bool moving() const { return !modal() || choice.modal.moving; }
  /// Of the mesh that the answer is of.
  const Cells& cells() const { return modal() ? choice.modal.cells : choice.cells; }
};

/// What one individual is stepped with. Finite elements have `steps` a tick, and those that solve a solver; the others
/// a basis and their own numbers.
struct FrontierIndividual {
  std::shared_ptr<const MuscleTemplate> shape;
  std::uint32_t steps = 1;
  std::shared_ptr<const BellySolver> solver;
  std::shared_ptr<const ModalBasis> basis;
  std::vector<float> motion, points;

  bool alike(const FrontierIndividual& other) const {
    return shape == other.shape && steps == other.steps && solver == other.solver && basis == other.basis;
  }
};

/// Makes `own` move along those modes, with that body's motions.
void set_modes(FrontierIndividual& own, std::shared_ptr<const ModalBasis> basis, const ModalBelly& belly,
               double damping_per_s);

/// The drive's sixteen, set up as people's muscles are. `loads`: for the frame's too. Fails on a choice out of range,
/// or a step above somebody's critical one.
std::vector<FrontierIndividual> frontier_individuals(const FrontierDrive& drive, const FrontierMethod& method,
                                                     bool loads, BellyLibrary& library);

/// The muscle's template's mesh in any cells.
HexahedralMesh frontier_mesh(Muscle muscle, const Cells& cells);

}  // namespace mobil
