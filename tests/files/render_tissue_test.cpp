// Pictures of muscles: tendons, aponeuroses and fibres.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <mobil/renderer.h>

namespace mobil::render_tissue_test {

constexpr int size = 160;

/// A plate of 0.4 × 0.2 m that faces +Z, with fibres along it.
struct Plate {
  std::vector<Vec3<float>> position = {{-0.1F, 0.8F, 0}, {0.1F, 0.8F, 0}, {0.1F, 1.2F, 0}, {-0.1F, 1.2F, 0}};
  std::vector<std::uint32_t> triangle = {0, 1, 2, 0, 2, 3};
  std::vector<Tissue> tissue;
  DrawMesh mesh;

  explicit Plate(std::uint8_t tendon = 0, std::uint8_t aponeurosis = 0) {
    for (const auto& [along, around] : {std::pair{255, 0}, {255, 255}, {0, 255}, {0, 0}})
      tissue.push_back({static_cast<std::uint8_t>(along), static_cast<std::uint8_t>(around), tendon, aponeurosis});
    mesh = {.position = position, .triangle = triangle, .tissue = tissue, .fibres = {0.4F, 0.4F, 0.2F}};
  }
};

class RenderTissue : public testing::Test {
 protected:
  void SetUp() override {
    auto made = Renderer::create(size, size);
    if (!made) GTEST_SKIP() << made.error().message;
    renderer.emplace(std::move(*made));
  }
  /// Returns the red of 31 × 31 pixels in the middle of the plate, seen from a distance, m, and from `aside`, m.
  std::vector<int> reds(const DrawMesh& mesh, float away_m, float aside_m = 0) {
    Scene scene;
    scene.camera = {.eye = {aside_m, 1, away_m}, .target = {aside_m, 1, 0}, .vertical_fov_deg = 2};
    scene.ground = scene.shadows = false;
    scene.meshes = {&mesh, 1};
    const auto image = renderer->render(scene);
    EXPECT_TRUE(image) << image.error().message;
    std::vector<int> values;
    for (int y = 65; y < 96; ++y) {
      for (int x = 65; x < 96; ++x) values.push_back(image->pixel(x, y)[0]);
    }
    return values;
  }
  static int spread(const std::vector<int>& values) {
    const auto [low, high] = std::ranges::minmax(values);
    return high - low;
  }
  std::optional<Renderer> renderer;
};

/// A pixel is 0.2 mm at 1 m and 2.6 mm at 12 m.
TEST_F(RenderTissue, FibresAreSeenNearAndFadeWhereTheyAreThinnerThanAPixel) {
  const Plate belly;
  DrawMesh plain = belly.mesh;
  plain.fibres = {};
  EXPECT_GT(spread(reds(belly.mesh, 1)), 20);
  EXPECT_LE(spread(reds(plain, 1)), 3);
  EXPECT_LE(spread(reds(belly.mesh, 12)), 3);
  const auto far = reds(belly.mesh, 12), flat = reds(plain, 12);
  for (std::size_t i = 0; i < far.size(); ++i) ASSERT_LE(std::abs(far[i] - flat[i]), 3);
}

/// The camera moves by a tenth of a pixel at each distance.
TEST_F(RenderTissue, PixelsChangeLittleWhileTheCameraMovesByPartsOfAPixel) {
  const Plate belly;
  for (const float away_m : {1.0F, 2.0F, 3.0F, 4.0F, 6.0F, 9.0F}) {
    const float pixel_m = away_m * std::tan(0.0349F) / size;
    auto before = reds(belly.mesh, away_m);
    for (int step = 1; step <= 5; ++step) {
      const auto now = reds(belly.mesh, away_m, 0.1F * static_cast<float>(step) * pixel_m);
      for (std::size_t i = 0; i < now.size(); ++i) ASSERT_LE(std::abs(now[i] - before[i]), 10) << away_m;
      before = now;
    }
  }
}

TEST_F(RenderTissue, TendonsAreIvoryAndAponeurosesBetween) {
  const auto mean = [&](const Plate& plate) {
    DrawMesh mesh = plate.mesh;
    mesh.fibres = {};
    Scene scene;
    scene.camera = {.eye = {0, 1, 5}, .target = {0, 1, 0}, .vertical_fov_deg = 2};
    scene.ground = scene.shadows = false;
    scene.meshes = {&mesh, 1};
    return static_cast<int>(renderer->render(scene)->pixel(size / 2, size / 2)[1]);  // green
  };
  Plate ivory;
  ivory.mesh.tissue = {};
  ivory.mesh.colour = tendon_ivory;
  const int belly = mean(Plate()), sheet = mean(Plate(0, 255)), tendon = mean(Plate(255, 0));
  EXPECT_NEAR(tendon, mean(ivory), 2);
  EXPECT_GT(sheet, belly + 30);
  EXPECT_GT(tendon, sheet + 10);
}

TEST_F(RenderTissue, TissueOfOtherVerticesIsRefused) {
  Plate plate;
  plate.mesh.tissue = plate.mesh.tissue.first(3);
  Scene scene;
  scene.meshes = {&plate.mesh, 1};
  const auto drawn = renderer->render(scene);
  ASSERT_FALSE(drawn);
  EXPECT_NE(drawn.error().message.find("tissue of 3 vertices"), std::string::npos) << drawn.error().message;
}

}  // namespace mobil::render_tissue_test
