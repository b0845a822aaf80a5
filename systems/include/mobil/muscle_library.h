#pragma once
// Meshes, operators and bases that a simulation's muscles share. They are made at first use, or ahead of it.
//
//   simulation.muscle_library().prepare({.muscles = usual_muscles()});
//   const std::vector<std::byte> baked = simulation.muscle_library().bake();  // for a file
//   other_simulation.muscle_library().load(baked);

#include <cstddef>
#include <span>
#include <vector>

#include <mobil/components/leg_muscles.h>
#include <mobil/engine/error.h>
#include <mobil/engine/phase.h>

namespace mobil::inline v0_3 {

/// A simulation's library (Simulation::muscle_library). Simulations can share one (SimulationOptions::library_of).
class MuscleLibrary {
 public:
  explicit MuscleLibrary(const Frame& frame) : frame_(frame) {}

  /// Makes the templates and bases of typical bodies for this choice, in parallel. Spawning people and changing methods
  /// then do not wait for them. Errors: a choice out of range; the library is then unchanged.
  Result<void> prepare(const LegMuscles& choice);
  /// Returns all meshes, operators and bases made so far, by `prepare` or by adding muscles, as bytes for a file. They
  /// do not depend on bodies or scenes.
  std::vector<std::byte> bake() const;
  /// Loads the result of `bake` in milliseconds, with the same bits that this program would compute. The bytes can be
  /// freed afterwards. Errors: truncated or altered bytes, another version of the library, a processor that computes
  /// differently; the library is then unchanged.
  Result<void> load(std::span<const std::byte> baked);

 private:
  Frame frame_;
};

}  // namespace mobil::inline v0_3
