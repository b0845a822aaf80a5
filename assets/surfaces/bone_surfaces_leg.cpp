#include "assets/surfaces/bone_surfaces_leg.h"

#include <algorithm>
#include <array>

#include <mobil/engine/geometry.h>
#include "assets/surfaces/bone_shapes.h"
#include "assets/surfaces/leg_station.h"
#include "assets/surfaces/surface_mesh.h"

namespace mobil::inline v0_3::bones {
namespace {

using namespace geometry;

/// Returns the lofted shaft in the frame whose origin is at `level`.
SurfaceMesh shaft(const LegFrame& leg, std::span<const LegSection> sections, double level, int rings, int segments) {
  LegFrame moved = leg;
  moved.hip = Vec{0, 0, 0} - leg_point(leg, level, 0, 0);
  std::vector<TubeStation> line;
  for (const auto& s : sections) line.push_back(leg_station(moved, s));
  return loft(line, {.reference = forward, .normal = down, .rings = rings, .segments = segments, .cap = 0.35});
}

/// Adds a bone of the foot or toes between its two ends, where it is thickest.
void add_bone_of_foot(SurfaceMesh& mesh, const Vec& near, const Vec& far, double r_near, double r_middle,
                      double r_far) {
  const Vec middle = 0.5 * (near + far) + Vec{0, 0.06 * length(far - near), 0};
  const std::array<TubeStation, 4> line = {TubeStation{near, r_near, r_near},
                                           {0.5 * (near + middle), r_middle, r_middle},
                                           {0.4 * middle + 0.6 * far, r_middle, r_middle},
                                           {far, r_far, r_far}};
  append(mesh, loft(line, {.reference = up, .rings = 5, .segments = 7, .cap = 0.7}));
}

/// Scale of the measured foot, in mm from the ankle. Forward of the ankle its length follows the body's.
struct FootScale {
  double forward_factor;

  Vec operator()(double x, double y, double z) const { return {x, y, z > 0 ? z * forward_factor : z}; }
};
constexpr double measured_ball = 122;

FootScale foot_scale(const Proportions& p) {
  return {p.tip[index(Segment::foot_right)].z / measured_ball};
}

struct Ray {
  Vec base, head, tip;  // ends of the metatarsal, and of the toe
  double base_r, shaft_r, head_r;
};
constexpr std::array<Ray, 5> rays = {{{{9, -25, 66}, {4, -50, 121}, {-6, -58, 177}, 10.5, 7, 10},
                                      {{-8, -18, 60}, {-16, -53, 123}, {-26, -60, 178}, 7.5, 4.6, 6.5},
                                      {{-15, -22, 58}, {-29, -55, 119}, {-41, -60, 171}, 7, 4.3, 6.2},
                                      {{-22, -30, 50}, {-40, -57, 111}, {-54, -60, 157}, 7, 4.3, 6},
                                      {{-28, -38, 40}, {-52, -59, 99}, {-63, -61, 139}, 7.5, 4.5, 6}}};

}  // namespace

SurfaceMesh femur(const Proportions& p) {
  const LegFrame& leg = p.leg;
  const auto at = [&](double level, double lateral, double anterior) {
    return leg_point(leg, level, lateral, anterior);
  };
  SurfaceMesh mesh = shaft(leg, femur_sections(), 0, 26, 12);
  add_ellipsoid(mesh, {0, 0, 0}, {23, 23, 23}, 9, 14);
  const Vec a = at(0.015, 12, -1), b = at(0.04, 26, -4), c = at(0.075, 42, -8);
  add_tube(mesh, {{a.x, a.y, a.z, 16, 17}, {b.x, b.y, b.z, 13.5, 16}, {c.x, c.y, c.z, 17, 24}},
           {.reference = forward, .rings = 7, .segments = 12});
  // greater trochanter, with its tip above the neck's root; lesser trochanter behind and inside
  const Vec t0 = at(-0.012, 54, -16), t1 = at(0.03, 58, -11), t2 = at(0.075, 56, -8), t3 = at(0.14, 40, -6);
  add_tube(
      mesh,
      {{t0.x, t0.y, t0.z, 9, 6}, {t1.x, t1.y, t1.z, 17, 11}, {t2.x, t2.y, t2.z, 19, 12}, {t3.x, t3.y, t3.z, 11, 9}},
      {.reference = forward, .rings = 9, .segments = 10});
  add_ellipsoid(mesh, at(0.155, 14, -15), {9, 13, 9});
  // condyles and the groove between them in front
  for (const double side : {-1.0, 1.0}) {
    add_ellipsoid(mesh, at(1.014, 23 * side, -2), {14.5, 26.5, 29}, 8, 12);
    add_ellipsoid(mesh, at(0.992, 34 * side, 2), {11, 17, 16});
    const Vec g0 = at(0.94, 15 * side, 21), g1 = at(0.985, 17 * side, 23), g2 = at(1.046, 17 * side, 11);
    add_tube(mesh, {{g0.x, g0.y, g0.z, 9, 6}, {g1.x, g1.y, g1.z, 11, 8}, {g2.x, g2.y, g2.z, 11, 9}},
             {.reference = {1, 0, 0}, .rings = 6, .segments = 8});
  }
  return united(mesh);
}

SurfaceMesh patella() {
  SurfaceMesh mesh;
  add_tube(mesh,
           {{0, 17, -2, 15, 7},
            {0, 9, -3.7, 20, 12.9},
            {0, -2, -3.7, 20.5, 13.5},
            {0, -12, -2.5, 14, 10.5},
            {0, -20, -2, 5, 4.5}},
           {.reference = {1, 0, 0}, .normal = up, .rings = 8, .segments = 12, .cap = 0.5});
  return mesh;
}

SurfaceMesh tibia_and_fibula(const Proportions& p) {
  LegFrame leg = p.leg;
  SurfaceMesh mesh = shaft(leg, tibia_sections(), 1, 22, 12);
  const SurfaceMesh fibula = shaft(leg, fibula_sections(), 1, 16, 8);
  leg.hip = {0, leg.thigh_length, 0};  // the shank's frame begins at the knee
  const auto at = [&](double level, double lateral, double anterior) {
    return leg_point(leg, level, lateral, anterior);
  };
  for (const double side : {-1.0, 1.0}) {  // plateaus
    add_ellipsoid(mesh, at(1.096, 19 * side + 1, 0), {19, 10, 24}, 6, 12);
    add_ellipsoid(mesh, at(1.075, 5 * side, -1), {4, 8, 7}, 4, 8);
  }
  const Vec t0 = at(1.13, 5, 27), t1 = at(1.175, 5, 32), t2 = at(1.22, 4, 30), t3 = at(1.28, 4, 28);
  add_tube(mesh,
           {{t0.x, t0.y, t0.z, 8, 8}, {t1.x, t1.y, t1.z, 10, 9}, {t2.x, t2.y, t2.z, 8, 7}, {t3.x, t3.y, t3.z, 5, 5}},
           {.reference = {1, 0, 0}, .rings = 8, .segments = 8});
  const Vec m0 = at(1.92, -20, 8), m1 = at(1.965, -26, 7), m2 = at(2.005, -27, 8);
  add_tube(mesh, {{m0.x, m0.y, m0.z, 14, 9}, {m1.x, m1.y, m1.z, 13, 7}, {m2.x, m2.y, m2.z, 9, 5}},
           {.reference = forward, .normal = down, .rings = 6, .segments = 10});
  mesh = united(mesh);
  append(mesh, fibula);
  return mesh;
}

SurfaceMesh foot(const Proportions& p) {
  const FootScale at = foot_scale(p);
  SurfaceMesh mesh;
  const auto put = [&](std::initializer_list<Station> line, const TubeShape& shape) { add_tube(mesh, line, shape); };
  put({{1, -34, -40, 17, 13},
       {1, -37, -30, 22, 15},
       {0, -34, -14, 19, 14},
       {-2, -30, 4, 17, 15},
       {-8, -30, 24, 13, 13}},
      {.reference = up, .normal = forward, .rings = 8, .segments = 11, .cap = 0.5});
  put({{10, -22, 2, 7, 8}, {13, -22, 10, 6, 9}}, {.reference = up, .rings = 3, .segments = 8});  // sustentaculum
  mesh = united(mesh);
  // talus: the trochlea under the shank, neck and head
  put({{0, -6, -18, 9, 12}, {0, -4, -6, 15, 17}, {1, -3, 6, 15, 18}, {5, -9, 20, 11, 13}, {8, -13, 31, 12, 14}},
      {.reference = up, .normal = forward, .rings = 8, .segments = 11, .cap = 0.6});
  const auto block = [&](double x, double y, double z, double a, double b, double c) {
    add_ellipsoid(mesh, at(x, y, z), {a, b, c * at.forward_factor});
  };
  block(6, -13, 42, 19, 13, 9);     // navicular
  block(-16, -30, 38, 13, 13, 16);  // cuboid
  block(9, -22, 58, 9, 15, 13);     // cuneiforms
  block(-4, -17, 55, 8, 11, 11);
  block(-13, -22, 51, 8, 12, 13);
  for (const Ray& r : rays) {
    add_bone_of_foot(mesh, at(r.base.x, r.base.y, r.base.z), at(r.head.x, r.head.y, r.head.z), r.base_r, r.shaft_r,
                     r.head_r);
  }
  for (const double x : {-1.0, 10.0}) add_ellipsoid(mesh, at(x, -60, 113), {4.5, 3.5, 6}, 4, 8);  // sesamoids
  return mesh;
}

SurfaceMesh toes(const Proportions& p) {
  const Vec origin = p.joint[index(Segment::toes_right)];
  const double toe_factor = p.tip[index(Segment::toes_right)].z / 56;  // the measured great toe's 56 mm
  SurfaceMesh mesh;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Ray& r = rays[i];
    const Vec start = foot_scale(p)(r.head.x, r.head.y, r.head.z) - origin;
    const Vec span{r.tip.x - r.head.x, r.tip.y - r.head.y, (r.tip.z - r.head.z) * toe_factor};
    const auto at = [&](double t, double lift) { return start + t * span + Vec{0, lift, 0}; };
    const double q = i == 0 ? 1.0 : 0.62, m = r.head_r;
    if (i == 0) {
      add_bone_of_foot(mesh, at(0.12, 0), at(0.55, 1), 9.5, 6.5, 8);
      add_bone_of_foot(mesh, at(0.66, 0), at(0.96, 0), 8.5, 5.5, 5.5);
    } else {
      add_bone_of_foot(mesh, at(0.10, 0), at(0.50, 3), 0.9 * m, 0.55 * m, 0.75 * m);
      add_bone_of_foot(mesh, at(0.58, 3), at(0.76, 1), q * m, 0.5 * m, 0.6 * m);
      add_bone_of_foot(mesh, at(0.83, 0), at(0.98, 0), 0.6 * m, 0.45 * m, 0.45 * m);
    }
  }
  return mesh;
}

}  // namespace mobil::inline v0_3::bones
