// Texture coordinates, tangents, and coarser surfaces for the middle distance.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <tuple>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/engine/geometry.h>
#include <mobil/engine/world.h>
#include <mobil/far_figure.h>
#include <mobil/simulation.h>
#include <mobil/surfaces.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/systems/surfaces/write_vertices.h>
#include "tests/engine/instruction_sets.h"
#include "tests/refused.h"
#include "tests/simulation/people.h"

namespace mobil::texture_test {
using namespace geometry;

struct Vertex {
  Vec3<float> position, normal, tangent;
  float handed;
};

/// Returns a tube of radius 0.1 m along y from 0 down to −1, bent forward by `bend` rad, open at both ends.
SurfaceMesh tube(float bend) {
  constexpr std::uint32_t around = 16, rings = 21;
  SurfaceMesh mesh;
  mesh.name = "tube";
  for (std::uint32_t r = 0; r < rings; ++r) {
    const float down = static_cast<float>(r) / (rings - 1), turn = bend * down;
    const Vec3<float> centre =
        bend == 0 ? Vec3<float>{0, -down, 0} : Vec3<float>{0, -std::sin(turn) / bend, (1 - std::cos(turn)) / bend};
    for (std::uint32_t k = 0; k < around; ++k) {
      const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(k) / around;
      const float x = 0.1F * std::sin(angle), z = 0.1F * std::cos(angle);
      mesh.position.push_back(centre + Vec3<float>{x, z * std::sin(turn), z * std::cos(turn)});
      if (r + 1 == rings) continue;
      const std::uint32_t p = r * around + k, q = r * around + (k + 1) % around;
      for (const std::uint32_t v : {p, p + around, q, q, p + around, q + around}) mesh.triangle.push_back(v);
    }
  }
  return mesh;
}

/// Coordinates of a straight tube: distance down, and angle from the front.
TEST(Texture, CoordinatesOfATubeAreItsLengthAndAngle) {
  const SurfaceMesh mesh = tube(0);
  const auto place = texture_places(mesh.position);
  for (std::size_t v = 0; v < place.size(); ++v) {
    const Vec3<float>& p = mesh.position[v];
    EXPECT_NEAR(place[v].along, -p.y, 1e-5F);
    EXPECT_NEAR(std::abs(place[v].around), std::atan2(std::abs(p.x), p.z) / std::numbers::pi_v<float>, 1e-4F);
    if (std::abs(p.x) < 1e-3F) continue;
    EXPECT_EQ(place[v].around<0, p.x> 0);  // the axis points down: left of it is −x
  }
}

/// On a straight or bent tube, tangents run down it, and normal × tangent points to the back.
TEST(Texture, TangentsOfATubeRunAlongIt) {
  for (const float bend : {0.0F, 0.5F}) {
    const SurfaceMesh mesh = tube(bend);
    const auto place = texture_places(mesh.position);
    const auto rigid = pack_rigid(mesh, along_stencils(mesh.triangle, place));
    ASSERT_TRUE(rigid);
    std::vector<Vertex> out(mesh.position.size());
    auto* const bytes = reinterpret_cast<std::byte*>(out.data());
    write_rigid(*rigid, affine_map({{0, 0, 0}, {0, 0, 0, 1}}),
                {bytes, bytes + 12, sizeof(Vertex), sizeof(Vertex), bytes + 24, sizeof(Vertex)});
    for (std::size_t v = 0; v < out.size(); ++v) {
      const float turn = bend * static_cast<float>(v / 16) / 20;
      const Vec3<float> down{0, -std::cos(turn), std::sin(turn)};
      EXPECT_NEAR(length(out[v].tangent), 1, 1e-5F);
      EXPECT_NEAR(dot(out[v].tangent, out[v].normal), 0, 1e-5F);
      const bool end = v < 16 || v + 16 >= out.size();  // with half of the triangles
      EXPECT_GT(dot(out[v].tangent, down), end ? 0.97F : 0.99F) << v;
      const std::size_t k = v % 16;
      if (k == 0 || k == 8) continue;  // front and back: either side is equally near
      const float to_back = k < 8 ? 1.0F : -1.0F;
      const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(k) / 16;
      const Vec3<float> backward{to_back * std::cos(angle), -to_back * std::sin(angle) * std::sin(turn),
                                 -to_back * std::sin(angle) * std::cos(turn)};
      EXPECT_GT(out[v].handed * dot(cross(out[v].normal, out[v].tangent), backward), 0.9F) << v;
    }
  }
}

/// Distance of a point from a triangle, m.
double from_triangle(const Vec3<float>& p, const Vec3<float>& a, const Vec3<float>& b, const Vec3<float>& c) {
  const auto from_edge = [&](const Vec3<float>& u, const Vec3<float>& w) {
    const Vec3<float> way = w - u;
    const float t = std::clamp(dot(p - u, way) / std::max(dot(way, way), 1e-12F), 0.0F, 1.0F);
    return static_cast<double>(length(p - (u + t * way)));
  };
  const Vec3<float> n = cross(b - a, c - a);
  const bool inside =
      dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 && dot(cross(a - c, p - c), n) >= 0;
  if (inside && length(n) > 0) return static_cast<double>(std::abs(dot(p - a, n)) / length(n));
  return std::min({from_edge(a, b), from_edge(b, c), from_edge(c, a)});
}

struct Walker {
  Simulation simulation{sharing()};
  Entity person;
  Person subject;
  std::vector<SurfaceMuscle> muscles;

  Walker() {
    person = *simulation.spawn({.height_m = 1.72F, .mass_kg = 70}, {.speed_m_s = 1.3F});
    EXPECT_TRUE(simulation.set_muscles(person));
    for (int i = 0; i < 47; ++i) simulation.tick();
    subject = *simulation.person(person);
    for (const PersonMuscle& own : subject.muscles) muscles.push_back({own.plan.muscle, own.entity});
  }
  SurfaceRequest request(const BodySurfaces& surfaces, std::vector<Vertex>& out) const {
    const auto bytes = std::as_writable_bytes(std::span(out));
    SurfaceRequest one{.person = person, .muscles = muscles, .surfaces = &surfaces};
    one.positions = {bytes, sizeof(Vertex)};
    one.normals = {bytes.subspan(offsetof(Vertex, normal)), sizeof(Vertex)};
    one.tangents = {bytes.subspan(offsetof(Vertex, tangent)), sizeof(Vertex)};
    return one;
  }
  std::vector<Vertex> show(const BodySurfaces& surfaces, bool tangents) const {
    std::vector<Vertex> out(surfaces.vertices);
    SurfaceRequest one = request(surfaces, out);
    if (!tangents) one.tangents.bytes = {};
    SurfaceWriter writer;
    const auto done = writer.write(simulation.world(), {&one, 1});
    EXPECT_TRUE(done) << done.error().message;
    return out;
  }
};

/// On the bent legs of a walker, tangents are perpendicular to normals, and points farther along are ahead.
TEST(Texture, TangentsOfAWalkerRunAlongMusclesAndBones) {
  const Walker walker;
  const BodySurfaces surfaces = *bind_surfaces(walker.subject.body, {.textured = true});
  ASSERT_EQ(surfaces.texture.size(), surfaces.vertices);
  const auto out = walker.show(surfaces, true);
  for (std::size_t v = 0; v < out.size(); ++v) {
    ASSERT_NEAR(length(out[v].tangent), 1, 1e-4F) << v;
    ASSERT_NEAR(dot(out[v].tangent, out[v].normal), 0, 1e-4F) << v;
    ASSERT_EQ(std::abs(out[v].handed), 1) << v;
    ASSERT_TRUE(surfaces.texture[v].along >= 0 && surfaces.texture[v].along <= 1);
    ASSERT_TRUE(surfaces.texture[v].around >= 0 && surfaces.texture[v].around <= 1);
  }
  std::size_t right_way = 0, all = 0, to_back = 0, sided = 0;
  for (const SurfacePart& part : surfaces.part) {
    if (!part.driver) continue;
    for (std::uint32_t i = 0; i < part.indices; ++i) {
      const std::uint32_t a = surfaces.index[part.first_index + i];
      const std::uint32_t b = surfaces.index[part.first_index + (i % 3 == 2 ? i - 2 : i + 1)];
      const TexturePlace &from = surfaces.texture[a], &to = surfaces.texture[b];
      const Vec3<float> way = out[b].position - out[a].position;
      if (std::abs(to.along - from.along) > 0.01F) {
        ++all;
        right_way += (to.along > from.along) == (dot(way, out[a].tangent) > 0) ? 1 : 0;
      }
      if (std::abs(to.around - from.around) > 0.05F && std::min(from.around, to.around) > 0.05F &&
          std::max(from.around, to.around) < 0.95F) {
        ++sided;
        const float beside = out[a].handed * dot(way, cross(out[a].normal, out[a].tangent));
        to_back += (to.around > from.around) == (beside > 0) ? 1 : 0;
      }
    }
  }
  std::printf("%zu of %zu edges go along, %zu of %zu round\n", right_way, all, to_back, sided);
  EXPECT_GT(right_way, all * 98 / 100);
  EXPECT_GT(to_back, sided * 94 / 100);
}

TEST(Texture, OnlyTangentsAreAddedEquallyOnEveryProcessor) {
  const Walker walker;
  const BodySurfaces plain = *bind_surfaces(walker.subject.body),
                     textured = *bind_surfaces(walker.subject.body, {.textured = true});
  EXPECT_TRUE(plain.texture.empty());
  const auto without = walker.show(plain, false), with = walker.show(textured, true);
  ASSERT_EQ(without.size(), with.size());
  for (std::size_t v = 0; v < with.size(); ++v)
    ASSERT_EQ(std::memcmp(&without[v], &with[v], 2 * sizeof(Vec3<float>)), 0) << v;
  for_each_fused_instruction_set([&] {
    const auto here = walker.show(textured, true);
    EXPECT_EQ(std::memcmp(here.data(), with.data(), with.size() * sizeof with[0]), 0);
  });
}

TEST(Texture, InvalidRequestsAreRefused) {
  const Walker walker;
  const BodySurfaces plain = *bind_surfaces(walker.subject.body),
                     textured = *bind_surfaces(walker.subject.body, {.textured = true});
  std::vector<Vertex> out(plain.vertices);
  const auto says = [&](const SurfaceRequest& one, const char* what) {
    SurfaceWriter writer;
    EXPECT_TRUE(is_refused(writer.write(walker.simulation.world(), {&one, 1}), what)) << what;
  };
  says(walker.request(plain, out), "textured");
  SurfaceRequest one = walker.request(textured, out);
  one.normals.bytes = {};
  says(one, "normals");
  one = walker.request(textured, out);
  one.tangents.stride = 12;
  says(one, "at least 16");
  one = walker.request(textured, out);
  one.tangents.bytes = one.tangents.bytes.subspan(0, 100);
  says(one, "are needed");
  one = walker.request(textured, out);
  one.tangents.bytes = one.normals.bytes.subspan(8);
  says(one, "tangents lie over normals");
  EXPECT_FALSE(bind_surfaces(walker.subject.body, {.detail = 0}));
  EXPECT_FALSE(bind_surfaces(walker.subject.body, {.detail = 2}));
}

/// Every piece still exists, has its own vertices, and is near the fine one on a walker.
TEST(Coarser, SurfacesAreNearTheFineOnes) {
  const Walker walker;
  const BodySurfaces fine = *bind_surfaces(walker.subject.body);
  const auto is = walker.show(fine, false);
  double before = 1;
  for (const auto& [share, mean_mm, max_mm] : {std::tuple{0.3, 1.0, 20.0}, {0.1, 2.0, 60.0}, {0.05, 4.0, 125.0}}) {
    const BodySurfaces coarse = *bind_surfaces(walker.subject.body, {.detail = share, .textured = true});
    const auto out = walker.show(coarse, true);
    ASSERT_EQ(coarse.part.size(), fine.part.size());
    double sum = 0, farthest = 0;
    for (std::size_t p = 0; p < fine.part.size(); ++p) {
      const SurfacePart &from = fine.part[p], &part = coarse.part[p];
      EXPECT_EQ(part.name, from.name);
      EXPECT_GT(part.indices, 0U) << from.name;
      // Distance of fine vertices from the nearest point of the coarse triangles: the visible change.
      for (std::uint32_t v = 0; v < from.vertices; v += 7) {
        const Vec3<float> at = is[from.first_vertex + v].position;
        double nearest = 1e9;
        for (std::uint32_t t = 0; t < part.indices; t += 3) {
          const std::uint32_t* corner = &coarse.index[part.first_index + t];
          nearest = std::min(
              nearest, from_triangle(at, out[corner[0]].position, out[corner[1]].position, out[corner[2]].position));
        }
        farthest = std::max(farthest, nearest);
        sum += nearest;
      }
    }
    const double mean = 7 * sum / fine.vertices;
    const double kept = static_cast<double>(coarse.index.size()) / static_cast<double>(fine.index.size());
    std::printf("%.2f of the triangles, %u vertices of %u: off by %.2f mm in the mean, %.1f at most\n", kept,
                coarse.vertices, fine.vertices, 1000 * mean, 1000 * farthest);
    EXPECT_LT(kept, 1.25 * share);
    EXPECT_LT(1000 * mean, mean_mm);
    EXPECT_LT(1000 * farthest, max_mm);
    EXPECT_LT(kept, before);
    before = kept;
  }
}

TEST(FarFigure, HasItsBodysSizeAndIsWoundOutwards) {
  const FarFigure figure = far_figure();
  EXPECT_EQ(sizeof(FarVertex), 28U);
  ASSERT_EQ(figure.index.size() % 3, 0U);
  std::array<std::size_t, segment_count> of_segment{};
  for (const FarVertex& v : figure.vertex) {
    ASSERT_LT(v.segment, segment_count);
    ASSERT_LT(v.part, skin_parts);
    EXPECT_NEAR(length(v.normal), 1, 1e-4F);
    ++of_segment[v.segment];
  }
  EXPECT_GT(of_segment[index(Segment::head)], 0U);
  const Body body = *make_body(far_body);
  const Pose<float> pose = standing_pose(body);
  float low = 1e9F, high = -1e9F;
  double volume = 0;
  const auto at = [&](std::uint32_t v) {
    return figure.vertex[v].position + pose.position_m[figure.vertex[v].segment];
  };
  for (std::size_t t = 0; t < figure.index.size(); t += 3) {
    const Vec3<float> a = at(figure.index[t]), b = at(figure.index[t + 1]), c = at(figure.index[t + 2]);
    volume += static_cast<double>(dot(a, cross(b, c))) / 6;
    for (const Vec3<float>& p : {a, b, c}) low = std::min(low, p.y), high = std::max(high, p.y);
  }
  EXPECT_NEAR(high, 1.75F, 0.04F);
  EXPECT_NEAR(low, 0, 0.03F);
  EXPECT_NEAR(volume, 0.075, 0.01);  // wound outwards, clothes included
  const Vec3<float> scale = far_scale(1.75F, 70);
  EXPECT_NEAR(scale.x, 1, 1e-6F);
  EXPECT_NEAR(far_scale(1.75F, 140).x, std::sqrt(2.0F), 1e-5F);
}

}  // namespace mobil::texture_test
