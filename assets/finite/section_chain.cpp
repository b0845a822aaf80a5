#include "assets/finite/section_chain.h"

#include "engine/eigen.h"

namespace mobil::inline v0_3 {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

}  // namespace

SectionChain make_chain(std::size_t sections, std::size_t size) {
  const auto n = static_cast<Index>(size);
  return {std::vector<MatrixXd>(sections, MatrixXd::Zero(n, n)),
          std::vector<MatrixXd>(sections > 0 ? sections - 1 : 0, MatrixXd::Zero(n, n))};
}

void clear(SectionChain& chain) {
  for (MatrixXd& m : chain.own) m.setZero();
  for (MatrixXd& m : chain.below) m.setZero();
}

bool factorise(SectionChain& chain) {
  for (std::size_t s = 0; s < chain.own.size(); ++s) {
    const Eigen::LLT<Eigen::Ref<MatrixXd>> factor(chain.own[s]);
    if (factor.info() != Eigen::Success) return false;
    if (s + 1 == chain.own.size()) break;
    chain.own[s].triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(chain.below[s]);
    chain.own[s + 1].selfadjointView<Eigen::Lower>().rankUpdate(chain.below[s], -1.0);
  }
  return true;
}

void solve(const SectionChain& chain, Eigen::VectorXd& rows) {
  const std::size_t sections = chain.own.size();
  const Index n = chain.own.front().rows();
  const auto part = [&](std::size_t s) { return rows.segment(static_cast<Index>(s) * n, n); };
  for (std::size_t s = 0; s < sections; ++s) {
    if (s > 0) part(s).noalias() -= chain.below[s - 1] * part(s - 1);
    auto own = part(s);
    chain.own[s].triangularView<Eigen::Lower>().solveInPlace(own);
  }
  for (std::size_t s = sections; s-- > 0;) {
    if (s + 1 < sections) part(s).noalias() -= chain.below[s].transpose() * part(s + 1);
    auto own = part(s);
    chain.own[s].triangularView<Eigen::Lower>().transpose().solveInPlace(own);
  }
}

}  // namespace mobil::inline v0_3
