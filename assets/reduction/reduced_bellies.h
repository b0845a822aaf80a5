#pragma once
// The reduced problems of up to sixteen bodies of one basis, solved together: a lane is a body, and what a lane gets
// does not depend on who shares the block. Set-up, in double precision; the same bits on every instruction set.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <mobil/components/lanes.h>
#include <mobil/components/muscle.h>
#include <mobil/engine/error.h>
#include "assets/reduction/reduced_belly.h"

namespace mobil::inline v0_3 {

/// What ReducedBelly (reduced_belly.h) has of one body, of sixteen. Lanes past `count` hold no numbers of use. The
/// caller sets `tuned` before solve_bellies.
struct ReducedBellies {
  std::uint32_t vectors = 0, inputs = 0, count = 0;
  bool tuned = false;
  std::vector<Lanes<double>> words{}, scratch{};

  using Column = Lanes<double>;
  void resize(std::uint32_t all_vectors, std::uint32_t all_inputs) {
    vectors = all_vectors;
    inputs = all_inputs;
    words.resize(std::size_t{vectors} * (3 + vectors + inputs) + inputs + 1);
  }
  Column& omega_1_s(std::size_t motion) { return words[motion]; }
  Column& lift_share(std::size_t motion) { return words[vectors + motion]; }
  Column& tension_1_s2(std::size_t motion) { return words[2 * vectors + motion]; }
  Column& eigenvector(std::size_t motion, std::size_t vector) { return words[eigenvector_at(motion, vector)]; }
  Column& participation(std::size_t motion, std::size_t input) { return words[participation_at(motion, input)]; }
  Column& reaction(std::size_t input) { return words[participation_at(vectors, input)]; }
  Column& lift_mass_kg() { return words.back(); }
  const Column& omega_1_s(std::size_t motion) const { return words[motion]; }
  const Column& lift_share(std::size_t motion) const { return words[vectors + motion]; }
  const Column& tension_1_s2(std::size_t motion) const { return words[2 * vectors + motion]; }
  const Column& eigenvector(std::size_t motion, std::size_t vector) const {
    return words[eigenvector_at(motion, vector)];
  }
  const Column& participation(std::size_t motion, std::size_t input) const {
    return words[participation_at(motion, input)];
  }
  const Column& reaction(std::size_t input) const { return words[participation_at(vectors, input)]; }
  const Column& lift_mass_kg() const { return words.back(); }

 private:
  std::size_t eigenvector_at(std::size_t motion, std::size_t vector) const { return (3 + motion) * vectors + vector; }
  /// Reactions stand behind the last motion's.
  std::size_t participation_at(std::size_t motion, std::size_t input) const {
    return (3 + std::size_t{vectors}) * vectors + motion * inputs + input;
  }
};

/// The reduced problems of 1 to 16 bodies, solved: by Jacobi's rotations in the order of a tournament, from the motions
/// of the body in the middle of the basis's range (ReducedBasis::turned) where it has them (Golub and Van Loan, Matrix
/// Computations, 4th ed., 8.5). Fails, of the first body of which it is so, outside the basis's range of ratios (up to
/// rounding) or where the operator is not positive definite. Asks for no heap where `bellies` had such a basis before.
Result<void> solve_bellies(const ReducedBasis& basis, std::span<const BellyScale<double>> bodies,
                           ReducedBellies& bellies);
Result<void> solve_bellies(const ReducedBasis& basis, std::span<const BellyScale<float>> bodies,
                           ReducedBellies& bellies);
ReducedBelly belly_of(const ReducedBellies& bellies, std::size_t lane);

}  // namespace mobil::inline v0_3
