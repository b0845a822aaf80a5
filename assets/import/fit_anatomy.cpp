#include <mobil/fit_anatomy.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "assets/import/bone_maps.h"
#include "assets/surfaces/surface_mesh.h"

namespace mobil::inline v0_3 {
namespace {

using Eigen::Vector3d;

/// A quadriceps that extends this far below the knee includes its ligament.
constexpr double past_kneecap_m = 0.035;

Vec3<float> single(const Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

Vector3d origin_of(Segment segment, const LegJoints& joints) {
  switch (segment) {
    case Segment::pelvis:
      return joints.pelvis;
    case Segment::thigh_right:
      return joints.hip;
    case Segment::patella_right:
      return joints.patella;
    case Segment::shank_right:
      return joints.knee;
    case Segment::foot_right:
      return joints.ankle;
    default:
      return joints.ball;
  }
}

std::string left_name(std::string name) {
  constexpr std::string_view suffix = "_right";
  if (name.ends_with(suffix)) name.resize(name.size() - suffix.size());
  return name + "_left";
}

void add_bone(const AnatomyPart& part, const BoneMaps& maps, const LegJoints& joints, std::vector<BoneSurface>& bones) {
  BoneSurface bone{part.origin, part.mesh};
  const Vector3d origin = origin_of(part.origin, joints);
  const BoneMap& map = maps.of(part.origin);
  for (auto& p : bone.mesh.position) p = single(map(eigen(p)) - origin);
  bones.push_back(bone);
  if (part.midline) return;
  BoneSurface image{part.origin == Segment::pelvis ? part.origin : on_side(part.origin, Side::left),
                    mirror_image(bone.mesh)};
  image.mesh.name = left_name(image.mesh.name);
  bones.push_back(std::move(image));
}

/// Returns the centre of the highest or lowest hundredth of a surface.
Vec3<float> extreme(const SurfaceMesh& mesh, bool top) {
  auto by_height = mesh.position;
  std::sort(by_height.begin(), by_height.end(),
            [top](const auto& a, const auto& b) { return top ? a.y > b.y : a.y < b.y; });
  const std::size_t count = std::max<std::size_t>(1, by_height.size() / 100);
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < count; ++i) sum += eigen(by_height[i]);
  return single(sum / static_cast<double>(count));
}

void hold(double knee_height, FittedMuscle& muscle) {
  MuscleSurface& surface = muscle.surface;
  const Vec3<float> bottom = extreme(surface.mesh, false);
  const bool past_kneecap =
      surface.insertion == Segment::patella_right && static_cast<double>(bottom.y) < knee_height - past_kneecap_m;
  if (past_kneecap) surface.insertion = Segment::shank_right;
  muscle.attachments = {muscle.origin_m.value_or(extreme(surface.mesh, true)),
                        past_kneecap ? bottom : muscle.insertion_m.value_or(bottom)};
}

}  // namespace

Result<FittedAnatomy> fit_anatomy(const Anatomy& anatomy, const Body& body) {
  const auto maps = bone_maps(anatomy, body);
  if (!maps) return fail(maps.error().message);
  const LegJoints joints = leg_joints(body);
  FittedAnatomy fitted;
  for (const auto& part : anatomy.part) {
    if (part.kind == AnatomyKind::bone) {
      add_bone(part, *maps, joints, fitted.bones);
      continue;
    }
    const auto place = [&](const Vec3<float>& p) {
      return single(maps->along_muscle(eigen(p), part.origin, part.insertion));
    };
    MuscleSurface surface;
    surface.mesh = part.mesh;
    surface.origin = part.origin;
    surface.insertion = part.insertion;
    for (auto& p : surface.mesh.position) p = place(p);
    if (part.kind == AnatomyKind::skin) {
      fitted.skins.push_back(std::move(surface.mesh));
      continue;
    }
    if (!part.group) {
      fitted.others.push_back(std::move(surface));
      continue;
    }
    FittedMuscle muscle{*part.group, part.muscle.value_or(*part.group), std::move(surface), {}, {}};
    if (part.origin_m) muscle.origin_m = place(*part.origin_m);
    if (part.insertion_m) muscle.insertion_m = place(*part.insertion_m);
    hold(joints.knee.y(), muscle);
    fitted.muscles.push_back(std::move(muscle));
  }
  return fitted;
}

std::optional<Ligament> cut_at_kneecap(FittedMuscle& muscle, const Body& body) {
  MuscleSurface& surface = muscle.surface;
  if (muscle.group != Muscle::quadriceps || surface.insertion != Segment::shank_right) return std::nullopt;
  const LegJoints joints = leg_joints(body);
  const SurfaceMesh whole = std::move(surface.mesh);
  const std::string name = whole.name.substr(0, whole.name.rfind("_right"));
  Ligament ligament;
  ligament.surface.origin = Segment::patella_right;
  ligament.surface.insertion = Segment::shank_right;
  surface.mesh = {whole.name, {}, {}};
  ligament.surface.mesh = {name + "_ligament_right", {}, {}};
  constexpr std::uint32_t absent = ~0U;
  std::array<std::vector<std::uint32_t>, 2> number;
  for (auto& n : number) n.assign(whole.position.size(), absent);
  for (std::size_t t = 0; t < whole.triangle.size(); t += 3) {
    double middle = 0;
    for (std::size_t k = 0; k < 3; ++k) middle += static_cast<double>(whole.position[whole.triangle[t + k]].y) / 3;
    const std::size_t below = middle < joints.patella.y() ? 1 : 0;
    SurfaceMesh& mesh = below == 1 ? ligament.surface.mesh : surface.mesh;
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& n = number[below][whole.triangle[t + k]];
      if (n == absent) {
        n = static_cast<std::uint32_t>(mesh.position.size());
        mesh.position.push_back(whole.position[whole.triangle[t + k]]);
      }
      mesh.triangle.push_back(n);
    }
  }
  const Vec3<float> bottom = muscle.attachments.insertion_m;
  ligament.ends = {single({bottom.x, joints.patella.y(), bottom.z}), bottom};
  surface.insertion = Segment::patella_right;
  muscle.attachments.insertion_m = muscle.insertion_m.value_or(single(joints.patella));
  return ligament;
}

}  // namespace mobil::inline v0_3
