#pragma once
// The body of height 1 m in the form that kernels read.

#include <cstddef>

#include <mobil/anthropometry.h>
#include <mobil/components/segments.h>

namespace mobil::inline v0_3 {

/// The body of height 1 m in single precision.
struct UnitSkeleton {
  Vec3<float> joint_offset[segment_count], centre_of_mass[segment_count];
  float mass_share[segment_count];
};

constexpr UnitSkeleton make_unit_skeleton() {
  UnitSkeleton s{};
  auto single = [](const Vec3<double>& v) {
    return Vec3<float>{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
  };
  for (std::size_t i = 0; i < segment_count; ++i) {
    s.joint_offset[i] = single(unit_body.joint_offset[i]);
    s.centre_of_mass[i] = single(unit_body.centre_of_mass[i]);
    s.mass_share[i] = static_cast<float>(unit_body.mass_share[i]);
  }
  return s;
}

inline constexpr UnitSkeleton unit_skeleton = make_unit_skeleton();

}  // namespace mobil::inline v0_3
