#pragma once
// Curves of a running step (mobil/components/run_shape.h) as polynomials: the ground force of a foot, the path of the
// centre of mass as its double integral, and the lean that balances the trunk in flight. The path is therefore exact:
// a parabola in flight, and twice continuously differentiable through contact and toe-off.

#include <array>
#include <cstddef>
#include <span>

namespace mobil::inline v0_3::run_curve {

/// Foot flat and heel rise in the usual run, and the part in which heel and shoe yield: of the cycle, from contact.
inline constexpr double usual_flat = 0.055, usual_rise = 0.13, pad_part = 0.07;

/// Number of terms of a force up or forward, with the first, which follows from the others.
inline constexpr std::size_t force_terms = 9;

/// A force over stance, u = time since contact / contact time from 0 to 1, and its integrals over u from 0. Polynomials
/// of 2u − 1, coefficients from the constant upward: their terms hardly cancel, so single precision is enough.
struct ForcePath {
  std::array<double, force_terms + 2> force{};
  std::array<double, force_terms + 3> once{};
  std::array<double, force_terms + 4> twice{};
};

/// Returns the value of a polynomial.
template <class F, std::size_t count>
constexpr F polynomial(const std::array<double, count>& coefficient, const F& u) {
  F sum = F(coefficient[count - 1]);
  for (std::size_t i = count - 1; i > 0; --i) sum = F(coefficient[i - 1]) + u * sum;
  return sum;
}

/// Returns the indefinite integral that is 0 at 0.
template <std::size_t count>
constexpr std::array<double, count + 1> integral(const std::array<double, count>& of) {
  std::array<double, count + 1> sum{};
  for (std::size_t i = 0; i < count; ++i) sum[i + 1] = of[i] / static_cast<double>(i + 1);
  return sum;
}

/// Returns the coefficients of the Legendre polynomials.
constexpr std::array<std::array<double, force_terms>, force_terms> legendre_coefficients() {
  std::array<std::array<double, force_terms>, force_terms> p{};
  p[0][0] = 1;
  p[1][1] = 1;
  for (std::size_t k = 1; k + 1 < force_terms; ++k) {
    const auto degree = static_cast<double>(k);
    for (std::size_t i = 0; i < force_terms; ++i)
      p[k + 1][i] = ((2 * degree + 1) * (i > 0 ? p[k][i - 1] : 0) - degree * p[k - 1][i]) / (degree + 1);
  }
  return p;
}

/// Returns the integral over u of a polynomial of 2u − 1, from u = 0.
template <std::size_t count>
constexpr std::array<double, count + 1> integral_over_stance(const std::array<double, count>& of) {
  std::array<double, count + 1> sum = integral(of);
  for (double& c : sum) c *= 0.5;
  sum[0] -= polynomial(sum, -1.0);
  return sum;
}

/// Returns the force u (1 − u) Σ number_k P_k(2u − 1), of at most `force_terms` numbers, with its integrals.
constexpr ForcePath force_path(std::span<const double> number) {
  constexpr auto legendre_terms = legendre_coefficients();
  ForcePath path;
  for (std::size_t k = 0; k < number.size(); ++k) {
    for (std::size_t i = 0; i < force_terms; ++i) {
      const double c = 0.25 * number[k] * legendre_terms[k][i];  // u (1 − u) = (1 − x²)/4
      path.force[i] += c;
      path.force[i + 2] -= c;
    }
  }
  path.once = integral_over_stance(path.force);
  path.twice = integral_over_stance(path.once);
  return path;
}

/// Returns number 0 of a force up, from number 2 and the duty factor, so that a steady run carries its weight: over a
/// step the mean force is 1. (Of u (1 − u) P_k only k = 0 and 2 have integrals, 1/6 and −1/30.)
constexpr double weight_term(double duty, double second) {
  return 3 / duty + second / 5;
}
/// Returns number 0 of a force forward, so that the speed is the same after the step.
constexpr double steady_term(double second) {
  return second / 5;
}

/// Returns the force at u; 0 in flight.
constexpr double force_at(const ForcePath& path, double u) {
  return u < 1 ? polynomial(path.force, 2 * u - 1) : 0.0;
}
/// Returns the whole integral over stance.
constexpr double impulse(const ForcePath& path) {
  return polynomial(path.once, 1.0);
}
/// Returns the double integral at u, continued in a straight line beyond stance.
constexpr double twice_at(const ForcePath& path, double u) {
  return u < 1 ? polynomial(path.twice, 2 * u - 1) : polynomial(path.twice, 1.0) + (u - 1) * impulse(path);
}

/// Number of terms of the lean added in flight.
inline constexpr std::size_t flight_terms = 4;

/// A lean over a step. Its second derivative in flight is a Legendre polynomial of w, from −1 at toe-off to 1 at
/// contact. In stance that derivative is linear between the values at both ends, plus a multiple of x (1 − x), with x
/// from 0 at contact to 1 at toe-off. The multiple is that after which the rate returns to its value. The mean over a
/// step is 0. Derivatives are by w. Polynomials of x and of w + 1.
struct FlightLean {
  std::array<double, 5> stance{};
  std::array<double, 6> flight{};
};

/// Returns a term for steps whose contact takes `ratio` times half of the flight's time.
constexpr FlightLean flight_lean(std::size_t term, double ratio) {
  // P_k of v − 1, as coefficients of v
  constexpr std::array<std::array<double, 4>, flight_terms> legendre_terms = {
      {{1, 0, 0, 0}, {-1, 1, 0, 0}, {1, -3, 1.5, 0}, {-1, 6, -7.5, 2.5}}};
  const double last = term % 2 == 0 ? 1 : -1;
  const double bulge = -6 * (0.5 * (1 + last) + (term == 0 ? 2 / ratio : 0));
  const double scale = ratio * ratio;
  const std::array<double, 3> bend = {scale, scale * (last - 1 + bulge), -scale * bulge};  // by x
  const auto rate = integral(bend);
  const auto flight_rate = integral(legendre_terms[term]);
  FlightLean lean;
  lean.stance = integral(rate);
  lean.flight = integral(flight_rate);
  const double rate_after = polynomial(rate, 1.0) / ratio;  // by w
  const double start_rate =
      -(polynomial(lean.stance, 1.0) + 2 * rate_after + polynomial(lean.flight, 2.0)) / (ratio + 2);
  lean.stance[1] = start_rate * ratio;
  lean.flight[1] = start_rate + rate_after;
  lean.flight[0] = polynomial(lean.stance, 1.0);
  const double mean =
      (ratio * polynomial(integral(lean.stance), 1.0) + polynomial(integral(lean.flight), 2.0)) / (ratio + 2);
  lean.stance[0] -= mean;
  lean.flight[0] -= mean;
  return lean;
}

/// Returns the value of a term at a part `step` of the step, 0 at contact to 1, `stance` its end of stance.
constexpr double flight_lean_at(const FlightLean& lean, double step, double stance) {
  return step < stance ? polynomial(lean.stance, step / stance)
                       : polynomial(lean.flight, 2 * (step - stance) / (1 - stance));
}

}  // namespace mobil::inline v0_3::run_curve
