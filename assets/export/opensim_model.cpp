#include "assets/export/opensim_model.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/assets/files/output_file.h>
#include <mobil/opensim_writer.h>
#include "assets/body/joint_limits.h"
#include "assets/export/opensim_axes.h"
#include "assets/export/opensim_muscles.h"
#include "assets/export/skeleton_keys.h"

namespace mobil::inline v0_3 {
namespace {

/// A coordinate of a joint: about an axis of the model, or along it.
struct OpensimCoordinate {
  std::string name;
  Eigen::Vector3d axis;
  double low, high;  // rad or m
};

struct OpensimJoint {
  std::string name, parent, child;  // parent and child: bodies
  Eigen::Vector3d in_parent_m;      // the child's origin
  std::vector<OpensimCoordinate> turns, slides;
};

/// A rigid body of the model: its origin in mobil's anatomical position, and its segments.
struct OpensimBody {
  std::string name;
  Eigen::Vector3d origin_m;
  std::vector<Segment> segments;
};

std::string opensim_numbers(const Eigen::Vector3d& v) {
  return fmt::format("{:.9g} {:.9g} {:.9g}", v.x(), v.y(), v.z());
}

Eigen::Vector3d opensim_standing_place(const Body& body, Segment segment) {
  return widened(standing_pose(body).position_m[index(segment)]);
}

/// Returns the origin of the model's pelvis in the pelvis' frame, as `pelvis_t*` of motions have it.
Eigen::Vector3d pelvis_origin(const Body& body) {
  const Eigen::Vector3d right = widened(body.joint_offset_m[index(Segment::thigh_right)]);
  const Eigen::Vector3d left = widened(body.joint_offset_m[index(Segment::thigh_left)]);
  const double size = (right - left).norm() / model_hips_m;
  return 0.5 * (right + left) + size * Eigen::Vector3d(0, model_above_m, model_ahead_m);
}

std::vector<OpensimBody> opensim_bodies(const Body& body) {
  using enum Segment;
  std::vector<OpensimBody> bodies;
  const auto at = [&](Segment segment) -> OpensimBody& {
    const std::string name = opensim_body(segment);
    for (OpensimBody& known : bodies)
      if (known.name == name) return known;
    return bodies.emplace_back(name, opensim_standing_place(body, segment), std::vector<Segment>{});
  };
  for (std::size_t s = 0; s < segment_count; ++s)
    at(static_cast<Segment>(s)).segments.push_back(static_cast<Segment>(s));
  bodies.front().origin_m += pelvis_origin(body);
  return bodies;
}

std::string opensim_body_element(const Body& body, const OpensimBody& rigid) {
  double mass = 0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  const auto centre_of = [&](Segment segment) {
    return opensim_axes(opensim_standing_place(body, segment) + widened(body.centre_of_mass_m[index(segment)]) -
                        rigid.origin_m);
  };
  for (const Segment segment : rigid.segments) {
    const auto own = static_cast<double>(body.mass_kg[index(segment)]);
    mass += own;
    moment += own * centre_of(segment);
  }
  const Eigen::Vector3d centre = moment / mass;
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (const Segment segment : rigid.segments) {
    const Vec3<double> own = segment_inertia_kg_m2(body, segment);
    const Eigen::Vector3d off = centre_of(segment) - centre;
    inertia += Eigen::Vector3d(own.z, own.y, own.x).asDiagonal();
    inertia += static_cast<double>(body.mass_kg[index(segment)]) *
               (off.squaredNorm() * Eigen::Matrix3d::Identity() - off * off.transpose());
  }
  return fmt::format(
      "<Body name=\"{}\"><mass>{:.9g}</mass><mass_center>{}</mass_center><inertia>{:.9g} {:.9g} {:.9g} {:.9g} {:.9g} "
      "{:.9g}</inertia></Body>\n",
      rigid.name, mass, opensim_numbers(centre), inertia(0, 0), inertia(1, 1), inertia(2, 2), inertia(0, 1),
      inertia(0, 2), inertia(1, 2));
}

std::string opensim_frame(const std::string& body) {
  return body == "ground" ? "/ground" : "/bodyset/" + body;
}

std::string opensim_joint_element(const OpensimJoint& joint) {
  std::string coordinates, axes;
  const auto add = [&](const char* kind, const std::vector<OpensimCoordinate>& moving) {
    for (int i = 0; i < 3; ++i) {
      const auto number = static_cast<std::size_t>(i);
      const bool moves = number < moving.size();
      const Eigen::Vector3d axis = moves ? moving[number].axis : Eigen::Vector3d(Eigen::Vector3d::Unit(2 - i));
      const std::string function =
          moves ? "<LinearFunction name=\"function\"><coefficients>1 0</coefficients></LinearFunction>"
                : "<Constant name=\"function\"><value>0</value></Constant>";
      axes +=
          fmt::format("<TransformAxis name=\"{}{}\"><coordinates>{}</coordinates><axis>{}</axis>{}</TransformAxis>\n",
                      kind, i + 1, moves ? moving[number].name : "", opensim_numbers(axis), function);
      if (!moves) continue;
      coordinates += fmt::format("<Coordinate name=\"{}\"><range>{:.6g} {:.6g}</range></Coordinate>\n",
                                 moving[number].name, moving[number].low, moving[number].high);
    }
  };
  add("rotation", joint.turns);
  add("translation", joint.slides);
  const auto offset = [&](const std::string& name, const std::string& body, const Eigen::Vector3d& at) {
    return fmt::format(
        "<PhysicalOffsetFrame name=\"{}\"><socket_parent>{}</socket_parent><translation>{}</translation>"
        "<orientation>0 0 0</orientation></PhysicalOffsetFrame>\n",
        name, opensim_frame(body), opensim_numbers(at));
  };
  const std::string parent = joint.parent + "_offset", child = joint.child + "_offset";
  return fmt::format(
             "<CustomJoint name=\"{}\">\n<socket_parent_frame>{}</socket_parent_frame>\n"
             "<socket_child_frame>{}</socket_child_frame>\n<coordinates>\n",
             joint.name, parent, child) +
         coordinates + "</coordinates>\n<frames>\n" + offset(parent, joint.parent, joint.in_parent_m) +
         offset(child, joint.child, Eigen::Vector3d::Zero()) + "</frames>\n<SpatialTransform>\n" + axes +
         "</SpatialTransform>\n</CustomJoint>\n";
}

std::vector<OpensimJoint> opensim_joints(const Body& body) {
  using enum Segment;
  constexpr double radian = std::numbers::pi / 180, around = std::numbers::pi, far_m = 100;
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d pelvis_at = pelvis_origin(body);
  const auto offset = [&](Segment segment) { return opensim_axes(widened(body.joint_offset_m[index(segment)])); };
  const auto turn = [&](const std::string& name, const Eigen::Vector3d& axis, double low_deg, double high_deg) {
    return OpensimCoordinate{name, axis, low_deg * radian, high_deg * radian};
  };
  const auto limit = [](std::size_t number) -> const JointLimit& { return limb_limits[number]; };
  std::vector<OpensimJoint> joints = {
      {"ground_pelvis",
       "ground",
       "pelvis",
       Eigen::Vector3d::Zero(),
       {{"pelvis_tilt", z, -around, around},
        {"pelvis_list", x, -around, around},
        {"pelvis_rotation", y, -around, around}},
       {{"pelvis_tx", x, -far_m, far_m}, {"pelvis_ty", y, -far_m, far_m}, {"pelvis_tz", z, -far_m, far_m}}},
      {"back",
       "pelvis",
       "torso",
       offset(L5) - opensim_axes(pelvis_at),
       {turn("lumbar_extension", z, -90, 90), turn("lumbar_bending", x, -90, 90), turn("lumbar_rotation", y, -90, 90)},
       {}}};
  for (const std::size_t side : {0U, 1U}) {
    const std::string end = side == Side::right ? "_r" : "_l";
    const double inward = side == Side::right ? 1 : -1;
    const auto of = [&](Segment right) { return offset(on_side(right, side)); };
    // limb_limits begins with hip flexion, abduction, rotation, knee, ankle, hindfoot and toes.
    joints.push_back({"hip" + end,
                      "pelvis",
                      "femur" + end,
                      of(thigh_right) - opensim_axes(pelvis_at),
                      {turn("hip_flexion" + end, z, limit(0).low_deg, limit(0).high_deg),
                       turn("hip_adduction" + end, inward * x, -limit(1).high_deg, -limit(1).low_deg),
                       turn("hip_rotation" + end, inward * y, limit(2).low_deg, limit(2).high_deg)},
                      {}});
    joints.push_back({"knee" + end,
                      "femur" + end,
                      "tibia" + end,
                      of(shank_right),
                      {turn("knee_angle" + end, z, -limit(3).high_deg, -limit(3).low_deg)},
                      {}});
    joints.push_back({"ankle" + end,
                      "tibia" + end,
                      "calcn" + end,
                      of(foot_right),
                      {turn("ankle_angle" + end, z, limit(4).low_deg, limit(4).high_deg),
                       turn("subtalar_angle" + end, inward * x, limit(5).low_deg, limit(5).high_deg)},
                      {}});
    joints.push_back({"mtp" + end,
                      "calcn" + end,
                      "toes" + end,
                      of(toes_right),
                      {turn("mtp_angle" + end, z, limit(6).low_deg, limit(6).high_deg)},
                      {}});
  }
  return joints;
}

}  // namespace

std::string opensim_body(Segment segment) {
  using enum Segment;
  if (segment == pelvis) return "pelvis";
  for (const std::size_t side : {0U, 1U}) {
    const std::string end = side == Side::right ? "_r" : "_l";
    if (segment == on_side(thigh_right, side) || segment == on_side(patella_right, side)) return "femur" + end;
    if (segment == on_side(shank_right, side)) return "tibia" + end;
    if (segment == on_side(foot_right, side)) return "calcn" + end;
    if (segment == on_side(toes_right, side)) return "toes" + end;
  }
  return "torso";
}

Result<void> write_opensim_model(const std::filesystem::path& path, const Body& body) {
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<OpenSimDocument Version=\"40000\">\n<Model name=\"walker\">\n"
      "<length_units>meters</length_units>\n<force_units>N</force_units>\n<gravity>0 -9.81 0</gravity>\n"
      "<Ground name=\"ground\"/>\n<BodySet name=\"bodyset\"><objects>\n";
  for (const OpensimBody& rigid : opensim_bodies(body)) text += opensim_body_element(body, rigid);
  text += "</objects></BodySet>\n<JointSet name=\"jointset\"><objects>\n";
  for (const OpensimJoint& joint : opensim_joints(body)) text += opensim_joint_element(joint);
  text += "</objects></JointSet>\n<ForceSet name=\"forceset\"><objects>\n";
  text += opensim_muscles(body, pelvis_origin(body));
  text += "</objects></ForceSet>\n</Model>\n</OpenSimDocument>\n";
  return write_file(path, text);
}

}  // namespace mobil::inline v0_3
