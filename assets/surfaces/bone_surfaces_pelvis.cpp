#include "assets/surfaces/bone_surfaces_pelvis.h"

#include <cmath>
#include <numbers>

#include <mobil/engine/geometry.h>
#include "assets/surfaces/bone_shapes.h"
#include "assets/surfaces/surface_mesh.h"

namespace mobil::inline v0_3::bones {
using namespace geometry;

SurfaceMesh pelvis() {
  SurfaceMesh mesh, hip;
  const auto tube = [&](SurfaceMesh& into, std::initializer_list<Station> line, const TubeShape& shape) {
    add_tube(into, line, shape);
  };
  // wing of the ilium: flat sections from the socket's roof up to the crest
  tube(hip,
       {{-64, -6, -4, 30, 20, -25},
        {-70, 18, -5, 34, 18, -33},
        {-75, 34, 0, 38, 13, -32},
        {-76, 50, -8, 50, 8, -33, -2},
        {-80, 65, -6, 64, 5.5, -31, -4},
        {-79, 80, -9, 75, 4.5, -30, -6},
        {-81, 95, -10, 77, 4.5, -29, -6},
        {-86, 110, -15, 70, 4.5, -33, -4},
        {-94, 125, -17, 54, 5, -36},
        {-95, 137, -19, 34, 5, -40}},
       {.reference = forward, .normal = up, .rings = 16, .segments = 20, .cap = 0.8});
  tube(hip,
       {{-115, 62, 54, 6, 6},
        {-117, 84, 60, 8, 7},
        {-125, 104, 44, 6.5, 6},
        {-127, 122, 20, 7, 6},
        {-115, 136, -6, 6.5, 6},
        {-94, 139, -30, 6.5, 6},
        {-68, 126, -55, 7, 7},
        {-47, 104, -75, 8, 7},
        {-41, 86, -78, 7, 7},
        {-46, 66, -62, 6, 6}},
       {.reference = {0.5, 0.2, 0.8}, .rings = 24, .segments = 8});  // iliac crest
  tube(hip, {{-113, 64, 52, 6, 6}, {-108, 46, 42, 7, 7}, {-100, 32, 34, 9, 8}, {-92, 20, 26, 10, 10}},
       {.reference = across, .rings = 5, .segments = 7});  // front border to the lower spine
  tube(hip, {{-46, 66, -64, 6, 6}, {-52, 46, -46, 8, 6}, {-58, 26, -36, 10, 9}, {-62, 6, -34, 11, 10}},
       {.reference = across, .rings = 5, .segments = 7});  // greater sciatic notch
  // the socket's rim, open below
  std::vector<TubeStation> rim;
  const Vec centre{-84, -1, 2}, axis = normalised(Vec{-0.80, -0.36, 0.48});
  const Vec ring_u = orthogonal({0, -1, 0}, axis), ring_v = cross(axis, ring_u);
  for (int i = 0; i <= 12; ++i) {
    const double angle = 0.45 + 2 * (std::numbers::pi - 0.45) * i / 12;
    rim.push_back({centre + 27.0 * (std::cos(angle) * ring_u + std::sin(angle) * ring_v), 8, 6, 0, 0});
  }
  append(hip, loft(rim, {.reference = axis, .rings = 18, .segments = 7}));
  // ischium, its tuberosity and both pubic rami
  tube(hip,
       {{-66, 0, -26, 15, 14},
        {-67, -18, -36, 14, 13},
        {-64, -38, -43, 14, 13},
        {-56, -52, -42, 12, 12},
        {-42, -57, -28, 8, 9},
        {-30, -53, -10, 7, 6},
        {-20, -44, 10, 8, 6},
        {-11, -34, 30, 10, 6}},
       {.reference = across, .rings = 17, .segments = 9});
  tube(hip, {{-66, 4, 18, 13, 12}, {-52, 6, 28, 9, 9}, {-36, 3, 40, 8, 8}, {-20, -4, 48, 9, 8}, {-8, -12, 49, 11, 8}},
       {.reference = up, .rings = 8, .segments = 9});
  tube(hip, {{-8, -10, 49, 6, 8}, {-8, -22, 44, 6, 8}, {-9, -34, 34, 6, 7}},
       {.reference = across, .rings = 4, .segments = 8});
  // sacrum and coccyx, with wings above and a crest behind
  tube(mesh,
       {{0, 103, -32, 14, 44},
        {0, 90, -36, 19, 57},
        {0, 74, -45, 20, 58},
        {0, 56, -57, 18, 50},
        {0, 42, -68, 15, 43},
        {0, 28, -73, 13, 35},
        {0, 12, -73, 11, 26},
        {0, -2, -72, 7, 15},
        {0, -16, -69, 5, 11},
        {0, -32, -64, 4, 5}},
       {.reference = forward, .normal = up, .rings = 20, .segments = 18, .cap = 0.4});
  add_ellipsoid(mesh, {0, 92, -24}, {27, 9, 17});
  for (int i = 0; i < 4; ++i) add_ellipsoid(mesh, {0, 84.0 - 17 * i, -62.0 - 8.5 * i}, {4, 8, 7}, 4, 8);
  mesh = united(mesh);
  add_pair(mesh, united(hip));
  add_ellipsoid(mesh, {0, -21, 44}, {4, 16, 7});  // symphysis
  return mesh;
}

}  // namespace mobil::inline v0_3::bones
