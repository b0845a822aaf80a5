#include "assets/reduction/modal_belly.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <mobil/components/lanes.h>
#include "assets/reduction/modal_rows.h"

namespace mobil::inline v0_3 {
namespace {

/// Returns a block of bodies that all are this one.
ModalBellies block_of(const ModalBelly& belly) {
  ModalBellies block;
  block.resize(belly.modes, belly.inputs);
  block.count = 1;
  block.tuned = belly.tuned;
  const auto fill = [](Lanes<double>& column, double x) { std::fill_n(column.lane, lane_count, x); };
  for (std::size_t j = 0; j < belly.modes; ++j) {
    fill(block.omega_1_s(j), belly.omega_1_s[j]);
    fill(block.lift_share(j), belly.lift_share[j]);
    fill(block.tension_1_s2(j), belly.tension_1_s2[j]);
    for (std::size_t i = 0; i < belly.modes; ++i) fill(block.eigenvector(j, i), belly.eigenvector[i][j]);
    for (std::size_t k = 0; k < belly.inputs; ++k) fill(block.participation(j, k), belly.participation[j][k]);
  }
  for (std::size_t k = 0; k < belly.inputs; ++k) fill(block.reaction(k), belly.reaction[k]);
  fill(block.lift_mass_kg(), belly.lift_mass_kg);
  return block;
}

/// Returns z at rest under inputs (or its rate under their rates).
double rest_of(const ModalBelly& belly, std::size_t motion, std::span<const double> input) {
  double sum = 0;
  for (std::size_t k = 0; k < belly.inputs; ++k) sum += belly.participation[motion][k] * input[k];
  return sum;
}

/// Returns the factor on X and W: 1 over P with one input, or 0 if that hardly moves the motion (not kept); else 1.
double inverse_unit(const ModalBelly& belly, std::size_t motion) {
  if (belly.inputs != 1) return 1;
  double largest = 0;
  for (std::size_t j = 0; j < belly.modes; ++j) largest = std::max(largest, std::abs(belly.participation[j][0]));
  const double p = belly.participation[motion][0];
  return std::abs(p) > 1e-9 * largest ? 1 / p : 0;
}

/// Writes the lift of a held far face by `w`, and q, on the control points.
void show(const ModalBasis& basis, double w, const double* q, std::span<float> field) {
  const std::size_t width = std::size_t{basis.modes} + 1;
  for (std::size_t row = 0; row < field.size(); ++row) {
    const float* const shape = &basis.shape[row * width];
    double sum = static_cast<double>(shape[0]) * w;
    for (std::size_t i = 0; i < basis.modes; ++i) sum += static_cast<double>(shape[i + 1]) * q[i];
    field[row] = static_cast<float>(sum);
  }
}

}  // namespace

Result<ModalBelly> make_modal_belly(const ModalBasis& basis, double across, double along, bool tuned) {
  const BellyScale<double> scale{across, along};
  ModalBellies one;
  one.tuned = tuned;
  if (auto solved = solve_bellies(basis, {&scale, 1}, one); !solved) return tl::unexpected(solved.error());
  return belly_of(one, 0);
}

void write_motion(const ModalBelly& belly, double damping_per_s, double tick_s, std::span<float> motion) {
  std::vector<Lanes<float>> words(motion.size());
  write_motions(block_of(belly), damping_per_s, tick_s, words[0].lane);
  for (std::size_t w = 0; w < motion.size(); ++w) motion[w] = words[w][0];
}

void write_shape(const ModalBelly& belly, double damping_per_s, std::span<float> shape) {
  std::vector<Lanes<float>> words(shape.size());
  write_shapes(block_of(belly), damping_per_s, words[0].lane);
  for (std::size_t w = 0; w < shape.size(); ++w) shape[w] = words[w][0];
}

void fit_coordinates(const ModalBasis& basis, double w, std::span<const float> displacement, std::span<double> q) {
  const std::size_t rows = displacement.size(), width = std::size_t{basis.modes} + 1;
  for (std::size_t i = 0; i < basis.modes; ++i) {
    q[i] = 0;
    for (std::size_t row = 0; row < rows; ++row) {
      q[i] += basis.fit[i * rows + row] *
              (static_cast<double>(displacement[row]) - static_cast<double>(basis.shape[row * width]) * w);
    }
  }
}

void fit_state(const ModalBasis& basis, const ModalBelly& belly, std::span<const double> input,
               std::span<const double> rate, std::span<const float> displacement, std::span<const float> velocity,
               std::span<float> state) {
  double q[max_modes], speed[max_modes];
  fit_coordinates(basis, input[0], displacement, q);
  fit_coordinates(basis, rate[0], velocity, speed);
  for (std::size_t j = 0; j < belly.modes; ++j) {
    double z = belly.lift_share[j] * input[0], zdot = belly.lift_share[j] * rate[0];
    for (std::size_t i = 0; i < belly.modes; ++i) {
      z += belly.eigenvector[i][j] * q[i];
      zdot += belly.eigenvector[i][j] * speed[i];
    }
    const double unit = inverse_unit(belly, j);
    state[2 * j] = static_cast<float>(belly.omega_1_s[j] * (z - rest_of(belly, j, input)) * unit);
    state[2 * j + 1] = static_cast<float>(zdot * unit);
  }
}

void show_state(const ModalBasis& basis, const ModalBelly& belly, std::span<const double> input,
                std::span<const double> rate, std::span<const float> state, std::span<float> displacement,
                std::span<float> velocity) {
  double q[max_modes] = {}, speed[max_modes] = {};
  for (std::size_t j = 0; j < belly.modes; ++j) {
    const double unit = belly.inputs == 1 ? belly.participation[j][0] : 1;
    const double z = rest_of(belly, j, input) + unit * static_cast<double>(state[2 * j]) / belly.omega_1_s[j];
    const double zdot = unit * static_cast<double>(state[2 * j + 1]);
    for (std::size_t i = 0; i < belly.modes; ++i) {
      q[i] += belly.eigenvector[i][j] * (z - belly.lift_share[j] * input[0]);
      speed[i] += belly.eigenvector[i][j] * (zdot - belly.lift_share[j] * rate[0]);
    }
  }
  show(basis, input[0], q, displacement);
  show(basis, rate[0], speed, velocity);
}

}  // namespace mobil::inline v0_3
