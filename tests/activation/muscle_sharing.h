#pragma once
// Static optimisation in double precision: shares given moments among a leg's muscles. Of all activations that make the
// moments, it returns those of minimum Σ volume · activation² (Crowninshield & Brand 1981 with the square; Happee & van
// der Helm 1995 for the volumes). A reserve moment at each joint replaces muscles that the leg lacks.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <mobil/components/activation.h>
#include "engine/eigen.h"

namespace mobil::test {

using MomentVector = Eigen::Matrix<double, leg_moment_count, 1>;
using MomentMatrix = Eigen::Matrix<double, leg_moment_count, leg_moment_count>;

/// One muscle at one instant. `active_n`: active force at activation 1, added to its passive force.
struct SharingMember {
  double volume_m3 = 0, active_n = 0, passive_n = 0;
  MomentVector arm_m = MomentVector::Zero();  // for each moment
};

/// A reserve of `size_nm` costs as much as a muscle of `volume_m3` at activation 1, and can exceed that size.
struct SharingReserve {
  double size_nm = 1, volume_m3 = 1;
};
using SharingReserves = std::array<SharingReserve, leg_moment_count>;

struct Sharing {
  std::vector<double> activation;
  MomentVector reserve_nm = MomentVector::Zero();
};

/// Solves the dual problem, which has five unknowns: activation = clamp(active · (arm · y) / volume), reserve = size²
/// · y / volume. Each Newton step is halved until the residual moments shrink.
inline Sharing share_moments(const std::vector<SharingMember>& members, const MomentVector& moments_nm,
                             const SharingReserves& reserves) {
  constexpr double least = 0.01, most = 1;
  MomentVector yielding;
  for (std::size_t j = 0; j < leg_moment_count; ++j)
    yielding[static_cast<Eigen::Index>(j)] = std::pow(reserves[j].size_nm, 2) / reserves[j].volume_m3;
  const auto wanted = [](const SharingMember& of, const MomentVector& y) {
    return of.active_n * of.arm_m.dot(y) / of.volume_m3;
  };
  const auto left = [&](const MomentVector& y) {
    MomentVector sum = moments_nm - yielding.cwiseProduct(y);
    for (const SharingMember& one : members)
      sum -= (std::clamp(wanted(one, y), least, most) * one.active_n + one.passive_n) * one.arm_m;
    return sum;
  };
  MomentVector y = MomentVector::Zero(), error = left(y);
  for (int step = 0; step < 200 && error.norm() > 1e-10 * (1 + moments_nm.norm()); ++step) {
    MomentMatrix slope = yielding.asDiagonal();
    for (const SharingMember& one : members) {
      const double a = wanted(one, y);
      if (a > least && a < most)
        slope += one.active_n * one.active_n / one.volume_m3 * one.arm_m * one.arm_m.transpose();
    }
    const MomentVector toward = slope.ldlt().solve(error);
    double part = 1;
    while (part > 1e-6 && left(y + part * toward).norm() > (1 - 1e-4 * part) * error.norm()) part /= 2;
    y += part * toward;
    error = left(y);
  }
  Sharing result;
  for (const SharingMember& one : members) result.activation.push_back(std::clamp(wanted(one, y), least, most));
  result.reserve_nm = yielding.cwiseProduct(y);
  return result;
}

}  // namespace mobil::test
