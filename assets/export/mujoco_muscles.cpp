#include "assets/export/mujoco_muscles.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include <mobil/assets/muscles/muscle_path.h>
#include <mobil/engine/geometry.h>
#include "assets/body/joint_limits.h"
#include "assets/export/model_muscles.h"
#include "engine/exact_math.h"

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

constexpr double edge_radius_m = 1e-4, beside_edge_m = 0.02, edge_half_length_m = 0.02;

const JointLimit& limit_of(std::string_view joint, std::string_view motion) {
  return *std::ranges::find_if(limb_limits,
                               [&](const JointLimit& limit) { return limit.joint == joint && limit.motion == motion; });
}

/// Returns the shortest and longest path of a member over the sagittal range of hip, knee and ankle, m.
std::array<double, 2> length_range(const Body& body, const MemberMuscle& member) {
  constexpr int parts = 6;
  const LegScale<double> scale = leg_scale(body);
  const JointLimit& hip = limit_of("hip", "flexion-extension");
  const JointLimit& knee = limit_of("knee", "flexion-extension");
  const JointLimit& ankle = limit_of("ankle", "dorsiflexion-plantarflexion");
  const auto at = [](const JointLimit& limit, int i) {
    return limit.low_deg + (limit.high_deg - limit.low_deg) * i / parts;
  };
  std::array<double, 2> range = {std::numeric_limits<double>::infinity(), 0};
  for (int h = 0; h <= parts; ++h) {
    for (int k = 0; k <= parts; ++k) {
      for (int a = 0; a <= parts; ++a) {
        const double length = member_length(member, scale, bent_leg(body, at(hip, h), at(knee, k), at(ankle, a)));
        range = {std::min(range[0], length), std::max(range[1], length)};
      }
    }
  }
  return range;
}

/// A member muscle of one side being written.
class MujocoMember {
 public:
  MujocoMember(const Body& body, const MemberMuscle& member, std::size_t side, MujocoMuscles& into)
      : body_(body),
        member_(member),
        side_(side),
        into_(into),
        name_(fmt::format("{}_{}", member.name, side == Side::right ? "right" : "left")) {}

  void write() {
    into_.tendons += fmt::format("<spatial name=\"{}\">\n", name_);
    bool edge_before = false;
    for (const PathPoint& point : member_.path) {
      const bool edge = point.hold != PathHold::fixed;
      if (edge && edge_before) continue;
      edge ? add_edge(point) : add_site(point.bone, place(point));
      edge_before = edge;
    }
    if (member_.kneecap) add_kneecap();
    into_.tendons += "</spatial>\n";
    add_actuator();
  }

 private:
  Vec3<double> place(const PathPoint& point) const { return member_place(body_, point, side_); }
  std::string& on(Segment right_segment) { return into_.on_segment[index(on_side(right_segment, side_))]; }
  std::string& on(LegBone bone) { return into_.on_segment[index(bone_segment(bone, side_))]; }
  std::string site_on(std::string& text, const std::string& name, const Vec3<double>& at) {
    text += fmt::format("<site name=\"{}\" class=\"muscle\" pos=\"{:.9g} {:.9g} {:.9g}\"/>\n", name, at.x, at.y, at.z);
    return name;
  }
  std::string next_name() { return fmt::format("{}_{}", name_, ++points_); }

  void add_site(LegBone bone, const Vec3<double>& at) {
    into_.tendons += fmt::format("  <site site=\"{}\"/>\n", site_on(on(bone), next_name(), at));
  }
  void add_edge(const PathPoint& point) {
    const std::string name = next_name();
    const Vec3<double> at = place(point);
    on(point.bone) += fmt::format(
        "<geom name=\"{}\" class=\"edge\" type=\"cylinder\" size=\"{} {}\" pos=\"{:.9g} {:.9g} {:.9g}\" "
        "zaxis=\"1 0 0\"/>\n",
        name, edge_radius_m, edge_half_length_m, at.x, at.y, at.z);
    const double ahead = point.hold == PathHold::front ? beside_edge_m : -beside_edge_m;
    const std::string beside = site_on(on(point.bone), name + "_side", at + Vec3<double>{0, 0, ahead});
    into_.tendons += fmt::format("  <geom geom=\"{}\" sidesite=\"{}\"/>\n", name, beside);
  }
  void add_kneecap() {
    const PathPoint end = path_end(member_, 0);
    const Vec3<double> knee = to_double(body_.joint_offset_m[index(on_side(Segment::shank_right, side_))]);
    const Vec3<double> cap = to_double(body_.joint_offset_m[index(on_side(Segment::patella_right, side_))]);
    const std::string name = site_on(on(Segment::patella_right), next_name(), place(end) + knee - cap);
    into_.tendons += fmt::format("  <site site=\"{}\"/>\n", name);
  }
  /// MuJoCo's fibre is (longest − shortest) / (range₁ − range₀), its tendon is shortest − range₀ · fibre.
  void add_actuator() {
    const HillMuscle muscle = hill_muscle(body_, member_);
    const auto [shortest, longest] = length_range(body_, member_);
    const auto of_fibre = [&](double length) { return (length - muscle.tendon_m) / muscle.fibre_m; };
    into_.actuators += fmt::format(
        "<muscle name=\"{0}\" tendon=\"{0}\" force=\"{1:.6g}\" lengthrange=\"{2:.6g} {3:.6g}\" range=\"{4:.6g} "
        "{5:.6g}\"/>\n",
        name_, muscle.force_n * exact::cos(muscle.pennation_rad), shortest, longest, of_fibre(shortest),
        of_fibre(longest));
  }

  const Body& body_;
  const MemberMuscle& member_;
  std::size_t side_;
  MujocoMuscles& into_;
  std::string name_;
  int points_ = 0;
};

}  // namespace

MujocoMuscles mujoco_muscles(const Body& body) {
  MujocoMuscles made;
  for (const Side side : {Side::right, Side::left})
    for (const MemberMuscle& member : member_muscles()) MujocoMember(body, member, side, made).write();
  return made;
}

}  // namespace mobil::inline v0_3
