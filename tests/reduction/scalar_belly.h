#pragma once
// One body's reduced problem in plain scalars: what the sixteen lanes of assets/reduction/reduced_bellies.h are
// compared with.

#include <span>

#include "assets/reduction/reduced_basis.h"
#include "assets/reduction/reduced_belly.h"
#include "engine/error.h"

namespace mobil::oracle {

/// As the functions of these names in assets/reduction/reduced_belly.h; by Householder's form and QL.
Result<ReducedBelly> make_reduced_belly(const ReducedBasis& basis, double across, double along);
void write_motion(const ReducedBelly& belly, double damping_per_s, double tick_s, std::span<float> motion);
void write_shape(const ReducedBelly& belly, double damping_per_s, std::span<float> shape);

}  // namespace mobil::oracle
