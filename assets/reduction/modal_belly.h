#pragma once
// One body's motions along the modes of a basis, and the conversion of states to and from them. Many bodies at once:
// modal_bellies.h.

#include <cstddef>
#include <cstdint>
#include <span>

#include <mobil/engine/error.h>
#include "assets/reduction/modal_basis.h"

namespace mobil::inline v0_3 {

/// A₀, the activation whose motions a tuned belly moves along, about that of a standing person's calf. A foundation
/// leaves the frequencies of many motions nearly equal, and the smallest tension decides which these are. Along the
/// motions without tension, its coupling cannot be left out: vibration across differs from a nonlinear solution by 14
/// to 42 % instead of 7 to 12.
inline constexpr double tuned_activation = 0.05;
/// Minimum of ω² at full activation, over that at `tuned_activation`: tension stiffens.
inline constexpr double min_taut_stiffness = 0.25;

/// One body's own motions z = Eᵀ·(q + VᵀM₁ψ·w), E the eigenvectors of its modal stiffness over its mass (EᵀE = 1),
/// fastest last. They follow z̈ + α·ż + ω²·z = ω²·Σ P·input; participations P are z at rest under each input, per unit.
/// `tuned` includes the tension of `tuned_activation`, of which each unit adds tension_1_s2 to ω². The end's
/// displacement then has the same static response as without.
struct ModalBelly {
  std::uint32_t modes = 0, inputs = 0;
  bool tuned = false;
  double tension_1_s2[max_modes];                     // 0 unless tuned
  double omega_1_s[max_modes];                        // ascending
  double eigenvector[max_modes][max_modes];           // [vector of V][motion]
  double participation[max_modes][3 + frame_inputs];  // [motion][input]
  double lift_share[max_modes];                       // [motion]: Eᵀ·VᵀM₁ψ; q = E·(z − lift_share·w)
  double reaction[3 + frame_inputs];  // held far face: force on it in rest under each input, N per unit; else 0
  double lift_mass_kg;                // S²·l·(ψᵀM₁ψ − |VᵀM₁ψ|²); 0 without a lift
};

/// Solves the modal problem of a body scaled by `across` and `along`: one lane of solve_bellies (modal_bellies.h), and
/// its errors. On a shared core with 12 modes 9 µs, with frame loads 11 (modal_belly_test
/// --gtest_also_run_disabled_tests --gtest_filter=*Microseconds).
Result<ModalBelly> make_modal_belly(const ModalBasis& basis, double across, double along, bool tuned = false);

/// Sizes of the kernels' numbers, laid out as in systems/deformation/modal.h: `motion` has modal_motion_width(),
/// `shape` modal_shape_width() floats.
constexpr std::size_t modal_motion_width(std::uint32_t modes, std::uint32_t inputs) {
  const std::size_t pairs = inputs > frame_inputs ? frame_inputs / 2 : 0, ends = inputs - 2 * pairs;
  return std::size_t{modes} * (inputs == 1 ? 3 : 3 + ends + pairs);
}
constexpr std::size_t modal_state_width(std::uint32_t modes) {
  return 2 * std::size_t{modes};
}
constexpr std::size_t modal_shape_width(std::uint32_t modes, std::uint32_t inputs) {
  return std::size_t{modes} * (modes + inputs) + 2 * std::size_t{modes} + inputs + 1;
}
/// Fits q to displacements of the control points (m, 3·nodes) with the held end at `w` (m; 0 without a lift).
void fit_coordinates(const ModalBasis& basis, double w, std::span<const float> displacement, std::span<double> q);

void write_motion(const ModalBelly& belly, double damping_per_s, double tick_s, std::span<float> motion);
void write_shape(const ModalBelly& belly, double damping_per_s, std::span<float> shape);

/// Convert a belly's state from the displacement and velocity of its control points (3·nodes floats each, this body's m
/// and m/s) under `input` and its rates of change (per s), and back. A round trip keeps displacement and velocity,
/// except for parts that the modes cannot show.
void fit_state(const ModalBasis& basis, const ModalBelly& belly, std::span<const double> input,
               std::span<const double> rate, std::span<const float> displacement, std::span<const float> velocity,
               std::span<float> state);
void show_state(const ModalBasis& basis, const ModalBelly& belly, std::span<const double> input,
                std::span<const double> rate, std::span<const float> state, std::span<float> displacement,
                std::span<float> velocity);

}  // namespace mobil::inline v0_3
