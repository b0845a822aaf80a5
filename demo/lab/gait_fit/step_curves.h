#pragma once
// Curves of a step, and the ankle of a foot that rolls on the ground.

#include <algorithm>
#include <cmath>

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
