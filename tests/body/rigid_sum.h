#pragma once
// Combines segments into one rigid body, as in the sources of their inertias.

#include <span>

#include <mobil/components/body.h>
#include <mobil/engine/geometry.h>
#include "assets/body/segment_inertia.h"

namespace mobil {

/// Several segments of a standing body in the anatomical position at x = z = 0, as one rigid body. `inertia_kg_m2`: xx,
/// yy, zz about the body's own centre, world axes.
struct RigidSum {
  double mass_kg = 0;
  Vec3<double> centre_m{}, inertia_kg_m2{};
};
inline RigidSum rigid_sum(const Body& body, std::span<const Segment> segments) {
  using namespace geometry;
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
