#include <mobil/mujoco_writer.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>

#include <mobil/anthropometry.h>
#include <mobil/assets/files/output_file.h>
#include "assets/body/joint_limits.h"
#include "assets/export/mujoco_motion.h"
#include "assets/export/mujoco_muscles.h"
#include "assets/export/skeleton_keys.h"

namespace mobil::inline v0_3 {
namespace {

constexpr double tissue_kg_m3 = 1000, full_turn_deg = 180;

std::string three(const Eigen::Vector3d& v) {
  return fmt::format("{:.9g} {:.9g} {:.9g}", v.x(), v.y(), v.z());
}

/// Adds lines with that indentation.
void indented(const std::string& lines, std::size_t depth, std::string& text) {
  for (std::size_t from = 0; from < lines.size();) {
    const std::size_t end = lines.find('\n', from);
    text += std::string(2 * depth, ' ') + lines.substr(from, end - from) + '\n';
    from = end + 1;
  }
}

Segment right_of(Segment segment) {
  using enum Segment;
  for (const Segment right : {thigh_right, patella_right, shank_right, foot_right, toes_right, clavicle_right,
                              upper_arm_right, forearm_right, hand_right, fingers_right, thumb_right})
    if (segment == on_side(right, Side::left)) return right;
  return segment;
}

/// Returns the angle of a ball to the farthest corner of its limits, or nothing if it turns freely, degrees.
std::optional<double> ball_limit_deg(Segment segment) {
  double squares = 0;
  for (const JointLimit& limit : limb_limits) {
    if (limit.segment == right_of(segment))
      squares += std::pow(std::max(std::abs(limit.low_deg), std::abs(limit.high_deg)), 2);
  }
  const std::size_t s = index(segment), first = index(Segment::L5);
  if (s >= first && s < first + vertebra_limits.size()) {
    const VertebraLimit& limit = vertebra_limits[s - first];
    squares =
        std::pow(0.5 * limit.flexion_extension, 2) + std::pow(limit.lateral_bending, 2) + std::pow(limit.rotation, 2);
  }
  const double angle = std::sqrt(squares);
  if (angle == 0 || angle >= full_turn_deg) return {};
  return angle;
}

std::string joint_element(const Body& body, Segment segment) {
  constexpr double radian = std::numbers::pi / 180;
  const std::string_view name = segment_name[index(segment)];
  const MujocoJoint joint = mujoco_joint(segment);
  if (joint == MujocoJoint::free) return fmt::format("<freejoint name=\"{}\"/>\n", name);
  if (joint == MujocoJoint::ball) {
    const auto limit = ball_limit_deg(segment);
    const std::string range = limit ? fmt::format(" range=\"0 {:.6g}\"", *limit * radian) : "";
    return fmt::format("<joint name=\"{}\" type=\"ball\"{}/>\n", name, range);
  }
  std::string more;
  const Segment right = right_of(segment);
  if (right == Segment::patella_right) {
    const Eigen::Vector3d knee = widened(body.joint_offset_m[index(segment) + 1]);
    more = fmt::format(" pos=\"{}\"", three(knee - widened(body.joint_offset_m[index(segment)])));
  } else {
    const auto* const limit = std::ranges::find(limb_limits, right, &JointLimit::segment);
    more = fmt::format(" range=\"{:.6g} {:.6g}\"", limit->low_deg * radian, limit->high_deg * radian);
  }
  return fmt::format("<joint name=\"{}\" type=\"hinge\" axis=\"{}\"{}/>\n", name, three(hinge_axis(segment)), more);
}

/// Returns a capsule or sphere with the segment's mass: along the segment if it is long enough; across the column.
std::string body_geom(const Body& body, Segment segment) {
  const std::size_t s = index(segment);
  const double volume = static_cast<double>(body.mass_kg[s]) / tissue_kg_m3;
  const double sphere = std::cbrt(3 * volume / (4 * std::numbers::pi));
  const Eigen::Vector3d tip = widened(body.tip_m[s]), centre = widened(body.centre_of_mass_m[s]);
  const std::string start = fmt::format("<geom name=\"{}\" class=\"body\" ", segment_name[s]);
  if (segment < Segment::head) {
    const double radius = std::cbrt(3 * volume / (10 * std::numbers::pi));  // of a capsule twice as long as wide
    const Eigen::Vector3d out(radius, 0, 0);
    return start + fmt::format("type=\"capsule\" size=\"{:.6g}\" fromto=\"{} {}\"/>\n", radius, three(centre - out),
                               three(centre + out));
  }
  if (tip.norm() < 2 * sphere)
    return start + fmt::format("type=\"sphere\" size=\"{:.6g}\" pos=\"{}\"/>\n", sphere,
                               three(segment == Segment::head ? Eigen::Vector3d(0.5 * tip) : centre));
  return start + fmt::format("type=\"capsule\" size=\"{:.6g}\" fromto=\"0 0 0 {}\"/>\n",
                             std::sqrt(volume / (std::numbers::pi * tip.norm())), three(tip));
}

/// Returns two capsules along the sole, and the site of a touch sensor around them. `from` and `to` are on the ground.
std::string sole_elements(std::string_view name, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                          double radius) {
  const double half_width = 2 * radius;
  std::string text;
  for (const auto& [side, x] : {std::pair{"left", half_width}, std::pair{"right", -half_width}}) {
    const Eigen::Vector3d lift(x, radius, 0);
    text += fmt::format("<geom name=\"{}_{}_edge\" class=\"sole\" size=\"{:.6g}\" fromto=\"{} {}\"/>\n", name, side,
                        radius, three(from + lift), three(to + lift));
  }
  const Eigen::Vector3d middle = 0.5 * (from + to) + Eigen::Vector3d(0, radius, 0), half = 0.5 * (to - from);
  text +=
      fmt::format("<site name=\"{}\" class=\"sole\" type=\"box\" size=\"{:.6g} {:.6g} {:.6g}\" pos=\"{}\"/>\n", name,
                  half_width + 2 * radius, 2 * radius + std::abs(half.y()), half.z() + 2 * radius, three(middle));
  return text;
}

std::string foot_elements(const Body& body, Segment segment) {
  const Segment right = right_of(segment);
  const double radius = fraction::toe_joint_height * static_cast<double>(body.size.leg_scale_m);
  const std::string name = fmt::format("sole_{}", segment_name[index(segment)]);
  if (right == Segment::foot_right)
    return sole_elements(name, widened(body.heel_m) + Eigen::Vector3d(0, 0, radius), widened(body.ball_m), radius);
  if (right != Segment::toes_right) return {};
  const Eigen::Vector3d down(0, -radius, 0), tip = widened(body.tip_m[index(segment)]);
  return sole_elements(name, down, tip + down - Eigen::Vector3d(0, 0, radius), radius);
}

void add_body(const Body& body, const MujocoMuscles& muscles, Segment segment, std::size_t depth, std::string& text) {
  const std::size_t s = index(segment);
  const Vec3<double> inertia = segment_inertia_kg_m2(body, segment);
  const std::string indent(2 * depth, ' ');
  text +=
      fmt::format("{}<body name=\"{}\" pos=\"{}\">\n", indent, segment_name[s], three(widened(body.joint_offset_m[s])));
  std::string own =
      fmt::format("<inertial pos=\"{}\" mass=\"{:.9g}\" diaginertia=\"{:.9g} {:.9g} {:.9g}\"/>\n",
                  three(widened(body.centre_of_mass_m[s])), body.mass_kg[s], inertia.x, inertia.y, inertia.z);
  own += joint_element(body, segment);
  if (segment == Segment::pelvis)
    own += "<camera name=\"side\" mode=\"trackcom\" pos=\"3 0 0\" xyaxes=\"0 0 -1 0 1 0\"/>\n";
  own += body_geom(body, segment) + foot_elements(body, segment) + muscles.on_segment[s];
  indented(own, depth + 1, text);
  for (const Segment child : child_segments(segment)) add_body(body, muscles, child, depth + 1, text);
  text += indent + "</body>\n";
}

std::string numbers_of(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += fmt::format("{}{:.9g}", text.empty() ? "" : " ", value);
  return text;
}

constexpr std::string_view model_head = R"(  <compiler angle="radian" autolimits="true"/>
  <option gravity="0 -9.81 0" timestep="0.002" integrator="implicitfast"/>
  <default>
    <default class="body"><geom contype="1" conaffinity="0" group="1" rgba="0.8 0.74 0.6 1"/></default>
    <default class="sole"><geom type="capsule" contype="1" conaffinity="0" friction="1" rgba="0.3 0.3 0.3 1"/><site group="4"/></default>
    <default class="edge"><geom contype="0" conaffinity="0" group="4"/></default>
    <default class="muscle"><site size="0.003" group="4"/></default>
    <tendon width="0.004" rgba="0.6 0.1 0.1 1"/>
    <muscle ctrllimited="true" ctrlrange="0 1"/>
  </default>
)";

std::string model_text(const Body& body, const WalkRecording& recording) {
  const MujocoMuscles muscles = mujoco_muscles(body);
  const MujocoState state = mujoco_state(recording, 0);
  std::string text = "<mujoco model=\"walker\">\n" + std::string(model_head);
  text += "  <worldbody>\n    <light pos=\"2 4 2\" dir=\"-0.4 -0.8 -0.4\"/>\n";
  text +=
      "    <geom name=\"floor\" type=\"plane\" size=\"0 0 0.1\" zaxis=\"0 1 0\" contype=\"0\" conaffinity=\"1\" "
      "rgba=\"0.5 0.55 0.6 1\"/>\n";
  add_body(body, muscles, Segment::pelvis, 2, text);
  text += "  </worldbody>\n  <equality>\n";
  for (const std::size_t side : {0U, 1U}) {
    text += fmt::format("    <joint name=\"{0}\" joint1=\"{0}\" joint2=\"{1}\" polycoef=\"0 {2:.6g} 0 0 0\"/>\n",
                        segment_name[index(on_side(Segment::patella_right, side))],
                        segment_name[index(on_side(Segment::shank_right, side))], kneecap_part);
  }
  text += "  </equality>\n  <tendon>\n";
  indented(muscles.tendons, 2, text);
  text += "  </tendon>\n  <actuator>\n";
  indented(muscles.actuators, 2, text);
  text += "  </actuator>\n  <sensor>\n";
  for (const Segment right : {Segment::foot_right, Segment::toes_right}) {
    for (const std::size_t side : {0U, 1U}) {
      text += fmt::format("    <touch name=\"{0}\" site=\"sole_{0}\"/>\n", segment_name[index(on_side(right, side))]);
    }
  }
  text += fmt::format("  </sensor>\n  <keyframe>\n    <key name=\"walk\" time=\"{:.6f}\" qpos=\"{}\" qvel=\"{}\"/>\n",
                      recording.start_s, numbers_of(state.qpos), numbers_of(state.qvel));
  return text + "  </keyframe>\n</mujoco>\n";
}

}  // namespace

Result<void> write_mujoco_model(const std::filesystem::path& path, const Body& body, const WalkRecording& recording) {
  if (auto ok = check_mujoco(path, body, recording); !ok) return ok;
  return write_file(path, model_text(body, recording));
}

}  // namespace mobil::inline v0_3
