#include "assets/body/segment_inertia.h"

#include <mobil/engine/geometry.h>
#include "assets/body/body_scales.h"

namespace mobil::inline v0_3 {

using namespace geometry;

Vec3<double> segment_inertia_kg_m2(const Body& body, Segment segment) {
  const std::size_t s = index(segment);
  const auto thick = static_cast<double>(group_scales(body.size)[static_cast<std::size_t>(segment_groups[s].z)]);
  return (static_cast<double>(body.mass_kg[s]) * thick * thick) * unit_inertia[s];
}

Vec3<double> joint_centre_m(const Body& body, Segment segment) {
  Vec3<double> at = to_double(body.joint_offset_m[index(segment)]);
  for (Segment s = segment; s != Segment::pelvis;) {
    s = segment_parent[index(s)];
    at = at + to_double(body.joint_offset_m[index(s)]);
  }
  return at;
}

}  // namespace mobil::inline v0_3
