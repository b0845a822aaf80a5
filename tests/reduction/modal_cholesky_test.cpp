// The banded factor solves as a dense one does, with the same bits on every instruction set.

#include "assets/reduction/modal_cholesky.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstring>
#include <optional>

#include "tests/engine/instruction_sets.h"
#include "tests/fem/oracle.h"

namespace mobil::modal_cholesky_test {
using Eigen::Index;
using oracle::Matrix;

int any(int low, int high) {
  return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(low, high));
}

/// A random diagonally dominant problem.
struct Problem {
  Index size = any(1, 260), reach = any(0, 130), columns = any(1, 5);
  Matrix dense = Matrix::Zero(size, size);
  Columns right{size, columns};

  Problem() {
    for (Index c = 0; c < size; ++c) {
      for (Index r = c; r <= std::min(size - 1, c + reach); ++r)
        dense(r, c) = dense(c, r) = r == c ? 2.0 * static_cast<double>(reach) + 1 : any(-100, 101) / 100.0;
    }
    for (Index i = 0; i < right.size(); ++i) right.data()[i] = any(-100, 101) / 10.0;
  }
  BandCholesky band() const {
    BandCholesky band(static_cast<std::size_t>(size), static_cast<std::size_t>(reach));
    for (Index c = 0; c < size; ++c)
      for (Index r = c; r <= std::min(size - 1, c + reach); ++r)
        band.at(static_cast<std::size_t>(r), static_cast<std::size_t>(c)) = dense(r, c);
    return band;
  }
  Columns solution() const {
    BandCholesky factor = band();
    Columns found = right;
    RC_ASSERT(factor.factorise());
    factor.solve(found);
    return found;
  }
};

RC_GTEST_PROP(BandCholesky, SolvesAsADenseMatrixDoes, ()) {
  const Problem problem;
  RC_ASSERT((problem.dense * problem.solution() - problem.right).norm() <= 1e-11 * (1 + problem.right.norm()));
}

RC_GTEST_PROP(BandCholesky, HasTheSameBitsOnEveryInstructionSet, ()) {
  const Problem problem;
  std::optional<Columns> first;
  bool same = true;
  for_each_instruction_set([&](const char*) {
    const Columns found = problem.solution();
    if (!first) first = found;
    same =
        same && std::memcmp(found.data(), first->data(), sizeof(double) * static_cast<std::size_t>(found.size())) == 0;
  });
  RC_ASSERT(same);
}

RC_GTEST_PROP(BandCholesky, RefusesIndefiniteMatrices, ()) {
  Problem problem;
  const Index at = any(0, static_cast<int>(problem.size));
  problem.dense(at, at) = any(-3, 1);
  RC_ASSERT(!problem.band().factorise());
}

}  // namespace mobil::modal_cholesky_test
