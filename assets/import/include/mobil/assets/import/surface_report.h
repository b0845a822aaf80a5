#pragma once
// Report about one surface of an anatomy.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace mobil::inline v0_3 {

/// Tissue of a mesh.
enum class AnatomyKind : std::uint8_t { bone, muscle, tendon, skin };

/// True if the surface must be that of a body: closed, with a volume.
constexpr bool is_fleshy(AnatomyKind kind) {
  return kind == AnatomyKind::muscle || kind == AnatomyKind::tendon;
}

/// Data of a mesh in its file and after repair, with one line for each repair.
struct SurfaceReport {
  std::size_t triangles = 0, open_edges = 0, overused_edges = 0;  // in the file
  std::size_t pieces = 0;                                         // connected, of the mesh that remains
  std::size_t self_intersections = 0;  // pairs of triangles without a common vertex that cut each other
  double volume_cm3 = 0, area_cm2 = 0;
  std::vector<std::string> said;
};

}  // namespace mobil::inline v0_3
