#include <mobil/opensim_writer.h>

#include <fmt/format.h>

#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include <mobil/assets/files/output_file.h>
#include "assets/export/joint_angles.h"
#include "assets/export/opensim_axes.h"
#include "assets/export/recording_check.h"
#include "assets/export/skeleton_keys.h"

namespace mobil::inline v0_3 {
namespace {

constexpr double opensim_degrees = 180 / std::numbers::pi;

/// A vector in OpenSim's axes.
struct OpensimVector {
  double x, y, z;
};
OpensimVector in_opensim(const Eigen::Vector3d& v) {
  return {v.z(), v.y(), -v.x()};
}
OpensimVector in_opensim(const Vec3<float>& v) {
  return {static_cast<double>(v.z), static_cast<double>(v.y), -static_cast<double>(v.x)};
}

/// A table being written, column by column.
struct OpensimTable {
  std::vector<std::string> name;
  std::vector<std::vector<double>> column;

  std::vector<double>& add(std::string called) {
    name.push_back(std::move(called));
    return column.emplace_back();
  }
};

std::string table_text(const OpensimTable& table, const WalkRecording& recording, std::string_view title,
                       bool in_degrees) {
  const std::size_t rows = recording.frames.size();
  std::string text = fmt::format("{}\nversion=1\nnRows={}\nnColumns={}\ninDegrees={}\nendheader\ntime", title, rows,
                                 table.name.size() + 1, in_degrees ? "yes" : "no");
  for (const auto& name : table.name) text += "\t" + name;
  for (std::size_t row = 0; row < rows; ++row) {
    const double time_s = recording.start_s + static_cast<double>(row) * recording.frame_s;
    text += fmt::format("\n{:.6f}", time_s);
    for (const auto& column : table.column) text += fmt::format("\t{:.6f}", column[row]);
  }
  text += '\n';
  return text;
}

/// Columns of the three angles of a joint, with the sign of each.
struct JointColumns {
  std::string about_x, about_z, about_y;  // empty: no column
  double x_sign = -1, z_sign = 1, y_sign = 1;
};

void add_joint(OpensimTable& table, const std::vector<Eigen::Quaterniond>& rotation, const JointColumns& columns) {
  const auto turns = joint_turns(rotation);
  const auto add = [&](const std::string& name, double sign, double JointTurn::*angle) {
    if (name.empty()) return;
    auto& column = table.add(name);
    for (const JointTurn& turn : turns) column.push_back(sign * turn.*angle * opensim_degrees);
  };
  add(columns.about_x, columns.x_sign, &JointTurn::x);
  add(columns.about_z, columns.z_sign, &JointTurn::z);
  add(columns.about_y, columns.y_sign, &JointTurn::y);
}

void add_pelvis(OpensimTable& table, const SkeletonKeys& skeleton) {
  std::vector<Eigen::Quaterniond> rotation;
  for (const auto& frame : skeleton.world) rotation.push_back(frame[0].rotation);
  add_joint(table, rotation, {"pelvis_tilt", "pelvis_list", "pelvis_rotation"});
  const std::size_t first = table.column.size();
  for (const auto* name : {"pelvis_tx", "pelvis_ty", "pelvis_tz"}) table.add(name);
  for (const auto& frame : skeleton.world) {
    const Eigen::Vector3d right = frame[index(Segment::thigh_right)].position_m,
                          left = frame[index(Segment::thigh_left)].position_m;
    const double size = (right - left).norm() / model_hips_m;
    const Eigen::Vector3d origin =
        0.5 * (right + left) + frame[0].rotation * (size * Eigen::Vector3d(0, model_above_m, model_ahead_m));
    const OpensimVector at = in_opensim(origin);
    table.column[first].push_back(at.x);
    table.column[first + 1].push_back(at.y);
    table.column[first + 2].push_back(at.z);
  }
}

void add_leg(OpensimTable& table, const SkeletonKeys& skeleton, std::size_t side) {
  using enum Segment;
  const std::string ending = side == Side::right ? "_r" : "_l";
  const double inward = side == Side::right ? 1 : -1;
  const auto of = [&](Segment right_segment) { return on_side(right_segment, side); };
  const auto between = [&](Segment parent, Segment child) { return turned_against(skeleton, parent, child); };
  add_joint(table, between(pelvis, of(thigh_right)),
            {"hip_flexion" + ending, "hip_adduction" + ending, "hip_rotation" + ending, -1, inward, inward});
  add_joint(table, between(of(thigh_right), of(shank_right)), {"knee_angle" + ending, "", ""});
  add_joint(table, between(of(shank_right), of(foot_right)),
            {"ankle_angle" + ending, "subtalar_angle" + ending, "", -1, inward});
  add_joint(table, between(of(foot_right), of(toes_right)), {"mtp_angle" + ending, "", ""});
}

void add_ground(OpensimTable& table, const WalkRecording& recording) {
  const auto add = [&](const std::string& name, const auto& of_frame) {
    const std::size_t first = table.column.size();
    for (const char axis : {'x', 'y', 'z'}) table.add(name + axis);
    for (const auto& ground : recording.ground) {
      const OpensimVector v = of_frame(ground);
      table.column[first].push_back(v.x);
      table.column[first + 1].push_back(v.y);
      table.column[first + 2].push_back(v.z);
    }
  };
  const std::string before[2] = {"", "1_"};
  for (const std::size_t side : {0U, 1U}) {
    add(before[side] + "ground_force_v", [side](const auto& ground) { return in_opensim(ground.force_n[side]); });
    add(before[side] + "ground_force_p", [side](const auto& ground) { return in_opensim(ground.centre_m[side]); });
  }
  for (const std::size_t side : {0U, 1U}) {
    add(before[side] + "ground_torque_", [side](const auto& ground) {
      return in_opensim(Vec3<float>{0, ground.free_moment_nm[side], 0});
    });
  }
}

}  // namespace

Result<void> write_opensim_motion(const std::filesystem::path& path, const WalkRecording& recording) {
  if (auto ok = check_recording(recorded_people(recording)); !ok) {
    return fail(fmt::format("{}: {}", path.string(), ok.error().message));
  }
  const SkeletonKeys skeleton = skeleton_keys(recording.frames, standing_places(recording.frames, {}));
  OpensimTable table;
  add_pelvis(table, skeleton);
  for (const std::size_t side : {0U, 1U}) add_leg(table, skeleton, side);
  add_joint(table, turned_against(skeleton, Segment::pelvis, Segment::T1),
            {"lumbar_extension", "lumbar_bending", "lumbar_rotation"});
  return write_file(path, table_text(table, recording, "Coordinates", true));
}

Result<void> write_opensim_forces(const std::filesystem::path& path, const WalkRecording& recording) {
  if (auto ok = check_recording(recorded_people(recording)); !ok) {
    return fail(fmt::format("{}: {}", path.string(), ok.error().message));
  }
  if (recording.ground.size() != recording.frames.size()) {
    return fail(fmt::format("{}: forces of {} frames, the recording has {}; simulate forces in all of them",
                            path.string(), recording.ground.size(), recording.frames.size()));
  }
  OpensimTable table;
  add_ground(table, recording);
  return write_file(path, table_text(table, recording, "ground_forces", false));
}

}  // namespace mobil::inline v0_3
