#pragma once
// Data shared by all bellies of one shape: mesh, operators, and those in the kernels' layout. Immutable.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/components/muscle.h>
#include <mobil/engine/error.h>
#include "assets/fem/critical_step.h"
#include "assets/fem/finite_kernel.h"
#include "assets/fem/kernel_arrays.h"
#include "assets/fem/stiffness_terms.h"

namespace mobil::inline v0_3 {

/// Options of a template. Damping is Rayleigh's, C = α·M + β·K: `damping_per_s` is α (0–1000), `stiffness_damping_s` β
/// (0–1). Fascia and neighbours hold a belly sideways as an elastic foundation (2π·`foundation_hz`)²·M in x and y
/// (0–1000 Hz). The critical step of `mass` and `strain` is tabulated for individuals with across / along between
/// `lowest_ratio` and `highest_ratio` (0.1–10).
struct MuscleOptions {
  FarEnd far_end = FarEnd::held;
  double damping_per_s = 8;
  double lowest_ratio = 0.5, highest_ratio = 2;
  Element element = Element::full;
  Mass mass = Mass::lumped;  // of the critical step
  double stiffness_damping_s = 0;
  double foundation_hz = 0;
  Strain strain = Strain::small;
};

struct MuscleTemplate {
  HexahedralMesh mesh;
  Material material;
  MuscleOptions options;
  StiffnessTerms terms;
  CriticalSteps critical_steps;
  KernelArrays kernel;
  FiniteKernel finite;  // without elements unless Strain::finite
};

/// Returns the conditions of a template's critical step.
StepCase step_case(const MuscleOptions& options);

/// Returns the number of floats of one individual's displacement (or velocity).
constexpr std::size_t nodal_width(const Cells& cells) {
  return 3 * std::size_t{node_count(cells)};
}

/// Fails on a number out of its range, which the error names.
Result<void> check_muscle_options(const MuscleOptions& options);

/// Makes a template. Fails on an inverted element, a bad material, damping or range of ratios. `known` has the critical
/// steps of an equal template, which take most of the time to find.
Result<MuscleTemplate> make_muscle_template(HexahedralMesh mesh, const Material& material, const MuscleOptions& options,
                                            std::optional<CriticalSteps> known = std::nullopt);

}  // namespace mobil::inline v0_3
