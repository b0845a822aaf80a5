#include "assets/surfaces/bone_surfaces_skull.h"

#include <utility>

#include <mobil/engine/geometry.h>
#include "assets/surfaces/bone_shapes.h"
#include "assets/surfaces/surface_mesh.h"

namespace mobil::inline v0_3::bones {
using namespace geometry;

SurfaceMesh skull() {
  SurfaceMesh mesh, side;
  const auto tube = [&](SurfaceMesh& into, std::initializer_list<Station> line, const TubeShape& shape) {
    add_tube(into, line, shape);
  };
  add_ellipsoid(mesh, {0, 60, 0}, {70, 61, 89}, 16, 24);
  tube(mesh,
       {{0, -8, -22, 30, 30}, {0, 2, -22, 49, 50}, {0, 14, -17, 61, 58}, {0, 27, -10, 70, 62}, {0, 46, -3, 74, 62}},
       {.reference = forward, .normal = up, .rings = 8, .segments = 22, .cap = 0.3});  // base
  // brow, orbits, cheek bone and arch, bridge of the nose, upper jaw
  tube(mesh,
       {{-52, 32, 58, 6, 7},
        {-38, 41, 76, 6, 8},
        {-16, 40, 84, 6, 8},
        {0, 38, 86, 8, 8},
        {16, 40, 84, 6, 8},
        {38, 41, 76, 6, 8},
        {52, 32, 58, 6, 7}},
       {.reference = up, .rings = 15, .segments = 8});
  tube(side, {{-52, 34, 58, 6, 7}, {-51, 20, 61, 6, 7}, {-45, 6, 67, 8, 9}, {-33, 0, 76, 8, 9}, {-19, 3, 81, 7, 6}},
       {.reference = forward, .rings = 9, .segments = 8});
  tube(side, {{-44, 4, 66, 9, 6}, {-57, 6, 46, 6, 3.5}, {-63, 10, 22, 5, 3.5}, {-59, 13, 2, 6, 4}},
       {.reference = up, .rings = 8, .segments = 7});
  tube(side, {{-8, 38, 82, 7, 6}, {-10, 22, 82, 6, 6}, {-16, 4, 83, 7, 7}, {-17, -12, 80, 9, 7}, {-16, -24, 76, 9, 7}},
       {.reference = forward, .rings = 9, .segments = 8});
  add_ellipsoid(side, {-28, -8, 66}, {14, 16, 15});
  add_ellipsoid(side, {-42, 20, 46}, {15, 22, 14});  // behind the orbit
  add_ellipsoid(side, {-51, -4, -12}, {9, 20, 12});  // mastoid process
  tube(mesh, {{0, 40, 84, 6, 6}, {0, 28, 92, 5, 5.5}, {0, 16, 100, 5, 4}},
       {.reference = forward, .rings = 5, .segments = 8});
  tube(mesh, {{0, 6, 54, 22, 26}, {0, -10, 60, 24, 25}, {0, -24, 63, 25, 25}, {0, -34, 63, 25, 25}},
       {.reference = forward, .normal = up, .rings = 7, .segments = 18, .cap = 0.2});
  add_pair(mesh, std::exchange(side, {}));
  mesh = united(mesh);
  // teeth: two arches that meet
  tube(mesh, {{0, -34, 63.5, 25, 24.5}, {0, -43, 63.5, 24.5, 24}},
       {.reference = forward, .normal = up, .rings = 2, .segments = 20, .cap = 0.1});
  tube(mesh, {{0, -44, 62, 24, 23}, {0, -54, 62, 23.5, 24}},
       {.reference = forward, .normal = up, .rings = 2, .segments = 20, .cap = 0.1});
  SurfaceMesh jaw;  // two branches and the arch between them
  tube(side, {{-52, 8, 8, 6, 5}, {-51.5, -10, 9, 12, 4}, {-50, -32, 12, 17, 4.5}, {-46, -52, 16, 17, 6}},
       {.reference = forward, .normal = up, .rings = 8, .segments = 11});
  tube(side, {{-50, 2, 30, 5, 3.5}, {-50, -16, 26, 8, 4}, {-48, -34, 22, 11, 4.5}},
       {.reference = forward, .rings = 5, .segments = 8});
  add_pair(jaw, side);
  tube(jaw,
       {{-46, -50, 12, 12, 5},
        {-43, -55, 32, 12, 6},
        {-35, -60, 54, 12, 6},
        {-22, -64, 73, 12, 6.5},
        {0, -67, 83, 14, 7},
        {22, -64, 73, 12, 6.5},
        {35, -60, 54, 12, 6},
        {43, -55, 32, 12, 6},
        {46, -50, 12, 12, 5}},
       {.reference = up, .rings = 19, .segments = 9});
  append(mesh, united(jaw));
  return mesh;
}

}  // namespace mobil::inline v0_3::bones
