#include <mobil/muscle_library.h>

#include "systems/muscles/leg_muscles.h"

namespace mobil::inline v0_3 {
namespace {
const MuscleMeans& means_of(const Frame& frame) {
  return frame.workspace.get<MuscleMeans>();
}
}  // namespace

Result<void> MuscleLibrary::prepare(const LegMuscles& choice) {
  const FloatMode mode;
  return named("prepare", means_of(frame_).library->prepare(choice, means_of(frame_).tick_s, frame_.jobs));
}

std::vector<std::byte> MuscleLibrary::bake() const {
  return means_of(frame_).library->bake();
}

Result<void> MuscleLibrary::load(std::span<const std::byte> baked) {
  const FloatMode mode;
  return named("load", means_of(frame_).library->load(baked));
}

}  // namespace mobil::inline v0_3
