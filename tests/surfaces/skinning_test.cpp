// A bound surface rests where it was drawn, moves rigidly with its body, follows its lattice, and never tears.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/assets/surfaces/muscle_surfaces.h>
#include <mobil/assets/surfaces/surface_binding.h>
#include <mobil/engine/geometry.h>
#include "assets/surfaces/tube.h"
#include "tests/surfaces/skinned.h"

namespace mobil::skinning_test {
using namespace geometry;

constexpr double blend_m = 0.04;
constexpr Passages at_the_faces{-blend_m, 0, 0.25, 0.25 + blend_m};  // of the lattice below

Body body() {
  return make_body({.height_m = 1.8F, .mass_kg = 80}).value();
}

Quat<float> rotation(const Vec& axis, double angle) {
  const Vec n = normalised(axis);
  const double s = std::sin(0.5 * angle);
  return {static_cast<float>(s * n.x), static_cast<float>(s * n.y), static_cast<float>(s * n.z),
          static_cast<float>(std::cos(0.5 * angle))};
}

/// Returns a bent lattice of about 0.25 m, whose widths in x and y peak at different stations.
HexahedralMesh lattice(const Cells& cells = {3, 3, 10}) {
  const std::array<LatticeStation, 4> stations = {LatticeStation{0, 0, 0, 0.020F, 0.020F},
                                                  {0.35F, 0.004F, -0.003F, 0.045F, 0.035F},
                                                  {0.7F, -0.002F, 0.002F, 0.038F, 0.040F},
                                                  {1, 0.003F, 0, 0.018F, 0.022F}};
  return bend_block(cells, stations, 0.25).value();
}

/// Returns a belly's frame from below the hip to above the knee, z down the thigh, slightly tilted.
RestFrame thigh_frame(const Body& b) {
  const Vec hip = to_double(b.joint_offset_m[0]) + to_double(b.joint_offset_m[index(Segment::thigh_right)]);
  return {to_float(hip + Vec{-0.02, -0.10, -0.02}), product(rotation({0.2, 0, 1}, 0.1), rotation({1, 0, 0}, 1.5708))};
}

struct Bound {
  HexahedralMesh mesh = lattice();
  Body b = body();
  RestFrame frame = thigh_frame(b);
  MuscleSurface surface;

  explicit Bound(std::size_t member = 0) {
    const GroupSurface muscle = make_muscle_surfaces(b)[member];
    surface = muscle.surface;
    bind_muscle(surface, mesh, frame, muscle.attachments, blend_m);
  }
  Pose<float> rest_pose() const { return standing_pose(b); }
  LineOfAction<float> rest_line() const {
    LineOfAction<float> line{};
    line.start_m = frame.start_m;
    line.rotation = frame.rotation;
    return line;
  }
  std::uint32_t nodes() const { return node_count(mesh.cells); }
  std::vector<Vec3<float>> skin(const Pose<float>& pose, const LineOfAction<float>& line, const std::vector<float>& u,
                                Side side = Side::right) const {
    return skinned(surface, side, b, pose, line, u);
  }
  std::vector<float> still() const { return std::vector<float>(3 * nodes(), 0.0F); }
};

double distance(const Vec3<float>& a, const Vec3<float>& b) {
  return length(to_double(a) - to_double(b));
}

Vec direction() {
  return normalised(
      Vec{*rc::gen::inRange(-9, 10) + 0.3, *rc::gen::inRange(-9, 10) + 0.1, *rc::gen::inRange(-9, 10) + 0.2});
}

RC_GTEST_PROP(PlaceInLattice, PointsInsideAreFoundAndWeightsArePartition, ()) {
  const HexahedralMesh mesh = lattice({4, 3, 9});
  // a point inside, by the map itself: any convex combination of an element's nodes with trilinear weights
  const auto e = static_cast<std::uint32_t>(*rc::gen::inRange(0, 4 * 3 * 9));
  const double x = *rc::gen::inRange(0, 101) * 0.01, y = *rc::gen::inRange(0, 101) * 0.01,
               z = *rc::gen::inRange(0, 101) * 0.01;
  const std::array<double, 8> w = {
      (1 - x) * (1 - y) * (1 - z), x * (1 - y) * (1 - z), x * y * (1 - z), (1 - x) * y * (1 - z),
      (1 - x) * (1 - y) * z,       x * (1 - y) * z,       x * y * z,       (1 - x) * y * z};
  const Hexahedron nodes = element_nodes(mesh.cells, e);
  Vec point{};
  for (std::size_t c = 0; c < 8; ++c) point = point + w[c] * mesh.node[nodes[c]];
  const LatticePlace place = place_in_lattice(mesh, point);
  Vec found{};
  for (std::size_t c = 0; c < 8; ++c) found = found + place.weight[c] * mesh.node[place.node[c]];
  RC_ASSERT(length(found - point) < 1e-9);
}

RC_GTEST_PROP(PlaceInLattice, OutsideItNeverExtrapolates, ()) {
  const HexahedralMesh mesh = lattice();
  const Vec point = Vec{0, 0, 0.12} + (*rc::gen::inRange(0, 500) * 0.001) * direction();
  const LatticePlace place = place_in_lattice(mesh, point);
  double sum = 0;
  for (const double w : place.weight) {
    RC_ASSERT(w >= 0 && w <= 1);
    sum += w;
  }
  RC_ASSERT(std::abs(sum - 1) < 1e-12);
}

float sum_of(const VertexBinding& b) {
  return b.lattice + b.origin + b.insertion + b.origin_held + b.insertion_held;
}

TEST(Binding, WeightsArePartitionsOfOne) {
  for (std::size_t m = 0; m < 12; ++m) {
    const Bound bound(m);
    ASSERT_EQ(bound.surface.binding.size(), bound.surface.mesh.position.size());
    for (const auto& b : bound.surface.binding) {
      EXPECT_GE(std::min({b.lattice, b.origin, b.insertion, b.origin_held, b.insertion_held}), 0.0F);
      EXPECT_NEAR(sum_of(b), 1.0F, 1e-6F);
      EXPECT_TRUE(b.lattice == 0 || b.origin_held + b.insertion_held == 0);
      float sum = 0;
      for (int i = 0; i < 8; ++i) {
        EXPECT_GE(b.node_weight[i], 0.0F);
        EXPECT_LT(b.node[i], bound.nodes());
        sum += b.node_weight[i];
      }
      EXPECT_NEAR(sum, 1.0F, 1e-6F);
    }
  }
}

TEST(Binding, AttachmentsAreOnTheirBonesAndTendonsThatMeetAgree) {
  // All of triceps surae: the calcaneal tendon reaches the heel; the others end in it and move with it.
  const Bound base(10);
  auto muscles = make_muscle_surfaces(base.b);
  const Vec knee = to_double(base.rest_pose().position_m[index(Segment::shank_right)]);
  const RestFrame frame{to_float(knee + Vec{0, -0.01, -0.02}), rotation({1, 0, 0}, 1.5708)};
  std::vector<MuscleSurface*> group;
  for (auto& m : muscles) {
    if (m.group != Muscle::triceps_surae || m.surface.mesh.name.starts_with("plantaris")) continue;
    group.push_back(&m.surface);
    bind_muscle(m.surface, base.mesh, frame, m.attachments, blend_m);
  }
  ASSERT_EQ(group.size(), 4U);
  const auto& tendon = *group.back();
  EXPECT_EQ(tendon.binding.back().insertion_held, 1.0F);
  for (const MuscleSurface* s : group) {
    for (std::size_t v = 0; v < s->binding.size(); ++v) {
      EXPECT_NEAR(sum_of(s->binding[v]), 1.0F, 1e-6F);
      for (std::size_t w = 0; w < tendon.binding.size(); ++w) {
        const bool together = std::abs(s->rest_in_lattice[v].z - tendon.rest_in_lattice[w].z) < 1e-3F;
        if (together) {
          const VertexBinding &own = s->binding[v], &other = tendon.binding[w];
          EXPECT_NEAR(own.insertion + own.insertion_held, other.insertion + other.insertion_held, 0.02F);
        }
      }
    }
  }
}

TEST(Skinning, RestsInItsDrawnPlace) {
  for (std::size_t m = 0; m < 12; ++m) {
    const Bound bound(m);
    const auto out = bound.skin(bound.rest_pose(), bound.rest_line(), bound.still());
    for (std::size_t v = 0; v < out.size(); ++v) EXPECT_LT(distance(out[v], bound.surface.mesh.position[v]), 1e-5);
  }
}

RC_GTEST_PROP(Skinning, MovesRigidlyWithTheWholeBody, ()) {
  static const Bound bound;
  const Quat<float> turn = rotation(direction(), *rc::gen::inRange(-314, 315) * 0.01);
  const Vec shift = (*rc::gen::inRange(0, 300) * 0.01) * direction();
  const auto moved = [&](const Vec3<float>& p) { return to_float(rotated(to_double(turn), to_double(p)) + shift); };
  Pose<float> pose = bound.rest_pose();
  for (std::size_t s = 0; s < segment_count; ++s) {
    pose.position_m[s] = moved(pose.position_m[s]);
    pose.rotation[s] = turn;
  }
  LineOfAction<float> line = bound.rest_line();
  line.start_m = moved(line.start_m);
  line.rotation = product(turn, line.rotation);
  const auto out = bound.skin(pose, line, bound.still());
  for (std::size_t v = 0; v < out.size(); ++v) {
    RC_ASSERT(distance(out[v], moved(bound.surface.mesh.position[v])) < 1e-5);
  }
}

RC_GTEST_PROP(Skinning, LinearFieldOfTheLatticeIsReproduced, ()) {
  static const Bound bound;
  // a separate surface well inside
  MuscleSurface inner;
  inner.mesh = ellipsoid({0, 0, 0}, {0.012, 0.012, 0.10}, 20, 12);
  for (auto& p : inner.mesh.position) {
    const Vec q = to_double(p) + Vec{0.001, 0, 0.125};
    p = to_float(rotated(to_double(bound.frame.rotation), q) + to_double(bound.frame.start_m));
  }
  bind_surface(inner, bound.mesh, bound.frame, at_the_faces);
  double gradient[3][3];
  for (auto& row : gradient) {
    for (double& g : row) g = *rc::gen::inRange(-30, 31) * 0.01;
  }
  const auto field = [&](const Vec& q) {
    return Vec{gradient[0][0] * q.x + gradient[0][1] * q.y + gradient[0][2] * q.z,
               gradient[1][0] * q.x + gradient[1][1] * q.y + gradient[1][2] * q.z,
               gradient[2][0] * q.x + gradient[2][1] * q.y + gradient[2][2] * q.z};
  };
  std::vector<float> u;
  for (const auto& node : bound.mesh.node) {
    const Vec3<float> d = to_float(field(node));
    u.insert(u.end(), {d.x, d.y, d.z});
  }
  const auto out = skinned(inner, Side::right, bound.b, bound.rest_pose(), bound.rest_line(), u);
  for (std::size_t v = 0; v < out.size(); ++v) {
    const Vec q = rotated(conjugate(to_double(bound.frame.rotation)),
                          to_double(inner.mesh.position[v]) - to_double(bound.frame.start_m));
    const Vec expected = rotated(to_double(bound.frame.rotation), q + field(q)) + to_double(bound.frame.start_m);
    RC_ASSERT(length(to_double(out[v]) - expected) < 1e-5);
  }
}

/// A bent leg: the shank turned back about the knee, the thigh forward about the hip. The muscle's frame moves with the
/// thigh.
struct BentLeg {
  Pose<float> pose;
  LineOfAction<float> line;
};
BentLeg bent(const Bound& bound, double hip, double knee) {
  using enum Segment;
  BentLeg leg{bound.rest_pose(), bound.rest_line()};
  const Quat<float> thigh = rotation({1, 0, 0}, -hip), shank = rotation({1, 0, 0}, knee - hip);
  const Vec hip_at = to_double(leg.pose.position_m[index(thigh_right)]),
            knee_at = to_double(leg.pose.position_m[index(shank_right)]);
  leg.pose.rotation[index(thigh_right)] = thigh;
  leg.pose.rotation[index(shank_right)] = shank;
  leg.pose.position_m[index(shank_right)] = to_float(hip_at + rotated(to_double(thigh), knee_at - hip_at));
  leg.line.start_m = to_float(hip_at + rotated(to_double(thigh), to_double(leg.line.start_m) - hip_at));
  leg.line.rotation = product(thigh, leg.line.rotation);
  return leg;
}

RC_GTEST_PROP(Skinning, NeighboursStayNeighboursAcrossTheEnds, ()) {
  // Displacement differs along an edge by at most the edge times a bounded strain: the surface does not tear.
  static const Bound bound;
  const BentLeg leg = bent(bound, *rc::gen::inRange(-20, 60) * 0.01, *rc::gen::inRange(0, 100) * 0.01);
  // the lattice bulges and is drawn out towards its far end
  std::vector<float> u;
  for (const auto& q : bound.mesh.node) {
    const double t = q.z / 0.25;
    const Vec3<float> d = to_float(Vec{0.2 * q.x * std::sin(3.14 * t), 0.2 * q.y * std::sin(3.14 * t), 0.015 * t});
    u.insert(u.end(), {d.x, d.y, d.z});
  }
  const auto out = bound.skin(leg.pose, leg.line, u);
  const auto& mesh = bound.surface.mesh;
  for (std::size_t t = 0; t < mesh.triangle.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = mesh.triangle[t + k], b = mesh.triangle[t + (k + 1) % 3];
      const double rest = distance(mesh.position[a], mesh.position[b]), now = distance(out[a], out[b]);
      RC_ASSERT(now < 5 * rest + 2e-3);
    }
  }
}

RC_GTEST_PROP(Skinning, LeftIsTheMirrorImageOfRight, ()) {
  static const Bound bound;
  const BentLeg leg = bent(bound, *rc::gen::inRange(-20, 60) * 0.01, *rc::gen::inRange(0, 100) * 0.01);
  Pose<float> mirrored{};
  for (std::size_t s = 0; s < segment_count; ++s) {
    const auto segment = static_cast<Segment>(s);
    const bool is_right = segment_name[s].ends_with("_right");
    if (segment_name[s].ends_with("_left")) continue;
    const std::size_t to = is_right ? index(on_side(segment, Side::left)) : s;
    const auto& p = leg.pose.position_m[s];
    const auto& q = leg.pose.rotation[s];
    mirrored.position_m[to] = {-p.x, p.y, p.z};
    mirrored.rotation[to] = {q.x, -q.y, -q.z, q.w};
  }
  std::vector<float> u;
  for (std::uint32_t n = 0; n < 3 * bound.nodes(); ++n) u.push_back(0.004F * std::sin(static_cast<float>(n)));
  const auto r = bound.skin(leg.pose, leg.line, u);
  const auto l = bound.skin(mirrored, leg.line, u, Side::left);
  for (std::size_t v = 0; v < r.size(); ++v) RC_ASSERT(distance({-r[v].x, r[v].y, r[v].z}, l[v]) < 1e-6);
}

RC_GTEST_PROP(Skinning, BlocksHoldTheBitsOfOneVertexAtATime, (bool large)) {
  const HexahedralMesh mesh = lattice(large ? Cells{12, 12, 26} : Cells{3, 3, 10});
  static const Bound bound;
  MuscleSurface surface = bound.surface;
  bind_surface(surface, mesh, bound.frame, blend_m);
  const BentLeg leg = bent(bound, *rc::gen::inRange(-20, 60) * 0.01, *rc::gen::inRange(0, 100) * 0.01);
  std::vector<float> u(3 * node_count(mesh.cells));
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = 0.01F * std::sin(static_cast<float>(i));
  for (const Side side : {Side::right, Side::left}) {
    const auto a = skinned(surface, side, bound.b, leg.pose, leg.line, u);
    const auto b = skinned_one_by_one(surface, side, bound.b, leg.pose, leg.line, u);
    for (std::size_t v = 0; v < a.size(); ++v) RC_ASSERT(a[v].x == b[v].x && a[v].y == b[v].y && a[v].z == b[v].z);
  }
}

TEST(Ligament, FollowsItsBonesAtItsEnds) {
  const Bound bound;
  auto ligament = make_muscle_surfaces(bound.b).back();
  ASSERT_TRUE(ligament.ligament);
  auto& surface = ligament.surface;
  bind_ligament(surface, surface.mesh.position.front(), surface.mesh.position.back());
  BentLeg leg = bent(bound, 0.3, 0.8);
  const std::vector<float> u(3, 0.0F);
  leg.pose.position_m[index(Segment::patella_right)].y += 0.02F;
  const auto out = skinned(surface, Side::right, bound.b, leg.pose, leg.line, u);
  const Pose<float> rest = bound.rest_pose();
  const auto follow = [&](Segment bone, const Vec3<float>& p) {
    const std::size_t s = index(bone);
    return rotated(to_double(leg.pose.rotation[s]), to_double(p) - to_double(rest.position_m[s])) +
           to_double(leg.pose.position_m[s]);
  };
  EXPECT_LT(length(to_double(out.front()) - follow(surface.origin, surface.mesh.position.front())), 1e-5);
  EXPECT_LT(length(to_double(out.back()) - follow(surface.insertion, surface.mesh.position.back())), 1e-5);
}

TEST(Normals, OfAnEllipsoidAreExact) {
  const Vec semi{0.05, 0.08, 0.12};
  const SurfaceMesh mesh = ellipsoid({0, 0, 0}, semi, 60, 64);
  const RigidSurface rigid = pack_rigid(mesh).value();
  std::vector<float> out(6 * rigid.vertices);
  const auto bytes = std::as_writable_bytes(std::span(out)).data();
  write_rigid(rigid, affine_map({{1, 2, 3}, {0, 0, 0, 1}}), {bytes, bytes + 12, 24, 24});
  for (std::size_t v = 0; v < rigid.vertices; ++v) {
    const Vec p = to_double(mesh.position[v]);
    const Vec exact = normalised(Vec{p.x / (semi.x * semi.x), p.y / (semi.y * semi.y), p.z / (semi.z * semi.z)});
    const Vec n = to_double(Vec3<float>{out[6 * v + 3], out[6 * v + 4], out[6 * v + 5]});
    EXPECT_GT(dot(n, exact), std::cos(0.02)) << v;
    EXPECT_NEAR(length(n), 1, 1e-6);
  }
}

/// Vertex rings that lack neighbours, have more than six, meet only in one vertex, or are empty.
TEST(Normals, RingsAreSumsOfTheirTriangles) {
  SurfaceMesh mesh;
  for (int i = 0; i < 15; ++i) {
    const float a = 0.9F * static_cast<float>(i);
    mesh.position.push_back({std::cos(a) * (1 + 0.1F * a), std::sin(a), 0.2F * std::sin(3 * a)});
  }
  mesh.position.push_back({0, 0, 0.5F});  // 15: in the middle of a fan of each size
  mesh.position.push_back({9, 9, 9});     // 16: without triangles
  for (std::uint32_t fan = 1; fan <= 13; ++fan) {
    for (const bool closed : {false, true}) {
      mesh.triangle.clear();
      for (std::uint32_t i = 0; i < fan; ++i) mesh.triangle.insert(mesh.triangle.end(), {15, i, i + 1});
      if (closed) mesh.triangle.insert(mesh.triangle.end(), {15, fan, 0});
      if (fan == 7) mesh.triangle.insert(mesh.triangle.end(), {15, 10, 11, 15, 13, 14});
      const RigidSurface rigid = pack_rigid(mesh).value();
      for (std::size_t v = 0; v < mesh.position.size(); ++v) {
        const Vec3<Eight>& n = rigid.block[v / block_vertices].normal;
        const Vec is = to_double(Vec3<float>{n.x.lane[v % 8], n.y.lane[v % 8], n.z.lane[v % 8]});
        EXPECT_LT(length(is - triangle_normals(mesh.position, mesh.triangle)[v]), 1e-5) << fan << ' ' << v;
      }
    }
  }
}

TEST(PackSurface, RefusalsNameTheMistake) {
  const Bound bound;
  const auto error = [&](const MuscleSurface& s, std::uint32_t nodes) {
    const auto packed = pack_surface(s, bound.b, nodes);
    return packed ? std::string("nothing") : packed.error().message;
  };
  EXPECT_EQ(error(bound.surface, bound.nodes()), "nothing");
  EXPECT_NE(error(bound.surface, 8).find("of a mesh of 8"), std::string::npos);
  MuscleSurface changed = bound.surface;
  changed.binding.pop_back();
  EXPECT_NE(error(changed, bound.nodes()).find("are bound"), std::string::npos);
  changed = bound.surface;
  changed.mesh.triangle[0] = 5000;
  EXPECT_NE(error(changed, bound.nodes()).find("vertex 5000"), std::string::npos);
  changed = bound.surface;
  for (int i = 0; i < 50; ++i) {
    changed.mesh.position.insert(changed.mesh.position.end(), bound.surface.mesh.position.begin(),
                                 bound.surface.mesh.position.end());
    changed.binding.insert(changed.binding.end(), bound.surface.binding.begin(), bound.surface.binding.end());
    changed.rest_in_lattice.insert(changed.rest_in_lattice.end(), bound.surface.rest_in_lattice.begin(),
                                   bound.surface.rest_in_lattice.end());
  }
  EXPECT_NE(error(changed, bound.nodes()).find("simplify it"), std::string::npos);
}

}  // namespace mobil::skinning_test
