#pragma once
// Head, arms and trunk with the pelvis as one piece: how its centre of mass and its angular momentum follow the lean of
// the chest and the attitude of the pelvis, for small angles. A body of height 1 m and mass 1 kg.

#include <cstddef>

#include "assets/body/anthropometry.h"
#include "assets/body/segment_inertia.h"

namespace mobil {

/// The pelvis' anterior tilt of somebody who stands upright, as gait laboratories measure it (front and back of the
/// iliac crest): that of the anatomical position, from which the column is turned.
inline constexpr double neutral_tilt_deg = 11.5;

/// How much of the way from the pelvis' attitude to the chest's a vertebra has turned: two thirds in the five lumbar
/// ones, the rest evenly up to the first thoracic.
constexpr double column_part(Segment vertebra) {
  const auto above = static_cast<double>(index(vertebra) - index(Segment::L5)) + 1;
  constexpr double lumbar = 5, all = 17, lumbar_part = 2.0 / 3;
  return above <= lumbar ? lumbar_part * above / lumbar
                         : lumbar_part + (1 - lumbar_part) * (above - lumbar) / (all - lumbar);
}

struct UpperBody {
  double mass;
  double up, forward;                    // of the centre of mass from the middle of the hips, upright
  double by_chest, by_pelvis;            // how far the centre goes per rad of either
  double spin_by_chest, spin_by_pelvis;  // angular momentum about the centre per rad/s of either
};

/// Kinematics turns vertebra by vertebra from the pelvis' attitude to the chest's, and from the shoulders up to a head
/// that stays upright; arms hang on the chest.
constexpr UpperBody make_upper_body() {
  using enum Segment;
  const UnitBody& u = unit_body;
  const UnitInertia inertia = make_unit_inertia();
  double y[segment_count]{}, z[segment_count]{}, chest[segment_count]{}, pelvis_part[segment_count]{};
  double dz_chest[segment_count]{}, dz_pelvis[segment_count]{};  // of each joint, forward per rad of pitch
  pelvis_part[0] = 1;
  const std::size_t first = index(L5), shoulders = index(T1), top = index(head);
  UpperBody b{};
  double ny = 0, nz = 0, nc = 0, np = 0;
  double cy[segment_count]{}, cc[segment_count]{}, cp[segment_count]{};
  const auto counted = [&](std::size_t s) { return s <= top || s >= index(clavicle_right); };
  for (std::size_t s = 0; s < segment_count; ++s) {
    if (!counted(s)) continue;
    if (s >= first && s <= shoulders) {
      chest[s] = column_part(static_cast<Segment>(s));
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
    const double m = u.mass_fraction[s];
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
    const double m = u.mass_fraction[s];
    b.spin_by_chest += m * (cy[s] - b.up) * (cc[s] - b.by_chest) + inertia[s].x * chest[s];
    b.spin_by_pelvis += m * (cy[s] - b.up) * (cp[s] - b.by_pelvis) + inertia[s].x * pelvis_part[s];
  }
  return b;
}

inline constexpr UpperBody upper_body = make_upper_body();

}  // namespace mobil
