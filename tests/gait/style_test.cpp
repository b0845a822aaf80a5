// Effect of each posture parameter on steady walks.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <vector>

#include "tests/gait/walkers.h"

namespace mobil::style_test {

constexpr std::size_t instants = 200;
constexpr float degree = 3.14159265F / 180;

/// One cycle of a right leg in a steady walk, from its heel strike.
struct Cycle {
  std::vector<float> knee, ankle, pitch, toe_up, hips_up, lean;
  float off;  // toe-off, as a fraction of the cycle
};

Cycle walk(float speed_m_s, const GaitStyle& style) {
  const auto w = std::make_unique<Walkers>();
  for (std::size_t l = 0; l < lane_count; ++l) {
    w->set_body(l, {.height_m = 1.75F, .mass_kg = 70.0F});
    GaitRequest request;
    request.speed_m_s = speed_m_s;
    request.style = style;
    if (!w->ask(l, request)) throw std::runtime_error("a natural walk was refused");
  }
  w->begin();
  Cycle c;
  c.off = 0.5F + 0.5F * w->plan.double_support[0];
  for (int step = 0; step < 2; ++step) {
    for (std::size_t i = 0; i < instants / 2; ++i) {
      w->place_at(static_cast<float>(i) / (instants / 2));
      c.knee.push_back(w->angles.knee_flexion[Side::right][0] / degree);
      c.ankle.push_back(w->angles.ankle_dorsiflexion[Side::right][0] / degree);
      const Quat<float> foot = row(w->pose, 0).rotation[index(Segment::foot_right)];
      c.pitch.push_back(std::asin(rotated(foot, Vec3<float>{0, 0, 1}).y) / degree);
      c.toe_up.push_back(w->feet.tip_m[Side::right].y[0]);
      c.hips_up.push_back(w->pose.position_m[index(Segment::pelvis)].y[0]);
      const Quat<float> chest = row(w->pose, 0).rotation[index(Segment::T1)];
      c.lean.push_back(std::asin(rotated(chest, Vec3<float>{0, 1, 0}).z) / degree);
    }
    w->strike();
  }
  return c;
}

std::size_t at(float cycle) {
  return static_cast<std::size_t>(cycle * instants);
}
auto place(const std::vector<float>& of, float cycle) {
  return of.begin() + static_cast<long>(at(cycle));
}
float greatest(const std::vector<float>& of, float from, float to) {
  return *std::max_element(place(of, from), place(of, to));
}
float least(const std::vector<float>& of, float from, float to) {
  return *std::min_element(place(of, from), place(of, to));
}

struct Aspect {
  const char* name;
  float GaitStyle::*parameter;
  float by;
  std::function<float(const Cycle&, const Cycle&)> value;  // of a walk compared with the usual one
};

/// Checks parameters with a visible effect in the parameter's own unit.
TEST(Style, ParametersChangeTheQuantityTheyAreNamedAfter) {
  const std::vector<Aspect> aspects = {
      {"strike pitch", &GaitStyle::strike_pitch_deg, 4, [](const Cycle& c, const Cycle&) { return c.pitch[0]; }},
      {"strike knee", &GaitStyle::strike_knee_deg, 6, [](const Cycle& c, const Cycle&) { return c.knee[0]; }},
      {"stance knee", &GaitStyle::stance_knee_deg, 6,
       [](const Cycle& c, const Cycle& usual) {
         const auto least = std::min_element(place(usual.knee, 0.22F), place(usual.knee, 0.46F));
         return c.knee[static_cast<std::size_t>(least - usual.knee.begin())];
       }},
      {"toe-off knee", &GaitStyle::toe_off_knee_deg, -6,
       [](const Cycle& c, const Cycle&) { return c.knee[at(c.off)]; }},
      {"swing knee", &GaitStyle::swing_knee_deg, 8,
       [](const Cycle& c, const Cycle&) { return greatest(c.knee, c.off, 0.95F); }},
      {"swing ankle", &GaitStyle::swing_ankle_deg, 4,
       [](const Cycle& c, const Cycle&) { return c.ankle[at(0.5F * c.off + 0.5F)]; }},
      {"toe clearance", &GaitStyle::toe_clearance_m, 0.02F,
       [](const Cycle& c, const Cycle&) { return c.toe_up[at(0.5F * c.off + 0.5F)]; }},
      {"trunk lean", &GaitStyle::trunk_lean_deg, 5,
       [](const Cycle& c, const Cycle&) {
         float sum = 0;
         for (const float lean : c.lean) sum += lean / instants;
         return sum;
       }},
  };
  const GaitStyle usual;
  for (const float speed : {0.9F, 1.3F, 1.7F}) {
    const Cycle before = walk(speed, usual);
    for (const Aspect& aspect : aspects) {
      GaitStyle style;
      style.*aspect.parameter += aspect.by;
      const float changed = aspect.value(walk(speed, style), before) - aspect.value(before, before);
      EXPECT_NEAR(changed / aspect.by, 1, 0.5) << aspect.name << " at " << speed << " m/s";
    }
  }
}

/// Checks the direction of effect of parameters of forces and times.
TEST(Style, ParametersChangeTheirCurvesInTheRightDirection) {
  const auto with = [](float GaitStyle::*parameter, float value) {
    GaitStyle style;
    style.*parameter = value;
    return walk(1.3F, style);
  };
  const Cycle usual = walk(1.3F, {});
  const auto fall = [](const Cycle& c) { return greatest(c.hips_up, 0, 0.5F) - least(c.hips_up, 0, 0.5F); };
  EXPECT_LT(fall(with(&GaitStyle::hip_fall, 0.2F)), fall(usual) - 0.002F);
  const auto bend = [](const Cycle& c) { return greatest(c.knee, 0.06F, 0.22F) - c.knee[0]; };
  EXPECT_LT(bend(with(&GaitStyle::leg_damping, 1.0F)), bend(usual) - 1);
  const auto sway = [](const Cycle& c) { return greatest(c.lean, 0, 1) - least(c.lean, 0, 1); };
  EXPECT_GT(sway(with(&GaitStyle::trunk_stiffness, 3.0F)), 1.5F * sway(usual));
  EXPECT_GT(with(&GaitStyle::knee_release_cycle, 0.433F).knee[at(0.53F)], usual.knee[at(0.53F)] + 1);
  // The centre of pressure is where the hips need it, so it moves ahead with them.
  EXPECT_NE(with(&GaitStyle::foot_pivot_h, 0.02F).knee[at(0.3F)], usual.knee[at(0.3F)]);
  EXPECT_NE(with(&GaitStyle::roll_over, 0.62F).knee[at(0.3F)], usual.knee[at(0.3F)]);
}

}  // namespace mobil::style_test
