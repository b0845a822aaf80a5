#pragma once
// Head and trunk with the pelvis as one piece: change of their centre of mass and angular momentum with the lean of the
// chest and the attitude of the pelvis, for small angles; and the arms. The body has 1 kg.

#include <cstddef>

#include <mobil/anthropometry.h>
#include <mobil/engine/geometry.h>
#include "assets/body/body_scales.h"
#include "assets/body/column.h"
#include "assets/body/segment_inertia.h"
#include "assets/body/segment_masses.h"

namespace mobil {

/// Lengths in m, masses as parts of the body's, and moments of inertia of the segments of a body of 1 kg.
struct BodyParts {
  std::array<Vec3<double>, segment_count> joint_offset, centre_of_mass, inertia;
  std::array<double, segment_count> mass;
};

/// Returns the parts of a body, with all its lengths times `by`.
inline BodyParts body_parts(const BodySize<float>& size, double by) {
  using namespace geometry;
  const auto scales = group_scales(size);
  BodyParts parts;
  for (std::size_t s = 0; s < segment_count; ++s) {
    parts.joint_offset[s] = by * scaled(unit_body.joint_offset[s], scales, joint_groups[s]);
    parts.centre_of_mass[s] = by * scaled(unit_body.centre_of_mass[s], scales, segment_groups[s]);
    parts.mass[s] = mass_fraction(size, s);
    const double thick = by * static_cast<double>(scales[static_cast<std::size_t>(segment_groups[s].z)]);
    parts.inertia[s] = (parts.mass[s] * thick * thick) * unit_inertia[s];
  }
  return parts;
}

struct UpperBody {
  double mass;
  double up, forward;                    // of the centre of mass from the middle of the hips, upright
  double by_chest, by_pelvis;            // shift of the centre per rad of either
  double spin_by_chest, spin_by_pelvis;  // angular momentum about the centre per rad/s of either
  double spin_by_list;                   // of the pelvis, about the axis along
  struct {
    double up, forward, aside, by_chest, by_pelvis;
  } shoulder;
};

/// Upper arm, and forearm with the hand as one piece: masses, centres below the joint above, moments of inertia about
/// them.
struct ArmBody {
  double upper, upper_centre, upper_spin, length, lower, lower_centre, lower_spin;
};

inline ArmBody make_arm(const BodyParts& u) {
  using enum Segment;
  ArmBody a{u.mass[index(upper_arm_right)],
            -u.centre_of_mass[index(upper_arm_right)].y,
            u.inertia[index(upper_arm_right)].x,
            -u.joint_offset[index(forearm_right)].y,
            0,
            0,
            0};
  double below[segment_count]{};
  for (const Segment s : {forearm_right, hand_right, fingers_right, thumb_right}) {
    if (s != forearm_right) below[index(s)] = below[index(segment_parent[index(s)])] - u.joint_offset[index(s)].y;
    a.lower += u.mass[index(s)];
    a.lower_centre += u.mass[index(s)] * (below[index(s)] - u.centre_of_mass[index(s)].y);
  }
  a.lower_centre /= a.lower;
  for (const Segment s : {forearm_right, hand_right, fingers_right, thumb_right}) {
    const double off = below[index(s)] - u.centre_of_mass[index(s)].y - a.lower_centre;
    a.lower_spin += u.mass[index(s)] * off * off + u.inertia[index(s)].x;
  }
  return a;
}

/// Returns the upper body. Kinematics turns vertebra by vertebra from the pelvis' attitude to the chest's, and from the
/// shoulders up to a head that stays upright.
inline UpperBody make_upper_body(const BodyParts& u) {
  using enum Segment;
  double y[segment_count]{}, z[segment_count]{}, chest[segment_count]{}, pelvis_part[segment_count]{};
  double dz_chest[segment_count]{}, dz_pelvis[segment_count]{};  // of each joint, forward per rad of pitch
  pelvis_part[0] = 1;
  const std::size_t first = index(L5), shoulders = index(T1), top = index(head);
  UpperBody b{};
  double ny = 0, nz = 0, nc = 0, np = 0;
  double cy[segment_count]{}, cc[segment_count]{}, cp[segment_count]{};
  const auto counted = [&](std::size_t s) {
    return s <= top || s == index(clavicle_right) || s == index(clavicle_left);
  };
  for (std::size_t s = 0; s < segment_count; ++s) {
    if (!counted(s)) continue;
    if (s >= first && s <= shoulders) {
      chest[s] = column_parts()[s - first];
      pelvis_part[s] = 1 - chest[s];
    } else if (s > shoulders && s <= top) {
      chest[s] = 1 - static_cast<double>(s - shoulders) / static_cast<double>(top - shoulders);
    } else if (s > top) {
      chest[s] = 1;
    }
    if (s > 0) {
      const std::size_t p = index(segment_parent[s]);
      const Vec3<double>& o = u.joint_offset[s];
      y[s] = y[p] + o.y;
      z[s] = z[p] + o.z;
      dz_chest[s] = dz_chest[p] + chest[p] * o.y;
      dz_pelvis[s] = dz_pelvis[p] + pelvis_part[p] * o.y;
    }
    const double m = u.mass[s];
    cy[s] = y[s] + u.centre_of_mass[s].y;
    cc[s] = dz_chest[s] + chest[s] * u.centre_of_mass[s].y;
    cp[s] = dz_pelvis[s] + pelvis_part[s] * u.centre_of_mass[s].y;
    b.mass += m;
    ny += m * cy[s];
    nz += m * (z[s] + u.centre_of_mass[s].z);
    nc += m * cc[s];
    np += m * cp[s];
  }
  b.up = ny / b.mass;
  b.forward = nz / b.mass;
  b.by_chest = nc / b.mass;
  b.by_pelvis = np / b.mass;
  for (std::size_t s = 0; s < segment_count; ++s) {
    if (!counted(s)) continue;
    const double m = u.mass[s];
    b.spin_by_chest += m * (cy[s] - b.up) * (cc[s] - b.by_chest) + u.inertia[s].x * chest[s];
    b.spin_by_pelvis += m * (cy[s] - b.up) * (cp[s] - b.by_pelvis) + u.inertia[s].x * pelvis_part[s];
    b.spin_by_list += m * (cy[s] - b.up) * (cp[s] - b.by_pelvis) + u.inertia[s].z * pelvis_part[s];
  }
  const std::size_t collar = index(clavicle_left);
  const Vec3<double>& o = u.joint_offset[index(upper_arm_left)];
  b.shoulder = {y[collar] + o.y, z[collar] + o.z, u.joint_offset[collar].x + o.x, dz_chest[collar] + o.y,
                dz_pelvis[collar]};
  return b;
}

}  // namespace mobil
