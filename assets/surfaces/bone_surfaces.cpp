#include "assets/surfaces/bone_surfaces.h"

#include <numbers>
#include <string>

#include "assets/surfaces/bone_shapes.h"
#include "assets/surfaces/surface_mesh.h"
#include "engine/geometry.h"

namespace mobil {

using namespace geometry;

namespace bones {

Proportions proportions(const Body& body) {
  Proportions p{};
  const double mm = reference_height_mm / static_cast<double>(body.request.height_m);
  for (std::size_t s = 0; s < segment_count; ++s) {
    p.joint[s] = mm * to_double(body.joint_offset_m[s]);
    p.tip[s] = mm * to_double(body.tip_m[s]);
    const std::size_t parent = index(segment_parent[s]);
    p.world[s] = s == parent ? p.joint[s] : p.world[parent] + p.joint[s];
  }
  p.leg = leg_frame(body);
  p.leg.hip = {0, 0, 0};
  p.leg.thigh_length *= mm;
  p.leg.shank_length *= mm;
  p.leg.unit = 1;
  return p;
}

void add_tube(SurfaceMesh& mesh, std::initializer_list<Station> stations, const TubeShape& shape) {
  std::vector<TubeStation> line;
  for (const Station& s : stations) {
    line.push_back({{s.x, s.y, s.z}, s.semi_u, s.semi_v, s.angle_deg * std::numbers::pi / 180, s.bow});
  }
  append(mesh, loft(line, shape));
}

void add_ellipsoid(SurfaceMesh& mesh, const Vec3<double>& centre, const Vec3<double>& semi, int rings, int segments) {
  append(mesh, ellipsoid(centre, semi, rings, segments));
}

void add_pair(SurfaceMesh& mesh, const SurfaceMesh& part) {
  append(mesh, part);
  append(mesh, mirror_image(part));
}

}  // namespace bones

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
    put(on_side(segment, right), name + "_right", mesh);
    put(on_side(segment, left), name + "_left", mirror_image(mesh));
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

}  // namespace mobil
