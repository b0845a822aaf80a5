#include "assets/muscles/excitation_curves.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <mobil/components/activation.h>
#include "engine/exact_math.h"

namespace mobil::inline v0_3 {
namespace {

// clang-format off
constexpr ExcitationCurve curves[] = {
#include "assets/muscles/excitation_curves.inl"
};
// clang-format on
constexpr std::size_t measured_curves = 6;  // the first ones

/// Returns the name of the curve that a line uses: its own, or that of another head.
std::string_view curve_of(std::string_view muscle) {
  if (muscle.starts_with("vastus")) return "vastus_medialis";
  if (muscle.starts_with("gastrocnemius") || muscle == "plantaris") return "gastrocnemius_medial";
  if (muscle.starts_with("semi") || muscle.starts_with("biceps_femoris")) return "biceps_femoris";
  return muscle;
}

}  // namespace

bool is_measured(const MemberMuscle& line) {
  return member_excitation(line).curve < curves + measured_curves;
}

std::span<const ExcitationCurve> excitation_curves() {
  return curves;
}

MemberExcitation member_excitation(const MemberMuscle& muscle) {
  const auto* const curve = std::ranges::find(curves, curve_of(muscle.name), &ExcitationCurve::name);
  return {curve, muscle.name == "soleus" ? 0.05F : 0.02F};
}

double excitation(const MemberExcitation& of, double cycle, double speed) {
  const double least = static_cast<double>(min_excitation_speed);
  const double s = std::clamp(speed, least, static_cast<double>(max_excitation_speed));
  const auto term = [&](std::size_t i) {
    const auto& c = of.curve->terms[i];
    return static_cast<double>(c[0]) + s * (static_cast<double>(c[1]) + s * static_cast<double>(c[2]));
  };
  double sum = term(0);
  for (std::size_t k = 1; k <= excitation_harmonics; ++k) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(k) * cycle;
    sum += term(2 * k - 1) * exact::cos(angle) + term(2 * k) * exact::sin(angle);
  }
  const double part = std::clamp(speed / least, 0.0, 1.0), standing = static_cast<double>(of.standing);
  return std::clamp(standing + part * (static_cast<double>(excitation_scale) * sum - standing),
                    static_cast<double>(min_activation), static_cast<double>(max_activation));
}

}  // namespace mobil::inline v0_3
