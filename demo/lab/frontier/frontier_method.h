#pragma once
// A method of deformation, prepared for sixteen individuals, and their drives and loads: recorded from walking people,
// the same for every method. For `mobil frontier`.

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

/// Load of the frame on a belly of each lane at one moment, as in FrameLoad.
struct FrontierFrame {
  Vec3<Lanes<float>> constant;
  Mat3<Lanes<float>> gradient;
};

/// Bellies of one muscle in sixteen right legs, each with its own walk; fewer walks are repeated. Contains displacement
/// of the far end (m) and load of the frame in each tick, both linear between ticks. All start at rest without load:
/// over the first second displacement and load grow smoothly to their values. Comparison begins with tick `first`.
struct FrontierDrive {
  Muscle muscle;
  std::size_t walks;  // number of lanes with distinct walks
  std::vector<MusclePlan> plan;
  BellyScale<Lanes<float>> scale;
  std::vector<Lanes<float>> end_m;
  std::vector<FrontierFrame> frame;
  std::size_t first;

  std::size_t ticks() const { return end_m.size() - 1; }
  /// Return drive and load over the time from `from_s` to `to_s`, interpolated between ticks.
  EndDrive<Lanes<float>> end(double from_s, double to_s) const;
  FrameLoad<Lanes<float>> load(double from_s, double to_s) const;
};

/// Returns five bodies, light to heavy, at 0.9, 1.4 and 2.0 m/s each, and one more.
std::vector<FrontierWalk> frontier_walks();

/// Records the right legs of up to sixteen walkers for each muscle: `seconds` to compare, after the start. Fails
/// without walks or with more than sixteen, on a body or a speed out of range, or less than a tick's time.
std::vector<FrontierDrive> record_walks(std::span<const Muscle> muscles, std::span<const FrontierWalk> walks,
                                        double seconds);

inline constexpr Cells frontier_points = {2, 2, 8};  // the control points: this mesh's nodes
inline constexpr std::size_t point_width = nodal_width(frontier_points);

/// `fixed_step`: steps of exactly choice.dt_s, independent of ticks, instead of equal parts of a tick; they are
/// compared where both coincide. Muscles and inertia of the choice are not used.
struct FrontierMethod {
  LegMuscles choice;
  bool fixed_step = false;

  bool modal() const { return choice.method == Method::modal; }
  bool moving() const { return !modal() || choice.modal.moving; }
  /// Returns the cells of the resulting mesh.
  const Cells& cells() const { return modal() ? choice.modal.cells : choice.cells; }
};

/// Data to step one individual. Finite elements have `steps` a tick and, for solving methods, a solver. Other methods
/// have a basis and their own numbers.
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

/// Makes `own` move in those modes, with that body's motions.
void set_modes(FrontierIndividual& own, std::shared_ptr<const ModalBasis> basis, const ModalBelly& belly,
               double damping_per_s);

/// Returns the drive's sixteen individuals, set up like people's muscles; `loads` prepares them for the frame's. Fails
/// on a choice out of range, or a step above an individual's critical one.
std::vector<FrontierIndividual> frontier_individuals(const FrontierDrive& drive, const FrontierMethod& method,
                                                     bool loads, BellyLibrary& library);

/// Returns the mesh of the muscle's template with any cells.
HexahedralMesh frontier_mesh(Muscle muscle, const Cells& cells);

}  // namespace mobil
