#include "assets/fem/stencil_matrix.h"

namespace mobil::inline v0_3 {

void StencilMatrix::add(std::uint32_t neighbour, const std::array<double, 9>& block) {
  Coupling& to = coupling_.emplace_back();
  to.of = 3 * std::size_t{neighbour};
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t r = 0; r < 3; ++r) to.column[c][r] = block[3 * r + c];
}

void StencilMatrix::multiply(const std::vector<double>& x, std::vector<double>& y) const {
  for (std::size_t n = 0; n + 1 < first_.size(); ++n) {
    double f[4] = {0, 0, 0, 0};
    for (std::size_t p = first_[n]; p < first_[n + 1]; ++p) {
      const auto& [column, of] = coupling_[p];
      const double* const u = &x[of];
      for (std::size_t r = 0; r < 4; ++r) f[r] += column[0][r] * u[0] + column[1][r] * u[1] + column[2][r] * u[2];
    }
    for (std::size_t r = 0; r < 3; ++r) y[3 * n + r] = f[r];
  }
}

}  // namespace mobil::inline v0_3
