#pragma once
// Bellies that others are held against: as many vectors of as fine a mesh as there are, for one body's slenderness
// alone, driven by the very line and frame that a simulation's muscle has.

#include <cstdint>
#include <memory>
#include <vector>

#include <mobil/components/lanes.h>
#include <mobil/components/muscle.h>
#include <mobil/engine/error.h>
#include <mobil/simulation.h>
#include "assets/reduction/reduced_basis.h"

namespace mobil {

/// What references are made of: 32 vectors of this mesh, extrapolated.
inline constexpr Cells reference_cells = {8, 8, 32};

/// The basis for a muscle of one person's size, of `choice` with its inertia and damping. Errors: those of
/// make_reduced_basis.
Result<std::shared_ptr<const ReducedBasis>> reference_basis(const MusclePlan& plan, const LegMuscles& choice,
                                                            const Cells& cells = reference_cells,
                                                            std::uint32_t vectors = most_vectors);

/// One muscle of one leg, at rest at first under whatever loads it.
class ReferenceMuscle {
 public:
  static Result<ReferenceMuscle> make(std::shared_ptr<const ReducedBasis> basis, const HumanMuscle& muscle,
                                      const LegMuscles& choice, double tick_s);

  /// One tick, as that muscle of the simulation was just driven; fails where it is gone or not driven by displacement.
  Result<void> follow(const Simulation& simulation, Entity muscle);
  /// The largest distance of a control point from where `nodes` has it, m; of no nodes its own displacement.
  float largest_error_m(const NodalView& nodes) const;

 private:
  struct Line {
    alignas(64) float lane[lane_count];
  };

  std::shared_ptr<const ReducedBasis> basis_;
  BellyScale<Lanes<float>> scale_;
  float tick_s_ = 0;
  std::vector<Line> state_, motion_, shape_, displacement_;
};

}  // namespace mobil
