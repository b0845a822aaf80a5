#pragma once
// A symmetric matrix of sections that are each coupled to the next one alone, factorised section by section with dense
// blocks: bellies are long, and a spring on a section's mean adds nothing to the work.

#include <cstddef>
#include <vector>

#include "engine/eigen.h"

namespace mobil::inline v0_3 {

struct SectionChain {
  std::vector<Eigen::MatrixXd> own;    // of each section; the lower triangle counts
  std::vector<Eigen::MatrixXd> below;  // rows of the next section, columns of this one: one fewer
};

/// `sections` of `size` rows each, all zero.
SectionChain make_chain(std::size_t sections, std::size_t size);
void clear(SectionChain& chain);

/// Cholesky's factor in place; false where the matrix is not positive definite, and then it is spoilt.
bool factorise(SectionChain& chain);

/// Of a factorised chain, in place: `rows` is the right side, section after section, then the solution.
void solve(const SectionChain& chain, Eigen::VectorXd& rows);

}  // namespace mobil::inline v0_3
