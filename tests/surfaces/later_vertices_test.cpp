// Vertices at instants between ticks, and in a host's axes.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <mobil/engine/geometry.h>
#include <mobil/pose_writer.h>
#include <mobil/simulation.h>
#include <mobil/skin_writer.h>
#include <mobil/surfaces.h>
#include <mobil/systems/muscles/person.h>

namespace mobil::later_vertices_test {
namespace {
using namespace geometry;

std::span<std::byte> bytes_of(std::vector<Vec3<float>>& vertices) {
  return std::as_writable_bytes(std::span(vertices));
}

/// A walker with muscles, drawn at frames of 144 Hz over ticks of 60 Hz.
struct Drawn {
  Simulation simulation;
  BodyRequest body{.height_m = 1.80F, .mass_kg = 80};
  Entity person = *simulation.spawn(body, {.speed_m_s = 1.4F});
  BodySkins skins;
  BodySurfaces surfaces;
  std::vector<SurfaceMuscle> muscles;
  PoseWriter pose_writer;
  SkinWriter skin_writer;
  SurfaceWriter surface_writer;
  Pose<float> pose;
  std::vector<Vec3<float>> skin, inside;

  Drawn() {
    EXPECT_TRUE(simulation.set_muscles(person, LegMuscles{}));
    const Person of = *simulation.person(person);
    for (const PersonMuscle& own : of.muscles) muscles.push_back({own.plan.muscle, own.entity});
    surfaces = *bind_surfaces(of.body);
    simulation.tick(40);
  }
  void draw(double ahead_s, const VertexAxes& axes = {}) {
    struct Row {
      Vec3<float> at;
      Quat<float> turn;
    };
    std::array<Row, segment_count> rows;
    ASSERT_TRUE(
        pose_writer.write(simulation.world(), {&person, 1}, ahead_s, {}, {std::as_writable_bytes(std::span(rows))}));
    for (std::size_t s = 0; s < segment_count; ++s) pose.position_m[s] = rows[s].at, pose.rotation[s] = rows[s].turn;
    const SkinShape shape = *skins.of(body, SkinDetail::distant);
    skin.resize(shape.skin->rest.size());
    SkinRequest on{person, shape, {bytes_of(skin), 12}};
    on.ahead_s = ahead_s;
    std::array<Vec3<float>, 2> bounds;
    on.bounds = &bounds;
    ASSERT_TRUE(skin_writer.write(simulation.world(), {&on, 1}, {}, axes));
    for (const Vec3<float>& v : skin) {
      ASSERT_TRUE(bounds[0].x <= v.x && bounds[0].y <= v.y && bounds[0].z <= v.z);
      ASSERT_TRUE(bounds[1].x >= v.x && bounds[1].y >= v.y && bounds[1].z >= v.z);
    }
    inside.resize(surfaces.vertices);
    SurfaceRequest in{person, muscles, &surfaces, {bytes_of(inside), 12}};
    in.ahead_s = ahead_s;
    ASSERT_TRUE(surface_writer.write(simulation.world(), {&in, 1}, {}, axes));
  }
};

/// Third differences of a series of places.
std::vector<Vec> jerks(const std::vector<Vec>& at) {
  std::vector<Vec> out;
  for (std::size_t i = 3; i < at.size(); ++i) out.push_back(at[i] - 3.0 * at[i - 1] + 3.0 * at[i - 2] - at[i - 3]);
  return out;
}
double largest_gap(const std::vector<Vec>& a, const std::vector<Vec>& b) {
  double gap = 0;
  for (std::size_t i = 0; i < a.size(); ++i) gap = std::max(gap, length(a[i] - b[i]));
  return gap;
}

TEST(LaterVertices, MoveAsEvenlyAsPosesAt144Hertz) {
  Drawn drawn;
  const std::size_t hand = index(Segment::hand_right);
  const auto bone = std::ranges::find_if(
      drawn.surfaces.part, [](const SurfacePart& part) { return !part.driver && part.segment == Segment::hand_right; });
  ASSERT_NE(bone, drawn.surfaces.part.end());
  std::size_t on_hand = 0;  // a vertex of the skin near the palm's middle
  drawn.draw(0);
  for (std::size_t v = 0; v < drawn.skin.size(); ++v) {
    const Vec palm = to_double(drawn.pose.position_m[hand]);
    if (length(to_double(drawn.skin[v]) - palm) < length(to_double(drawn.skin[on_hand]) - palm)) on_hand = v;
  }
  std::vector<Vec> pose, skin, bones;
  for (int frame = 0; frame < 144; ++frame) {
    const Ticks ticks = drawn.simulation.advance(1.0 / 144);
    drawn.draw(ticks.alpha * drawn.simulation.tick_s());
    pose.push_back(to_double(drawn.pose.position_m[hand]));
    skin.push_back(to_double(drawn.skin[on_hand]));
    bones.push_back(to_double(drawn.inside[bone->first_vertex]));
  }
  const std::vector<Vec> of_pose = jerks(pose);
  // Without the instant both are 10 mm.
  EXPECT_LT(largest_gap(jerks(bones), of_pose), 0.0005);
  EXPECT_LT(largest_gap(jerks(skin), of_pose), 0.0005);
}

TEST(LaterVertices, MeetTheNextTick) {
  Drawn drawn;
  for (int i = 0; i < 70; ++i) {
    drawn.draw(drawn.simulation.tick_s());
    const std::vector<Vec3<float>> skin = drawn.skin, inside = drawn.inside;
    drawn.simulation.tick();
    drawn.draw(0);
    double on_skin = 0, within = 0;
    for (std::size_t v = 0; v < skin.size(); ++v)
      on_skin = std::max(on_skin, length(to_double(skin[v]) - to_double(drawn.skin[v])));
    for (std::size_t v = 0; v < inside.size(); ++v)
      within = std::max(within, length(to_double(inside[v]) - to_double(drawn.inside[v])));
    ASSERT_LT(on_skin, 1e-5) << i;
    ASSERT_LT(within, 0.008) << i;  // bellies keep their bulge for a tick, in which the person walks 23 mm
  }
}

TEST(LaterVertices, AreInTheHostsAxes) {
  Drawn drawn;
  drawn.draw(0.01);
  const std::vector<Vec3<float>> skin = drawn.skin, inside = drawn.inside;
  drawn.draw(0.01, {PoseAxes::z_up_left_handed, 100});
  const auto turned = [](const Vec3<float>& v) { return Vec3<float>{100 * v.z, -100 * v.x, 100 * v.y}; };
  for (std::size_t v = 0; v < skin.size(); ++v) {
    ASSERT_FLOAT_EQ(drawn.skin[v].x, turned(skin[v]).x);
    ASSERT_FLOAT_EQ(drawn.skin[v].y, turned(skin[v]).y);
    ASSERT_FLOAT_EQ(drawn.skin[v].z, turned(skin[v]).z);
  }
  for (std::size_t v = 0; v < inside.size(); ++v) {
    ASSERT_FLOAT_EQ(drawn.inside[v].x, turned(inside[v]).x);
    ASSERT_FLOAT_EQ(drawn.inside[v].y, turned(inside[v]).y);
    ASSERT_FLOAT_EQ(drawn.inside[v].z, turned(inside[v]).z);
  }
}

TEST(LaterVertices, AreRefusedBeyondTheirRange) {
  Drawn drawn;
  const SkinShape shape = *drawn.skins.of(drawn.body, SkinDetail::distant);
  std::vector<Vec3<float>> skin(shape.skin->rest.size());
  SkinRequest on{drawn.person, shape, {bytes_of(skin), 12}};
  for (const double ahead_s : {-0.001, 0.21, std::nan("")}) {
    on.ahead_s = ahead_s;
    EXPECT_FALSE(drawn.skin_writer.write(drawn.simulation.world(), {&on, 1})) << ahead_s;
  }
  on.ahead_s = 0;
  for (const float units : {0.0F, 1e7F}) {
    const VertexAxes axes{PoseAxes::y_up, units};
    EXPECT_FALSE(drawn.skin_writer.write(drawn.simulation.world(), {&on, 1}, {}, axes)) << units;
  }
}

}  // namespace
}  // namespace mobil::later_vertices_test
