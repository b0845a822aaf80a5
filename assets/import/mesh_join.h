#pragma once
// Shared by the readers of mesh formats: indexed triangles from those of a file.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <mobil/components/lanes.h>
#include <mobil/engine/error.h>
#include <mobil/mesh_file.h>

namespace mobil::inline v0_3 {

/// Vertices and triangles of a file: three indices each, all below the count of positions, which are finite.
struct RawMesh {
  std::vector<Vec3<float>> position;
  std::vector<std::uint32_t> triangle;
};

/// Returns the mesh; see MeshFile. Vertices are in the order in which triangles first use them; unused ones are left
/// out. Fails if no triangle has three different corners.
Result<MeshFile> join_mesh(const RawMesh& raw, std::string_view path);

/// Returns "PATH line N: what", for faults of a text.
tl::unexpected<Error> fault_in_line(std::string_view path, std::size_t line, std::string_view what);

/// Returns the failure of more triangles than max_mesh_triangles.
tl::unexpected<Error> too_many_triangles(std::string_view path);

}  // namespace mobil::inline v0_3
