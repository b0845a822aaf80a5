#include <mobil/fit_anatomy.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include <mobil/muscle_table.h>
#include "assets/import/bone_maps.h"
#include "assets/muscles/muscle_architecture.h"
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

/// Returns the centre of the hundredth of a surface that is farthest along `direction`.
Vec3<float> extreme(const SurfaceMesh& mesh, const Vector3d& direction) {
  auto by_place = mesh.position;
  std::ranges::sort(by_place, {}, [&](const Vec3<float>& p) { return -direction.dot(eigen(p)); });
  const std::size_t count = std::max<std::size_t>(1, by_place.size() / 100);
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < count; ++i) sum += eigen(by_place[i]);
  return single(sum / static_cast<double>(count));
}

/// Returns the direction from a single muscle's origin to its insertion; downwards for a group's.
Vector3d direction_of(const FittedMuscle& muscle, const Body& body) {
  const auto lines = members_of(muscle.muscle);
  if (is_muscle_group(muscle.muscle) && lines.size() > 1) return -Vector3d::UnitY();
  const auto places = member_places(body, lines.front());
  const Vec3<double>&from = places.front().world_m, &to = places.back().world_m;
  return Vector3d(to.x - from.x, to.y - from.y, to.z - from.z).normalized();
}

/// Sets the attachments, and the segments of surfaces that do not end where their muscle does.
void hold(double knee_height, const Vector3d& way, FittedMuscle& muscle) {
  constexpr double above_knee_m = 0.1;
  MuscleSurface& surface = muscle.surface;
  if (muscle.origin_m && muscle.insertion_m && way.dot(eigen(*muscle.insertion_m) - eigen(*muscle.origin_m)) < 0)
    std::swap(muscle.origin_m, muscle.insertion_m);
  const Vec3<float> bottom = extreme(surface.mesh, -Vector3d::UnitY());
  const auto end_height = static_cast<double>(bottom.y);
  const bool past_kneecap = surface.insertion == Segment::patella_right && end_height < knee_height - past_kneecap_m;
  if (past_kneecap) surface.insertion = Segment::shank_right;
  if (surface.insertion > Segment::patella_right && end_height > knee_height + above_knee_m)
    surface.insertion = Segment::thigh_right;  // tensor fasciae latae without its tract
  muscle.attachments = {muscle.origin_m.value_or(extreme(surface.mesh, -way)),
                        past_kneecap ? bottom : muscle.insertion_m.value_or(extreme(surface.mesh, way))};
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
    hold(joints.knee.y(), direction_of(muscle, body), muscle);
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
