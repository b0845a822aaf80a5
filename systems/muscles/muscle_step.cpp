#include <mobil/systems/muscles/muscle_step.h>

#include "assets/fem/muscle_template.h"

namespace mobil::inline v0_3 {

std::optional<double> critical_step_s(const World& world, Entity muscle, const BellyScale<float>& scale) {
  const auto* shape = world.shared<MuscleTemplate>(muscle);
  if (shape == nullptr) return std::nullopt;
  const auto step =
      critical_step(shape->critical_steps, static_cast<double>(scale.across), static_cast<double>(scale.along));
  return step ? std::optional(*step) : std::nullopt;
}

}  // namespace mobil::inline v0_3
