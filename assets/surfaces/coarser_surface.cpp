#include "assets/surfaces/coarser_surface.h"

#if !defined(MOBIL_ONE_DETAIL)
#include <meshoptimizer.h>
#endif

#include <cmath>
#include <cstddef>

#include "assets/surfaces/surface_mesh.h"

namespace mobil::inline v0_3 {

#if defined(MOBIL_ONE_DETAIL)

bool can_be_coarser() {
  return false;
}

SurfaceMesh coarser(const SurfaceMesh& mesh, double) {
  return mesh;
}

#else

bool can_be_coarser() {
  return true;
}

SurfaceMesh coarser(const SurfaceMesh& mesh, double share) {
  if (share >= 1 || mesh.triangle.empty()) return mesh;
  constexpr std::size_t stride = sizeof(Vec3<float>);
  const float* places = &mesh.position[0].x;
  const std::size_t triangles = mesh.triangle.size() / 3;
  const auto wanted = 3 * static_cast<std::size_t>(std::ceil(share * static_cast<double>(triangles)));
  SurfaceMesh light;
  light.name = mesh.name;
  light.triangle.resize(mesh.triangle.size());
  constexpr float any_error = 1;  // of the mesh' extent
  light.triangle.resize(meshopt_simplify(light.triangle.data(), mesh.triangle.data(), mesh.triangle.size(), places,
                                         mesh.position.size(), stride, wanted, any_error, 0, nullptr));
  light.position = mesh.position;
  drop_unused(light);
  return light;
}

#endif

}  // namespace mobil::inline v0_3
