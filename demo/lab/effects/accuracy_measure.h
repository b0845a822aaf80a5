#pragma once
// Measures the accuracy table (mobil/systems/accuracy/accuracy_table.h): people walk with each level, compared with
// references.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <mobil/components/body.h>
#include <mobil/components/lanes.h>
#include <mobil/components/muscle.h>
#include <mobil/each.h>
#include <mobil/engine/error.h>
#include <mobil/simulation.h>
#include <mobil/systems/accuracy/accuracy_table.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/systems/surfaces/nodal_view.h>
#include "assets/reduction/modal_basis.h"
#include "demo/lab/bench/bench_crowd.h"

namespace mobil {

/// Mesh of the references: 32 of its modes, extrapolated.
inline constexpr Cells reference_cells = {8, 8, 32};

/// Returns the basis for a muscle of one person's size, of `choice` with its inertia and damping. Throws Stopped if
/// make_modal_basis fails.
std::shared_ptr<const ModalBasis> reference_basis(const MusclePlan& plan, const LegMuscles& choice,
                                                  const Cells& cells = reference_cells,
                                                  std::uint32_t modes = max_modes);

/// Reference belly, driven by the same line and frame as a simulation's muscle: one muscle of one leg, initially at
/// rest.
class ReferenceMuscle {
 public:
  ReferenceMuscle(std::shared_ptr<const ModalBasis> basis, const PersonMuscle& muscle, const LegMuscles& choice,
                  double tick_s);

  /// Advances by a tick, as that muscle of the simulation was just driven. Throws Stopped if it no longer exists or is
  /// not driven by displacement.
  void follow(const Simulation& simulation, Entity muscle);
  /// Returns the largest distance of a control point from its place in `nodes`, m; without nodes, its own displacement.
  float largest_error_m(const NodalView& nodes) const;

 private:
  struct Line {
    alignas(64) float lane[lane_count];
  };

  std::shared_ptr<const ModalBasis> basis_;
  BellyScale<Lanes<float>> scale_;
  float tick_s_ = 0;
  std::vector<Line> state_, motion_, shape_, displacement_;
};

/// Height of measured errors. Those of other people scale with height, and their speeds with its root.
inline constexpr float accuracy_height_m = static_cast<float>(reference_body_height_m);

struct AccuracyPlan {
  std::vector<Muscle> muscles;
  std::vector<BodyRequest> bodies;  // each walks at every class' speed, in proportion to the root of height
  double settle_s = 3, seconds = 6;
  std::function<void(double)> progress = [](double) {};  // parts done
};
/// Returns a plan for these muscles in light, middling and heavy bodies, small and tall.
AccuracyPlan accuracy_plan(const MuscleSet& muscles);

/// Returns rows with or without inertia: the worst body's 99.9th percentile, scaled to the reference body's height.
std::vector<AccuracyRow> measure_errors(const AccuracyPlan& plan, bool inertia);

/// Measures costs of levels in a crowd, processor time.
LevelCost measure_costs(std::size_t people, bool inertia, bool active);

/// Return rows and costs as source of systems/accuracy/accuracy_table.cpp.
std::string accuracy_source(const std::vector<AccuracyRow>& rows);
std::string cost_source(const LevelCost& cost);

/// Spawns copies of one walker with muscles of the choice, one for each level of a lod_table. Fails as Simulation does.
std::array<Entity, level_count> spawn_copies(Simulation& simulation, const BodyRequest& body, float speed_m_s,
                                             const LegMuscles& choice, bool active);

/// Returns the value below which `part` of the values lie; reorders them. 0 without values.
float percentile(std::vector<float>& values, double part);

}  // namespace mobil
