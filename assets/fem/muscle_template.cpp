#include "assets/fem/muscle_template.h"

#include <fmt/format.h>

#include <numbers>
#include <utility>

namespace mobil::inline v0_3 {

Result<void> check_muscle_options(const MuscleOptions& options) {
  const auto within = [](double value, double low, double high) { return value >= low && value <= high; };
  if (!within(options.damping_per_s, 0, 1000)) {
    return fail(fmt::format("mass damping {} 1/s must lie between 0 and 1000", options.damping_per_s));
  }
  if (!within(options.stiffness_damping_s, 0, 1)) {
    return fail(fmt::format("stiffness damping {} s must lie between 0 and 1", options.stiffness_damping_s));
  }
  if (!within(options.foundation_hz, 0, 1000)) {
    return fail(fmt::format("foundation {} Hz must lie between 0 and 1000", options.foundation_hz));
  }
  if (options.strain == Strain::finite && (options.stiffness_damping_s > 0 || options.mass != Mass::lumped))
    return fail("finite strain is stepped with the lumped mass and mass damping alone; leave the others out");
  if (!(options.lowest_ratio >= 0.1 && options.highest_ratio <= 10 && options.lowest_ratio <= options.highest_ratio)) {
    return fail(fmt::format("ratios of scales from {} to {} must ascend within 0.1 to 10", options.lowest_ratio,
                            options.highest_ratio));
  }
  return {};
}

StepCase step_case(const MuscleOptions& options) {
  return {options.far_end, options.mass, options.stiffness_damping_s, 2 * std::numbers::pi * options.foundation_hz};
}

Result<MuscleTemplate> make_muscle_template(HexahedralMesh mesh, const Material& material, const MuscleOptions& options,
                                            std::optional<CriticalSteps> known) {
  if (auto ok = check_muscle_options(options); !ok) return tl::unexpected(ok.error());
  auto terms = assemble(mesh, material, options.element);
  if (!terms) return tl::unexpected(terms.error());
  FiniteKernel finite;
  if (options.strain == Strain::finite) {
    auto made = make_finite_kernel(mesh, *terms, material);
    if (!made) return tl::unexpected(made.error());
    finite = std::move(*made);
  }
  const auto tabulate = [&](const StiffnessTerms& of) {
    return tabulate_critical_steps(of, step_case(options), options.lowest_ratio, options.highest_ratio);
  };
  auto steps = known                              ? std::move(*known)
               : options.strain == Strain::finite ? tabulate(finite_bound(mesh, finite, *terms))
                                                  : tabulate(*terms);
  auto kernel = make_kernel_arrays(mesh, *terms);
  return MuscleTemplate{std::move(mesh),  material,          options,          std::move(*terms),
                        std::move(steps), std::move(kernel), std::move(finite)};
}

}  // namespace mobil::inline v0_3
