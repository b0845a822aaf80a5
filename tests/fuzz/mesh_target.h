#pragma once
// A mesh file in OBJ, STL or PLY. The first byte selects the format; the rest are its bytes.

#include <array>
#include <cmath>

#include <mobil/mesh_file.h>
#include "assets/import/simplify_surface.h"
#include "assets/surfaces/surface_mesh.h"
#include "tests/fuzz/fuzz_input.h"

namespace mobil::fuzz {

inline void check_mesh(const Result<MeshFile>& file) {
  if (!held(file)) return;
  const auto sound = [](const SurfaceMesh& mesh) {
    promise(mesh.triangle.size() % 3 == 0, "triangles are whole");
    for (const auto i : mesh.triangle) promise(i < mesh.position.size(), "indices are in range");
    for (const auto& p : mesh.position) {
      promise(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "places are finite");
    }
  };
  sound(file->mesh);
  promise(!file->mesh.triangle.empty(), "a mesh that is taken has a triangle");
  (void)count_edges(file->mesh);
  (void)enclosed_volume(file->mesh);
  SurfaceMesh mesh = file->mesh;
  remove_specks(mesh, 0.01);
  sound(mesh);
  sound(clustered(mesh, 0.003));
}

inline void fuzz_mesh(Input input) {
  if (input.empty()) return;
  constexpr std::array<std::string_view, 3> names = {"a.obj", "a.stl", "a.ply"};
  check_mesh(read_mesh_bytes(text_of(input.subspan(1)), std::string(names[input[0] % names.size()])));
}

}  // namespace mobil::fuzz
