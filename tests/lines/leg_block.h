#pragma once
// Blocks of sixteen legs and lines for tests of paths and lines of action, set from legs in double precision.

#include <random>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/assets/muscles/muscle_path.h>
#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/components/muscle.h>
#include <mobil/engine/geometry.h>
#include "tests/lines/leg_pose.h"
#include "tests/simulation/people.h"

namespace mobil::test {

using geometry::Vec;

/// Groups and single muscles.
inline std::vector<Muscle> every_muscle() {
  std::vector<Muscle> all;
  for (std::size_t i = 0; i < muscles().size(); ++i) all.push_back(static_cast<Muscle>(i));
  return all;
}

struct Block {
  LegScale<Lanes<float>> scale;
  LegFrames<Lanes<float>> legs;
  LineOfAction<Lanes<float>> line{};
  EndDrive<Lanes<float>> end{};
};

inline void set(Vec3<Lanes<float>>& to, const Vec& v, std::size_t l) {
  to.x[l] = static_cast<float>(v.x), to.y[l] = static_cast<float>(v.y), to.z[l] = static_cast<float>(v.z);
}
inline void set(Quat<Lanes<float>>& to, const Quat<double>& q, std::size_t l) {
  to.x[l] = static_cast<float>(q.x), to.y[l] = static_cast<float>(q.y), to.z[l] = static_cast<float>(q.z);
  to.w[l] = static_cast<float>(q.w);
}
inline void set(LegFrames<Lanes<float>>& to, const LegFrames<double>& leg, std::size_t l) {
  set(to.hip_m, leg.hip_m, l), set(to.knee_m, leg.knee_m, l), set(to.ankle_m, leg.ankle_m, l);
  set(to.pelvis, leg.pelvis, l), set(to.thigh, leg.thigh, l), set(to.shank, leg.shank, l), set(to.foot, leg.foot, l);
}
inline void set(Block& block, const Body& body, const LegFrames<double>& leg, Muscle muscle, std::size_t l) {
  const MusclePlan plan = make_muscle_plan(body, muscle).value();
  block.scale.thigh[l] = plan.leg_scale.thigh;
  block.scale.shank[l] = plan.leg_scale.shank;
  block.scale.across[l] = plan.leg_scale.across;
  block.line.rest_length_m[l] = static_cast<float>(plan.rest_length_m);
  block.line.stiffness_n_per_m[l] = static_cast<float>(bar_stiffness({}, plan.section_m2, plan.rest_length_m));
  set(block.legs, leg, l);
}

struct Random {
  std::mt19937 engine{7};
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); }
  Body body() {
    const auto height = static_cast<float>(between(1.2, 2.2));
    return make_body({height, living_mass(height, between(0, 1))}).value();
  }
  /// Returns random angles over the full range of the joints (assets/body/joint_limits.h), plus slight overextension of
  /// the knee.
  LegAngles angles() { return {between(-30, 120), between(-5, 144), between(-50, 30)}; }
  Quat<double> turn(double max_deg) {
    return about({between(-1, 1), between(-1, 1), between(-1, 1)}, between(-max_deg, max_deg));
  }
  Vec place(double far) { return {between(-far, far), between(0, 2), between(-far, far)}; }
  /// Returns a leg whose pelvis and foot also turn out of the sagittal plane.
  LegFrames<double> leg(const Body& own) {
    LegFrames<double> leg = posed(own, angles(), product(about({0, 1, 0}, between(-180, 180)), turn(10)), place(3));
    leg.pelvis = product(leg.pelvis, turn(10));
    leg.foot = product(leg.foot, turn(10));
    return leg;
  }
};

enum class Joint { hip, knee, ankle };

/// Returns the leg with flexion or dorsiflexion of one joint increased: everything distal of it turns about its axis.
inline LegFrames<double> flexed(LegFrames<double> leg, Joint joint, double by_deg) {
  using namespace geometry;
  const Quat<double>& proximal = joint == Joint::hip ? leg.pelvis : joint == Joint::knee ? leg.thigh : leg.shank;
  const Vec centre = joint == Joint::hip ? leg.hip_m : joint == Joint::knee ? leg.knee_m : leg.ankle_m;
  const Quat<double> turn = about(rotated(proximal, {1, 0, 0}), joint == Joint::knee ? by_deg : -by_deg);
  leg.foot = product(turn, leg.foot);
  leg.ankle_m = centre + rotated(turn, leg.ankle_m - centre);
  if (joint == Joint::ankle) return leg;
  leg.shank = product(turn, leg.shank);
  leg.knee_m = centre + rotated(turn, leg.knee_m - centre);
  if (joint == Joint::knee) return leg;
  leg.thigh = product(turn, leg.thigh);
  return leg;
}

}  // namespace mobil::test
