// Skin through the C interface: matches C++ in the host's axes; refusals.

#include <array>
#include <string>
#include <vector>

#include <mobil/engine/world.h>
#include <mobil/simulation.h>
#include <mobil/skin_writer.h>
#include "tests/c/c_fixture.h"

namespace mobil::c_skin_test {
namespace {
using namespace c_test;

TEST(CSkin, MatchesCppInTheHostsAxes) {
  auto options = filled<mobil_options>(MOBIL_OPTIONS);
  options.axes = MOBIL_AXES_UNREAL;
  options.units_per_m = 100;
  Sim sim(options);
  auto person = filled<mobil_person>(MOBIL_PERSON);
  person.height_m = 1.68F;
  person.mass_kg = 61;
  person.sex = MOBIL_WOMAN;
  mobil_id id{};
  ASSERT_EQ(mobil_spawn(sim, &person, 0, 1, nullptr, &id), MOBIL_OK) << sim.message();
  auto read_back = filled<mobil_person>(MOBIL_PERSON);
  ASSERT_EQ(mobil_get_person(sim, id, &read_back), MOBIL_OK);
  EXPECT_EQ(read_back.sex, MOBIL_WOMAN);

  Simulation simulation;
  BodyRequest body;
  body.height_m = 1.68F;
  body.mass_kg = 61;
  body.sex = Sex::woman;
  const Entity same = *simulation.spawn(body);
  ASSERT_EQ(mobil_advance(sim, 0.5, nullptr), MOBIL_OK);
  simulation.advance(0.5);

  const std::size_t vertices = mobil_skin_vertex_count(MOBIL_WOMAN, MOBIL_DISTANT);
  ASSERT_GT(vertices, 500U);
  std::vector<float> theirs(6 * vertices), ours(6 * vertices);
  auto target = filled<mobil_skin_target>(MOBIL_SKIN_TARGET);
  target.id = id;
  target.detail = MOBIL_DISTANT;
  target.positions = theirs.data();
  target.normals = theirs.data() + 3;
  target.position_stride = target.normal_stride = 24;
  target.position_bytes = 24 * vertices;
  target.normal_bytes = 24 * vertices - 12;
  ASSERT_EQ(mobil_write_skin(sim, &target, 0, 1), MOBIL_OK) << sim.message();

  BodySkins skins;
  SkinRequest request{same, *skins.of(body, SkinDetail::distant)};
  const auto bytes = std::as_writable_bytes(std::span(ours));
  request.positions = {bytes, 24};
  request.normals = {bytes.subspan(12), 24};
  SkinWriter writer;
  ASSERT_TRUE(writer.write(simulation.world(), {&request, 1}));
  for (std::size_t v = 0; v < vertices; ++v) {
    const float *a = &theirs[6 * v], *b = &ours[6 * v];
    ASSERT_NEAR(a[0], 100 * b[2], 1e-3F);  // ahead
    ASSERT_NEAR(a[1], -100 * b[0], 1e-3F);
    ASSERT_NEAR(a[2], 100 * b[1], 1e-3F);
    ASSERT_NEAR(a[3], b[5], 1e-5F);
    ASSERT_NEAR(a[5], b[4], 1e-5F);
  }

  std::vector<unsigned int> index(mobil_skin_index_count(MOBIL_WOMAN, MOBIL_DISTANT));
  std::array<unsigned int, MOBIL_SKIN_PARTS + 1> first{};
  ASSERT_EQ(mobil_skin_indices(sim, MOBIL_WOMAN, MOBIL_DISTANT, index.data(), index.size(), first.data()), MOBIL_OK);
  EXPECT_EQ(3 * std::size_t{first[MOBIL_SKIN_PARTS]}, index.size());
  // Triangles are wound so that the front is outside in these axes, which mirror the library's.
  double six_fold = 0;
  for (std::size_t i = 0; i < index.size(); i += 3) {
    const float *a = &theirs[6 * index[i]], *b = &theirs[6 * index[i + 1]], *c = &theirs[6 * index[i + 2]];
    six_fold +=
        a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  EXPECT_NEAR(six_fold / 6e6, 0.065, 0.02);
}

TEST(CSkin, LegsFlexOnRequest) {
  Sim sim;
  auto person = filled<mobil_person>(MOBIL_PERSON);
  auto target = filled<mobil_skin_target>(MOBIL_SKIN_TARGET);
  ASSERT_EQ(mobil_spawn(sim, &person, 0, 1, nullptr, &target.id), MOBIL_OK);
  ASSERT_EQ(mobil_tick(sim, 30), MOBIL_OK);
  target.detail = MOBIL_DISTANT;
  std::vector<float> still(3 * mobil_skin_vertex_count(MOBIL_MAN, MOBIL_DISTANT)), moved(still.size());
  target.positions = still.data();
  target.position_bytes = still.size() * sizeof(float);
  ASSERT_EQ(mobil_write_skin(sim, &target, 0, 1), MOBIL_OK) << sim.message();
  target.positions = moved.data();
  target.flexing = 1;
  ASSERT_EQ(mobil_write_skin(sim, &target, 0, 1), MOBIL_OK) << sim.message();
  float most = 0;
  for (std::size_t i = 0; i < still.size(); ++i) most = std::max(most, std::abs(moved[i] - still[i]));
  EXPECT_GT(most, 0.001F);
  EXPECT_LT(most, 0.05F);
}

TEST(CSkin, RefusesInvalidRequests) {
  Sim sim;
  EXPECT_EQ(mobil_skin_vertex_count(2, 0), 0U);
  EXPECT_EQ(mobil_skin_index_count(0, 4), 0U);
  unsigned int one = 0;
  EXPECT_EQ(mobil_skin_indices(sim, 0, 9, &one, 1, nullptr), MOBIL_REFUSED);
  EXPECT_EQ(mobil_skin_indices(sim, 0, MOBIL_DISTANT, &one, 1, nullptr), MOBIL_ROOM);
  auto person = filled<mobil_person>(MOBIL_PERSON);
  person.sex = 5;
  mobil_id id{};
  EXPECT_EQ(mobil_spawn(sim, &person, 0, 1, nullptr, &id), MOBIL_REFUSED);
  EXPECT_NE(std::string(sim.message()).find("sex"), std::string::npos);
  auto target = filled<mobil_skin_target>(MOBIL_SKIN_TARGET);
  float room[3];
  target.positions = room;
  target.position_bytes = sizeof room;
  EXPECT_EQ(mobil_write_skin(sim, &target, 0, 1), MOBIL_STALE);
  person.sex = MOBIL_MAN;
  ASSERT_EQ(mobil_spawn(sim, &person, 0, 1, nullptr, &target.id), MOBIL_OK);
  target.detail = MOBIL_DISTANT;
  EXPECT_NE(mobil_write_skin(sim, &target, 0, 1), MOBIL_OK);
  EXPECT_NE(std::string(sim.message()).find("bytes"), std::string::npos) << sim.message();
}

}  // namespace
}  // namespace mobil::c_skin_test
