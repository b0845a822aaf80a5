#pragma once
// The meshes, operators and bases that a simulation's muscles share. They are made when first called for, or before.
//
//   simulation.muscle_library().prepare({.muscles = muscle_groups()});
//   const std::vector<std::byte> baked = simulation.muscle_library().bake();  // for a file
//   other_simulation.muscle_library().load(baked);

#include <cstddef>
#include <span>
#include <vector>

#include <mobil/components/leg_muscles.h>
#include <mobil/engine/error.h>
#include <mobil/engine/phase.h>

namespace mobil::inline v0_3 {

/// Of a simulation (Simulation::muscle_library), and of those that share its (SimulationOptions::library_of).
class MuscleLibrary {
 public:
  explicit MuscleLibrary(const Frame& frame) : frame_(frame) {}

  /// Makes the templates and bases that typical bodies share for this choice, with the simulation's jobs: then spawning
  /// them and changing their methods does not wait for that. Errors: a choice out of range; nothing has changed.
  Result<void> prepare(const LegMuscles& choice);
  /// All meshes, operators and bases that have been made so far, by `prepare` or by adding muscles, as bytes for a
  /// file: a program that loads them need not make them. They depend on no body and on no scene.
  std::vector<std::byte> bake() const;
  /// Takes in what `bake` wrote, in milliseconds: the bits are those that would be made here. The bytes are not needed
  /// afterwards. Errors, in one line: bytes that were cut or altered, or baked by another version of the library or on
  /// a processor that computes otherwise; nothing has changed then.
  Result<void> load(std::span<const std::byte> baked);

 private:
  Frame frame_;
};

}  // namespace mobil::inline v0_3
