// Features for close views through the C interface: a custom skin, and muscle contacts. Results are equal in all axes.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/assets/surfaces/body_skin.h>
#include <mobil/simulation.h>
#include "tests/c/c_fixture.h"
#include "tests/labels.h"

MOBIL_TEST_LABELS("long");

namespace mobil::c_close_up_test {
namespace {
using namespace c_test;

unsigned members() {
  unsigned all = 0;
  for (const char* name : {"vastus_lateralis", "vastus_medialis", "rectus_femoris", "soleus", "gastrocnemius_medial"}) {
    const int muscle = mobil_find_muscle(name);
    EXPECT_GE(muscle, 0) << name;
    all |= 1U << muscle;
  }
  return all;
}

/// A person in mid-stride, with surfaces of single muscles.
struct Shown {
  explicit Shown(const mobil_options& options) : sim(options) {
    muscles = filled<mobil_muscles>(MOBIL_MUSCLES);
    muscles.muscles = members();
    muscles.method = MOBIL_MODAL;
    ids = spawn(sim, 1, &muscles);
    EXPECT_EQ(mobil_tick(sim, 40), MOBIL_OK);
    auto choice = filled<mobil_surface_choice>(MOBIL_SURFACE_CHOICE);
    choice.muscles = members();
    for (std::size_t k = 0; k < 3; ++k) choice.cells[k] = muscles.cells[k];
    EXPECT_EQ(mobil_bind_surfaces(sim, ids[0], &choice, &surfaces), MOBIL_OK) << sim.message();
  }
  ~Shown() { mobil_drop_surfaces(surfaces); }
  Shown(const Shown&) = delete;
  Shown& operator=(const Shown&) = delete;

  std::vector<float> write() {
    std::vector<float> out(6 * mobil_vertex_count(surfaces));
    auto to = target(out);
    EXPECT_EQ(mobil_write_surfaces(sim, &to, 0, 1), MOBIL_OK) << sim.message();
    return out;
  }
  mobil_surface_target target(std::vector<float>& out) const {
    auto to = filled<mobil_surface_target>(MOBIL_SURFACE_TARGET);
    to.id = ids[0];
    to.surfaces = surfaces;
    aim(to, out, true);
    return to;
  }

  Sim sim;
  mobil_muscles muscles{};
  std::vector<mobil_id> ids;
  mobil_surfaces* surfaces = nullptr;
};

TEST(CCloseUp, MusclesAreSeparatedEquallyInAnyAxes) {
  Shown ours(filled<mobil_options>(MOBIL_OPTIONS)), theirs(unreal());
  std::array<std::vector<float>, 2> apart;
  float most = 0;
  for (Shown* const one : {&ours, &theirs}) {
    mobil_contacts* contacts = nullptr;
    ASSERT_EQ(mobil_find_contacts(one->sim, one->ids[0], one->surfaces, &contacts), MOBIL_OK) << one->sim.message();
    std::vector<float> out = one->write();
    const std::vector<float> before = out;
    auto target = one->target(out);
    ASSERT_EQ(mobil_keep_apart(one->sim, contacts, &target, 0, 1), MOBIL_OK) << one->sim.message();
    for (std::size_t i = 0; i < out.size(); ++i) most = std::max(most, std::abs(out[i] - before[i]));
    apart[one == &ours ? 0 : 1] = out;
    // Contacts need normals.
    target.normals = nullptr;
    EXPECT_EQ(mobil_keep_apart(one->sim, contacts, &target, 0, 1), MOBIL_REFUSED);
    mobil_drop_contacts(contacts);
  }
  EXPECT_GT(most, 1e-4F) << "somebody's muscles touch";
  // Rounding decides where two ways out of a muscle are equally short.
  std::size_t differ = 0;
  for (std::size_t v = 0; v < apart[0].size(); v += 6) {
    const float *a = &apart[1][v], *b = &apart[0][v];
    const float off_cm =
        std::max({std::abs(a[0] - 100 * b[2]), std::abs(a[1] + 100 * b[0]), std::abs(a[2] - 100 * b[1])});
    ASSERT_LT(off_cm, 0.1F);
    differ += off_cm > 0.02F || std::abs(a[5] - b[4]) > 0.02F ? 1 : 0;
  }
  EXPECT_LE(differ, apart[0].size() / 6 / 1000);
}

/// The right leg of a skin, cut off at a height of 80 cm.
struct Leg {
  std::vector<float> position;
  std::vector<unsigned int> index;
};
Leg leg_of(const BodySkin& skin, const mobil_options& options) {
  const SkinMesh& shared = skin_mesh(skin.sex, skin.detail);
  std::vector<unsigned int> number(skin.rest.size(), ~0U);
  Leg leg;
  for (std::size_t t = 0; t < shared.triangle.size(); t += 3) {
    const std::uint32_t* corner = &shared.triangle[t];
    if (!std::all_of(corner, corner + 3,
                     [&](std::uint32_t v) { return skin.rest[v].y < 0.8F && skin.rest[v].x < -0.02F; }))
      continue;
    if (std::any_of(corner, corner + 3, [&](std::uint32_t v) { return skin.rest[v].x < -0.3F; })) continue;  // a hand
    const bool mirrored = options.axes == MOBIL_AXES_UNREAL;
    for (std::size_t k = 0; k < 3; ++k) {
      unsigned int& n = number[corner[k]];
      const Vec3<float>& at = skin.rest[corner[k]];
      if (n == ~0U) {
        n = static_cast<unsigned int>(leg.position.size() / 3);
        if (mirrored)
          leg.position.insert(leg.position.end(), {100 * at.z, -100 * at.x, 100 * at.y});
        else
          leg.position.insert(leg.position.end(), {at.x, at.y, at.z});
      }
      leg.index.push_back(n);
    }
    if (mirrored) std::swap(leg.index.end()[-1], leg.index.end()[-2]);
  }
  // A vertex in the same buffer as the rest of a scan; no triangle refers to it.
  const std::array<float, 3> above =
      options.axes == MOBIL_AXES_UNREAL ? std::array{0.0F, 0.0F, 170.0F} : std::array{0.0F, 1.7F, 0.0F};
  leg.position.insert(leg.position.end(), above.begin(), above.end());
  return leg;
}

float square(float x) {
  return x * x;
}

TEST(CCloseUp, CustomSkinMovesWithTheBodySkin) {
  std::array<std::vector<float>, 2> written;
  for (const bool turned : {false, true}) {
    const auto options = turned ? unreal() : filled<mobil_options>(MOBIL_OPTIONS);
    const Sim sim(options);
    auto person = filled<mobil_person>(MOBIL_PERSON);
    mobil_id id{};
    ASSERT_EQ(mobil_spawn(sim, &person, 0, 1, nullptr, &id), MOBIL_OK);
    ASSERT_EQ(mobil_tick(sim, 33), MOBIL_OK);
    const BodySkin bare = *make_body_skin(*make_body({}), SkinDetail::near, {.dressed = false});
    const Leg leg = leg_of(bare, options);
    ASSERT_GT(leg.index.size(), 100U);
    auto mesh = filled<mobil_leg_mesh>(MOBIL_LEG_MESH);
    EXPECT_EQ(mesh.detail, MOBIL_NEAR);
    mesh.positions = leg.position.data();
    mesh.vertices = leg.position.size() / 3;
    mesh.indices = leg.index.data();
    mesh.index_count = leg.index.size();
    mobil_custom_skin* own = nullptr;
    ASSERT_EQ(mobil_bind_custom_skin(sim, id, &mesh, &own), MOBIL_OK) << sim.message();
    const std::size_t vertices = mobil_custom_skin_vertex_count(own);
    EXPECT_GT(vertices, mesh.vertices);  // both legs
    std::vector<unsigned int> index(mobil_custom_skin_index_count(own));
    ASSERT_EQ(mobil_custom_skin_indices(own, index.data(), index.size()), MOBIL_OK);
    EXPECT_EQ(mobil_custom_skin_indices(own, index.data(), index.size() - 1), MOBIL_ROOM);
    std::size_t rest = 0;
    ASSERT_EQ(mobil_custom_skin_rest(own, nullptr, 0, &rest), MOBIL_OK);
    EXPECT_LT(rest, mobil_skin_index_count(MOBIL_MAN, MOBIL_NEAR));
    EXPECT_GT(rest, mobil_skin_index_count(MOBIL_MAN, MOBIL_NEAR) / 2);
    std::vector<float> out(6 * vertices);
    auto target = filled<mobil_skin_target>(MOBIL_SKIN_TARGET);
    target.id = id;
    aim(target, out, true);
    ASSERT_EQ(mobil_write_custom_skin(sim, own, &target, 0, 1), MOBIL_OK) << sim.message();
    // The result matches the body's skin, from which the mesh was cut, except for edges that extend over the cut.
    std::vector<float> body(3 * mobil_skin_vertex_count(MOBIL_MAN, MOBIL_NEAR));
    auto of_body = target;
    of_body.detail = MOBIL_NEAR;
    of_body.normals = nullptr;
    of_body.position_stride = 0;
    aim(of_body, body, false);
    ASSERT_EQ(mobil_write_skin(sim, &of_body, 0, 1), MOBIL_OK) << sim.message();
    float furthest = 0;
    int looked = 0;
    for (std::size_t v = 0; v < vertices; v += 5) {
      const float up_m = out[6 * v + (turned ? 2 : 1)] / options.units_per_m;
      if (up_m < 0.15F || up_m > 0.55F) continue;  // within shoes and shorts
      ++looked;
      float least = 1e9F;
      for (std::size_t b = 0; b < body.size(); b += 3)
        least = std::min(least, square(out[6 * v] - body[b]) + square(out[6 * v + 1] - body[b + 1]) +
                                    square(out[6 * v + 2] - body[b + 2]));
      furthest = std::max(furthest, std::sqrt(least) / options.units_per_m);
    }
    EXPECT_GT(looked, 100);
    EXPECT_LT(furthest, 0.02F) << "as far as vertices are apart";
    written[turned ? 1 : 0] = out;
    target.normals = out.data();
    target.normal_bytes = target.position_bytes;
    EXPECT_EQ(mobil_write_custom_skin(sim, own, &target, 0, 1), MOBIL_REFUSED) << "normals over positions";
    target.position_bytes = 12;
    EXPECT_EQ(mobil_write_custom_skin(sim, own, &target, 0, 1), MOBIL_REFUSED);
    mesh.index_count = 4;
    mobil_custom_skin* none = own;
    EXPECT_EQ(mobil_bind_custom_skin(sim, id, &mesh, &none), MOBIL_REFUSED);
    EXPECT_EQ(none, nullptr);
    mesh.index_count = leg.index.size();
    std::vector<float> far = leg.position;
    far[1] = 1e30F;
    mesh.positions = far.data();
    EXPECT_EQ(mobil_bind_custom_skin(sim, id, &mesh, &none), MOBIL_REFUSED);
    EXPECT_NE(sim.message().find("unit"), std::string::npos) << sim.message();
    mesh.positions = leg.position.data();
    std::vector<unsigned int> wrong = leg.index;
    wrong.back() = static_cast<unsigned int>(mesh.vertices);
    mesh.index_count = wrong.size();
    mesh.indices = wrong.data();
    EXPECT_EQ(mobil_bind_custom_skin(sim, id, &mesh, &none), MOBIL_REFUSED);
    EXPECT_NE(sim.message().find("vertex"), std::string::npos) << sim.message();
    mobil_drop_custom_skin(own);
  }
  ASSERT_EQ(written[0].size(), written[1].size());
  for (std::size_t v = 0; v < written[0].size(); v += 6) {
    ASSERT_NEAR(written[1][v], 100 * written[0][v + 2], 0.01F);
    ASSERT_NEAR(written[1][v + 1], -100 * written[0][v], 0.01F);
    ASSERT_NEAR(written[1][v + 4], -written[0][v + 3], 0.02F);
  }
}

/// A leg bound over muscles at rest and written over muscles at rest is unchanged.
TEST(CCloseUp, CustomSkinMovesOverMuscles) {
  const Sim sim;
  auto muscles = filled<mobil_muscles>(MOBIL_MUSCLES);
  muscles.method = MOBIL_STATIC;
  auto person = filled<mobil_person>(MOBIL_PERSON);
  person.posed = 1;
  mobil_id id{};
  ASSERT_EQ(mobil_spawn(sim, &person, 0, 1, &muscles, &id), MOBIL_OK) << sim.message();
  ASSERT_EQ(mobil_tick(sim, 2), MOBIL_OK);
  auto choice = filled<mobil_surface_choice>(MOBIL_SURFACE_CHOICE);
  choice.bones = 0;
  mobil_surfaces* surfaces = nullptr;
  ASSERT_EQ(mobil_bind_surfaces(sim, id, &choice, &surfaces), MOBIL_OK) << sim.message();
  std::vector<float> all(3 * mobil_vertex_count(surfaces));
  auto written = filled<mobil_surface_target>(MOBIL_SURFACE_TARGET);
  written.id = id;
  written.surfaces = surfaces;
  aim(written, all, false);
  ASSERT_EQ(mobil_write_surfaces(sim, &written, 0, 1), MOBIL_OK) << sim.message();
  std::array<std::vector<float>, 2> of_side;
  mobil_part part{};
  for (int p = 0; mobil_surface_part(surfaces, p, &part) == MOBIL_OK; ++p) {
    const auto first = all.begin() + 3 * static_cast<std::ptrdiff_t>(part.first_vertex);
    of_side[static_cast<std::size_t>(part.side)].insert(of_side[static_cast<std::size_t>(part.side)].end(), first,
                                                        first + 3 * static_cast<std::ptrdiff_t>(part.vertices));
  }
  const BodySkin bare = *make_body_skin(*make_body({}), SkinDetail::near, {.dressed = false});
  const Leg leg = leg_of(bare, filled<mobil_options>(MOBIL_OPTIONS));
  auto mesh = filled<mobil_leg_mesh>(MOBIL_LEG_MESH);
  mesh.positions = leg.position.data();
  mesh.vertices = leg.position.size() / 3;
  mesh.indices = leg.index.data();
  mesh.index_count = leg.index.size();
  mesh.surfaces = surfaces;
  mobil_custom_skin* own = nullptr;
  ASSERT_EQ(mobil_bind_custom_skin(sim, id, &mesh, &own), MOBIL_OK) << sim.message();
  mobil_drop_surfaces(surfaces);
  std::vector<float> out(3 * mobil_custom_skin_vertex_count(own));
  auto target = filled<mobil_skin_target>(MOBIL_SKIN_TARGET);
  target.id = id;
  aim(target, out, false);
  const auto furthest_m = [&](std::size_t from, std::size_t to, float side) {
    EXPECT_EQ(mobil_write_custom_skin(sim, own, &target, 0, 1), MOBIL_OK) << sim.message();
    float furthest = 0;
    for (std::size_t v = from; v < to; v += 3) {
      if (out[v + 1] > 0.6F) continue;
      float least = 1e9F;
      for (std::size_t m = 0; m < leg.position.size(); m += 3)
        least = std::min(least, std::hypot(out[v] - side * leg.position[m], out[v + 1] - leg.position[m + 1],
                                           out[v + 2] - leg.position[m + 2]));
      furthest = std::max(furthest, least);
    }
    return furthest;
  };
  const std::size_t half = out.size() / 2 / 3 * 3;
  EXPECT_GT(furthest_m(0, half, 1), 0.002F) << "without muscles it sinks in";
  for (std::size_t side = 0; side < 2; ++side) {
    target.muscles[side] = of_side[side].data();
    target.muscle_vertices[side] = of_side[side].size() / 3;
  }
  EXPECT_LT(furthest_m(0, half, 1), 0.001F);
  EXPECT_LT(furthest_m(half, out.size(), -1), 0.004F) << "the left leg's muscles";
  mobil_drop_custom_skin(own);
}

}  // namespace
}  // namespace mobil::c_close_up_test
