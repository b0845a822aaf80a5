#pragma once
// Sixteen different walkers in one block, advanced as a simulation advances them.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <random>
#include <stdexcept>

#include <mobil/anthropometry.h>
#include <mobil/body_composition.h>
#include <mobil/components/step_plan.h>
#include <mobil/engine/geometry.h>
#include "systems/gait/gait.h"
#include "systems/gait/kinematics.h"
#include "tests/engine/row_lanes.h"

namespace mobil {

using geometry::rotated;

struct Dice {
  std::mt19937 engine;
  double operator()(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine()) / 4294967296.0);
  }
  float single(double low, double high) { return static_cast<float>((*this)(low, high)); }
};

inline double distance(const Vec3<float>& a, const Vec3<float>& b) {
  const double x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
  return std::sqrt(x * x + y * y + z * z);
}
/// Returns the angle between two rotations, rad.
inline double angle_between(const Quat<float>& a, const Quat<float>& b) {
  const double same = std::fabs(double{a.x} * b.x + double{a.y} * b.y + double{a.z} * b.z + double{a.w} * b.w);
  return 2.0 * std::sqrt(std::fmax(2.0 - 2.0 * same, 0.0));
}
/// Returns a style with every parameter at a random place within the fraction `part` of the way from its default to the
/// ends of its range. The two asymmetries and the forward swing keep their defaults; tests set them separately.
inline GaitStyle random_style(Dice& dice, double part) {
  GaitStyle style;
  for (const GaitParameter& p : gait_parameters) {
    if (p.value == &GaitStyle::step_asymmetry || p.value == &GaitStyle::time_asymmetry ||
        p.value == &GaitStyle::forward_swing)
      continue;
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
    put(body[lane].size, size, lane);
  }
  /// Returns false if the gait is out of range; it is then unchanged. Barefoot walkers have the steps of the table.
  bool ask(std::size_t lane, const GaitRequest& request, Footwear footwear = Footwear::barefoot) {
    auto wanted = resolve_gait(body[lane], request, footwear);
    if (!wanted) return false;
    wanted->heading_rad = gait.heading_rad[lane];
    wanted->displacement = gait.displacement[lane];
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
    pose_skeleton(size, plan, state, nullptr, pose, angles, feet);
    centre_of_mass(size, pose, centre);
  }
  void place(float time_s) {
    for (float& t : state.time_s.lane) t = time_s;
    place();
  }
  /// Sets the time to a fraction of the step.
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
    turn_gait(size, plan, gait, state, tick_s);
    place();
  }
  /// Advances from the end of this step to the start of the next at once.
  void strike() {
    state.time_s = plan.duration_s;
    advance_gait(plan, state, 0.0F);
    replan(0xFFFF);
    turn_gait(size, plan, gait, state, 1e-3F);
  }
};

/// Returns a body of any height, from very thin to very heavy.
inline BodyRequest random_body(Dice& dice) {
  const double height = dice(1.2, 2.2), mass = dice(15, 42) * height * height;
  return {.height_m = static_cast<float>(height), .mass_kg = static_cast<float>(std::clamp(mass, 30.0, 200.0))};
}

/// Requests a speed alone, or with a step length or frequency, in the body's allowed range.
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

/// Requests a walk of natural cadence, with speeds as a fraction of the range.
inline void ask_natural(Walkers& w, std::size_t lane, Dice& dice, double style_part) {
  GaitRequest request;
  request.style = random_style(dice, style_part);
  const double leg = w.body[lane].thigh_length_m + w.body[lane].shank_length_m;
  request.speed_m_s = dice.single(0.6, 1.9) * static_cast<float>(std::sqrt(leg / 0.9));
  if (!w.ask(lane, request)) throw std::runtime_error("a natural walk was refused");
}

/// Returns the time, s, at which the stance foot becomes flat in a step that equals the one before.
inline float flat_s(const StepPlan<Lanes<float>>& plan, std::size_t l) {
  return 2 * (0.09F + plan.from.shape[step_shape::times.first][l]) * plan.duration_s[l];
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
