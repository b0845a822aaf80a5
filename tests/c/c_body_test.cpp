// Bodies and skins for the graphics card through the C interface.

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "tests/c/c_fixture.h"

namespace mobil::c_body_test {
namespace {
using namespace c_test;

using Body = std::array<mobil_segment, MOBIL_SEGMENTS>;

Body body_of(mobil_sim* sim, mobil_id id) {
  Body body;
  body[0] = filled<mobil_segment>(MOBIL_SEGMENT);
  EXPECT_EQ(mobil_get_body(sim, id, body.data(), 0), MOBIL_OK) << mobil_message(sim);
  return body;
}

mobil_id spawned(mobil_sim* sim, float height_m, float mass_kg, float speed_m_s, int sex = MOBIL_MAN) {
  auto person = filled<mobil_person>(MOBIL_PERSON);
  person.height_m = height_m;
  person.mass_kg = mass_kg;
  person.sex = sex;
  person.given = MOBIL_SPEED;
  person.speed_m_s = speed_m_s;
  mobil_id id{};
  EXPECT_EQ(mobil_spawn(sim, &person, 0, 1, nullptr, &id), MOBIL_OK) << mobil_message(sim);
  return id;
}

/// Poses as matrices, three rows of four.
using Matrices = std::array<std::array<float, 12>, MOBIL_SEGMENTS>;
Matrices matrices_of(mobil_sim* sim, mobil_id id) {
  auto layout = filled<mobil_pose_layout>(MOBIL_POSE_LAYOUT);
  layout.form = MOBIL_MATRIX;
  Matrices matrices;
  EXPECT_EQ(mobil_poses(sim, &id, 1, &layout, matrices.data(), 0), MOBIL_OK) << mobil_message(sim);
  return matrices;
}
std::array<double, 3> moved(const std::array<float, 12>& by, const float* point) {
  std::array<double, 3> at;
  for (std::size_t r = 0; r < 3; ++r)
    at[r] = double{by[4 * r]} * double{point[0]} + double{by[4 * r + 1]} * double{point[1]} +
            double{by[4 * r + 2]} * double{point[2]} + double{by[4 * r + 3]};
  return at;
}

/// Rebuilds joints and the centre of mass of a walk from the body and rotations. The kneecap slides round the knee.
TEST(CBody, PlacesJointsAndTheCentreOfMassOfPoses) {
  for (const int axes : {MOBIL_AXES_Y_UP, MOBIL_AXES_UNITY, MOBIL_AXES_UNREAL, MOBIL_AXES_GODOT, MOBIL_AXES_Z_UP}) {
    auto options = filled<mobil_options>(MOBIL_OPTIONS);
    options.axes = axes;
    options.units_per_m = 100;
    Sim sim(options);
    const mobil_id id = spawned(sim, 1.74F, 71, 1.5F);
    const Body body = body_of(sim, id);
    ASSERT_EQ(mobil_tick(sim, 47), MOBIL_OK);
    const Matrices pose = matrices_of(sim, id);
    double mass = 0;
    std::array<double, 3> centre{};
    for (std::size_t s = 0; s < MOBIL_SEGMENTS; ++s) {
      const std::string name = mobil_segment_name(static_cast<int>(s));
      EXPECT_EQ(body[s].parent, mobil_segment_parent(static_cast<int>(s)));
      const std::array<double, 3> com = moved(pose[s], body[s].centre);
      for (std::size_t r = 0; r < 3; ++r) centre[r] += double{body[s].mass_kg} * com[r];
      mass += double{body[s].mass_kg};
      if (s == 0 || name.starts_with("patella")) continue;
      const std::array<double, 3> joint = moved(pose[static_cast<std::size_t>(body[s].parent)], body[s].offset);
      for (std::size_t r = 0; r < 3; ++r)
        EXPECT_NEAR(joint[r], double{pose[s][4 * r + 3]}, 1e-3) << name << ", 0.01 mm";
    }
    EXPECT_NEAR(mass, 71, 1e-4);
    std::array<float, 3> read{};
    ASSERT_EQ(mobil_read(sim, MOBIL_CENTRE, &id, 1, read.data(), 0), MOBIL_OK);
    for (std::size_t r = 0; r < 3; ++r) EXPECT_NEAR(centre[r] / mass, double{read[r]}, 1e-3) << "0.01 mm";
  }
}

TEST(CBody, HasInertiasOfAWholeAndRefuses) {
  Sim sim;
  const mobil_id id = spawned(sim, 1.80F, 80, 0);
  for (const mobil_segment& segment : body_of(sim, id)) {
    const float* const i = segment.inertia_kg_m2;
    EXPECT_GT(i[0], 0);
    EXPECT_LE(i[0], i[1] + i[2]);
    EXPECT_LE(i[1], i[0] + i[2]);
    EXPECT_LE(i[2], i[0] + i[1]);
  }
  Body body;
  body[0] = filled<mobil_segment>(MOBIL_SEGMENT);
  EXPECT_EQ(mobil_get_body(sim, {77, 3}, body.data(), 0), MOBIL_STALE);
  EXPECT_EQ(mobil_get_body(sim, id, nullptr, 0), MOBIL_REFUSED);
  EXPECT_EQ(mobil_get_body(sim, id, body.data(), 8), MOBIL_REFUSED);
  body[0].size = 3;
  EXPECT_EQ(mobil_get_body(sim, id, body.data(), 0), MOBIL_STRUCT);
}

TEST(CBody, FindsBonesByName) {
  const char* const bones[] = {"Armature", "person_7_head", "thigh_left", "mixamorig:T4", "xhead", nullptr};
  int segment[6];
  ASSERT_EQ(mobil_segments_of(bones, 6, segment), MOBIL_OK);
  EXPECT_EQ(segment[0], -1);
  EXPECT_EQ(segment[1], mobil_find_segment("head"));
  EXPECT_EQ(segment[2], mobil_find_segment("thigh_left"));
  EXPECT_EQ(segment[3], mobil_find_segment("T4"));
  EXPECT_EQ(segment[4], -1);
  EXPECT_EQ(segment[5], -1);
  EXPECT_EQ(mobil_segments_of(bones, 1, segment), MOBIL_MISSING);
  EXPECT_EQ(mobil_segments_of(nullptr, 1, segment), MOBIL_REFUSED);
  for (int s = 0; s < MOBIL_SEGMENTS; ++s) {
    const char* const own = mobil_segment_name(s);
    ASSERT_EQ(mobil_segments_of(&own, 1, segment), MOBIL_OK);
    EXPECT_EQ(segment[0], s) << own;
  }
}

/// Blends a skin in the host's axes and compares it with mobil_write_skin.
TEST(CSkinBinding, BlendsToTheWrittenSkinInTheHostsAxes) {
  for (const int axes : {MOBIL_AXES_Y_UP, MOBIL_AXES_UNREAL}) {
    auto options = filled<mobil_options>(MOBIL_OPTIONS);
    options.axes = axes;
    options.units_per_m = axes == MOBIL_AXES_UNREAL ? 100 : 1;
    const double mm = 0.001 * double{options.units_per_m};
    Sim sim(options);
    const mobil_id id = spawned(sim, 1.66F, 60, 1.3F, MOBIL_WOMAN);
    const std::size_t vertices = mobil_binding_vertex_count(MOBIL_WOMAN, MOBIL_DISTANT),
                      indices = mobil_skin_index_count(MOBIL_WOMAN, MOBIL_DISTANT),
                      own = mobil_skin_vertex_count(MOBIL_WOMAN, MOBIL_DISTANT);
    ASSERT_GT(vertices, own);
    std::vector<float> positions(3 * vertices), normals(3 * vertices), tangents(4 * vertices), texture(2 * vertices),
        weights(4 * vertices), inverse_binds(12 * MOBIL_SEGMENTS);
    std::vector<unsigned char> joints(4 * vertices);
    std::vector<unsigned int> same_as(vertices), index(indices), written_index(indices);
    auto binding = filled<mobil_skin_binding>(MOBIL_SKIN_BINDING);
    binding.detail = MOBIL_DISTANT;
    binding.vertices = vertices;
    binding.positions = positions.data();
    binding.normals = normals.data();
    binding.tangents = tangents.data();
    binding.texture = texture.data();
    binding.joints = joints.data();
    binding.weights = weights.data();
    binding.same_as = same_as.data();
    binding.indices = index.data();
    binding.index_room = indices;
    binding.inverse_binds = inverse_binds.data();
    ASSERT_EQ(mobil_get_skin_binding(sim, id, &binding), MOBIL_OK) << sim.message();

    ASSERT_EQ(mobil_skin_indices(sim, MOBIL_WOMAN, MOBIL_DISTANT, written_index.data(), indices, nullptr), MOBIL_OK);
    for (std::size_t i = 0; i < indices; ++i) ASSERT_EQ(same_as[index[i]], written_index[i]);

    ASSERT_EQ(mobil_tick(sim, 31), MOBIL_OK);
    const Matrices pose = matrices_of(sim, id);
    std::vector<float> written(3 * own);
    auto target = filled<mobil_skin_target>(MOBIL_SKIN_TARGET);
    target.id = id;
    target.detail = MOBIL_DISTANT;
    target.positions = written.data();
    target.position_bytes = written.size() * sizeof(float);
    ASSERT_EQ(mobil_write_skin(sim, &target, 0, 1), MOBIL_OK) << sim.message();
    for (std::size_t v = 0; v < vertices; ++v) {
      std::array<double, 3> at{};
      for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t joint = joints[4 * v + k];
        float bound[3];
        for (std::size_t r = 0; r < 3; ++r) {
          const float* const row = &inverse_binds[12 * joint + 4 * r];
          bound[r] = row[3];
          for (std::size_t c = 0; c < 3; ++c) bound[r] += row[c] * positions[3 * v + c];
        }
        const std::array<double, 3> part = moved(pose[joint], bound);
        for (std::size_t r = 0; r < 3; ++r) at[r] += double{weights[4 * v + k]} * part[r];
      }
      const std::string follows = mobil_segment_name(joints[4 * v]);
      const bool slides = follows.starts_with("forearm") || follows.starts_with("upper_arm");  // skin_weights.h
      for (std::size_t r = 0; r < 3; ++r)
        ASSERT_NEAR(at[r], double{written[3 * same_as[v] + r]}, (slides ? 45 : 20) * mm) << "vertex " << v;
    }
  }
}

TEST(CSkinBinding, IsRefusedWithoutRoomOrForAnotherSex) {
  Sim sim;
  const mobil_id id = spawned(sim, 1.75F, 70, 0);
  std::vector<float> few(30, 7.0F);
  auto binding = filled<mobil_skin_binding>(MOBIL_SKIN_BINDING);
  binding.detail = MOBIL_DISTANT;
  binding.vertices = 10;
  binding.positions = few.data();
  EXPECT_EQ(mobil_get_skin_binding(sim, id, &binding), MOBIL_ROOM);
  EXPECT_EQ(few[0], 7.0F) << "nothing is written";
  binding.sex = MOBIL_WOMAN;
  EXPECT_EQ(mobil_get_skin_binding(sim, id, &binding), MOBIL_REFUSED);
  binding.sex = -1;
  binding.detail = 4;
  EXPECT_EQ(mobil_get_skin_binding(sim, id, &binding), MOBIL_REFUSED);
  EXPECT_NE(sim.message().find("detail"), std::string::npos);
  EXPECT_EQ(mobil_get_skin_binding(sim, {9, 9}, nullptr), MOBIL_REFUSED);
  EXPECT_EQ(mobil_binding_vertex_count(2, 0), 0U);
  EXPECT_EQ(mobil_binding_vertex_count(0, -1), 0U);
}

}  // namespace
}  // namespace mobil::c_body_test
