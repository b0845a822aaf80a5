#pragma once
// Numbers between the stiffness of all bodies of one template and that of one of them, proven.
//
// With r = S / l, p = S·l and over the mass S²·l, a body's stiffness is K(r, p) = (A/r + B + r·C)/p + ω_f²·F; K₀ is
// that of (r₀, p₀) times p₀. A and C are positive semidefinite (each is the energy of a field with its other gradients
// left out), so with s = ln(r/r₀), A₀ = A/r₀ and C₀ = r₀·C
//   p·K = K₀ + s·(C₀ − A₀) + (e^s − 1 − s)·C₀ + (e^−s − 1 + s)·A₀ + (p − p₀)·ω_f²·F,
// whose third and fourth terms are at least 0 and at most (e^|s| − 1 − |s|)·(A₀ + C₀). Hence, from
//   low·K₀ ≤ C₀ − A₀ ≤ high·K₀,   A₀ + C₀ ≤ sum·K₀,   p₀·ω_f²·F ≤ braced·K₀,
// bounds of p·K by K₀ for every r and p. For the slowest vibration alone there is a sharper one: the same constant is
// proven at the ends r₁ and r₂ of the range too, and between two of the three, r = θ·r₁ + (1 − θ)·r₂,
//   θ·K(r₁) + (1 − θ)·K(r₂) = K(r) + (θ/r₁ + (1 − θ)/r₂ − 1/r)·A,
// all times p₀ or p, so that (concavity of the least eigenvalue) θ·slowest₁ + (1 − θ)·slowest₂ is too high by no more
// than the last term, at most (θ/r₁ + (1 − θ)/r₂ − 1/r)·r₀·sum/least of K(r) itself, and with p < p₀ the foundation's.
// Each constant is estimated by Lanczos iteration and then proven: the difference has a Cholesky factor. What rounding
// may hide in that is below 1e-6 of the margin that is left.

#include "assets/reduction/reduced_operators.h"
#include "tests/reduction/bound/reduction_space.h"

namespace mobil {

/// least·K₀ ≤ p·K ≤ most·K₀.
struct StiffnessRange {
  double least = 1, most = 1;
};

struct StiffnessConstants {
  double ratio = 1, product = 1;  // r₀ and p₀
  double low = 0, high = 0, sum = 0, braced = 0;
  double end_ratio[3] = {1, 1, 1}, slowest[3] = {};  // ascending, r₀ between them: slowest·M₁ ≤ p₀·K(r, p₀), 1/s²
};

/// K₀.
OperatorMix reference_stiffness(double ratio, double product, double foundation_1_s2);

/// Fails where K₀ is not positive definite.
Result<StiffnessConstants> make_stiffness_constants(const SpaceCase& given, const MovingOperator& inverse);

/// No vibration of that body, of a ratio between the ends, has an ω² below; 1/s².
double slowest_square(const StiffnessConstants& constants, double across, double along);

/// Of a body scaled by `across` and `along`; least may be 0 or below far from r₀.
StiffnessRange stiffness_range(const StiffnessConstants& constants, double across, double along);

}  // namespace mobil
