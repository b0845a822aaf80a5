// Skin over wobbling fat: each region moves by its displacement, and no other vertex moves.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/assets/surfaces/body_skin.h>
#include <mobil/components/fat.h>
#include <mobil/engine/world.h>
#include <mobil/simulation.h>
#include <mobil/skin_writer.h>
#include "systems/gait/fat_motion.h"
#include "tests/engine/instruction_sets.h"
#include "tests/surfaces/skin_placed.h"

namespace mobil::skin_fat_test {
namespace {

using skin_test::place;

/// Returns the fraction of a region's displacement that a vertex follows.
float part_of(const FatPlace& at, FatRegion region) {
  float part = 0;
  for (std::size_t k = 0; k < at.part.size(); ++k) part += at.region[k] == index(region) ? at.part[k] : 0;
  return part;
}

TEST(SkinFat, IsOnlyInItsRegions) {
  for (const Sex sex : {Sex::man, Sex::woman}) {
    const SkinMesh& mesh = skin_mesh(sex, SkinDetail::near);
    const BodySkin skin = *make_body_skin(*make_body(skin_body(sex)), SkinDetail::near);
    std::array<float, fat_regions> most{};
    for (std::size_t v = 0; v < mesh.fat.size(); ++v) {
      const Vec3<float>& at = skin.rest[v];
      EXPECT_GE(mesh.fat[v].part[0], mesh.fat[v].part[1]);
      for (std::size_t k = 0; k < 2; ++k) {
        if (mesh.fat[v].part[k] == 0) continue;
        const auto region = static_cast<FatRegion>(mesh.fat[v].region[k]);
        most[index(region)] = std::max(most[index(region)], mesh.fat[v].part[k]);
        const bool of_left =
            region == FatRegion::thigh_left || region == FatRegion::shank_left || region == FatRegion::upper_arm_left;
        const bool of_right = region == FatRegion::thigh_right || region == FatRegion::shank_right ||
                              region == FatRegion::upper_arm_right;
        EXPECT_FALSE(of_left && at.x < -0.01F) << v;
        EXPECT_FALSE(of_right && at.x > 0.01F) << v;
        EXPECT_FALSE(region == FatRegion::belly && at.z < -0.05F) << v;
        EXPECT_FALSE(region == FatRegion::seat && at.z > 0.02F) << v;
      }
      const bool bare = at.y > 1.45F || at.y < 0.13F;  // neck and head; ankles and feet
      EXPECT_FALSE(bare && mesh.fat[v].part[0] > 0) << v;
    }
    for (const float part : most) EXPECT_GT(part, 0.8F);
  }
}

TEST(SkinFat, MovesEachVertexByItsShare) {
  for (const Sex sex : {Sex::man, Sex::woman}) {
    const Body body = *make_body(skin_body(sex));
    const SkinMesh& mesh = skin_mesh(sex, SkinDetail::far);
    const BodySkin skin = *make_body_skin(body, SkinDetail::far);
    const Pose<float> pose = standing_pose(body);
    FatBeside beside{};
    for (std::size_t r = 0; r < fat_regions; ++r)
      beside[r] = {0.001F * static_cast<float>(r + 1), -0.002F, 0.0005F * static_cast<float>(r)};
    std::vector<std::vector<Vec3<float>>> all;
    for_each_fused_instruction_set([&] {
      const auto still = place(skin, pose), moved = place(skin, pose, nullptr, &beside);
      for (std::size_t v = 0; v < mesh.fat.size(); ++v) {
        Vec3<float> way{0, 0, 0};
        for (std::size_t r = 0; r < fat_regions; ++r) {
          const float part = part_of(mesh.fat[v], static_cast<FatRegion>(r));
          way.x += part * beside[r].x, way.y += part * beside[r].y, way.z += part * beside[r].z;
        }
        EXPECT_NEAR(moved.position[v].x - still.position[v].x, way.x, 1e-6F) << v;
        EXPECT_NEAR(moved.position[v].y - still.position[v].y, way.y, 1e-6F) << v;
        EXPECT_NEAR(moved.position[v].z - still.position[v].z, way.z, 1e-6F) << v;
        EXPECT_TRUE(mesh.fat[v].part[0] > 0 ||
                    std::memcmp(&moved.position[v], &still.position[v], sizeof(Vec3<float>)) == 0)
            << v;
        EXPECT_EQ(std::memcmp(&moved.normal[v], &still.normal[v], sizeof(Vec3<float>)), 0) << v;
      }
      all.push_back(moved.position);
    });
    for (const auto& one : all) EXPECT_EQ(std::memcmp(one.data(), all[0].data(), one.size() * sizeof(one[0])), 0);
  }
}

TEST(SkinFat, IsDisplayedOnlyForFullPeopleWithFat) {
  Simulation simulation;
  const BodyRequest body{.height_m = 1.75F, .mass_kg = 100};
  const std::array people = {*simulation.spawn(body, {.speed_m_s = 1.5F}),
                             *simulation.spawn(body, {.speed_m_s = 1.5F})};
  ASSERT_TRUE(simulation.enable({people.data(), 1}, Feature::fat));
  simulation.tick(150);
  BodySkins skins;
  const SkinShape shape = *skins.of(body, SkinDetail::far);
  std::array<std::vector<Vec3<float>>, 2> drawn;
  const auto write = [&] {
    std::array<SkinRequest, 2> requests;
    std::array<Pose<float>, 2> pose;
    for (std::size_t p = 0; p < 2; ++p) {
      drawn[p].resize(shape.skin->rest.size());
      pose[p] = *simulation.get<Pose>(people[p]);
      requests[p] = {people[p], shape, {std::as_writable_bytes(std::span(drawn[p])), sizeof(Vec3<float>)}};
      requests[p].pose = &pose[p];
    }
    SkinWriter writer;
    const auto done = writer.write(simulation.world(), requests);
    ASSERT_TRUE(done) << done.error().message;
  };
  const auto farthest = [&] {
    float most = 0;
    for (std::size_t v = 0; v < drawn[0].size(); ++v)
      most = std::max(most, std::hypot(drawn[0][v].x - drawn[1][v].x, drawn[0][v].y - drawn[1][v].y,
                                       drawn[0][v].z - drawn[1][v].z));
    return most;
  };
  write();
  const auto shown = shown_fat(*simulation.get<BodySize>(people[0]), *simulation.get<FatWobble>(people[0]));
  float most = 0;
  for (const auto& [x, y, z] : shown) most = std::max(most, std::hypot(x, y, z));
  EXPECT_GT(most, 0.001F);
  EXPECT_GT(farthest(), 0.8F * most);
  EXPECT_LT(farthest(), 1.2F * most);
  ASSERT_TRUE(simulation.set_state(people, PersonState::compact));
  write();
  EXPECT_EQ(farthest(), 0);
  ASSERT_TRUE(simulation.set_state(people, PersonState::asleep));
  write();
  EXPECT_EQ(farthest(), 0);

  ASSERT_TRUE(simulation.despawn(people[1]));
  const Pose<float> kept = *simulation.get<Pose>(people[0]);
  SkinRequest gone{people[1], shape, {std::as_writable_bytes(std::span(drawn[0])), sizeof(Vec3<float>)}};
  gone.pose = &kept;
  SkinWriter writer;
  EXPECT_EQ(writer.write(simulation.world(), {&gone, 1}).error().status, Status::stale_entity);
}

}  // namespace
}  // namespace mobil::skin_fat_test
