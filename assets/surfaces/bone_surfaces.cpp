#include "assets/surfaces/bone_surfaces.h"

#include <string>

#include <mobil/engine/geometry.h>
#include "assets/surfaces/bone_shapes.h"
#include "assets/surfaces/bone_surfaces_arm.h"
#include "assets/surfaces/bone_surfaces_leg.h"
#include "assets/surfaces/bone_surfaces_pelvis.h"
#include "assets/surfaces/bone_surfaces_skull.h"
#include "assets/surfaces/bone_surfaces_trunk.h"
#include "assets/surfaces/surface_mesh.h"

namespace mobil::inline v0_3 {

using namespace geometry;

std::vector<BoneSurface> make_bone_surfaces(const Body& body) {
  using enum Segment;
  const bones::Proportions p = bones::proportions(body);
  std::vector<BoneSurface> all(segment_count);
  const auto put = [&](Segment segment, std::string name, SurfaceMesh mesh) {
    scale(mesh, static_cast<double>(body.request.height_m) / reference_height_mm);
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

}  // namespace mobil::inline v0_3
