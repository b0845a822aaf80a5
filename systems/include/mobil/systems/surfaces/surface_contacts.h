#pragma once
// Resolves contacts of single muscles with each other and with bones, on displayed surfaces, for close views.
//
//   const SurfaceContacts contacts = find_contacts(*bound, rest, rest_normal);   // once for each body, standing
//   writer.write(...);                                                           // positions and normals, own memory
//   keep_apart(contacts, position, normal, work);                                // each frame
//
// Bellies deform along their own lines, and at rest surfaces already overlap slightly. Vertices that are deeper in a
// neighbour than at rest are moved out: by half for each of two muscles, and fully for a muscle in a bone. The
// displaced volume is restored around the same part of the belly, or elsewhere if it does not fit there. This requires
// closed surfaces, which all of the library's are. The dynamics are not affected.

#include <cstdint>
#include <span>
#include <vector>

#include <mobil/components/lanes.h>
#include <mobil/systems/surfaces/body_surfaces.h>

namespace mobil::inline v0_3 {

/// A muscle's vertex, the nearest vertex of another muscle or bone at rest, and the distance from it along its normal
/// at rest, m, if negative.
struct ContactPair {
  std::uint32_t vertex, other;
  float rest_m;
};

/// Possible contacts of a body's surfaces, and the connectivity of vertices.
struct SurfaceContacts {
  std::vector<ContactPair> pair;                          // by vertex
  std::vector<std::uint32_t> first_neighbour, neighbour;  // of each vertex; first_neighbour ends with the total
  std::vector<float> edge_m;                              // longest edge of each vertex at rest
  std::vector<std::uint32_t> triangle;                    // of muscles
  std::vector<std::uint16_t> band;  // section of a muscle's length for each vertex; no_band for bones
  std::vector<float> within;        // position within the section, 0 to 1
  std::uint16_t bands = 0;

  static constexpr std::uint16_t no_band = 0xFFFF;
};

/// Finds pairs within 15 mm of each other at rest. Parts of one driver have no contacts. `position` and `normal` are
/// those of all vertices, as SurfaceWriter writes them for a standing person with muscles at rest.
SurfaceContacts find_contacts(const BodySurfaces& surfaces, std::span<const Vec3<float>> position,
                              std::span<const Vec3<float>> normal);

/// Scratch memory of `keep_apart`.
struct ContactWork {
  std::vector<Vec3<float>> push, smooth, shift;
  std::vector<float> area, taken, free_area, pushed_area;
  std::vector<float> weight, wide, out, moved_out;  // for restoring volume
  std::vector<double> volume, now_volume;           // of each muscle
  std::vector<std::uint8_t> touches;
  std::vector<std::uint32_t> other;  // by pair: nearest vertex of the other surface in the last pass
};
/// Moves muscles' vertices out of contact and recomputes their normals. `position` and `normal` are those that
/// SurfaceWriter wrote for the same surfaces, in any frame. Takes about 0.7 µs a pair.
void keep_apart(const SurfaceContacts& contacts, std::span<Vec3<float>> position, std::span<Vec3<float>> normal,
                ContactWork& work);

}  // namespace mobil::inline v0_3
