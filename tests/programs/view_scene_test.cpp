// Scene of `mobil view`: changes while walking, refusals that change nothing, a crowd that stays near.
#include "demo/view/view_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace mobil::view_scene_test {

constexpr int width = 640, height = 400;

ViewChoice small_scene() {
  ViewChoice choice;
  choice.body.height_m = 1.8F;
  choice.body.mass_kg = 80;
  choice.gait.speed_m_s = 1.4F;
  choice.people = 12;
  return choice;
}

Camera beside(const ViewScene& scene) {
  Camera camera;
  camera.target = scene.place();
  camera.eye = {camera.target.x + 2, 1.2F, camera.target.z + 3.5F};
  return camera;
}

void run(ViewScene& scene, int ticks) {
  for (int i = 0; i < ticks; ++i) scene.tick(beside(scene), width, height);
}

TEST(ViewScene, WalksAndRemembersTheLastSeconds) {
  auto scene = ViewScene::make(small_scene());
  ASSERT_TRUE(scene) << scene.error().message;
  run(*scene, 150);
  EXPECT_GT(scene->place().z, 3);
  const ViewTrace& trace = scene->trace();
  EXPECT_GT(*std::ranges::max_element(trace.knee_deg), 50);
  EXPECT_GT(*std::ranges::max_element(trace.right_load), 1.0F);
  EXPECT_GT(*std::ranges::max_element(trace.elongation_mm[1]) - *std::ranges::min_element(trace.elongation_mm[1]), 20);
}

TEST(ViewScene, ChoicesApplyAndANewBodyReplacesTheOldInPlace) {
  auto scene = ViewScene::make(small_scene());
  ASSERT_TRUE(scene) << scene.error().message;
  run(*scene, 60);
  const float z = scene->place().z;
  ViewChoice choice = small_scene();
  choice.body.height_m = 1.6F;
  choice.method = {Method::explicit_central, Method::newmark, Method::statics, Method::none};
  ASSERT_TRUE(scene->set(choice));
  EXPECT_EQ(scene->gone(), 0U);
  EXPECT_EQ(scene->gone(), std::nullopt);
  EXPECT_NEAR(scene->place().z, z, 0.45F);  // half a step: it starts at heel strike, pelvis behind the heel
  for (std::size_t g = 0; g < view_groups; ++g) EXPECT_EQ(scene->method(g).method.method, choice.method[g]);
  EXPECT_EQ(scene->drawn().size(), 13U);
  choice.people = 30;
  choice.activation = ExcitationSource::moments;
  choice.inertia = true;
  ASSERT_TRUE(scene->set(choice));
  EXPECT_EQ(scene->drawn().size(), 31U);
  run(*scene, 20);
}

TEST(ViewScene, InvalidChoicesAreRefusedUnchanged) {
  auto scene = ViewScene::make(small_scene());
  ASSERT_TRUE(scene) << scene.error().message;
  run(*scene, 30);
  const std::uint64_t before = scene->simulation().state_hash();
  ViewChoice choice = small_scene();
  choice.body.height_m = 2.2F;
  choice.body.mass_kg = 40;
  EXPECT_FALSE(scene->set(choice));
  choice = small_scene();
  choice.gait.speed_m_s = 40;
  EXPECT_FALSE(scene->set(choice));
  EXPECT_TRUE(same_choice(scene->choice(), small_scene()));
  EXPECT_EQ(scene->simulation().state_hash(), before);
  EXPECT_EQ(scene->gone(), std::nullopt);
}

TEST(ViewScene, MethodsAreChosenForTheCameraAndSetAgainAfter) {
  ViewChoice choice = small_scene();
  choice.choose = true;
  auto scene = ViewScene::make(choice);
  ASSERT_TRUE(scene) << scene.error().message;
  run(*scene, 30);
  ASSERT_TRUE(scene->chosen());
  EXPECT_GT(scene->chosen()->predicted_s, 0);
  EXPECT_GT(scene->method(1).cost_us, 0);
  choice.choose = false;
  choice.method.fill(Method::explicit_central);
  ASSERT_TRUE(scene->set(choice));
  EXPECT_FALSE(scene->chosen());
  for (std::size_t g = 0; g < view_groups; ++g) EXPECT_EQ(scene->method(g).method.method, Method::explicit_central);
  run(*scene, 5);
}

TEST(ViewScene, CrowdStaysNear) {
  auto scene = ViewScene::make(small_scene());
  ASSERT_TRUE(scene) << scene.error().message;
  run(*scene, 60 * 40);
  const float z = scene->place().z;
  EXPECT_GT(z, 45);
  for (const auto& one : scene->drawn()) {
    const auto pose = scene->simulation().get<Pose>(one.entity);
    ASSERT_TRUE(pose);
    EXPECT_LT(std::abs(pose->position_m[0].z - z), 40);
  }
}

}  // namespace mobil::view_scene_test
