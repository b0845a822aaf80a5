// Generated surfaces are closed, wound outwards and deterministic, and follow the requested body.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <mobil/anthropometry.h>
#include <mobil/assets/muscles/leg_sections.h>
#include <mobil/assets/surfaces/muscle_surfaces.h>
#include <mobil/engine/geometry.h>
#include <mobil/muscle_table.h>
#include "assets/surfaces/bone_surfaces.h"
#include "assets/surfaces/leg_bones.h"
#include "assets/surfaces/surface_mesh.h"
#include "assets/surfaces/tube.h"

namespace mobil::surfaces_test {
using namespace geometry;

/// Succeeds if every directed edge and its reverse occur once, every vertex is used, and no number is NaN.
::testing::AssertionResult closed(const SurfaceMesh& mesh) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  std::vector<bool> used(mesh.position.size(), false);
  for (std::size_t t = 0; t < mesh.triangle.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = mesh.triangle[t + k], b = mesh.triangle[t + (k + 1) % 3];
      if (a >= mesh.position.size() || a == b) return ::testing::AssertionFailure() << mesh.name << ": bad triangle";
      if (!edges.emplace(a, b).second) return ::testing::AssertionFailure() << mesh.name << ": edge used twice";
      used[a] = true;
    }
  }
  for (const auto& [a, b] : edges) {
    if (!edges.contains({b, a})) return ::testing::AssertionFailure() << mesh.name << ": open edge";
  }
  if (!std::all_of(used.begin(), used.end(), [](bool u) { return u; })) {
    return ::testing::AssertionFailure() << mesh.name << ": unused vertex";
  }
  for (const auto& p : mesh.position) {
    if (!std::isfinite(p.x + p.y + p.z)) return ::testing::AssertionFailure() << mesh.name << ": not finite";
  }
  return ::testing::AssertionSuccess() << mesh.name;
}

/// Returns the connected parts of the mesh.
std::vector<SurfaceMesh> parts(const SurfaceMesh& mesh) {
  std::vector<std::uint32_t> root(mesh.position.size());
  for (std::uint32_t i = 0; i < root.size(); ++i) root[i] = i;
  const auto find = [&](std::uint32_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (std::size_t t = 0; t < mesh.triangle.size(); t += 3) {
    for (std::size_t k = 1; k < 3; ++k) root[find(mesh.triangle[t + k])] = find(mesh.triangle[t]);
  }
  std::map<std::uint32_t, SurfaceMesh> by_root;
  for (std::size_t t = 0; t < mesh.triangle.size(); t += 3) {
    SurfaceMesh& part = by_root[find(mesh.triangle[t])];
    if (part.position.empty()) part.position = mesh.position;
    part.triangle.insert(part.triangle.end(), {mesh.triangle[t], mesh.triangle[t + 1], mesh.triangle[t + 2]});
  }
  std::vector<SurfaceMesh> all;
  for (auto& [r, part] : by_root) all.push_back(std::move(part));
  return all;
}

Body body(float height = 1.75F, float mass = 75.0F) {
  return make_body({.height_m = height, .mass_kg = mass}).value();
}

std::vector<Vec> standing(const Body& b) {
  std::vector<Vec> at;
  for (const auto& p : standing_pose(b).position_m) at.push_back(to_double(p));
  return at;
}

double nearest(const SurfaceMesh& mesh, const Vec& point) {
  double best = 1e9;
  for (const auto& p : mesh.position) best = std::min(best, length(to_double(p) - point));
  return best;
}

const GroupSurface& named(const std::vector<GroupSurface>& all, std::string_view name) {
  return *std::find_if(all.begin(), all.end(), [&](const auto& s) { return s.surface.mesh.name == name; });
}

RC_GTEST_PROP(Tube, IsClosedAndHoldsTheVolumeOfItsSections, ()) {
  // a straight tube of equal ellipses: the prism's volume and two half ellipsoids, less the polygon's difference
  const double a = *rc::gen::inRange(5, 50) * 0.001, b = *rc::gen::inRange(5, 50) * 0.001;
  const double h = *rc::gen::inRange(50, 500) * 0.001, turn = *rc::gen::inRange(0, 314) * 0.01;
  const Vec axis = normalised(Vec{*rc::gen::inRange(-5, 6) + 0.1, *rc::gen::inRange(-5, 6) + 0.2, 3.0});
  const std::array<TubeStation, 3> line = {
      TubeStation{{0, 0, 0}, a, b, turn}, {0.5 * h * axis, a, b, turn}, {h * axis, a, b, turn}};
  const SurfaceMesh mesh = loft(line, {.reference = {1, 0, 0}, .rings = 5, .segments = 64, .cap = 0});
  RC_ASSERT(std::abs(enclosed_volume(mesh) / (3.14159265 * a * b * h) - 1) < 0.003);
  const SurfaceMesh capped = loft(line, {.reference = {1, 0, 0}, .rings = 5, .segments = 12, .cap = 0.7});
  RC_ASSERT(static_cast<bool>(closed(capped)));
  RC_ASSERT(enclosed_volume(capped) > 0.95 * enclosed_volume(mesh));
}

TEST(Tube, PassesThroughItsStations) {
  const std::array<TubeStation, 4> line = {
      TubeStation{{0, 0, 0}, 2, 1, 0.3}, {{1, 4, 2}, 3, 1, 1.2}, {{2, 9, 3}, 1, 1, 0}, {{0, 15, 3}, 2, 0.5, -0.4}};
  double total = 0;
  std::vector<double> at{0};
  for (std::size_t i = 1; i < line.size(); ++i) at.push_back(total += length(line[i].centre - line[i - 1].centre));
  for (std::size_t i = 0; i < line.size(); ++i) {
    const TubeSection s = tube_section(line, at[i] / total);
    EXPECT_LT(length(s.centre - line[i].centre), 1e-9);
    EXPECT_NEAR(s.uu * s.vv - s.uv * s.uv, line[i].semi_u * line[i].semi_v, 1e-9);  // the area
    EXPECT_NEAR(s.uu + s.vv, line[i].semi_u + line[i].semi_v, 1e-9);
  }
  for (double t = 0; t <= 1; t += 0.01) {
    const TubeSection s = tube_section(line, t);
    EXPECT_GT(s.uu * s.vv, s.uv * s.uv) << t;
  }
}

TEST(BoneSurfaces, EverySegmentHasClosedPartsWoundOutwards) {
  const auto bones = make_bone_surfaces(body());
  ASSERT_EQ(bones.size(), segment_count);
  std::size_t triangles = 0;
  for (std::size_t s = 0; s < segment_count; ++s) {
    EXPECT_EQ(index(bones[s].segment), s);
    EXPECT_TRUE(closed(bones[s].mesh));
    for (const auto& part : parts(bones[s].mesh)) EXPECT_GT(enclosed_volume(part), 1e-9) << bones[s].mesh.name;
    triangles += bones[s].mesh.triangle.size() / 3;
  }
  EXPECT_LT(triangles, 60000U);
  EXPECT_GT(triangles, 25000U);
}

TEST(BoneSurfaces, AreAroundTheirJoints) {
  for (const float height : {1.2F, 1.75F, 2.2F}) {
    const Body b = body(height);
    const auto bones = make_bone_surfaces(b);
    const double near = 0.03 * static_cast<double>(height) / 1.75;
    using enum Segment;
    for (const Segment s : {thigh_right, shank_right, upper_arm_right, forearm_right, hand_right, fingers_right,
                            clavicle_right, foot_right, toes_right, thigh_left, shank_left, L5, L1, T12, T5, C7, C2}) {
      const auto& mesh = bones[index(s)].mesh;
      EXPECT_LT(nearest(mesh, {0, 0, 0}), near) << segment_name[index(s)];
      EXPECT_LT(nearest(mesh, to_double(b.tip_m[index(s)])), near) << segment_name[index(s)];
    }
    // the femoral head is a ball of 23 mm in a man of 1.69 m, around the hip
    double top = 0;
    for (const auto& p : bones[index(thigh_right)].mesh.position) top = std::max(top, static_cast<double>(p.y));
    EXPECT_NEAR(top, 23e-3 * static_cast<double>(b.size.leg_scale_m) / 1.69, 5e-4);
  }
}

TEST(BoneSurfaces, HaveTheBodysHeight) {
  for (const float height : {1.3F, 1.8F, 2.1F}) {
    const Body b = body(height);
    const auto at = standing(b);
    double low = 1e9, high = -1e9;
    for (const auto& bone : make_bone_surfaces(b)) {
      for (const auto& p : bone.mesh.position) {
        const double y = static_cast<double>(p.y) + at[index(bone.segment)].y;
        low = std::min(low, y);
        high = std::max(high, y);
      }
    }
    const auto h = static_cast<double>(height);
    EXPECT_NEAR(low, 0, 0.012 * h);
    EXPECT_GT(low, -0.003 * h);
    EXPECT_NEAR(high, h, 0.012 * h);
  }
}

TEST(BoneSurfaces, LeftIsTheMirrorImageOfRight) {
  const auto bones = make_bone_surfaces(body());
  for (std::size_t s = 0; s < segment_count; ++s) {
    if (!segment_name[s].ends_with("_right")) continue;
    const std::size_t other = index(on_side(static_cast<Segment>(s), Side::left));
    const auto &r = bones[s].mesh, &l = bones[other].mesh;
    ASSERT_EQ(r.position.size(), l.position.size());
    for (std::size_t i = 0; i < r.position.size(); ++i) {
      ASSERT_EQ(r.position[i].x, -l.position[i].x);
      ASSERT_EQ(r.position[i].y, l.position[i].y);
      ASSERT_EQ(r.position[i].z, l.position[i].z);
    }
    EXPECT_GT(enclosed_volume(l), 0);
  }
}

TEST(MuscleSurfaces, AreClosedAndHoldTheirVolumes) {
  for (const auto& b : {body(1.5F, 45), body(1.75F, 75), body(2.0F, 110)}) {
    const auto muscles = make_muscle_surfaces(b, muscle_members());
    std::vector<double> volumes;
    for (const GroupSurface& one : muscles) {
      if (!is_single_muscle(one.muscle)) continue;  // tendons and ligaments
      double& sum = volumes.emplace_back(0);
      for (const MemberMuscle& line : members_of(one.muscle)) sum += member_volume_m3(b, line);
    }
    ASSERT_EQ(muscles.size(), volumes.size() + 3);
    for (std::size_t m = 0; m < muscles.size(); ++m) {
      const auto& mesh = muscles[m].surface.mesh;
      EXPECT_TRUE(closed(mesh));
      EXPECT_EQ(muscles[m].tendon.size(), mesh.position.size());
      EXPECT_GT(enclosed_volume(mesh), 0);
      if (m < volumes.size()) {
        EXPECT_NEAR(enclosed_volume(mesh) / volumes[m], 1, 0.05) << mesh.name;
      }
      for (const auto& p : mesh.position) ASSERT_LT(p.x, 0.02F) << mesh.name;  // the right leg
    }
  }
}

TEST(MuscleSurfaces, AreOutsideTheBones) {
  for (const Body& b : {body(1.5F, 45), body(1.75F, 75), body(2.0F, 110)}) {
    const LegBones bones(b);
    for (const auto& m : make_muscle_surfaces(b, muscle_members())) {
      const MuscleSurface& s = m.surface;
      for (std::size_t v = 0; v < s.mesh.position.size(); ++v) {
        const bool is_held = (v < s.origin_held.size() && s.origin_held[v] > 0) ||
                             (v < s.insertion_held.size() && s.insertion_held[v] > 0);
        if (is_held || m.ligament) continue;
        for (const Segment bone : LegBones::hard)
          ASSERT_GT(bones.distance(bone, to_double(s.mesh.position[v])), -0.002) << s.mesh.name << " vertex " << v;
      }
    }
  }
}

TEST(MuscleSurfaces, ReachTheirBones) {
  const Body b = body();
  const LegBones bones(b);
  const auto all = make_muscle_surfaces(b, muscle_members());
  const auto off = [&](Segment segment, const Vec3<float>& p) {
    return std::abs(bones.distance(segment, to_double(p)));
  };
  for (const auto& m : all) {
    const SurfaceMesh& mesh = m.surface.mesh;
    if (m.ligament) continue;
    const bool begins_in_muscle = mesh.name.starts_with("calcaneal") || mesh.name.starts_with("iliotibial");
    if (!begins_in_muscle) {
      EXPECT_LT(off(m.surface.origin, mesh.position.front()), 0.002) << mesh.name;
    }
    const bool ends_in_tract = mesh.name.starts_with("tensor");
    const bool ends_in_tendon =
        mesh.name.starts_with("gastrocnemius") || mesh.name.starts_with("soleus") || ends_in_tract;
    if (!ends_in_tendon) {
      EXPECT_LT(off(m.surface.insertion, mesh.position.back()), 0.002) << mesh.name;
    } else {
      const Vec last = to_double(mesh.position.back());
      const char* const tendon = ends_in_tract ? "iliotibial_tract_right" : "calcaneal_tendon_right";
      EXPECT_LT(nearest(named(all, tendon).surface.mesh, last), 0.025) << mesh.name;
    }
  }
}

TEST(MuscleSurfaces, LookLikeALeg) {
  const Body b = body();
  const double thigh = static_cast<double>(b.hip_height_m - 0.5F * b.thigh_length_m);
  const double calf = static_cast<double>(b.hip_height_m - b.thigh_length_m - 0.3F * b.shank_length_m);
  const LegFrame leg = leg_frame(b);
  const auto bone_z = [&](std::span<const LegSection> s, double y) {
    return leg_ellipse(s, leg_level(leg, y))->anterior * leg.unit;
  };
  for (const auto& m : make_muscle_surfaces(b)) {
    if (m.ligament || m.surface.mesh.name.starts_with("calcaneal")) continue;
    const bool below_knee = m.group == Muscle::triceps_surae || m.group == Muscle::tibialis_anterior;
    const double y = below_knee ? calf : thigh;
    double z = 0;
    int count = 0;
    for (const auto& p : m.surface.mesh.position) {
      if (std::abs(static_cast<double>(p.y) - y) > 0.03) continue;
      z += static_cast<double>(p.z);
      ++count;
    }
    ASSERT_GT(count, 0) << m.surface.mesh.name;
    z /= count;
    const double femur_z = below_knee ? 0 : bone_z(femur_sections(), y);
    if (m.group == Muscle::quadriceps) {
      EXPECT_GT(z, femur_z - 0.01) << m.surface.mesh.name;
    } else if (m.group == Muscle::hamstrings) {
      EXPECT_LT(z, femur_z - 0.01) << m.surface.mesh.name;
    } else if (m.group == Muscle::tibialis_anterior) {
      EXPECT_GT(z, bone_z(tibia_sections(), y)) << m.surface.mesh.name;
    } else {
      EXPECT_LT(z, bone_z(tibia_sections(), y) - 0.02) << m.surface.mesh.name;
    }
  }
}

TEST(MuscleSurfaces, TendonsAreAtTheEndsAndTheBellyBetween) {
  for (const auto& m : make_muscle_surfaces(body())) {
    EXPECT_GT(m.tendon.front(), 0.6F) << m.surface.mesh.name;
    EXPECT_GT(m.tendon.back(), 0.9F) << m.surface.mesh.name;
    const bool belly = std::count(m.tendon.begin(), m.tendon.end(), 0.0F) > 0;
    EXPECT_EQ(belly, !m.ligament && !m.surface.mesh.name.starts_with("calcaneal")) << m.surface.mesh.name;
  }
}

TEST(Surfaces, FollowTheirMuscleOrGroupAndTendonsAnyOfThem) {
  const auto set = [](std::initializer_list<Muscle> muscles) {
    MuscleSet s;
    for (const Muscle m : muscles) s.set(static_cast<std::size_t>(m));
    return s;
  };
  const Muscle group = Muscle::triceps_surae, soleus = find_muscle("soleus").value(),
               medial = find_muscle("gastrocnemius_medial").value();
  EXPECT_EQ(driving_muscle(set({group, soleus}), group, soleus), soleus);
  EXPECT_EQ(driving_muscle(set({group, soleus}), group, medial), group);
  EXPECT_EQ(driving_muscle(set({soleus}), group, medial), std::nullopt);
  EXPECT_EQ(driving_muscle(set({soleus, medial}), group, group), soleus);  // the tendon
  EXPECT_EQ(driving_muscle(set({Muscle::hamstrings}), group, group), std::nullopt);
}

}  // namespace mobil::surfaces_test
