#pragma once
// Single muscles kept out of each other and of bones, on what is drawn: for close views.
//
//   const SurfaceContacts contacts = find_contacts(*bound, rest, rest_normal);   // once a body, standing
//   writer.write(...);                                                           // positions and normals, own memory
//   keep_apart(contacts, position, normal, work);                                // each frame
//
// Bellies are deformed along their own lines, and bodies at rest already lie in each other a little. What lies deeper
// in a neighbour than at rest is moved out, both muscles by half, from bones alone; the volume that this takes is given
// back round the same part of the belly, and what that has no room for elsewhere, where muscles' surfaces are closed,
// as all here are. Dynamics do not hear of it.

#include <cstdint>
#include <span>
#include <vector>

#include <mobil/components/lanes.h>
#include <mobil/systems/surfaces/body_surfaces.h>

namespace mobil::inline v0_3 {

/// A muscle's vertex, the vertex of another muscle or bone that is nearest to it at rest, and how far it is out of that
/// there along its normal, m, where it is less than 0.
struct ContactPair {
  std::uint32_t vertex, other;
  float rest_m;
};

/// Who may touch whom in a body's surfaces, and how vertices hang together.
struct SurfaceContacts {
  std::vector<ContactPair> pair;                          // by vertex
  std::vector<std::uint32_t> first_neighbour, neighbour;  // of each vertex; first_neighbour has one more at its end
  std::vector<float> edge_m;                              // of each vertex, at rest: its longest edge
  std::vector<std::uint32_t> triangle;                    // of muscles
  std::vector<std::uint16_t> band;  // of each vertex of a muscle: a part of its length; else no_band
  std::vector<float> within;        // and where in it: 0 to 1
  std::uint16_t bands = 0;

  static constexpr std::uint16_t no_band = 0xFFFF;
};

/// Pairs that are within 15 mm of each other at rest. Parts of one driver do not touch. `position`, `normal`: of all
/// vertices of the surfaces, the person standing with muscles at rest, as SurfaceWriter writes them.
SurfaceContacts find_contacts(const BodySurfaces& surfaces, std::span<const Vec3<float>> position,
                              std::span<const Vec3<float>> normal);

/// Memory that it works in.
struct ContactWork {
  std::vector<Vec3<float>> push, smooth, shift;
  std::vector<float> area, taken, free_area, pushed_area;
  std::vector<float> weight, wide, out, moved_out;  // of what gives volume back
  std::vector<double> volume, now_volume;           // of each muscle
  std::vector<std::uint8_t> touches;
  std::vector<std::uint32_t> other;  // by pair: the other surface's vertex that was nearest in the last pass
};
/// Moves muscles' vertices, and makes their normals anew. `position`, `normal`: as SurfaceWriter wrote them, of the
/// same surfaces, in any frame. Some 0.7 µs a pair.
void keep_apart(const SurfaceContacts& contacts, std::span<Vec3<float>> position, std::span<Vec3<float>> normal,
                ContactWork& work);

}  // namespace mobil::inline v0_3
