#pragma once
// Sixteen walkers, each another, side by side in one block and moved on as a simulation moves them.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <memory>
#include <random>
#include <stdexcept>

#include "assets/body/anthropometry.h"
#include "systems/gait/gait.h"
#include "systems/kinematics/kinematics.h"

namespace mobil {

struct Dice {
  std::mt19937 engine;
  double operator()(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine()) / 4294967296.0);
  }
  float single(double low, double high) { return static_cast<float>((*this)(low, high)); }
};

/// One row into one lane of a block: both are nothing but 4-byte words.
template <class Row, class Block>
void put(const Row& row, Block& block, std::size_t lane) {
  static_assert(sizeof(Block) == lane_count * sizeof(Row));
  for (std::size_t i = 0; i < sizeof(Row) / 4; ++i)
    std::memcpy(reinterpret_cast<char*>(&block) + 4 * (i * lane_count + lane),
                reinterpret_cast<const char*>(&row) + 4 * i, 4);
}

/// One lane of a block as a row.
template <template <class> class C>
C<float> row(const C<Lanes<float>>& block, std::size_t lane) {
  C<float> r;
  for (std::size_t i = 0; i < sizeof(r) / 4; ++i)
    std::memcpy(reinterpret_cast<char*>(&r) + 4 * i,
                reinterpret_cast<const char*>(&block) + 4 * (i * lane_count + lane), 4);
  return r;
}

inline Vec3<float> at(const Vec3<Lanes<float>>& v, std::size_t l) {
  return {v.x[l], v.y[l], v.z[l]};
}
inline Quat<float> at(const Quat<Lanes<float>>& q, std::size_t l) {
  return {q.x[l], q.y[l], q.z[l], q.w[l]};
}
inline double distance(const Vec3<float>& a, const Vec3<float>& b) {
  const double x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
  return std::sqrt(x * x + y * y + z * z);
}
/// Angle between two rotations, rad.
inline double angle_between(const Quat<float>& a, const Quat<float>& b) {
  const double same = std::fabs(double{a.x} * b.x + double{a.y} * b.y + double{a.z} * b.z + double{a.w} * b.w);
  return 2.0 * std::sqrt(std::fmax(2.0 - 2.0 * same, 0.0));
}
inline Vec3<float> rotated(const Quat<float>& q, const Vec3<float>& v) {
  const Vec3<float> t = {2 * (q.y * v.z - q.z * v.y), 2 * (q.z * v.x - q.x * v.z), 2 * (q.x * v.y - q.y * v.x)};
  return {v.x + q.w * t.x + q.y * t.z - q.z * t.y, v.y + q.w * t.y + q.z * t.x - q.x * t.z,
          v.z + q.w * t.z + q.x * t.y - q.y * t.x};
}

/// Every parameter somewhere in the given part of the way from its default to the ends of its range. The two that make
/// right and left steps unlike stay as they are.
inline GaitStyle random_style(Dice& dice, double part) {
  GaitStyle style;
  for (const GaitParameter& p : gait_parameters) {
    if (p.value == &GaitStyle::step_asymmetry || p.value == &GaitStyle::time_asymmetry) continue;
    float& value = style.*p.value;
    value += static_cast<float>(part * (dice(double{p.low}, double{p.high}) - double{value}));
  }
  return style;
}

struct Walkers {
  std::array<Body, lane_count> body;
  BodySize<Lanes<float>> size{};
  Gait<Lanes<float>> gait{};
  StepPlan<Lanes<float>> plan{};
  GaitState<Lanes<float>> state{};
  Pose<Lanes<float>> pose{};
  JointAngles<Lanes<float>> angles{};
  Feet<Lanes<float>> feet{};
  CentreOfMass<Lanes<float>> centre{};

  void set_body(std::size_t lane, const BodyRequest& request) {
    body[lane] = make_body(request).value();
    put(BodySize<float>{request.height_m, request.mass_kg}, size, lane);
  }
  /// False where the gait is out of range; it then stays as it was.
  bool ask(std::size_t lane, const GaitRequest& request) {
    auto wanted = resolve_gait(body[lane], request);
    if (!wanted) return false;
    wanted->heading_rad = gait.heading_rad[lane];
    wanted->revision = gait.revision[lane] + 1;
    put(*wanted, gait, lane);
    return true;
  }
  void begin() {
    state = {};
    plan_first_step(size, gait, plan);
    place();
  }
  void place() {
    pose_skeleton(size, plan, state, pose, angles, feet);
    centre_of_mass(size, pose, centre);
  }
  void place(float time_s) {
    for (float& t : state.time_s.lane) t = time_s;
    place();
  }
  /// To a part of the step.
  void place_at(float part) {
    for (std::size_t l = 0; l < lane_count; ++l) state.time_s[l] = part * plan.duration_s[l];
    place();
  }
  void replan(std::uint32_t lanes) {
    const auto next = std::make_unique<StepPlan<Lanes<float>>>(plan);
    plan_next_step(size, gait, state, *next);
    for (std::size_t l = 0; l < lane_count; ++l)
      if ((lanes >> l & 1U) != 0) put(row(*next, l), plan, l);
  }
  void tick(float tick_s) {
    advance_gait(plan, state, tick_s);
    if (const std::uint32_t lanes = lanes_to_plan(plan, gait, state, tick_s); lanes != 0) replan(lanes);
    turn_gait(plan, gait, state, tick_s);
    place();
  }
  /// From the end of this step to the start of the next, all at once.
  void strike() {
    state.time_s = plan.duration_s;
    advance_gait(plan, state, 0.0F);
    replan(0xFFFF);
    turn_gait(plan, gait, state, 1e-3F);
  }
};

/// Of any height, from very thin to very heavy.
inline BodyRequest random_body(Dice& dice) {
  const double height = dice(1.2, 2.2), mass = dice(15, 42) * height * height;
  return {.height_m = static_cast<float>(height), .mass_kg = static_cast<float>(std::clamp(mass, 30.0, 200.0))};
}

/// A speed alone, or with a step length or a step frequency, any that the body may be asked.
inline void ask_anything(Walkers& w, std::size_t lane, Dice& dice, double style_part) {
  for (;;) {
    GaitRequest request;
    request.style = random_style(dice, style_part);
    const double leg = w.body[lane].thigh_length_m + w.body[lane].shank_length_m, scale = std::sqrt(leg / 0.9);
    request.speed_m_s = dice.single(0.31, 2.29) * static_cast<float>(scale);
    const double which = dice(0, 3);
    if (which < 1) request.step_length_m = dice.single(0.26, 1.24) * static_cast<float>(leg);
    if (which > 2) request.step_frequency_hz = dice.single(0.51, 2.99) / static_cast<float>(scale);
    if (w.ask(lane, request)) return;
  }
}

/// A walk of a natural cadence, speeds as a part of the range.
inline void ask_natural(Walkers& w, std::size_t lane, Dice& dice, double style_part) {
  GaitRequest request;
  request.style = random_style(dice, style_part);
  const double leg = w.body[lane].thigh_length_m + w.body[lane].shank_length_m;
  request.speed_m_s = dice.single(0.6, 1.9) * static_cast<float>(std::sqrt(leg / 0.9));
  if (!w.ask(lane, request)) throw std::runtime_error("a natural walk was refused");
}

inline std::unique_ptr<Walkers> random_walkers(unsigned seed, double style_part = 0.0) {
  Dice dice{std::mt19937(seed)};
  auto w = std::make_unique<Walkers>();
  for (std::size_t l = 0; l < lane_count; ++l) {
    w->set_body(l, random_body(dice));
    ask_natural(*w, l, dice, style_part);
  }
  w->begin();
  return w;
}

}  // namespace mobil
