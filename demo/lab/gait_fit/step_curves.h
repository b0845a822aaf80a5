#pragma once
// Curves of a step, and the ankle of a foot that rolls on the ground.

#include <algorithm>
#include <cmath>
#include <span>

#include <mobil/components/step_plan.h>
#include "demo/lab/gait_fit/step_model.h"

namespace mobil {

/// A value with its first two derivatives by time.
struct Moving {
  double value = 0, rate = 0, bend = 0;
};

/// Fifth-degree polynomial between two states over u in 0…1 that takes `span` seconds.
inline double quintic(double u, const Moving& a, const Moving& b, double span) {
  const double r = b.value - a.value - a.rate * span - 0.5 * a.bend * span * span;
  const double s = (b.rate - a.rate) * span - a.bend * span * span, q = 0.5 * (b.bend - a.bend) * span * span;
  return a.value + u * (a.rate * span +
                        u * (0.5 * a.bend * span * span +
                             u * ((10 * r - 4 * s + q) + u * ((-15 * r + 7 * s - 2 * q) + u * (6 * r - 3 * s + q)))));
}

inline double legendre(std::size_t degree, double x) {
  double before = 1, now = x;
  if (degree == 0) return 1;
  for (std::size_t k = 1; k < degree; ++k) {
    const double k1 = static_cast<double>(k);
    const double next = ((2 * k1 + 1) * x * now - k1 * before) / (k1 + 1);
    before = now;
    now = next;
  }
  return now;
}

/// Returns (1 − u)³ times a polynomial that starts with the first number and without slope; 0 from u = 1 on.
inline double falling(std::span<const double> numbers, double u) {
  const double left = std::max(1 - u, 0.0);
  double tail = 0;
  for (std::size_t i = numbers.size() - 1; i > 0; --i) tail = u * (numbers[i] + tail);
  return left * left * left * (numbers[0] * (1 + u * (3 + 6 * u)) + tail);
}

/// Returns the start of a falling curve over `span` of the cycle, with derivatives by the cycle.
inline Moving falling_start(std::span<const double> numbers, double span) {
  return {numbers[0], numbers[1] / span, (2 * numbers[2] - 6 * numbers[1]) / (span * span)};
}

/// Returns the pitch from heel rise on, for u from 0 to 1 at toe-off: heel up, negative.
inline double heel_rise(std::span<const double> numbers, double u) {
  double sum = 0;
  for (std::size_t i = numbers.size(); i > 0; --i) sum = numbers[i - 1] + u * sum;
  return -u * u * u * sum;
}

/// Returns the end of a heel rise over `span` of the cycle, with derivatives by the cycle.
inline Moving heel_rise_end(std::span<const double> numbers, double span) {
  double sum = 0, slope = 0, bend = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const double k = static_cast<double>(i + 3), v = numbers[i];
    sum -= v;
    slope -= k * v;
    bend -= k * (k - 1) * v;
  }
  return {sum, slope / span, bend / (span * span)};
}

/// Returns 64 (u (1 − u))³ times Legendre polynomials.
inline double bumps(std::span<const double> numbers, double u) {
  double sum = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) sum += numbers[i] * legendre(i, 2 * u - 1);
  const double bump = u * (1 - u);
  return 64 * bump * bump * bump * sum;
}

/// Returns derivatives by time of a curve with derivatives by the cycle.
inline Moving per_second(const Moving& by_cycle, double period_s) {
  return {by_cycle.value, by_cycle.rate / period_s, by_cycle.bend / (period_s * period_s)};
}

/// Returns the pitch of the toes, heel up, of a foot whose heel has risen by `heel_up`, with derivatives by `heel_up`.
inline Moving toe_pitch(double heel_up) {
  constexpr double w2 = static_cast<double>(toe_rocker::within) * static_cast<double>(toe_rocker::within);
  constexpr double part = static_cast<double>(toe_rocker::part);
  const double d = std::max(heel_up - static_cast<double>(toe_rocker::from), 0.0), d2 = d * d, s = d2 + w2;
  return {part * d * d2 / s, part * d2 * (d2 + 3 * w2) / (s * s), part * 2 * d * w2 * (3 * w2 - d2) / (s * s * s)};
}

/// Returns the ankle's height (`up`) or its distance ahead of the foothold, with derivatives. The foot rolls over the
/// rim of its heel (toes up) or over its toes (heel up).
inline Moving rolled(const StepBody& b, const Moving& pitch, bool up) {
  if (pitch.value >= 0) {
    const double s = std::sin(pitch.value), c = std::cos(pitch.value), over = b.ankle_height - b.heel_radius;
    const double value = up ? b.heel_radius + b.heel_back * s + over * c
                            : b.heel_back * (c - 1) - over * s - b.heel_radius * pitch.value;
    const double first = up ? b.heel_back * c - over * s : -b.heel_back * s - over * c - b.heel_radius;
    const double bend = up ? -b.heel_back * s - over * c : -b.heel_back * c + over * s;
    return {value, first * pitch.rate, bend * pitch.rate * pitch.rate + first * pitch.bend};
  }
  const double over = b.ankle_height - b.toe_joint_height;
  const Moving q = toe_pitch(-pitch.value);
  const double s = std::sin(-pitch.value), c = std::cos(pitch.value), qs = std::sin(q.value), qc = std::cos(q.value);
  // the toe joint from the tips, the ankle from the joint: z and y of each, and these are each other's derivatives
  const double joint_y = b.toes_length * qs + b.toe_joint_height * qc;
  const double joint_z = b.toes_length * qc - b.toe_joint_height * qs;
  const double ankle_y = b.ball_forward * s + over * c, ankle_z = b.ball_forward * c - over * s;
  const double value = up ? joint_y + ankle_y : b.ball_forward + b.toes_length - joint_z - ankle_z;
  const double first = up ? joint_z * q.rate + ankle_z : joint_y * q.rate + ankle_y;
  const double bend = up ? joint_z * q.bend - joint_y * q.rate * q.rate - ankle_y
                         : joint_y * q.bend + joint_z * q.rate * q.rate + ankle_z;
  return {value, -first * pitch.rate, bend * pitch.rate * pitch.rate - first * pitch.bend};
}

}  // namespace mobil
