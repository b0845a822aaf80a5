#include "assets/surfaces/bone_surfaces.h"

#include <string>
#include <utility>

#include <mobil/anthropometry.h>
#include <mobil/assets/surfaces/form_scale.h>
#include <mobil/engine/geometry.h>
#include "assets/body/body_scales.h"
#include "assets/surfaces/bone_shapes.h"
#include "assets/surfaces/bone_surfaces_arm.h"
#include "assets/surfaces/bone_surfaces_leg.h"
#include "assets/surfaces/bone_surfaces_pelvis.h"
#include "assets/surfaces/bone_surfaces_skull.h"
#include "assets/surfaces/bone_surfaces_trunk.h"
#include "assets/surfaces/surface_mesh.h"

namespace mobil::inline v0_3 {

using namespace geometry;

namespace {

using bones::Proportions;

/// Draws all bones in mm of a man of reference_height_mm.
std::vector<BoneSurface> drawn_bones(const Proportions& p) {
  using enum Segment;
  std::vector<BoneSurface> all(segment_count);
  const auto put = [&](Segment segment, std::string name, SurfaceMesh mesh) {
    mesh.name = std::move(name);
    all[index(segment)] = {segment, std::move(mesh)};
  };
  const auto put_both = [&](Segment segment, const std::string& name, const SurfaceMesh& mesh) {
    put(on_side(segment, Side::right), name + "_right", mesh);
    put(on_side(segment, Side::left), name + "_left", mirror_image(mesh));
  };
  put(pelvis, "pelvis", bones::pelvis());
  for (std::size_t s = index(L5); s <= index(C1); ++s) {
    const auto segment = static_cast<Segment>(s);
    put(segment, std::string(segment_name[s]), bones::vertebra(p, segment));
  }
  put(head, "skull", bones::skull());
  put_both(thigh_right, "femur", bones::femur(p));
  put_both(patella_right, "patella", bones::patella());
  put_both(shank_right, "tibia_fibula", bones::tibia_and_fibula(p));
  put_both(foot_right, "foot", bones::foot(p));
  put_both(toes_right, "toes", bones::toes(p));
  put_both(clavicle_right, "clavicle_scapula", bones::clavicle_and_scapula(p));
  put_both(upper_arm_right, "humerus", bones::humerus(p));
  put_both(forearm_right, "radius_ulna", bones::radius_and_ulna(p));
  put_both(hand_right, "hand", bones::hand(p));
  put_both(fingers_right, "fingers", bones::fingers(p));
  put_both(thumb_right, "thumb", bones::thumb(p));
  return all;
}

}  // namespace

const std::vector<BoneSurface>& usual_bones() {
  static const std::vector<BoneSurface> bones = drawn_bones(bones::proportions());
  return bones;
}

BoneScales bone_scales(const Body& body) {
  using enum Segment;
  const auto scales = group_scales(body.size);
  const double head_wide = 1.75 / reference_height_mm * form::form_scale(body).head_wide;
  BoneScales all;
  for (std::size_t s = 0; s < segment_count; ++s) {
    const auto segment = static_cast<Segment>(s);
    AxisGroups groups = segment_groups[s];
    if (segment == pelvis) groups = {LengthGroup::hips, LengthGroup::leg, LengthGroup::leg};
    if (segment >= T12 && segment <= T1) groups.x = LengthGroup::shoulders;
    const Vec size = scaled({1, 1, 1}, scales, groups);
    all[s] = {size.x / reference_height_mm, size.y / reference_height_mm, size.z / reference_height_mm};
    if (segment >= C7 && segment <= head) all[s].x = all[s].z = head_wide;
  }
  if (!has_own_limbs(body.request)) return all;
  BodyRequest usual = body.request;
  usual.limbs = {};
  const LimbLengths<float> own_m = limb_lengths(body), usual_m = limb_lengths(*make_body(usual));
  for (std::size_t s = 0; s < segment_count; ++s) {
    const auto length = [&](const LimbLengths<float>& limbs) {
      return static_cast<double>(value_of(limbs, static_cast<Segment>(s), 1));
    };
    all[s].y *= length(own_m) / length(usual_m);
  }
  return all;
}

std::vector<BoneSurface> make_bone_surfaces(const Body& body) {
  std::vector<BoneSurface> all = usual_bones();
  const BoneScales scales = bone_scales(body);
  for (BoneSurface& bone : all) {
    const Vec& by = scales[index(bone.segment)];
    for (auto& p : bone.mesh.position) {
      const Vec at = to_double(p);
      p = to_float(Vec{by.x * at.x, by.y * at.y, by.z * at.z});
    }
  }
  return all;
}

}  // namespace mobil::inline v0_3
