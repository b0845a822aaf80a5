#include <algorithm>

#include "assets/bone_shapes.h"
#include "assets/geometry.h"

namespace mobil::bones {
namespace {

using namespace geometry;

constexpr Vec forward{0, 0, 1}, up{0, 1, 0}, across{1, 0, 0};

/// Half-widths and processes of a vertebra, mm; T1–T12 also the ribs: half-width of the cage, drop to the end of the
/// bony rib, and where its cartilage ends (beside the middle, over the ground, forward).
struct VertebraSize {
  double half_width, half_depth;
  double spine_length, spine_drop, spine_height;
  double transverse_reach, transverse_back;
};
struct RibSize {
  double half_width, drop, end_x, end_y, end_z;
};

constexpr double sternum_top = 1376, sternum_bottom = 1240;  // over the ground, mm

VertebraSize vertebra_size(Segment segment) {
  const auto s = static_cast<double>(index(segment));
  if (segment <= Segment::L1) {
    const double t = (s - static_cast<double>(index(Segment::L5))) / 4;  // 0 at L5
    return {26 - 3 * t, 18 - 1.5 * t, 26, 6, 12, 42 - 3 * t, 6};
  }
  if (segment <= Segment::T1) {
    const double t = (s - static_cast<double>(index(Segment::T12))) / 11;  // 0 at T12
    const double steep = 4 * t * (1 - t);
    return {22 - 7 * t, 16 - 6 * t, 26 + 8 * steep, 12 + 22 * steep, 8 - 3 * steep, 24 + 12 * t, 16 - 6 * t};
  }
  const double t = (s - static_cast<double>(index(Segment::C7))) / 6;  // 0 at C7
  if (segment == Segment::C1) return {15, 7, 4, 0, 4, 36, 0};
  if (segment == Segment::C2) return {12, 8, 20, 8, 7, 26, 2};
  return {14 - 2 * t, 9 - t, 34 - 22 * t, 12 - 6 * t, 5, 29 - 4 * t, 1};
}

/// T1 to T12.
constexpr std::array<RibSize, 12> ribs = {{{56, 46, 22, 1366, 32},
                                           {82, 60, 20, 1347, 41},
                                           {102, 66, 17, 1328, 49},
                                           {114, 72, 16, 1308, 56},
                                           {122, 78, 16, 1289, 63},
                                           {127, 84, 16, 1271, 69},
                                           {130, 90, 17, 1254, 75},
                                           {130, 94, 34, 1234, 74},
                                           {127, 92, 56, 1212, 66},
                                           {120, 84, 78, 1192, 54},
                                           {108, 70, 0, 0, 0},
                                           {84, 40, 0, 0, 0}}};

void add_ribs(SurfaceMesh& mesh, const Proportions& p, Segment segment, const VertebraSize& v) {
  const std::size_t number = index(Segment::T1) - index(segment);
  const RibSize& r = ribs[number];
  const Vec origin = p.world[index(segment)];
  const double y0 = 0.5 * p.tip[index(segment)].y, w = r.half_width, d = r.drop;
  const double thick = number == 0 ? 7 : 6, thin = number == 0 ? 4.5 : 3.2;
  SurfaceMesh rib;
  const TubeShape shape{.reference = up, .rings = 20, .segments = 8};
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
             {.reference = up, .rings = 26, .segments = 8});
  }
  add_pair(mesh, rib);
}

void add_sternum(SurfaceMesh& mesh, const Vec& origin) {
  const auto at = [&](double y, double z, double half_width, double half_depth) {
    return Station{0, y - origin.y, z - origin.z, half_width, half_depth};
  };
  const TubeShape shape{.reference = across, .rings = 10, .segments = 12, .cap = 0.4};
  add_tube(mesh, {at(sternum_top - 4, 31, 27, 7), at(sternum_top - 16, 36, 30, 7.5), at(sternum_top - 44, 46, 17, 6)},
           shape);
  add_tube(
      mesh,
      {at(sternum_top - 47, 47, 17, 6), at(1290, 61, 18, 5.5), at(1262, 71, 20, 5.5), at(sternum_bottom, 77, 13, 5)},
      shape);
  add_tube(mesh, {at(sternum_bottom - 2, 77, 8, 4), at(1218, 79, 4, 2.5)},
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
             {.reference = forward, .normal = up, .rings = 7, .segments = 14, .cap = 0.12});
  }
  if (segment == Segment::C2) {  // the dens
    add_tube(mesh, {{0, 0.7 * h, 2, 5, 5}, {0, 1.3 * h, 3, 5.5, 5}, {0, 1.6 * h, 3, 4, 4}},
             {.reference = forward, .rings = 5, .segments = 8});
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
           {.reference = up, .rings = 15, .segments = 8});
  const double root = z - b - 19;
  add_tube(mesh,
           {{0, y - 2, root, v.spine_height * 0.8, 3.5},
            {0, y - 2 - 0.5 * v.spine_drop, root - 0.5 * v.spine_length, 0.9 * v.spine_height, 3},
            {0, y - 2 - v.spine_drop, root - v.spine_length, 0.75 * v.spine_height, 4}},
           {.reference = up, .normal = forward, .rings = 6, .segments = 8});
  SurfaceMesh side;
  add_tube(side,
           {{-canal, y, z - b - 4, arch, arch},
            {-0.6 * v.transverse_reach, y + 1, z - b - 5 - 0.6 * v.transverse_back, 0.8 * arch, 0.7 * arch},
            {-v.transverse_reach, y + 2, z - b - 5 - v.transverse_back, arch, 0.8 * arch}},
           {.reference = up, .rings = 5, .segments = 8});
  // articular processes, reaching for the neighbours
  add_tube(side,
           {{-canal - 2, y - 0.55 * h, z - b - 13, 3, 4},
            {-canal - 3, y, z - b - 9, 4, 5},
            {-canal - 4, y + 0.55 * h, z - b - 8, 3, 4}},
           {.reference = forward, .rings = 5, .segments = 8});
  if (segment == Segment::C1) {  // lateral masses and the front arch
    add_ellipsoid(side, {-18, 0.5 * h, 0}, {9, 8, 11});
    add_tube(mesh, {{-16, 0.5 * h, 4, 5, 4}, {0, 0.5 * h, 13, 6, 4}, {16, 0.5 * h, 4, 5, 4}},
             {.reference = up, .rings = 7, .segments = 8});
  }
  add_pair(mesh, side);
  if (segment >= Segment::T12 && segment <= Segment::T1) add_ribs(mesh, p, segment, v);
  if (segment == Segment::T4) add_sternum(mesh, p.world[index(segment)]);
  return mesh;
}

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
       {.reference = forward, .normal = up, .rings = 20, .segments = 22, .cap = 0.8});
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
       {.reference = {0.5, 0.2, 0.8}, .rings = 34, .segments = 8});  // iliac crest
  tube(hip, {{-113, 64, 52, 6, 6}, {-108, 46, 42, 7, 7}, {-100, 32, 34, 9, 8}, {-92, 20, 26, 10, 10}},
       {.reference = across, .rings = 8, .segments = 8});  // front border to the lower spine
  tube(hip, {{-46, 66, -64, 6, 6}, {-52, 46, -46, 8, 6}, {-58, 26, -36, 10, 9}, {-62, 6, -34, 11, 10}},
       {.reference = across, .rings = 8, .segments = 8});  // greater sciatic notch
  // the socket's rim, open below
  std::vector<TubeStation> rim;
  const Vec centre{-84, -1, 2}, axis = normalised({-0.80, -0.36, 0.48});
  const Vec ring_u = orthogonal({0, -1, 0}, axis), ring_v = cross(axis, ring_u);
  for (int i = 0; i <= 12; ++i) {
    const double angle = 0.45 + (2 * 3.14159265 - 0.9) * i / 12;
    rim.push_back({centre + 27.0 * (std::cos(angle) * ring_u + std::sin(angle) * ring_v), 8, 6, 0, 0});
  }
  append(hip, loft(rim, {.reference = axis, .rings = 26, .segments = 8}));
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
       {.reference = across, .rings = 24, .segments = 10});
  tube(hip, {{-66, 4, 18, 13, 12}, {-52, 6, 28, 9, 9}, {-36, 3, 40, 8, 8}, {-20, -4, 48, 9, 8}, {-8, -12, 49, 11, 8}},
       {.reference = up, .rings = 12, .segments = 10});
  tube(hip, {{-8, -10, 49, 6, 8}, {-8, -22, 44, 6, 8}, {-9, -34, 34, 6, 7}},
       {.reference = across, .rings = 6, .segments = 10});
  add_pair(mesh, hip);
  add_ellipsoid(mesh, {0, -21, 44}, {4, 16, 7});  // symphysis
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
  return mesh;
}

SurfaceMesh skull() {
  SurfaceMesh mesh, side;
  const auto tube = [&](SurfaceMesh& into, std::initializer_list<Station> line, const TubeShape& shape) {
    add_tube(into, line, shape);
  };
  tube(mesh,
       {{0, -6, -18, 34, 34},
        {0, 4, -16, 56, 52},
        {0, 18, -12, 68, 62},
        {0, 34, -2, 82, 67},
        {0, 56, 2, 88, 70},
        {0, 78, 0, 85, 68},
        {0, 98, -4, 72, 58},
        {0, 111, -8, 52, 42},
        {0, 118, -10, 30, 25}},
       {.reference = forward, .normal = up, .rings = 22, .segments = 24, .cap = 0.3});
  // brow, orbits, cheek bone and arch, upper jaw
  tube(mesh,
       {{-50, 36, 62, 6, 7},
        {-36, 42, 78, 6, 7},
        {-16, 40, 85, 6, 7},
        {0, 38, 87, 7, 7},
        {16, 40, 85, 6, 7},
        {36, 42, 78, 6, 7},
        {50, 36, 62, 6, 7}},
       {.reference = up, .rings = 19, .segments = 8});
  tube(side, {{-50, 38, 62, 5, 6}, {-51, 22, 64, 5, 6}, {-46, 6, 68, 7, 8}, {-34, -2, 78, 7, 8}, {-20, 0, 84, 6, 6}},
       {.reference = forward, .rings = 12, .segments = 8});
  tube(side, {{-46, 6, 68, 7, 5}, {-58, 7, 48, 6, 3.5}, {-64, 10, 24, 5, 3.5}, {-62, 12, 2, 5, 4}},
       {.reference = up, .rings = 10, .segments = 8});
  tube(side, {{-8, 38, 84, 6, 6}, {-10, 20, 84, 5, 6}, {-16, 2, 86, 6, 6}, {-16, -16, 86, 9, 7}},
       {.reference = forward, .rings = 9, .segments = 8});
  add_ellipsoid(side, {-40, 18, 48}, {14, 22, 14});                               // behind the orbit
  tube(side, {{-58, 2, -10, 10, 8}, {-55, -14, -8, 7, 6}, {-53, -24, -6, 4, 4}},  // mastoid process
       {.reference = forward, .rings = 6, .segments = 8});
  tube(mesh, {{0, 40, 86, 6, 5}, {0, 28, 93, 5, 5}, {0, 16, 101, 5, 4}},
       {.reference = forward, .rings = 6, .segments = 8});
  tube(mesh, {{0, 4, 56, 24, 30}, {0, -12, 62, 27, 27}, {0, -26, 64, 28, 26}, {0, -36, 64, 27, 25}},
       {.reference = forward, .normal = up, .rings = 8, .segments = 16, .cap = 0.2});
  tube(mesh, {{0, -36, 65, 26, 24}, {0, -46, 65, 25, 23.5}},
       {.reference = forward, .normal = up, .rings = 3, .segments = 20, .cap = 0.1});
  // lower jaw: two branches and the arch between them
  tube(side, {{-53, 4, 10, 6, 5}, {-52, -16, 10, 13, 4}, {-50, -36, 11, 17, 4.5}, {-47, -50, 14, 16, 5}},
       {.reference = forward, .normal = up, .rings = 10, .segments = 10});
  tube(side, {{-51, 2, 28, 5, 3.5}, {-50, -18, 24, 8, 4}, {-49, -36, 18, 10, 4.5}},
       {.reference = forward, .rings = 6, .segments = 8});
  add_pair(mesh, side);
  tube(mesh,
       {{-47, -50, 12, 13, 5},
        {-43, -56, 34, 13, 5.5},
        {-33, -61, 60, 13, 6},
        {-17, -65, 80, 14, 6.5},
        {0, -66, 86, 15, 7},
        {17, -65, 80, 14, 6.5},
        {33, -61, 60, 13, 6},
        {43, -56, 34, 13, 5.5},
        {47, -50, 12, 13, 5}},
       {.reference = up, .rings = 29, .segments = 10});
  return mesh;
}

}  // namespace mobil::bones
