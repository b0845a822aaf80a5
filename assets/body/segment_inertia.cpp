#include "assets/body/segment_inertia.h"

#include "engine/geometry.h"

namespace mobil {

using namespace geometry;

Vec3<double> segment_inertia_kg_m2(const Body& body, Segment segment) {
  const auto height = static_cast<double>(body.request.height_m), mass = static_cast<double>(body.request.mass_kg);
  return (mass * height * height) * unit_inertia[index(segment)];
}

Vec3<double> joint_centre_m(const Body& body, Segment segment) {
  Vec3<double> at = to_double(body.joint_offset_m[index(segment)]);
  for (Segment s = segment; s != Segment::pelvis;) {
    s = segment_parent[index(s)];
    at = at + to_double(body.joint_offset_m[index(s)]);
  }
  return at;
}

RigidSum rigid_sum(const Body& body, std::span<const Segment> segments) {
  RigidSum sum;
  const auto centre = [&](Segment s) { return joint_centre_m(body, s) + to_double(body.centre_of_mass_m[index(s)]); };
  for (const Segment s : segments) {
    const auto mass = static_cast<double>(body.mass_kg[index(s)]);
    sum.mass_kg += mass;
    sum.centre_m = sum.centre_m + mass * centre(s);
  }
  sum.centre_m = (1 / sum.mass_kg) * sum.centre_m;
  for (const Segment s : segments) {
    const auto mass = static_cast<double>(body.mass_kg[index(s)]);
    const Vec3<double> d = centre(s) - sum.centre_m;
    sum.inertia_kg_m2 = sum.inertia_kg_m2 + segment_inertia_kg_m2(body, s) +
                        mass * Vec3<double>{d.y * d.y + d.z * d.z, d.x * d.x + d.z * d.z, d.x * d.x + d.y * d.y};
  }
  return sum;
}

}  // namespace mobil
