#include "demo/lab/run_fit/run_top.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "assets/body/column.h"
#include "assets/gait/run_curves.h"

namespace mobil {
namespace {

using namespace geometry;
using enum Segment;

constexpr double cycle_angle = 2 * std::numbers::pi;

/// Rotation between two close ones, as kinematics has it.
Rotation part_of_way(const Rotation& a, const Rotation& b, double part) {
  const Rotation m{std::lerp(a.x, b.x, part), std::lerp(a.y, b.y, part), std::lerp(a.z, b.z, part),
                   std::lerp(a.w, b.w, part)};
  const double r = 1 / std::sqrt(m.x * m.x + m.y * m.y + m.z * m.z + m.w * m.w);
  return {m.x * r, m.y * r, m.z * r, m.w * r};
}

std::span<const double> numbers(const RunShape& shape, const ShapePart& part) {
  return {shape.data() + part.first, part.count};
}

/// Poses the top at one instant.
class TopPose {
 public:
  TopPose(const RunTask& task, RunPose& pose) : t_(task), pose_(pose) {}

  void column(double phase, double lean, double side_lean, double shoulders) {
    const RunGiven& g = t_.given;
    const double tilt = run_harmonics(g.tilt, 0, 2, phase), turn = run_harmonics(g.turn, 1, 2, phase),
                 list = run_harmonics(g.list, 1, 2, phase);
    const Rotation base = product(turn_about_y(turn), product(turn_about_z(-list), turn_about_x(tilt - neutral_tilt)));
    chest_ = product(turn_about_y(shoulders), product(turn_about_z(side_lean), turn_about_x(lean)));
    pose_.position[0] = {0, 0, 0};
    pose_.rotation[0] = base;
    constexpr std::size_t first = index(L5), shoulder = index(T1), top = index(head);
    static constexpr ColumnParts parts = column_parts();
    for (std::size_t s = first; s <= shoulder; ++s) hang(s, part_of_way(base, chest_, parts[s - first]));
    for (std::size_t s = shoulder + 1; s <= top; ++s)
      hang(s, part_of_way(chest_, Rotation{0, 0, 0, 1},
                          static_cast<double>(s - shoulder) / static_cast<double>(top - shoulder)));
  }

  void arm(std::size_t side, double phase) {
    const auto of = [&](Segment s) { return index(on_side(s, side)); };
    const double out = side == Side::left ? 1 : -1, pronation = -out * t_.forearm_pronation;
    const double shoulder = run_harmonics(t_.given.shoulder, 0, 1, phase),
                 elbow = run_harmonics(t_.given.elbow, 0, 1, phase);
    hang(of(clavicle_right), pose_.rotation[index(T1)]);
    const Rotation upper = product(chest_, product(turn_about_z(out * t_.arm_abduction),
                                                   product(turn_about_x(-shoulder), turn_about_y(0.3 * pronation))));
    hang(of(upper_arm_right), upper);
    const Rotation forearm = product(upper, product(turn_about_x(-elbow), turn_about_y(0.7 * pronation)));
    hang(of(forearm_right), forearm);
    const Rotation hand = product(forearm, turn_about_x(-0.10));
    hang(of(hand_right), hand);
    hang(of(fingers_right), product(hand, turn_about_x(-t_.finger_flexion)));
    hang(of(thumb_right), product(hand, product(turn_about_z(0.45 * out), turn_about_x(-0.35))));
  }

 private:
  void hang(std::size_t s, const Rotation& rotation) {
    const std::size_t parent = index(segment_parent[s]);
    pose_.position[s] = pose_.position[parent] + rotated(pose_.rotation[parent], t_.body.parts.joint_offset[s]);
    pose_.rotation[s] = rotation;
  }

  const RunTask& t_;
  RunPose& pose_;
  Rotation chest_{};
};

}  // namespace

Rotation turn_about_x(double angle) {
  return {std::sin(0.5 * angle), 0, 0, std::cos(0.5 * angle)};
}
Rotation turn_about_y(double angle) {
  return {0, std::sin(0.5 * angle), 0, std::cos(0.5 * angle)};
}
Rotation turn_about_z(double angle) {
  return {0, 0, std::sin(0.5 * angle), std::cos(0.5 * angle)};
}

Vec3<double> turned_by(const Rotation& from, const Rotation& to, const Vec3<double>& inertia) {
  const Rotation d = product(conjugate(from), to);
  const Vec3<double> half{d.x, d.y, d.z};
  const double sine2 = dot(half, half), times = (d.w < 0 ? -2 : 2) * (1 + sine2 * (1.0 / 6 + sine2 * (3.0 / 40)));
  const Vec3<double> momentum{times * inertia.x * half.x, times * inertia.y * half.y, times * inertia.z * half.z};
  return rotated(part_of_way(from, to, 0.5), momentum);
}

double run_harmonics(std::span<const double> number, int first, int apart, double phase) {
  const bool has_mean = first == 0;
  const std::size_t count = (number.size() - (has_mean ? 1 : 0)) / 2, from = has_mean ? 1 : 0;
  double sum = has_mean ? number[0] : 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double a = cycle_angle * phase * (first + apart * static_cast<int>(k + from));
    sum += number[from + k] * std::cos(a) + number[from + count + k] * std::sin(a);
  }
  return sum;
}

std::array<double, top_numbers> numbers_of_top(const RunShape& shape) {
  std::array<double, top_numbers> all{};
  auto to = all.begin();
  for (const ShapePart& part : {run_shape::trunk, run_shape::flight, run_shape::side_lean, run_shape::shoulders}) {
    const auto own = numbers(shape, part);
    to = std::copy(own.begin(), own.end(), to);
  }
  return all;
}

void evaluate_top(const RunTask& task, const RunShape& shape, RunTop& top) {
  const std::size_t n = task.samples / 2;
  const BodyParts& parts = task.body.parts;
  top.pose.resize(n);
  for (RunVectors* v : {&top.centre, &top.momentum}) v->assign(n, {0, 0, 0});
  for (RunSamples* v : {&top.trunk, &top.side_lean, &top.shoulders}) v->resize(n);
  top.mass = 0;
  for (std::size_t s = 0; s < segment_count; ++s) top.mass += is_in_top(s) ? parts.mass[s] : 0;
  std::array<run_curve::FlightLean, run_curve::flight_terms> leans;
  const double stance = 2 * task.duty;
  for (std::size_t k = 0; k < leans.size(); ++k) leans[k] = run_curve::flight_lean(k, 2 * stance / (1 - stance));

  std::vector<std::array<Vec3<double>, segment_count>> at(n);  // centres of segments
  for (std::size_t i = 0; i < n; ++i) {
    const double step = static_cast<double>(i) / static_cast<double>(n), phase = 0.5 * step;
    double lean = run_harmonics(numbers(shape, run_shape::trunk), 0, 2, phase);
    for (std::size_t k = 0; k < leans.size(); ++k)
      lean += shape[run_shape::flight.first + k] * run_curve::flight_lean_at(leans[k], step, stance);
    top.trunk[i] = lean;
    top.side_lean[i] = run_harmonics(numbers(shape, run_shape::side_lean), 1, 2, phase);
    top.shoulders[i] = run_harmonics(numbers(shape, run_shape::shoulders), 1, 2, phase);
    TopPose pose(task, top.pose[i]);
    pose.column(phase, lean, top.side_lean[i], top.shoulders[i]);
    pose.arm(Side::right, phase);
    pose.arm(Side::left, phase + 0.5);
    for (std::size_t s = 0; s < segment_count; ++s) {
      if (!is_in_top(s)) continue;
      at[i][s] = top.pose[i].position[s] + rotated(top.pose[i].rotation[s], parts.centre_of_mass[s]);
      top.centre[i] = top.centre[i] + (parts.mass[s] / top.mass) * at[i][s];
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    const bool last = i + 1 == n;
    const Vec3<double> next_centre = last ? mirrored(top.centre[0]) : top.centre[i + 1];
    for (std::size_t s = 0; s < segment_count; ++s) {
      if (!is_in_top(s)) continue;
      const Vec3<double> next = last ? mirrored(at[0][other_side(s)]) : at[i + 1][s];
      const Rotation turned = last ? mirrored(top.pose[0].rotation[other_side(s)]) : top.pose[i + 1].rotation[s];
      top.momentum[i] = top.momentum[i] + parts.mass[s] * cross(at[i][s] - top.centre[i], next - next_centre) +
                        turned_by(top.pose[i].rotation[s], turned, parts.inertia[s]);
    }
  }
}

}  // namespace mobil
