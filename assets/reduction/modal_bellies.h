#pragma once
// Solves the modal problems of up to sixteen bodies of one basis together. A lane is a body, and its result does not
// depend on the others in the block. For set-up, in double precision; the same bits on every instruction set.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <mobil/components/lanes.h>
#include <mobil/components/muscle.h>
#include <mobil/engine/error.h>
#include "assets/reduction/modal_belly.h"

namespace mobil::inline v0_3 {

/// ModalBelly (modal_belly.h) of sixteen bodies. Lanes past `count` have no useful numbers. The caller sets `tuned`
/// before solve_bellies.
struct ModalBellies {
  std::uint32_t modes = 0, inputs = 0, count = 0;
  bool tuned = false;
  std::vector<Lanes<double>> words{}, scratch{};

  using Column = Lanes<double>;
  void resize(std::uint32_t all_modes, std::uint32_t all_inputs) {
    modes = all_modes;
    inputs = all_inputs;
    words.resize(std::size_t{modes} * (3 + modes + inputs) + inputs + 1);
  }
  Column& omega_1_s(std::size_t motion) { return words[motion]; }
  Column& lift_share(std::size_t motion) { return words[modes + motion]; }
  Column& tension_1_s2(std::size_t motion) { return words[2 * modes + motion]; }
  Column& eigenvector(std::size_t motion, std::size_t vector) { return words[eigenvector_at(motion, vector)]; }
  Column& participation(std::size_t motion, std::size_t input) { return words[participation_at(motion, input)]; }
  Column& reaction(std::size_t input) { return words[participation_at(modes, input)]; }
  Column& lift_mass_kg() { return words.back(); }
  const Column& omega_1_s(std::size_t motion) const { return words[motion]; }
  const Column& lift_share(std::size_t motion) const { return words[modes + motion]; }
  const Column& tension_1_s2(std::size_t motion) const { return words[2 * modes + motion]; }
  const Column& eigenvector(std::size_t motion, std::size_t vector) const {
    return words[eigenvector_at(motion, vector)];
  }
  const Column& participation(std::size_t motion, std::size_t input) const {
    return words[participation_at(motion, input)];
  }
  const Column& reaction(std::size_t input) const { return words[participation_at(modes, input)]; }
  const Column& lift_mass_kg() const { return words.back(); }

 private:
  std::size_t eigenvector_at(std::size_t motion, std::size_t vector) const { return (3 + motion) * modes + vector; }
  /// Reactions are stored after the last motion's.
  std::size_t participation_at(std::size_t motion, std::size_t input) const {
    return (3 + std::size_t{modes}) * modes + motion * inputs + input;
  }
};

/// Solves the modal problems of 1 to 16 bodies by Jacobi's rotations in the order of a tournament. It starts from the
/// motions of the body in the middle of the basis's range (ModalBasis::turned), if known (Golub and Van Loan, Matrix
/// Computations, 4th ed., 8.5). Fails, for the first such body, outside the basis's range of ratios (up to rounding) or
/// if the operator is not positive definite. Does not allocate if `bellies` had such a basis before.
Result<void> solve_bellies(const ModalBasis& basis, std::span<const BellyScale<double>> bodies, ModalBellies& bellies);
Result<void> solve_bellies(const ModalBasis& basis, std::span<const BellyScale<float>> bodies, ModalBellies& bellies);
ModalBelly belly_of(const ModalBellies& bellies, std::size_t lane);

}  // namespace mobil::inline v0_3
