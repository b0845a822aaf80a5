#pragma once
// A jointed figure in double precision with prescribed motion, for the forces' system and its reference.

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <random>

#include <mobil/anthropometry.h>
#include <mobil/components/step_plan.h>
#include "assets/body/body_scales.h"
#include "assets/body/segment_masses.h"
#include "engine/eigen.h"
#include "systems/forces/forces.h"
#include "systems/gait/body_motion.h"
#include "tests/engine/row_lanes.h"

namespace mobil::figure {

using Vector = Eigen::Vector3d;
using Rotation = Eigen::Quaterniond;

constexpr double gravity = 9.81;

inline Vector of(const Vec3<double>& v) {
  return {v.x, v.y, v.z};
}
inline Vec3<float> row(const Vector& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

inline Rotation turn(double angle, const Vector& axis) {
  return Rotation(Eigen::AngleAxisd(angle, axis));
}

/// World position of the pelvis and world rotation of every segment.
struct Stance {
  Vector pelvis;
  std::array<Rotation, segment_count> rotation;
};

/// Returns the anatomical position at the origin.
inline Stance upright(double height) {
  Stance s;
  s.pelvis = {0, fraction::hip_height * height, 0};
  s.rotation.fill(Rotation::Identity());
  return s;
}

/// Returns the stance turned about the vertical through the origin, then moved.
inline Stance moved(Stance s, double heading, const Vector& by) {
  const Rotation q = turn(heading, Vector::UnitY());
  s.pelvis = q * s.pelvis + by;
  for (Rotation& r : s.rotation) r = q * r;
  return s;
}

inline std::size_t mirrored_segment(std::size_t i) {
  const std::size_t legs = index(Segment::thigh_right), arms = index(Segment::clavicle_right);
  if (i < legs) return i;
  return i < arms ? legs + (i - legs + 5) % 10 : arms + (i - arms + 6) % 12;
}

/// Returns the mirror image in the plane x = 0, with right and left exchanged.
inline Stance mirrored(const Stance& s) {
  Stance m;
  m.pelvis = {-s.pelvis.x(), s.pelvis.y(), s.pelvis.z()};
  for (std::size_t i = 0; i < segment_count; ++i) {
    const Rotation& q = s.rotation[mirrored_segment(i)];
    m.rotation[i] = Rotation(q.w(), q.x(), -q.y(), -q.z());
  }
  return m;
}

/// Returns the sizes of a man with the proportions of the unit body.
inline BodySize<float> uniform_size(float height_m, float mass_kg) {
  BodySize<float> size = make_size({.height_m = height_m, .mass_kg = mass_kg}, 0.183F);
  size.leg_scale_m = size.trunk_scale_m = size.shoulders_scale_m = size.arm_scale_m = height_m;
  return size;
}
/// Returns the part of a segment in his mass.
inline double mass_part(std::size_t segment) {
  static const BodySize<float> size = uniform_size(1.75F, 75);
  return mass_fraction(size, segment);
}

inline std::array<Vector, segment_count> places(double height, const Stance& s) {
  std::array<Vector, segment_count> at;
  at[0] = s.pelvis;
  for (std::size_t i = 1; i < segment_count; ++i) {
    const std::size_t parent = index(segment_parent[i]);
    at[i] = at[parent] + s.rotation[parent] * (height * of(unit_body.joint_offset[i]));
  }
  return at;
}

inline std::array<Vector, segment_count> centres(double height, const Stance& s) {
  auto at = places(height, s);
  for (std::size_t i = 0; i < segment_count; ++i) at[i] += s.rotation[i] * (height * of(unit_body.centre_of_mass[i]));
  return at;
}

inline Vector body_centre(double height, const Stance& s) {
  const auto at = centres(height, s);
  Vector sum = Vector::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < segment_count; ++i) {
    sum += mass_part(i) * at[i];
    mass += mass_part(i);
  }
  return sum / mass;
}

/// Sixteen people in three poses and the results of `joint_forces`.
struct Block {
  BodySize<Lanes<float>> size{};
  StepPlan<Lanes<float>> plan{};
  GaitState<Lanes<float>> state{};
  std::array<Pose<Lanes<float>>, 3> pose{};
  BodyMotion<Lanes<float>> motion{};
  GroundReaction<Lanes<float>> reaction{};
  JointMoments<Lanes<float>> moments{};

  void stand(std::size_t lane, const Stance& s, std::size_t which) {
    const auto at = places(static_cast<double>(size.height_m[lane]), s);
    Pose<float> p;
    for (std::size_t i = 0; i < segment_count; ++i) {
      p.position_m[i] = row(at[i]);
      const Rotation& q = s.rotation[i];
      p.rotation[i] = {static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z()),
                       static_cast<float>(q.w())};
    }
    put(p, pose[which], lane);
  }
  Vector force(std::size_t lane, std::size_t side) const {
    const auto& f = reaction.force_n[side];
    return Eigen::Vector3f(f.x[lane], f.y[lane], f.z[lane]).cast<double>();
  }
  Vector pressure(std::size_t lane, std::size_t side) const {
    const auto& c = reaction.centre_m[side];
    return Eigen::Vector3f(c.x[lane], c.y[lane], c.z[lane]).cast<double>();
  }
  Vector joints(std::size_t lane, std::size_t side) const {
    return {static_cast<double>(moments.hip_nm[side][lane]), static_cast<double>(moments.knee_nm[side][lane]),
            static_cast<double>(moments.ankle_nm[side][lane])};
  }
  /// Frontal and transverse moment of the hip, and the free moment under the foot.
  Vector aside(std::size_t lane, std::size_t side) const {
    return {static_cast<double>(moments.hip_abduction_nm[side][lane]),
            static_cast<double>(moments.hip_rotation_nm[side][lane]),
            static_cast<double>(reaction.free_moment_nm[side][lane])};
  }
};

/// Returns people of random sizes, all standing on both feet.
inline std::unique_ptr<Block> random_people(unsigned seed) {
  std::mt19937 engine(seed);
  auto dice = [&](double low, double high) {
    return static_cast<float>(low + (high - low) * (static_cast<double>(engine()) / 4294967296.0));
  };
  auto b = std::make_unique<Block>();
  for (std::size_t l = 0; l < lane_count; ++l) {
    const float height_m = dice(1.2, 2.2);
    put(uniform_size(height_m, dice(30, 200)), b->size, l);
    b->plan.duration_s[l] = 0.5F;
  }
  return b;
}

using Motion = std::function<Stance(std::size_t lane, double time)>;

/// Computes forces at time 0 from the poses then and `apart_s` before and after.
inline void forces_of(Block& b, const Motion& motion, float apart_s) {
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t l = 0; l < lane_count; ++l)
      b.stand(l, motion(l, (static_cast<double>(k) - 1) * static_cast<double>(apart_s)), k);
  }
  motion_of_poses(b.size, b.pose[0], b.pose[1], b.pose[2], apart_s, b.motion);
  joint_forces(b.size, b.motion, b.plan, b.state, nullptr, b.reaction, b.moments);
}

/// A body with every joint in random motion.
struct Thrashing {
  struct Joint {
    Vector mean, swing;
    double rate, phase;
    Rotation at(double t) const {
      const Vector v = mean + swing * std::sin(rate * t + phase);
      const double angle = v.norm();
      return angle < 1e-12 ? Rotation::Identity() : turn(angle, v / angle);
    }
  };
  std::array<Joint, segment_count> joint;
  Vector sway;
  double height;

  Thrashing(unsigned seed, double body_height) : height(body_height) {
    std::mt19937 engine(seed);
    auto dice = [&](double size) { return size * (2.0 * static_cast<double>(engine()) / 4294967296.0 - 1.0); };
    for (std::size_t i = 0; i < segment_count; ++i) {
      const double size = i >= index(Segment::L5) && i <= index(Segment::head) ? 0.04 : 0.3;
      joint[i] = {{dice(size), dice(size), dice(size)}, {dice(size), dice(size), dice(size)}, 6 + dice(3), dice(3)};
    }
    sway = {dice(0.1), dice(0.05), dice(0.1)};
  }
  Stance at(double t) const {
    Stance s = upright(height);
    s.pelvis += sway * std::sin(5 * t + 1);
    s.rotation[0] = joint[0].at(t);
    for (std::size_t i = 1; i < segment_count; ++i)
      s.rotation[i] = s.rotation[index(segment_parent[i])] * joint[i].at(t);
    return s;
  }
};

}  // namespace mobil::figure
