#include "demo/lab/compare/joint_contact.h"

#include <mobil/engine/geometry.h>
#include "assets/muscles/published_frames.h"
#include "demo/lab/compare/compare_reference.h"

namespace mobil {
namespace {

using namespace geometry;

/// The patellar ligament's end on the tibia, as in the model of Rajagopal et al. 2016 (muscle_table.h).
constexpr PathPoint tuberosity = published::on_tibia(0.0326, -0.06312, -0.00047);

bool is_distal(LegBone bone, std::size_t joint) {
  return static_cast<std::size_t>(bone) > joint;
}

Vec pull_direction(const Vec& distal, const Vec& proximal) {
  const Vec way = proximal - distal;
  const double size = length(way);
  return size > 1e-9 ? (1 / size) * way : Vec{};
}

}  // namespace

LegFrames<double> right_leg(const Pose<float>& pose) {
  using enum Segment;
  const auto at = [&](Segment s) { return to_double(pose.position_m[index(s)]); };
  const auto turn = [&](Segment s) { return to_double(pose.rotation[index(s)]); };
  return {at(thigh_right),   at(shank_right),   at(foot_right),  turn(pelvis),
          turn(thigh_right), turn(shank_right), turn(foot_right)};
}

std::array<Pull, leg_joint_count> pulls_of(const MemberMuscle& line, const LegScale<double>& scale,
                                           const LegFrames<double>& leg) {
  std::array<Pull, leg_joint_count> pulls;
  const auto corners = member_path(line, scale, leg);
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const PathCorner &before = corners[i - 1], &after = corners[i];
    for (std::size_t joint = 0; joint < leg_joint_count; ++joint) {
      if (is_distal(before.bone, joint) || !is_distal(after.bone, joint)) continue;
      pulls[joint] = {after.at, pull_direction(after.at, before.at)};
    }
  }
  if (line.kneecap) {
    const Vec below = path_point(tuberosity, scale, rolled(scale, leg));
    pulls[at_knee] = {below, pull_direction(below, corners.back().at)};
  }
  return pulls;
}

JointForces intersegmental_forces(const Body& body, const std::array<Pose<float>, 3>& poses,
                                  const GroundReaction<float>& ground, double tick_s) {
  using enum Segment;
  constexpr struct {
    Segment segment;
    std::size_t below;  // the joint nearest above it
  } parts[] = {{thigh_right, at_hip},
               {patella_right, at_hip},
               {shank_right, at_knee},
               {foot_right, at_ankle},
               {toes_right, at_ankle}};
  JointForces whole{};
  for (const auto& [segment, below] : parts) {
    const std::size_t s = index(segment);
    const auto centre = [&](const Pose<float>& pose) {
      return to_double(pose.position_m[s]) + rotated(to_double(pose.rotation[s]), to_double(body.centre_of_mass_m[s]));
    };
    Vec push = (1 / (tick_s * tick_s)) * (centre(poses[2]) - 2.0 * centre(poses[1]) + centre(poses[0]));
    push.y += gravity_m_s2;
    for (std::size_t joint = 0; joint <= below; ++joint)
      whole[joint] = whole[joint] + static_cast<double>(body.mass_kg[s]) * push;
  }
  for (Vec& force : whole) force = force - to_double(ground.force_n[Side::right]);
  return whole;
}

JointForces contact_forces(const Body& body, const Pose<float>& pose, const JointForces& whole_n,
                           std::span<const double> tension_n) {
  const LegScale<double> scale = leg_scale(body);
  const LegFrames<double> leg = right_leg(pose);
  JointForces contact = whole_n;
  const auto lines = member_muscles();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto pulls = pulls_of(lines[i], scale, leg);
    for (std::size_t joint = 0; joint < leg_joint_count; ++joint)
      contact[joint] = contact[joint] - tension_n[i] * pulls[joint].direction;
  }
  return contact;
}

}  // namespace mobil
