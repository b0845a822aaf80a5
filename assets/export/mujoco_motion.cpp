#include "assets/export/mujoco_motion.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>

#include <mobil/assets/files/output_file.h>
#include <mobil/forces.h>
#include <mobil/mujoco_writer.h>
#include "assets/export/recording_check.h"
#include "assets/export/skeleton_keys.h"

namespace mobil::inline v0_3 {
namespace {

constexpr double max_out_of_hinge_rad = 0.1 * std::numbers::pi / 180, max_off_place_m = 1e-4;

Eigen::Quaterniond world_rotation(const Pose<float>& pose, Segment segment) {
  const Quat<float>& q = pose.rotation[index(segment)];
  return Eigen::Quaterniond(static_cast<double>(q.w), static_cast<double>(q.x), static_cast<double>(q.y),
                            static_cast<double>(q.z))
      .normalized();
}

/// Returns a segment's rotation from its parent, for the pelvis from the world.
Eigen::Quaterniond joint_rotation(const Pose<float>& pose, Segment segment) {
  const Segment parent = segment_parent[index(segment)];
  if (parent == segment) return world_rotation(pose, segment);
  return world_rotation(pose, parent).conjugate() * world_rotation(pose, segment);
}

/// Returns the rotation vector of the shorter turn, rad.
Eigen::Vector3d turn_vector(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0 ? -1 : 1, sine = q.vec().norm();
  const double angle = 2 * std::atan2(sine, sign * q.w());
  return sine > 1e-12 ? Eigen::Vector3d(sign * angle / sine * q.vec()) : Eigen::Vector3d(2 * sign * q.vec());
}

/// Returns a segment's place in its parent's frame, m.
Eigen::Vector3d place_in_parent(const Pose<float>& pose, Segment segment) {
  const Segment parent = segment_parent[index(segment)];
  return world_rotation(pose, parent).conjugate() *
         (widened(pose.position_m[index(segment)]) - widened(pose.position_m[index(parent)]));
}

void append(std::vector<double>& to, const Eigen::Vector3d& v) {
  to.insert(to.end(), {v.x(), v.y(), v.z()});
}

void add_difference(const Eigen::Vector3d& backward, const Eigen::Vector3d& forward, MujocoState& state) {
  constexpr double step_s = motion_difference_s;
  append(state.qvel, (forward + backward) / (2 * step_s));
  append(state.qacc, (forward - backward) / (step_s * step_s));
}

std::string motion_header(const MujocoState& state, bool forces) {
  std::string text = "time_s";
  const auto number = [&text](const char* name, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) text += fmt::format(",{}_{}", name, i);
  };
  number("qpos", state.qpos.size());
  number("qvel", state.qvel.size());
  number("qacc", state.qacc.size());
  if (forces) {
    for (const auto* side : {"right", "left"})
      text += fmt::format(
          ",ground_force_x_{0}_n,ground_force_y_{0}_n,ground_force_z_{0}_n,centre_of_pressure_x_{0}_m,"
          "centre_of_pressure_y_{0}_m,centre_of_pressure_z_{0}_m,free_moment_{0}_nm",
          side);
  }
  return text + '\n';
}

}  // namespace

MujocoJoint mujoco_joint(Segment segment) {
  using enum Segment;
  if (segment == pelvis) return MujocoJoint::free;
  for (const Segment hinge : {shank_right, patella_right, toes_right, shank_left, patella_left, toes_left})
    if (segment == hinge) return MujocoJoint::hinge;
  return MujocoJoint::ball;
}

Eigen::Vector3d hinge_axis(Segment segment) {
  const bool toes = segment == Segment::toes_right || segment == Segment::toes_left;
  return {toes ? -1.0 : 1.0, 0, 0};
}

std::vector<Segment> child_segments(Segment parent) {
  std::vector<Segment> children;
  for (std::size_t s = 0; s < segment_count; ++s) {
    const auto child = static_cast<Segment>(s);
    if (segment_parent[s] == parent && child != parent) children.push_back(child);
  }
  return children;
}

std::array<Segment, segment_count> mujoco_order() {
  std::array<Segment, segment_count> order{};
  std::vector<Segment> open = {Segment::pelvis};
  for (Segment& next : order) {
    next = open.back();
    open.pop_back();
    const auto children = child_segments(next);
    open.insert(open.end(), children.rbegin(), children.rend());
  }
  return order;
}

MujocoState mujoco_state(const WalkRecording& recording, std::size_t frame) {
  const Pose<float>& now = recording.frames[frame];
  const auto& [before, after] = recording.around[frame];
  MujocoState state;
  for (const Segment segment : mujoco_order()) {
    const Eigen::Quaterniond turned = joint_rotation(now, segment);
    const Eigen::Vector3d backward = turn_vector(joint_rotation(before, segment).conjugate() * turned);
    const Eigen::Vector3d forward = turn_vector(turned.conjugate() * joint_rotation(after, segment));
    const MujocoJoint joint = mujoco_joint(segment);
    if (joint == MujocoJoint::hinge) {
      const Eigen::Vector3d axis = hinge_axis(segment);
      MujocoState turn;
      add_difference(backward, forward, turn);
      state.qpos.push_back(turn_vector(turned).dot(axis));
      state.qvel.push_back(Eigen::Vector3d(turn.qvel.data()).dot(axis));
      state.qacc.push_back(Eigen::Vector3d(turn.qacc.data()).dot(axis));
      continue;
    }
    if (joint == MujocoJoint::free) {
      const Eigen::Vector3d place = widened(now.position_m[0]);
      append(state.qpos, place);
      add_difference(place - widened(before.position_m[0]), widened(after.position_m[0]) - place, state);
    }
    state.qpos.insert(state.qpos.end(), {turned.w(), turned.x(), turned.y(), turned.z()});
    add_difference(backward, forward, state);
  }
  return state;
}

Result<void> check_mujoco(const std::filesystem::path& path, const Body& body, const WalkRecording& recording) {
  if (auto ok = check_recording(recorded_people(recording)); !ok) {
    return fail(fmt::format("{}: {}", path.string(), ok.error().message));
  }
  if (recording.around.size() != recording.frames.size()) {
    return fail(fmt::format("{}: poses around {} frames, the recording has {}; record them around all", path.string(),
                            recording.around.size(), recording.frames.size()));
  }
  for (std::size_t f = 0; f < recording.frames.size(); ++f) {
    for (std::size_t s = 1; s < segment_count; ++s) {
      const auto segment = static_cast<Segment>(s);
      if (mujoco_joint(segment) == MujocoJoint::hinge) {
        const Eigen::Vector3d turn = turn_vector(joint_rotation(recording.frames[f], segment));
        const double out = turn.cross(hinge_axis(segment)).norm();
        if (out > max_out_of_hinge_rad) {
          return fail(fmt::format("{}: frame {}: {} turns by {:.2f}° out of its hinge, at most 0.1° can be written",
                                  path.string(), f, segment_name[s], out * 180 / std::numbers::pi));
        }
      }
      if (segment == Segment::patella_right || segment == Segment::patella_left) continue;  // turn about the knee
      const double off = (place_in_parent(recording.frames[f], segment) - widened(body.joint_offset_m[s])).norm();
      if (off > max_off_place_m) {
        return fail(fmt::format("{}: frame {}: {} is {:.2f} mm from its place in the body; give the recording's body",
                                path.string(), f, segment_name[s], 1e3 * off));
      }
    }
  }
  return {};
}

Result<void> write_mujoco_motion(const std::filesystem::path& path, const Body& body, const WalkRecording& recording) {
  if (auto ok = check_mujoco(path, body, recording); !ok) return ok;
  const bool forces = recording.ground.size() == recording.frames.size();
  std::string text = motion_header(mujoco_state(recording, 0), forces);
  for (std::size_t f = 0; f < recording.frames.size(); ++f) {
    const MujocoState state = mujoco_state(recording, f);
    text += fmt::format("{:.6f}", recording.start_s + static_cast<double>(f) * recording.frame_s);
    for (const double q : state.qpos) text += fmt::format(",{:.9g}", q);
    for (const double v : state.qvel) text += fmt::format(",{:.7g}", v);
    for (const double a : state.qacc) text += fmt::format(",{:.7g}", a);
    if (forces) {
      for (const std::size_t side : {0U, 1U}) {
        const GroundReaction<float>& ground = recording.ground[f];
        for (const Vec3<float>& v : {ground.force_n[side], ground.centre_m[side]})
          text += fmt::format(",{:.9g},{:.9g},{:.9g}", v.x, v.y, v.z);
        text += fmt::format(",{:.7g}", ground.free_moment_nm[side]);
      }
    }
    text += '\n';
  }
  return write_file(path, text);
}

}  // namespace mobil::inline v0_3
