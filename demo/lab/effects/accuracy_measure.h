#pragma once
// Measures the accuracy table (mobil/systems/accuracy/accuracy_table.h): people walk with each level, beside
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

/// What references are made of: 32 modes of this mesh, extrapolated.
inline constexpr Cells reference_cells = {8, 8, 32};

/// The basis for a muscle of one person's size, of `choice` with its inertia and damping. Throws Stopped as
/// make_modal_basis fails.
std::shared_ptr<const ModalBasis> reference_basis(const MusclePlan& plan, const LegMuscles& choice,
                                                  const Cells& cells = reference_cells,
                                                  std::uint32_t modes = max_modes);

/// Belly that others are held against, driven by the very line and frame of a simulation's muscle: one muscle of one
/// leg, at rest at first.
class ReferenceMuscle {
 public:
  ReferenceMuscle(std::shared_ptr<const ModalBasis> basis, const PersonMuscle& muscle, const LegMuscles& choice,
                  double tick_s);

  /// One tick, as that muscle of the simulation was just driven; throws Stopped where it is gone or not driven by
  /// displacement.
  void follow(const Simulation& simulation, Entity muscle);
  /// The largest distance of a control point from where `nodes` has it, m; of no nodes its own displacement.
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

/// Of whom errors are told; others' are taken in proportion to height, and their speeds to its root.
inline constexpr float accuracy_height_m = static_cast<float>(reference_body_height_m);

struct AccuracyPlan {
  std::vector<Muscle> muscles;
  std::vector<BodyRequest> bodies;  // each walks at every class' speed, in proportion to the root of height
  double settle_s = 3, seconds = 6;
  std::function<void(double)> progress = [](double) {};  // parts done
};
/// Four groups; light, middling and heavy bodies, small and tall.
AccuracyPlan accuracy_plan();

/// Rows of `inertia` or without: the worst body's 99.9th percentile, in parts of its height over the reference body's.
std::vector<AccuracyRow> measure_errors(const AccuracyPlan& plan, bool inertia);

/// What levels cost in a crowd, processor time.
LevelCost measure_costs(std::size_t people, bool inertia, bool active);

/// Rows and costs as systems/accuracy/accuracy_table.cpp has them.
std::string accuracy_source(const std::vector<AccuracyRow>& rows);
std::string cost_source(const LevelCost& cost);

/// Copies of one walker with muscles of the choice, one for each level of a lod_table. Fails as Simulation does.
std::array<Entity, level_count> spawn_copies(Simulation& simulation, const BodyRequest& body, float speed_m_s,
                                             const LegMuscles& choice, bool active);

/// Takes the value below which `part` of them lie; reorders. 0 of none.
float percentile(std::vector<float>& values, double part);

}  // namespace mobil
