#pragma once
// Contact forces in the joints of a leg, from its motion, the ground's reaction and the tension of its muscles.

#include <array>
#include <span>

#include <mobil/assets/muscles/muscle_path.h>
#include <mobil/components/body.h>
#include <mobil/components/pose.h>
#include <mobil/forces.h>
#include <mobil/muscle_table.h>

namespace mobil {

enum LegJointIndex : std::size_t { at_hip, at_knee, at_ankle, leg_joint_count };

/// Forces on the distal bone at hip, knee and ankle of the right leg, world axes, N.
using JointForces = std::array<Vec3<double>, leg_joint_count>;

/// Returns the right leg's frames in a pose, m, world axes.
LegFrames<double> right_leg(const Pose<float>& pose);

/// Pull of a line on the part distal of a joint: a point of its segment across the joint, m, and the unit direction. A
/// line that does not cross the joint has the direction 0. A line that ends on the kneecap pulls the shank along the
/// patellar ligament.
struct Pull {
  Vec3<double> at_m{}, direction{};
};
std::array<Pull, leg_joint_count> pulls_of(const MemberMuscle& line, const LegScale<double>& scale,
                                           const LegFrames<double>& leg);

/// Returns the whole force through each joint of the right leg, by bones and muscles together: Σ m (a + g) of the
/// segments below, less the reaction of the ground. It is that of the middle of three poses, `tick_s` apart, to which
/// `ground` belongs.
JointForces intersegmental_forces(const Body& body, const std::array<Pose<float>, 3>& poses,
                                  const GroundReaction<float>& ground, double tick_s);

/// Returns the contact forces: the whole forces less the pulls of the lines, whose tension is in the order of
/// member_muscles(), N. Ligaments and the hip's passive tissue are left out. At the knee it is the tibiofemoral force.
JointForces contact_forces(const Body& body, const Pose<float>& pose, const JointForces& whole_n,
                           std::span<const double> tension_n);

}  // namespace mobil
