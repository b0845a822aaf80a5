#pragma once
// Pelvis, column, head and arms of a running step, relative to the middle of the hips, and rotations of segments.

#include <array>
#include <span>
#include <vector>

#include "demo/lab/run_fit/run_model.h"

namespace mobil {

using Rotation = Quat<double>;

Rotation turn_about_x(double angle);
Rotation turn_about_y(double angle);
Rotation turn_about_z(double angle);

/// Returns the angular momentum of a segment between two close rotations, per unit of mass, times the time between
/// them.
Vec3<double> turned_by(const Rotation& from, const Rotation& to, const Vec3<double>& inertia);

/// Returns a mean (if `first` is 0) and harmonics `first`, `first` + `apart` … of the cycle at a phase; cosines come
/// before sines in `number`.
double run_harmonics(std::span<const double> number, int first, int apart, double phase);

/// Segments above the legs.
constexpr bool is_in_top(std::size_t segment) {
  return segment <= index(Segment::head) || segment >= index(Segment::clavicle_right);
}
constexpr std::size_t other_side(std::size_t segment) {
  constexpr std::size_t leg = index(Segment::thigh_right), arm = index(Segment::clavicle_right);
  if (segment < leg) return segment;
  if (segment < arm) return segment < leg + 5 ? segment + 5 : segment - 5;
  return segment < arm + 6 ? segment + 6 : segment - 6;
}

/// Centre of mass of the body above the hips relative to their middle, its mass, and between each sample and the next
/// its angular momentum about its centre, times the interval.
struct RunTop {
  double mass = 0;
  RunVectors centre, momentum;
  RunSamples trunk, side_lean, shoulders;
  std::vector<RunPose> pose;  // relative to the middle of the hips; without legs
};

/// Number of shape parameters on which the top depends.
inline constexpr std::size_t top_numbers =
    run_shape::trunk.count + run_shape::flight.count + run_shape::side_lean.count + run_shape::shoulders.count;
std::array<double, top_numbers> numbers_of_top(const RunShape& shape);

/// Evaluates the top over a step.
void evaluate_top(const RunTask& task, const RunShape& shape, RunTop& top);

}  // namespace mobil
