#include "assets/surfaces/bone_shapes.h"

#include <numbers>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/engine/geometry.h>
#include "assets/surfaces/coarser_surface.h"
#include "assets/surfaces/distance_field.h"
#include "assets/surfaces/surface_mesh.h"

namespace mobil::inline v0_3::bones {

using namespace geometry;

Proportions proportions() {
  constexpr double mm = reference_height_mm, thigh = mm * fraction::thigh, shank = mm * fraction::shank;
  Proportions p{};
  for (std::size_t s = 0; s < segment_count; ++s) {
    p.joint[s] = mm * unit_body.joint_offset[s];
    p.tip[s] = mm * unit_body.tip[s];
    const std::size_t parent = index(segment_parent[s]);
    p.world[s] = s == parent ? p.joint[s] : p.world[parent] + p.joint[s];
  }
  p.leg = {{0, 0, 0}, thigh, shank, thigh, 1};
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

SurfaceMesh united(const SurfaceMesh& parts) {
  if (!can_be_coarser()) return parts;
  constexpr double cell_mm = 2.5, rounding_mm = 4;
  const SurfaceMesh whole = zero_surface(distance_field(parts, cell_mm, rounding_mm + cell_mm, rounding_mm));
  double share = 0.85 * static_cast<double>(parts.triangle.size()) / static_cast<double>(whole.triangle.size());
  for (;; share *= 1.25) {  // thin plates can lose their inside
    SurfaceMesh bone = coarser(whole, share);
    drop_fins(bone.triangle);
    drop_unused(bone);
    if (share >= 1 || is_closed(bone)) return bone;
  }
}

}  // namespace mobil::inline v0_3::bones
