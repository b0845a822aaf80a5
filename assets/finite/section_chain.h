#pragma once
// A symmetric matrix of sections that are each coupled only to the next one. It is factorised section by section with
// dense blocks, because bellies are long. A spring on a section's mean costs nothing extra.

#include <cstddef>
#include <vector>

#include "engine/eigen.h"

namespace mobil::inline v0_3 {

struct SectionChain {
  std::vector<Eigen::MatrixXd> own;    // of each section; only the lower triangle is used
  std::vector<Eigen::MatrixXd> below;  // rows of the next section, columns of this one; one fewer
};

/// Returns `sections` of `size` rows each, all zero.
SectionChain make_chain(std::size_t sections, std::size_t size);
void clear(SectionChain& chain);

/// Replaces the chain by its Cholesky factor. Returns false, with the chain spoilt, if it is not positive definite.
bool factorise(SectionChain& chain);

/// Solves with a factorised chain in place: `rows` is the right side, section after section, then the solution.
void solve(const SectionChain& chain, Eigen::VectorXd& rows);

}  // namespace mobil::inline v0_3
