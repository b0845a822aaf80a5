#include "assets/export/opensim_muscles.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>

#include <mobil/assets/muscles/muscle_path.h>
#include <mobil/engine/geometry.h>
#include "assets/export/model_muscles.h"
#include "assets/export/opensim_axes.h"
#include "assets/export/opensim_model.h"

namespace mobil::inline v0_3 {
namespace {

constexpr double flexion_radian = std::numbers::pi / 180;

Eigen::Vector3d opensim_place(const Vec3<double>& v) {
  return opensim_axes({v.x, v.y, v.z});
}

/// Returns the range of flexion of the knee, for an edge of the pelvis of the hip, at which the path touches its edge,
/// degrees; nothing if it never does.
std::optional<std::array<double, 2>> touched_at(const Body& body, const MemberMuscle& member, const PathPoint& edge) {
  using namespace geometry;
  const bool of_hip = edge.bone == LegBone::pelvis;
  const int from_deg = of_hip ? -30 : -2, to_deg = of_hip ? 120 : 144;
  const LegScale<double> scale = leg_scale(body);
  std::optional<std::array<double, 2>> range;
  for (int degrees = from_deg; degrees <= to_deg; ++degrees) {
    const LegFrames<double> leg = of_hip ? bent_leg(body, degrees, 0, 0) : bent_leg(body, 0, degrees, 0);
    const Vec3<double> at = path_point(edge, scale, rolled(scale, leg));
    const bool touches = std::ranges::any_of(member_path(member, scale, leg), [&](const PathCorner& corner) {
      const Vec3<double> off = corner.at - at;  // along x, the edge's direction in a sagittal plane
      return corner.bone == edge.bone && std::abs(off.y) < 1e-9 && std::abs(off.z) < 1e-9;
    });
    if (!touches) continue;
    const double flexion = degrees;
    if (!range) range = std::array{flexion, flexion};
    (*range)[1] = flexion;
  }
  return range;
}

std::string spline(std::string_view element, const std::array<double, knee_knots>& value) {
  std::string x, y;
  for (std::size_t knot = knee_knots; knot-- > 0;) {  // the knee's angle is minus its flexion
    x += fmt::format(" {:.9g}", -knee_knot_deg * static_cast<double>(knot) * flexion_radian);
    y += fmt::format(" {:.9g}", value[knot]);
  }
  return fmt::format("<{0}><SimmSpline><x>{1}</x><y>{2}</y></SimmSpline></{0}>\n", element, x, y);
}

/// A muscle of one side being written.
struct OpensimMember {
  const Body& body;
  const MemberMuscle& member;
  std::size_t side;
  Eigen::Vector3d pelvis_origin_m;
  std::string ending = side == Side::right ? "_r" : "_l";
  std::string name = std::string(member.name) + ending;
  int points = 0;

  std::string hip() const { return fmt::format("/jointset/hip{0}/hip_flexion{0}", ending); }
  std::string knee() const { return fmt::format("/jointset/knee{0}/knee_angle{0}", ending); }

  /// Returns a point's start tag and its frame.
  std::string begin(std::string_view element, LegBone bone) {
    return fmt::format("<{} name=\"{}-P{}\">\n  <socket_parent_frame>/bodyset/{}</socket_parent_frame>\n", element,
                       name, ++points, opensim_body(bone_segment(bone, side)));
  }
  Eigen::Vector3d place(const PathPoint& point) const {
    Eigen::Vector3d at = opensim_place(member_place(body, point, side));
    if (point.bone == LegBone::pelvis) at -= opensim_axes(pelvis_origin_m);
    return at;
  }
  std::string point(const PathPoint& path) {
    const Eigen::Vector3d at = place(path);
    const std::string location = fmt::format("  <location>{:.9g} {:.9g} {:.9g}</location>\n", at.x(), at.y(), at.z());
    if (path.hold == PathHold::fixed) return begin("PathPoint", path.bone) + location + "</PathPoint>\n";
    const auto range = touched_at(body, member, path);
    if (!range) return {};
    const double low = (*range)[0] * flexion_radian, high = (*range)[1] * flexion_radian;
    const bool of_hip = path.bone == LegBone::pelvis;  // its angle is the flexion, the knee's minus the flexion
    return begin("ConditionalPathPoint", path.bone) + location +
           fmt::format("  <socket_coordinate>{}</socket_coordinate>\n  <range>{:.6g} {:.6g}</range>\n",
                       of_hip ? hip() : knee(), of_hip ? low : -high, of_hip ? high : -low) +
           "</ConditionalPathPoint>\n";
  }
  std::string kneecap() {
    std::array<std::array<double, knee_knots>, 3> track{};
    for (std::size_t knot = 0; knot < knee_knots; ++knot) {
      const Eigen::Vector3d at = place({LegBone::shank, (*member.kneecap)[knot]});
      for (const int axis : {0, 1, 2}) track[static_cast<std::size_t>(axis)][knot] = at[axis];
    }
    std::string text = begin("MovingPathPoint", LegBone::shank);
    for (const auto* axis : {"x", "y", "z"})
      text += fmt::format("  <socket_{0}_coordinate>{1}</socket_{0}_coordinate>\n", axis, knee());
    return text + "  " + spline("x_location", track[0]) + "  " + spline("y_location", track[1]) + "  " +
           spline("z_location", track[2]) + "</MovingPathPoint>\n";
  }
  std::string text() {
    const HillMuscle muscle = hill_muscle(body, member);
    std::string made = fmt::format(
        "<Thelen2003Muscle name=\"{}\">\n<GeometryPath name=\"geometrypath\">\n<PathPointSet "
        "name=\"pathpointset\"><objects>\n",
        name);
    for (const PathPoint& path : member.path) made += point(path);
    if (member.kneecap) made += kneecap();
    return made + fmt::format(
                      "</objects></PathPointSet>\n</GeometryPath>\n<max_isometric_force>{:.6g}</max_isometric_force>\n"
                      "<optimal_fiber_length>{:.9g}</optimal_fiber_length>\n<tendon_slack_length>{:.9g}</"
                      "tendon_slack_length>\n"
                      "<pennation_angle_at_optimal>{:.9g}</pennation_angle_at_optimal>\n</Thelen2003Muscle>\n",
                      muscle.force_n, muscle.fibre_m, muscle.tendon_m, muscle.pennation_rad);
  }
};

}  // namespace

std::string opensim_muscles(const Body& body, const Eigen::Vector3d& pelvis_origin_m) {
  std::string text;
  for (const Side side : {Side::right, Side::left})
    for (const MemberMuscle& member : member_muscles())
      text += OpensimMember{.body = body, .member = member, .side = side, .pelvis_origin_m = pelvis_origin_m}.text();
  return text;
}

}  // namespace mobil::inline v0_3
