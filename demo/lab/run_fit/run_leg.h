#pragma once
// Thigh and shank of a right leg between a given hip and ankle, in their plane, which contains the direction ahead.

#include <array>
#include <cstddef>

#include "demo/lab/run_fit/run_top.h"

namespace mobil {

/// Segments of a leg in the order of LegPose.
inline constexpr std::size_t leg_segments = 5;

/// Pose of thigh, kneecap, shank, foot and toes: origins and rotations.
struct LegPose {
  std::array<Vec3<double>, leg_segments> position;
  std::array<Rotation, leg_segments> rotation;
};

/// A leg in its plane: `ahead` and `down`, from the hip.
struct LegPlane {
  double side_x, side_y;           // direction `down` in the world
  double knee_ahead, knee_down;    // from the hip
  double ankle_ahead, ankle_down;  // as far as the leg reaches
  double slack;                    // how much shorter than straight the leg is, m
  double thigh_angle, shank_angle;
};

/// Derivatives of a point of the leg by the place of the hip, row by row.
using LegDerivatives = std::array<std::array<double, 3>, 3>;

/// Sum of mass times place over the segments of a leg, with derivatives by the hip.
struct LegMoment {
  Vec3<double> sum;
  LegDerivatives by_hip;
};

LegPlane leg_plane(const StepBody& size, const Vec3<double>& hip, const Vec3<double>& ankle);

/// Returns the pose of a leg. The foot is turned outward, and its toes are bent.
LegPose leg_pose(const RunBody& body, const LegPlane& leg, const Vec3<double>& hip, double toe_out, double pitch,
                 double toes);

/// Returns the mass and the sum of mass times place of foot and toes, from the ankle.
struct FootMoment {
  double mass;
  Vec3<double> sum;
};
FootMoment foot_moment(const RunBody& body, double toe_out, double pitch, double toes);

LegMoment leg_moment(const RunBody& body, const LegPlane& leg, const Vec3<double>& hip, const FootMoment& foot);

}  // namespace mobil
