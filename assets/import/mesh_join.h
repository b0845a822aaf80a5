#pragma once
// Shared by the readers of mesh formats: indexed triangles from those of a file.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <mobil/components/lanes.h>
#include <mobil/engine/error.h>
#include <mobil/mesh_file.h>

namespace mobil::inline v0_3 {

/// A face of more than three corners: the triangles that it occupies, and its place in the file.
struct RawPolygon {
  std::size_t triangle = 0, triangles = 0, place = 0;
};

/// Vertices and triangles of a file: three indices each, all below the count of positions, which are finite.
struct RawMesh {
  std::vector<Vec3<float>> position;
  std::vector<std::uint32_t> triangle;
  std::vector<RawPolygon> polygon;
};

/// Adds a face of three or more corners, which join_mesh cuts once all vertices are known. `place` is its line or
/// number.
void add_face(RawMesh& raw, std::span<const std::uint32_t> corner, std::size_t place);

/// Adds a strip of triangles, every second of which is turned.
void add_strip(RawMesh& raw, std::span<const std::uint32_t> corner);

/// Returns whether so many more triangles are within max_mesh_triangles.
bool has_room(const RawMesh& raw, std::size_t triangles);

/// Returns the mesh; see MeshFile. Vertices are in the order in which triangles first use them; unused ones are left
/// out. `faces` begins the place of a face in messages, such as "line". Fails if no triangle has three different
/// corners, or if faces have so many corners that cutting them takes long.
Result<MeshFile> join_mesh(RawMesh raw, std::string_view path, std::string_view faces = "face");

/// Returns "PATH line N: what", for faults of a text.
tl::unexpected<Error> fault_in_line(std::string_view path, std::size_t line, std::string_view what);

/// Returns the failure of more triangles than max_mesh_triangles.
tl::unexpected<Error> too_many_triangles(std::string_view path);

}  // namespace mobil::inline v0_3
