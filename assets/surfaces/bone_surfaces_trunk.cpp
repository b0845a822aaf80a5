#include "assets/surfaces/bone_surfaces_trunk.h"

#include <algorithm>
#include <array>

#include <mobil/engine/geometry.h>
#include "assets/surfaces/bone_shapes.h"

namespace mobil::inline v0_3::bones {
namespace {

using namespace geometry;

/// Half-widths and processes of a vertebra, mm. T1–T12 also have ribs: half-width of the rib cage, drop to the end of
/// the bony rib, and end of its cartilage (to the side of the middle, above the ground, forward).
struct VertebraSize {
  double half_width, half_depth;
  double spine_length, spine_drop, spine_height;
  double transverse_reach, transverse_back;
};
struct RibSize {
  double half_width, drop, end_x, end_y, end_z;
};

constexpr double sternum_top = 1376, sternum_bottom = 1240;  // above the ground, mm

VertebraSize vertebra_size(Segment segment) {
  const auto s = static_cast<double>(index(segment));
  if (segment <= Segment::L1) {
    const double t = (s - static_cast<double>(index(Segment::L5))) / 4;  // 0 at L5
    return {26 - 3 * t, 18 - 1.5 * t, 26, 6, 12, 42 - 3 * t, 6};
  }
  if (segment <= Segment::T1) {
    const double t = (s - static_cast<double>(index(Segment::T12))) / 11;  // 0 at T12
    const double steep = 4 * t * (1 - t);
    return {22 - 7 * t, 16 - 6 * t, 20 + 5 * steep, 12 + 22 * steep, 8 - 3 * steep, 24 + 12 * t, 16 - 6 * t};
  }
  const double t = (s - static_cast<double>(index(Segment::C7))) / 6;  // 0 at C7
  if (segment == Segment::C1) return {15, 7, 4, 0, 4, 36, 0};
  if (segment == Segment::C2) return {12, 8, 20, 8, 7, 26, 2};
  return {14 - 2 * t, 9 - t, 34 - 22 * t, 12 - 6 * t, 5, 29 - 4 * t, 1};
}

/// T1 to T12.
constexpr std::array<RibSize, 12> ribs = {{{56, 46, 22, 1366, 25},
                                           {82, 60, 20, 1347, 33},
                                           {102, 66, 17, 1328, 40},
                                           {114, 72, 16, 1308, 46},
                                           {120, 78, 16, 1289, 52},
                                           {123, 84, 16, 1271, 57},
                                           {125, 90, 17, 1254, 62},
                                           {124, 94, 34, 1234, 61},
                                           {121, 92, 56, 1212, 54},
                                           {114, 84, 78, 1192, 44},
                                           {108, 70, 0, 0, 0},
                                           {84, 40, 0, 0, 0}}};

void add_ribs(SurfaceMesh& mesh, const Proportions& p, Segment segment, const VertebraSize& v) {
  const std::size_t number = index(Segment::T1) - index(segment);
  const RibSize& r = ribs[number];
  const Vec origin = p.world[index(segment)];
  const double y0 = 0.5 * p.tip[index(segment)].y, w = r.half_width, d = r.drop;
  const double thick = number == 0 ? 7 : 6, thin = number == 0 ? 4.5 : 3.2;
  SurfaceMesh rib;
  const TubeShape shape{.reference = up, .rings = 14, .segments = 6};
  if (number >= 10) {
    const double reach = number == 10 ? 0.55 : 0.25, back = -v.half_depth - 24;
    add_tube(rib,
             {{-13, y0, -4, thick, thin},
              {-30, y0, -v.half_depth - 10, thick, thin},
              {-0.60 * w, y0 - 0.20 * d, back, thick, thin},
              {-0.90 * w, y0 - 0.60 * d, back + 30, thick, thin},
              {-w, y0 - d, back + 30 + 80 * reach, thick - 2, thin - 0.6}},
             shape);
  } else {
    const Vec end = Vec{-r.end_x, r.end_y, r.end_z} - Vec{0, origin.y, origin.z};
    const double back = -v.half_depth - 22 - 0.10 * w, depth = end.z - back;
    add_tube(rib,
             {{-12, y0 + 1, -4, thick, thin},
              {-28, y0 + 2, -v.half_depth - 10, thick, thin},
              {-0.56 * w, y0 - 0.10 * d, back, thick, thin},
              {-0.90 * w, y0 - 0.36 * d, back + 0.24 * depth, thick, thin},
              {-w, y0 - 0.62 * d, back + 0.50 * depth, thick, thin},
              {-0.88 * w, y0 - 0.86 * d, back + 0.76 * depth, thick, thin},
              {-0.60 * w - 0.35 * r.end_x, y0 - d, back + 0.93 * depth, thick, 4},
              {end.x - 0.12 * w, 0.6 * end.y + 0.4 * (y0 - d), end.z - 3, thick, 4.2},
              {end.x, end.y, end.z, thick - 1, 4.2}},
             {.reference = up, .rings = 20, .segments = 6});
  }
  add_pair(mesh, rib);
}

void add_sternum(SurfaceMesh& mesh, const Vec& origin) {
  const auto at = [&](double y, double z, double half_width, double half_depth) {
    return Station{0, y - origin.y, z - origin.z, half_width, half_depth};
  };
  const TubeShape shape{.reference = across, .rings = 10, .segments = 12, .cap = 0.4};
  add_tube(mesh, {at(sternum_top - 4, 24, 27, 7), at(sternum_top - 16, 28, 30, 7.5), at(sternum_top - 44, 37, 17, 6)},
           shape);
  add_tube(
      mesh,
      {at(sternum_top - 47, 38, 17, 6), at(1290, 50, 18, 5.5), at(1262, 58, 20, 5.5), at(sternum_bottom, 64, 13, 5)},
      shape);
  add_tube(mesh, {at(sternum_bottom - 2, 64, 8, 4), at(1218, 66, 4, 2.5)},
           {.reference = across, .rings = 4, .segments = 8});
}

}  // namespace

SurfaceMesh vertebra(const Proportions& p, Segment segment) {
  const VertebraSize v = vertebra_size(segment);
  const Vec tip = p.tip[index(segment)];
  const double h = tip.y, a = v.half_width, b = v.half_depth;
  const auto mid = [&](double t) { return t * tip; };
  SurfaceMesh mesh;
  if (segment != Segment::C1) {
    const Vec low = mid(0.12), waist = mid(0.5), high = mid(0.88);
    add_tube(mesh,
             {{0, low.y, low.z, b, a},
              {0, mid(0.22).y, mid(0.22).z, 0.96 * b, 0.96 * a},
              {0, waist.y, waist.z, 0.86 * b, 0.84 * a},
              {0, mid(0.78).y, mid(0.78).z, 0.96 * b, 0.96 * a},
              {0, high.y, high.z, b, a}},
             {.reference = forward, .normal = up, .rings = 7, .segments = 11, .cap = 0.12});
  }
  if (segment == Segment::C2) {  // the dens
    add_tube(mesh, {{0, 0.7 * h, 2, 5, 5}, {0, 1.3 * h, 3, 5.5, 5}, {0, 1.6 * h, 3, 4, 4}},
             {.reference = forward, .rings = 3, .segments = 6});
  }
  // the arch round the canal, from the left pedicle to the right one
  const double y = 0.58 * h, z = mid(0.58).z, canal = segment >= Segment::C7 ? 11 : 9;
  const double arch = std::clamp(0.24 * h, 3.0, 6.0);
  add_tube(mesh,
           {{a * 0.6, y, z - 0.6 * b, arch * 0.8, arch},
            {canal + 4, y, z - b - 6, arch, arch},
            {0.6 * canal, y - 2, z - b - 17, arch * 1.2, 0.7 * arch},
            {0, y - 3, z - b - 21, arch * 1.3, 0.8 * arch},
            {-0.6 * canal, y - 2, z - b - 17, arch * 1.2, 0.7 * arch},
            {-canal - 4, y, z - b - 6, arch, arch},
            {-a * 0.6, y, z - 0.6 * b, arch * 0.8, arch}},
           {.reference = up, .rings = 9, .segments = 6});
  const double root = z - b - 19;
  add_tube(mesh,
           {{0, y - 2, root, v.spine_height * 0.8, 3.5},
            {0, y - 2 - 0.5 * v.spine_drop, root - 0.5 * v.spine_length, 0.9 * v.spine_height, 3},
            {0, y - 2 - v.spine_drop, root - v.spine_length, 0.75 * v.spine_height, 4}},
           {.reference = up, .normal = forward, .rings = 4, .segments = 6});
  SurfaceMesh side;
  add_tube(side,
           {{-canal, y, z - b - 4, arch, arch},
            {-0.6 * v.transverse_reach, y + 1, z - b - 5 - 0.6 * v.transverse_back, 0.8 * arch, 0.7 * arch},
            {-v.transverse_reach, y + 2, z - b - 5 - v.transverse_back, arch, 0.8 * arch}},
           {.reference = up, .rings = 3, .segments = 6});
  // articular processes, reaching for the neighbours
  add_tube(side,
           {{-canal - 2, y - 0.55 * h, z - b - 13, 3, 4},
            {-canal - 3, y, z - b - 9, 4, 5},
            {-canal - 4, y + 0.55 * h, z - b - 8, 3, 4}},
           {.reference = forward, .rings = 3, .segments = 6});
  if (segment == Segment::C1) {  // lateral masses and the front arch
    add_ellipsoid(side, {-18, 0.5 * h, 0}, {9, 8, 11});
    add_tube(mesh, {{-16, 0.5 * h, 4, 5, 4}, {0, 0.5 * h, 13, 6, 4}, {16, 0.5 * h, 4, 5, 4}},
             {.reference = up, .rings = 7, .segments = 8});
  }
  add_pair(mesh, side);
  mesh = united(mesh);
  if (segment >= Segment::T12 && segment <= Segment::T1) add_ribs(mesh, p, segment, v);
  if (segment == Segment::T4) add_sternum(mesh, p.world[index(segment)]);
  return mesh;
}

}  // namespace mobil::inline v0_3::bones
