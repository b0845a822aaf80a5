#pragma once
// Walks of any style, and their violations of limits of ground, joints or pelvis, found in the pose of every tick.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/components/step_plan.h>
#include <mobil/engine/geometry.h>
#include <mobil/simulation.h>
#include <mobil/systems/muscles/person.h>
#include "assets/body/column.h"
#include "assets/body/joint_limits.h"
#include "systems/gait/gait.h"
#include "tests/gait/walkers.h"

namespace mobil::style_limits_test {
using namespace geometry;
using enum Segment;

constexpr double degree = 3.14159265358979324 / 180, tick = 1.0 / 60;

struct Asked {
  BodyRequest body;
  GaitRequest gait;
};

/// Returns a style with one parameter at an end, two at ends, three anywhere, all anywhere, all at ends, or all
/// partway.
inline GaitStyle any_style(Dice& dice, unsigned kind) {
  GaitStyle style;
  const auto end = [&](const GaitParameter& p) { return dice(0, 1) < 0.5 ? p.low : p.high; };
  const auto anywhere = [&](const GaitParameter& p) { return dice.single(double{p.low}, double{p.high}); };
  const auto any = [&]() -> const GaitParameter& { return gait_parameters[dice.engine() % gait_parameters.size()]; };
  const double part = dice(0, 1);
  for (unsigned i = 0; i < (kind < 3 ? kind + 1 : 0); ++i) {
    const GaitParameter& p = any();
    style.*p.value = kind < 2 ? end(p) : anywhere(p);
  }
  if (kind >= 3) {
    for (const GaitParameter& p : gait_parameters) style.*p.value = kind == 4 ? end(p) : anywhere(p);
  }
  return kind == 5 ? random_style(dice, part) : style;
}

/// Returns any body at any allowed speed. With `steps` some have a step length or frequency as well.
inline Asked anyone(Dice& dice, unsigned kind, bool steps) {
  for (;;) {
    Asked asked{random_body(dice), {.style = any_style(dice, kind)}};
    const double leg = (fraction::thigh + fraction::shank) * double{asked.body.height_m}, scale = std::sqrt(leg / 0.9);
    asked.gait.speed_m_s = dice.single(0.3 * scale, 2.3 * scale);
    const double which = steps ? dice(0, 3) : 1.5;
    if (which < 1) asked.gait.step_length_m = dice.single(0.25 * leg, 1.25 * leg);
    if (which > 2) asked.gait.step_frequency_hz = dice.single(0.5 / scale, 3.0 / scale);
    const auto body = make_body(asked.body);
    if (body && resolve_gait(*body, asked.gait)) return asked;
  }
}

/// Quantities that a walk must bound, and the largest values reached.
enum Measure { under_mm, slides_mm, shaken_m_s2, joint_deg, measures };
inline constexpr std::array<const char*, measures> measure_name = {"mm under the ground", "mm slid in a tick",
                                                                   "m/s2 of the pelvis", "deg beyond a joint's limit"};
inline constexpr std::array<double, measures> most = {5, 2, 16, 0.01};

struct Walked {
  std::array<double, measures> worst{};
  const char* joint = "";

  void note(Measure m, double value) { worst[m] = std::max(worst[m], value); }
  void joint_at(const char* name, double value_deg, double low_deg, double high_deg) {
    const double by = std::max(low_deg - value_deg, value_deg - high_deg);
    if (by > worst[joint_deg]) joint = name;
    note(joint_deg, by);
  }
  bool keeps_limits() const {
    for (std::size_t m = 0; m < measures; ++m)
      if (worst[m] > most[m]) return false;
    return true;
  }
};

/// Observes one walker tick by tick.
class Watch {
 public:
  Watch(const Simulation& simulation, Entity who) : simulation_(simulation), who_(who) {
    height_ = double{simulation.person(who)->body.size.leg_scale_m};
  }

  void look(Walked& out) {
    pose_ = *simulation_.get<Pose>(who_);
    angles_ = *simulation_.get<JointAngles>(who_);
    feet_ = *simulation_.get<Feet>(who_);
    const auto state = *simulation_.get<GaitState>(who_);
    const auto plan = *simulation_.get<StepPlan>(who_);
    for (const Side side : {Side::right, Side::left}) {
      sole(state, plan, side, out);
      leg(side, out);
      arm(side, out);
    }
    column(out);
    const double up = double{pose_.position_m[index(pelvis)].y};
    if (ticks_ >= 2) out.note(shaken_m_s2, std::abs(up - 2 * up_[0] + up_[1]) / (tick * tick));
    up_[1] = up_[0];
    up_[0] = up;
    ++ticks_;
  }

 private:
  Quat<double> of(Segment s) const { return to_double(pose_.rotation[index(s)]); }
  static double heading(const Quat<double>& q) {
    const Vec to_left = rotated(q, {1, 0, 0});
    return std::atan2(-to_left.z, to_left.x) / degree;
  }
  static double about(double sine_half) { return 2 * std::asin(std::clamp(sine_half, -1.0, 1.0)) / degree; }

  void sole(const GaitState<float>& state, const StepPlan<float>& plan, Side side, Walked& out) {
    const Quat<double> foot = of(on_side(foot_right, side));
    const Vec ankle = to_double(pose_.position_m[index(on_side(foot_right, side))]), tip = to_double(feet_.tip_m[side]);
    const Vec ahead = rotated(foot, {0, 0, 1});
    const Vec rim = ankle + rotated(foot, {0, -height_ * (fraction::ankle_height - fraction::heel_radius),
                                           -height_ * fraction::heel_back});
    const double lowest = std::min({rim.y - height_ * fraction::heel_radius, double{feet_.toe_m[side].y}, tip.y});
    out.note(under_mm, -1000 * lowest);
    // Planted: from when the heel's pad has yielded, a twentieth of the cycle after the strike, to toe-off.
    const bool stance = state.stance_side == static_cast<std::uint32_t>(side);
    const bool planted = stance ? state.time_s > 0.1F * plan.duration_s : state.time_s < plan.double_support_s;
    const double pitch = std::asin(std::clamp(ahead.y, -1.0, 1.0)), level = std::hypot(ahead.x, ahead.z);
    Sole& before = sole_[side];
    if (planted && before.planted) {
      // A foot on its heel rolls; otherwise its tips stand.
      const double rolled = height_ * fraction::heel_radius * (pitch - before.pitch) / level;
      const double heel = std::hypot(rim.x - before.rim.x + rolled * ahead.x, rim.z - before.rim.z + rolled * ahead.z);
      const double toes = std::hypot(tip.x - before.tip.x, tip.z - before.tip.z);
      const bool on_heel = pitch >= 0 && before.pitch >= 0, on_toes = pitch < 0 && before.pitch < 0;
      out.note(slides_mm, 1000 * (on_heel ? heel : on_toes ? toes : std::min(heel, toes)));
    }
    before = {planted, rim, tip, pitch};
  }

  void leg(Side side, Walked& out) const {
    const double outward = side == Side::left ? 1 : -1;
    const auto deg = [](float rad) { return double{rad} / degree; };
    out.joint_at("hip flexion", deg(angles_.hip_flexion[side]) - neutral_tilt / degree, -30, 120);
    out.joint_at("knee flexion", deg(angles_.knee_flexion[side]), -1.6, 143.8);
    out.joint_at("ankle dorsiflexion", deg(angles_.ankle_dorsiflexion[side]), -50, 39);
    const auto from = [&](const Quat<double>& upper, Segment lower) { return product(conjugate(upper), of(lower)); };
    const Vec down = rotated(from(of(pelvis), on_side(thigh_right, side)), {0, -1, 0});
    out.joint_at("hip abduction", outward * std::asin(std::clamp(down.x, -1.0, 1.0)) / degree, -30, 45);
    const double turned = std::remainder(heading(of(on_side(foot_right, side))) - heading(of(pelvis)), 360) * -outward;
    out.joint_at("hip rotation", turned, -45, 45);
    const Quat<double> toes = from(of(on_side(foot_right, side)), on_side(toes_right, side));
    out.joint_at("toes' extension", -about(toes.w < 0 ? -toes.x : toes.x), -45, 70);
  }

  void arm(Side side, Walked& out) const {
    out.joint_at("shoulder flexion", double{angles_.shoulder_flexion[side]} / degree, -60, 180);
    out.joint_at("elbow flexion", double{angles_.elbow_flexion[side]} / degree, 0, 150);
  }

  /// Checks bending; rotation is excluded (mobil/systems/limits/walk_limits.h).
  void column(Walked& out) const {
    Quat<double> below = of(pelvis);
    for (std::size_t v = 0; v < vertebra_limits.size(); ++v) {
      const Quat<double> own = of(static_cast<Segment>(index(L5) + v));
      Quat<double> joint = product(conjugate(below), own);
      if (joint.w < 0) joint = {-joint.x, -joint.y, -joint.z, -joint.w};
      const VertebraLimit& limit = vertebra_limits[v];
      out.joint_at("vertebra's flexion", about(joint.x), -limit.flexion_extension / 2, limit.flexion_extension / 2);
      out.joint_at("vertebra's bending", about(joint.z), -limit.lateral_bending, limit.lateral_bending);
      below = own;
    }
  }

  struct Sole {
    bool planted = false;
    Vec rim{}, tip{};
    double pitch = 0;
  };
  const Simulation& simulation_;
  Entity who_;
  double height_ = 0;
  int ticks_ = 0;
  std::array<double, 2> up_{};
  std::array<Sole, 2> sole_;
  Pose<float> pose_;
  JointAngles<float> angles_;
  Feet<float> feet_;
};

inline std::vector<Entity> spawn(Simulation& simulation, const std::vector<Asked>& asked) {
  std::vector<SpawnRequest> requests;
  for (const Asked& one : asked) requests.push_back({.body = one.body, .gait = one.gait});
  std::vector<Entity> people(asked.size());
  if (const auto done = simulation.spawn(requests, people); !done) throw std::runtime_error(done.error().message);
  return people;
}

inline std::vector<Walked> walk(const std::vector<Asked>& asked, double seconds) {
  Simulation simulation({.tick_s = tick});
  const std::vector<Entity> people = spawn(simulation, asked);
  std::vector<Watch> watches;
  for (const Entity person : people) watches.emplace_back(simulation, person);
  std::vector<Walked> walked(asked.size());
  for (double t = 0; t < seconds; t += tick) {
    for (std::size_t i = 0; i < people.size(); ++i) watches[i].look(walked[i]);
    simulation.tick();
  }
  return walked;
}

inline std::string told(const Asked& asked, const Walked& walked) {
  std::string text = "height " + std::to_string(asked.body.height_m) + ", mass " + std::to_string(asked.body.mass_kg) +
                     ", speed " + std::to_string(*asked.gait.speed_m_s);
  if (asked.gait.step_length_m) text += ", step " + std::to_string(*asked.gait.step_length_m);
  if (asked.gait.step_frequency_hz) text += ", frequency " + std::to_string(*asked.gait.step_frequency_hz);
  for (const GaitParameter& p : gait_parameters)
    if (asked.gait.style.*p.value != GaitStyle{}.*p.value)
      text += ", " + std::string(p.name) + " " + std::to_string(asked.gait.style.*p.value);
  for (std::size_t m = 0; m < measures; ++m) text += "; " + std::to_string(walked.worst[m]) + " " + measure_name[m];
  return text + " (" + walked.joint + ")";
}

/// Runs people through stops, standing, starts, turns, slowing down and speeding up, as in a crowd, one phase at a
/// time.
template <class Look>
void play(const std::vector<Asked>& asked, Look look) {
  Simulation simulation({.tick_s = tick});
  const std::vector<Entity> people = spawn(simulation, asked);
  const auto at_speed = [&](float part) {
    for (std::size_t i = 0; i < people.size(); ++i) {
      const float speed = *asked[i].gait.speed_m_s, least = std::min(speed, 0.5F);
      const auto done = simulation.change_gait(people[i], {.speed_m_s = part == 0 ? 0 : std::max(part * speed, least)});
      ASSERT_TRUE(done) << done.error().message;
    }
  };
  const auto phase = [&](const char* name, double seconds) {
    for (double t = 0; t < seconds; t += tick) {
      simulation.tick();
      for (std::size_t i = 0; i < people.size(); ++i) look(simulation, people[i], i, name);
    }
  };
  phase("walks", 2);
  at_speed(0);
  phase("stops", 3.5);
  at_speed(1);
  phase("starts", 2.5);
  for (std::size_t i = 0; i < people.size(); ++i)
    ASSERT_TRUE(simulation.turn_to(people[i], i % 2 == 0 ? 1.05F : -1.05F));
  phase("turns", 3);
  at_speed(0.6F);
  phase("slows down", 2.5);
  at_speed(1);
  phase("speeds up", 2.5);
}

}  // namespace mobil::style_limits_test
