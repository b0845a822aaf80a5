#include "assets/surfaces/bone_surfaces_arm.h"

#include <array>
#include <utility>

#include <mobil/engine/geometry.h>
#include "assets/surfaces/bone_shapes.h"
#include "assets/surfaces/surface_mesh.h"

namespace mobil::inline v0_3::bones {
namespace {

using namespace geometry;

/// A small tubular bone with a waist.
void add_bone_of_hand(SurfaceMesh& mesh, const Vec& near, const Vec& far, double r_near, double r_middle,
                      double r_far) {
  const Vec quarter = 0.7 * near + 0.3 * far, three = 0.3 * near + 0.7 * far;
  const std::array<TubeStation, 4> line = {TubeStation{near, r_near, r_near},
                                           {quarter, r_middle, r_middle},
                                           {three, r_middle, r_middle},
                                           {far, r_far, r_far}};
  append(mesh, loft(line, {.reference = forward, .rings = 5, .segments = 7, .cap = 0.7}));
}

}  // namespace

SurfaceMesh clavicle_and_scapula(const Proportions& p) {
  const Vec s = p.tip[index(Segment::clavicle_right)];  // the shoulder's centre
  SurfaceMesh mesh;
  const auto tube = [&](std::initializer_list<Station> line, const TubeShape& shape) { add_tube(mesh, line, shape); };
  tube({{2, 0, 0, 11, 9},
        {0.10 * s.x, 3, 4, 8, 7},
        {0.33 * s.x, 8, 6, 6.5, 6},
        {0.62 * s.x, 14, 0.25 * s.z, 6, 6.5},
        {0.85 * s.x, s.y + 17, 0.72 * s.z, 5.5, 8},
        {0.98 * s.x, s.y + 24, 0.88 * s.z, 5, 9}},
       {.reference = up, .rings = 10, .segments = 6});
  const SurfaceMesh clavicle = std::exchange(mesh, {});
  // Blade, drawn from the shoulder's centre: sections from the lower angle up, turned with the back of the ribs.
  const auto at = [&](double x, double y, double z, double a, double b, double angle) {
    return Station{s.x + x, s.y + y, s.z + z, a, b, angle};
  };
  tube({at(78, -128, -92, 7, 3.5, -48), at(74, -100, -90, 15, 3, -48), at(66, -65, -83, 28, 2.6, -47),
        at(56, -28, -69, 43, 2.6, -46), at(50, 0, -52, 55, 2.8, -46), at(54, 20, -55, 44, 2.6, -44),
        at(66, 38, -62, 22, 2.6, -44), at(76, 46, -66, 8, 2.6, -44)},
       {.reference = forward, .normal = up, .rings = 14, .segments = 14, .cap = 0.6});
  tube({at(80, -132, -96, 4.5, 5, 0), at(88, -95, -102, 3.5, 4, 0), at(94, -40, -104, 3.2, 4, 0),
        at(92, 10, -95, 3.2, 4, 0), at(82, 46, -74, 3.5, 3.5, 0)},
       {.reference = {1, 0, 0}, .rings = 10, .segments = 6});  // medial border
  tube({at(76, -130, -92, 5, 4, 0), at(46, -70, -66, 5, 4, 0), at(20, -24, -22, 6.5, 6, 0)},
       {.reference = {1, 0, 0}, .rings = 8, .segments = 6});  // lateral border
  tube({at(90, 10, -98, 5, 4, 0), at(60, 17, -88, 8, 4, 0), at(28, 24, -62, 9, 4.5, 0), at(2, 30, -40, 8, 7, 0),
        at(-12, 29, -18, 4.5, 12, 0), at(-8, 27, -2, 4, 10, 0)},
       {.reference = up, .rings = 10, .segments = 6});  // spine and acromion
  tube({at(22, 6, -6, 9, 9, 0), at(22, 22, 4, 6.5, 6.5, 0), at(12, 25, 18, 5.5, 6, 0), at(2, 18, 26, 5, 5, 0)},
       {.reference = up, .rings = 8, .segments = 6});               // coracoid process
  add_ellipsoid(mesh, {s.x + 21, s.y - 2, s.z - 12}, {8, 19, 14});  // glenoid
  mesh = united(mesh);
  append(mesh, clavicle);
  return mesh;
}

SurfaceMesh humerus(const Proportions& p) {
  const double l = -p.tip[index(Segment::upper_arm_right)].y;
  SurfaceMesh mesh;
  add_ellipsoid(mesh, {3, 0, -3}, {22, 23, 22}, 9, 14);
  add_ellipsoid(mesh, {-17, -4, 2}, {10, 17, 14}, 7, 10);  // greater tubercle
  add_ellipsoid(mesh, {-6, -6, 17}, {6, 13, 6}, 5, 8);     // lesser
  add_tube(mesh,
           {{-5, -10, 0, 18, 18},
            {-6, -0.13 * l, 0, 15, 15},
            {-6, -0.25 * l, 1, 12, 12},
            {-7, -0.45 * l, 2, 11.5, 11.5},
            {-4, -0.65 * l, 2, 10, 11},
            {-1, -0.80 * l, 2, 9, 14},
            {0, -0.90 * l, 1, 8, 22},
            {0, -0.965 * l, 1, 8, 29}},
           {.reference = forward, .normal = up, .rings = 16, .segments = 11});
  add_ellipsoid(mesh, {25, -0.955 * l, -3}, {9, 12, 8});  // medial epicondyle
  add_ellipsoid(mesh, {-23, -0.965 * l, 0}, {8, 13, 8});  // lateral
  add_tube(mesh, {{22, -l - 3, 3, 14, 14}, {8, -l, 3, 9.5, 9.5}, {-4, -l, 3, 11, 11}, {-20, -l, 5, 11, 11}},
           {.reference = forward, .rings = 8, .segments = 12, .cap = 0.4});  // trochlea and capitulum
  return united(mesh);
}

SurfaceMesh radius_and_ulna(const Proportions& p) {
  const double l = -p.tip[index(Segment::forearm_right)].y;
  SurfaceMesh mesh;
  add_tube(mesh,
           {{-16, -13, 4, 11.5, 11.5},
            {-16, -20, 4, 11, 11},
            {-15, -30, 4, 7, 7},
            {-12, -0.18 * l, 5, 8, 8},
            {-19, -0.40 * l, 4, 7, 7.5},
            {-22, -0.60 * l, 3, 7, 8},
            {-18, -0.80 * l, 2, 8, 10},
            {-12, -0.93 * l, 1, 10, 15},
            {-11, -l + 4, 0, 10.5, 16}},
           {.reference = forward, .normal = up, .rings = 16, .segments = 9, .cap = 0.3});
  add_tube(mesh, {{-22, -l + 8, 0, 8, 6}, {-25, -l - 5, 1, 5, 4}}, {.reference = forward, .rings = 3, .segments = 8});
  const SurfaceMesh radius = united(std::exchange(mesh, {}));
  add_tube(mesh,
           {{10, 14, -18, 8, 10},
            {10, 2, -17, 9, 11},
            {10, -16, -12, 12, 11},
            {10, -0.16 * l, -7, 10, 8.5},
            {9, -0.35 * l, -5, 8, 7},
            {11, -0.60 * l, -3, 7, 6.5},
            {14, -0.82 * l, -2, 6, 5.5},
            {16, -0.93 * l, -2, 7.5, 7},
            {16, -l + 8, -2, 8, 8}},
           {.reference = forward, .normal = up, .rings = 16, .segments = 9, .cap = 0.5});
  add_tube(mesh, {{10, -14, -2, 8, 9}, {10, -20, 9, 5, 7}}, {.reference = up, .rings = 3, .segments = 8});  // coronoid
  add_ellipsoid(mesh, {19, -l + 2, -5}, {3.5, 7, 3.5}, 4, 8);
  mesh = united(mesh);
  append(mesh, radius);
  return mesh;
}

SurfaceMesh hand(const Proportions& p) {
  const double palm = -p.tip[index(Segment::hand_right)].y;
  SurfaceMesh mesh;
  constexpr std::array<std::array<double, 6>, 8> carpals = {{{-14, -8, 2, 9, 8, 7},    // scaphoid
                                                             {-2, -7, 1, 8, 8, 8},     // lunate
                                                             {10, -9, 0, 8, 7, 7},     // triquetrum
                                                             {13, -13, 8, 5, 5, 4},    // pisiform
                                                             {-20, -22, 4, 7, 7, 7},   // trapezium
                                                             {-12, -22, 1, 6, 7, 7},   // trapezoid
                                                             {-2, -22, 0, 7, 10, 8},   // capitate
                                                             {10, -22, 1, 8, 8, 8}}};  // hamate
  for (const auto& c : carpals) add_ellipsoid(mesh, {c[0], c[1], c[2]}, {c[3], c[4], c[5]}, 5, 8);
  constexpr std::array<std::array<double, 3>, 4> metacarpals = {
      {{-14, -24, 1.0}, {-3, -7, 1.0}, {7, 9, 0.95}, {15, 24, 0.89}}};
  for (const auto& m : metacarpals) {
    add_bone_of_hand(mesh, {m[0], -33, 0}, {m[1], -m[2] * palm + 4, 1}, 7, 4.3, 7);
  }
  return mesh;
}

SurfaceMesh fingers(const Proportions& p) {
  const double l = -p.tip[index(Segment::fingers_right)].y, palm = -p.tip[index(Segment::hand_right)].y;
  SurfaceMesh mesh;
  constexpr std::array<std::array<double, 4>, 4> digits = {
      {{-24, -31, 1.0, 0.90}, {-7, -8, 1.0, 1.0}, {9, 13, 0.95, 0.93}, {24, 33, 0.89, 0.74}}};
  for (const auto& d : digits) {
    const Vec start{d[0], (1 - d[2]) * palm, 1}, end{d[1], (1 - d[2]) * palm - d[3] * l, 3};
    const auto at = [&](double t) { return start + t * (end - start); };
    add_bone_of_hand(mesh, at(0.07), at(0.46), 6.3, 3.9, 5.2);
    add_bone_of_hand(mesh, at(0.54), at(0.75), 5.2, 3.4, 4.5);
    add_bone_of_hand(mesh, at(0.82), at(0.98), 4.4, 2.8, 3.2);
  }
  return mesh;
}

SurfaceMesh thumb(const Proportions& p) {
  const double l = -p.tip[index(Segment::thumb_right)].y;
  SurfaceMesh mesh;
  const Vec start{0, 0, 2}, end{-0.42 * l, -l, 0.25 * l};
  const auto at = [&](double t) { return start + t * (end - start); };
  add_bone_of_hand(mesh, at(0.02), at(0.42), 7, 4.6, 6.5);
  add_bone_of_hand(mesh, at(0.50), at(0.74), 6, 4, 5);
  add_bone_of_hand(mesh, at(0.82), at(0.99), 5, 3.2, 3.4);
  return mesh;
}

}  // namespace mobil::inline v0_3::bones
