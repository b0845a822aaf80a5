#include "tests/reduction/scalar_belly.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "assets/reduction/reduced_basis.h"
#include "assets/reduction/reduced_eigen.h"

namespace mobil::oracle {
namespace {

/// Of the twelve numbers of FrameLoad: what a body's size does to the field that each stands for.
double field_scale(std::size_t number, double across, double along) {
  return number < 3 ? 1 : number % 3 == 2 ? along : across;
}

std::size_t end_inputs(const ReducedBasis& basis) {
  return basis.inputs - (basis.frame.empty() ? 0 : frame_inputs);
}

/// A float's upper sixteen bits, rounded to the nearest: eight digits.
std::uint32_t upper_half(double x) {
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(x));
  return (bits + 0x7FFFU + (bits >> 16 & 1U)) >> 16;
}

}  // namespace

Result<ReducedBelly> make_reduced_belly(const ReducedBasis& basis, double across, double along) {
  constexpr double rounding = 1e-5;
  const double ratio = across / along;
  if (!(across > 0 && along > 0 && ratio >= basis.lowest_ratio * (1 - rounding) &&
        ratio <= basis.highest_ratio * (1 + rounding))) {
    return fail(fmt::format("scales {:.4g} across and {:.4g} along: their ratio must lie between {:.4g} and {:.4g}",
                            across, along, basis.lowest_ratio, basis.highest_ratio));
  }
  const std::size_t n = basis.vectors;
  const bool held = !basis.lift_mass.empty(), braced = !basis.foundation.empty();
  const double size = across * along, mass = across * size;
  const double a = 1 / (ratio * size), b = 1 / size, c = ratio / size, brace = basis.foundation_1_s2;
  alignas(64) double matrix[most_vectors][most_vectors];
  for (std::size_t i = 0; i < n; ++i) {
    const double *const pa = &basis.a[i * n], *const pb = &basis.b[i * n], *const pc = &basis.c[i * n];
    for (std::size_t j = 0; j < n; ++j) matrix[i][j] = a * pa[j] + b * pb[j] + c * pc[j];
    if (!braced) continue;
    for (std::size_t j = 0; j < n; ++j) matrix[i][j] += brace * basis.foundation[i * n + j];
  }
  alignas(64) SmallEigen eigen;
  if (!solve_small(matrix, n, eigen) || !(eigen.value[0] > 0)) {
    return fail(fmt::format("{} vectors of a mesh of {}x{}x{} cells are too many for a stiffness above 0{}; take fewer",
                            n, basis.cells[0], basis.cells[1], basis.cells[2],
                            basis.options.corrected ? " with the mesh's error extrapolated away" : ""));
  }

  Result<ReducedBelly> made;
  ReducedBelly& belly = *made;
  belly.vectors = basis.vectors;
  belly.inputs = basis.inputs;
  const std::size_t ends = end_inputs(basis), inputs = basis.inputs;
  double pull[most_vectors];  // k/m
  double energy = 0;          // ψᵀKψ/m
  if (held) {
    for (std::size_t i = 0; i < n; ++i) {
      pull[i] = a * basis.lift_a[i] + b * basis.lift_b[i] + c * basis.lift_c[i];
      if (braced) pull[i] += brace * basis.lift_foundation[i];
    }
    energy = a * basis.lift_energy_a + b * basis.lift_energy_b + c * basis.lift_energy_c +
             brace * basis.lift_energy_foundation;
  }
  double scale[frame_inputs];
  for (std::size_t i = 0; i < frame_inputs; ++i) scale[i] = field_scale(i, across, along);

  double kinetic = basis.lift_kinetic;
  for (std::size_t j = 0; j < n; ++j) {
    const double* const e = eigen.vector[j];
    const double value = eigen.value[j];
    belly.omega_1_s[j] = std::sqrt(value);
    double* const p = belly.participation[j];
    for (std::size_t i = 0; i < n; ++i) belly.eigenvector[i][j] = e[i];
    double tied = 0;  // Eᵀk/m
    if (held) {
      double share = 0;
      for (std::size_t i = 0; i < n; ++i) {
        share += e[i] * basis.lift_mass[i];
        tied += e[i] * pull[i];
      }
      belly.lift_share[j] = share;
      p[0] = share - tied / value;
      kinetic -= share * share;
      energy -= tied * tied / value;
    } else {
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < ends; ++k) p[k] += e[i] * basis.traction[i * ends + k];
      }
      for (std::size_t k = 0; k < ends; ++k) p[k] /= mass * value;
    }
    if (ends == inputs) continue;
    for (std::size_t i = 0; i < n; ++i) {
      const double* const row = &basis.frame[i * frame_inputs];
      for (std::size_t k = 0; k < frame_inputs; ++k) p[ends + k] += e[i] * row[k];
    }
    for (std::size_t k = 0; k < frame_inputs; ++k) {
      p[ends + k] *= scale[k] / value;
      if (held) belly.reaction[ends + k] += mass * tied * p[ends + k];
    }
  }
  if (held) {
    belly.reaction[0] = mass * energy;
    belly.lift_mass_kg = mass * kinetic;
    for (std::size_t k = ends; k < inputs; ++k) {
      belly.reaction[k] -= mass * scale[k - ends] * basis.lift_frame[k - ends];
    }
  }
  return made;
}

void write_motion(const ReducedBelly& belly, double damping_per_s, double tick_s, std::span<float> motion) {
  const double half = damping_per_s / 2;
  float* to = motion.data();
  for (std::size_t j = 0; j < belly.vectors; ++j) {
    const double omega = belly.omega_1_s[j], square = omega * omega - half * half;
    double cosine = 0, sine = 0;  // e^(−αh/2) times cos(ω_d·h) and sin(ω_d·h)/ω_d, or cosh and sinh
    if (square >= 0) {
      const double decay = std::exp(-half * tick_s), swing = std::sqrt(square);
      cosine = decay * std::cos(swing * tick_s);
      sine = decay * (swing * tick_s > 1e-8 ? std::sin(swing * tick_s) / swing : tick_s);
    } else {
      const double apart = std::sqrt(-square), slow = std::exp(-omega * omega / (half + apart) * tick_s);
      const double fast = std::expm1(-2 * apart * tick_s);  // of the slow one, less 1
      cosine = slow * (1 + fast / 2);
      sine = slow * (apart * tick_s > 1e-8 ? -fast / (2 * apart) : tick_s);
    }
    const auto g = static_cast<float>(damping_per_s / omega);
    auto a = static_cast<float>(cosine + half * sine), b = static_cast<float>(omega * sine);
    // An undamped motion must not grow by how its numbers round.
    const auto growth = [g](double x, double y) { return x * (x - static_cast<double>(g) * y) + y * y; };
    while (growth(static_cast<double>(a), static_cast<double>(b)) > 1) {
      a = std::nextafter(a, 0.0F);
      b = std::nextafter(b, 0.0F);
    }
    *to++ = a;
    *to++ = b;
    *to++ = g;
    if (belly.inputs == 1) continue;
    const double* const p = belly.participation[j];
    const std::size_t ends = belly.inputs > frame_inputs ? belly.inputs - frame_inputs : belly.inputs;
    for (std::size_t k = 0; k < ends; ++k) *to++ = static_cast<float>(p[k]);
    for (std::size_t k = ends; k < belly.inputs; k += 2) {
      *to++ = std::bit_cast<float>(upper_half(p[k + 1]) << 16 | upper_half(p[k]));
    }
  }
}

void write_shape(const ReducedBelly& belly, double damping_per_s, std::span<float> shape) {
  const std::size_t n = belly.vectors, inputs = belly.inputs;
  float* to = shape.data();
  double swing[most_vectors];
  for (std::size_t j = 0; j < n; ++j) swing[j] = (inputs == 1 ? belly.participation[j][0] : 1) / belly.omega_1_s[j];
  for (std::size_t i = 0; i < n; ++i) {
    const double* const e = belly.eigenvector[i];
    for (std::size_t j = 0; j < n; ++j) *to++ = static_cast<float>(e[j] * swing[j]);
    double rest[3 + frame_inputs] = {};
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t k = 0; k < inputs; ++k) rest[k] += e[j] * belly.participation[j][k];
      rest[0] -= e[j] * belly.lift_share[j];
    }
    for (std::size_t k = 0; k < inputs; ++k) *to++ = static_cast<float>(rest[k]);
  }
  for (std::size_t j = 0; j < n; ++j) *to++ = static_cast<float>(belly.omega_1_s[j]);
  for (std::size_t j = 0; j < n; ++j) *to++ = static_cast<float>(belly.participation[j][0]);
  for (std::size_t k = 0; k < inputs; ++k) *to++ = static_cast<float>(belly.reaction[k]);
  *to = static_cast<float>(belly.lift_mass_kg * damping_per_s);
}

}  // namespace mobil::oracle
