// Pictures and films: objects appear where the camera sees them, and files are complete or absent.
#include <gtest/gtest.h>
#include <png.h>
#include <rapidcheck/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <vector>

#include <mobil/png.h>
#include <mobil/renderer.h>
#include <mobil/video.h>
#include "systems/render/vertex_normals.h"
#include "tests/files/temporary_folder.h"
#include "tests/refused.h"

using namespace mobil;
namespace fs = std::filesystem;
using Point = Vec3<float>;

constexpr int width = 160, height = 120;
constexpr Colour red{0.9F, 0.1F, 0.1F}, green{0.1F, 0.8F, 0.1F};

struct Folder : TemporaryFolder {
  std::string file(const char* name) const { return (path / name).string(); }
};

/// Returns an upright triangle of about 1 m at that depth, counter-clockwise seen from +Z.
std::vector<Point> triangle_at(float z) {
  return {{-0.6F, 0.7F, z}, {0.6F, 0.7F, z}, {0, 1.7F, z}};
}
const std::vector<std::uint32_t> forward = {0, 1, 2}, backward = {0, 2, 1};

/// Returns a scene seen from the front at a height of 1 m, through a window shifted slightly to the right, lit from
/// over the shoulder.
Scene empty_scene() {
  Scene scene;
  scene.camera = {.eye = {0, 1, 4}, .target = {0, 1, 0}, .vertical_fov_deg = 40, .window_shift = 0.03F};
  scene.light = {0.3F, 0.6F, 1};
  scene.ground = false;
  return scene;
}

bool is_red(const std::uint8_t* p) {
  return p[0] > 80 && p[0] > 2 * p[1] && p[0] > 2 * p[2];
}
bool is_green(const std::uint8_t* p) {
  return p[1] > 80 && p[1] > 2 * p[0] && p[1] > 2 * p[2];
}

const std::uint8_t* at(const Image& image, const Camera& camera, Point p) {
  const Point pixel = project(camera, image.width, image.height, p);
  return image.pixel(static_cast<int>(pixel.x), static_cast<int>(pixel.y));
}

std::ptrdiff_t differing_bytes(const Image& a, const Image& b) {
  std::ptrdiff_t count = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) count += a.rgba[i] != b.rgba[i];
  return count;
}

class Render : public testing::Test {
 protected:
  void SetUp() override {
    auto made = Renderer::create(width, height);
    if (!made) GTEST_SKIP() << made.error().message;
    renderer.emplace(std::move(*made));
  }
  Image draw(const Scene& scene) {
    auto image = renderer->render(scene);
    EXPECT_TRUE(image.has_value()) << image.error().message;
    return image.value_or(Image{width, height, std::vector<std::uint8_t>(std::size_t{4} * width * height)});
  }
  Image draw(const DrawMesh& mesh) {
    Scene scene = empty_scene();
    scene.meshes = {&mesh, 1};
    return draw(scene);
  }
  std::optional<Renderer> renderer;
};

TEST_F(Render, TriangleCoversExactlyItsProjectedPixels) {
  const auto corners = triangle_at(0);
  const Image image = draw({.position = corners, .triangle = forward, .colour = red});
  const Camera camera = empty_scene().camera;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      float least = 1e9F;  // distance inside the nearest edge, in pixels, computed independently
      for (std::size_t i = 0; i < 3; ++i) {
        const Point a = project(camera, width, height, corners[i]);
        const Point b = project(camera, width, height, corners[(i + 1) % 3]);
        const float ex = b.x - a.x, ey = b.y - a.y;
        const float px = static_cast<float>(x) + 0.5F - a.x, py = static_cast<float>(y) + 0.5F - a.y;
        least = std::min(least, (ey * px - ex * py) / std::hypot(ex, ey));
      }
      if (std::abs(least) < 1) continue;
      ASSERT_EQ(is_red(image.pixel(x, y)), least > 0) << x << ", " << y;
      ASSERT_EQ(image.pixel(x, y)[3], 255);
    }
  }
}

TEST_F(Render, NearerHidesFartherInAnyDrawOrder) {
  const auto near = triangle_at(0.5F), far = triangle_at(-0.5F);
  DrawMesh meshes[] = {{.position = near, .triangle = forward, .colour = red},
                       {.position = far, .triangle = forward, .colour = green}};
  Scene scene = empty_scene();
  scene.meshes = meshes;
  EXPECT_TRUE(is_red(at(draw(scene), scene.camera, {0, 1, 0.5F})));
  std::swap(meshes[0], meshes[1]);
  EXPECT_TRUE(is_red(at(draw(scene), scene.camera, {0, 1, 0.5F})));
  scene.camera.eye.z = -4;
  for (auto& mesh : meshes) mesh.triangle = backward;
  EXPECT_TRUE(is_green(at(draw(scene), scene.camera, {0, 1, -0.5F})));
}

TEST_F(Render, MirroredWindingIsHiddenUnlessFlipped) {
  const auto corners = triangle_at(0);
  const Image whole = draw({.position = corners, .triangle = forward, .colour = red});
  const Image hidden = draw({.position = corners, .triangle = backward, .colour = red});
  const Image flipped = draw({.position = corners, .triangle = backward, .colour = red, .flip = true});
  EXPECT_FALSE(is_red(at(hidden, empty_scene().camera, {0, 1, 0})));
  EXPECT_EQ(differing_bytes(whole, flipped), 0);
}

TEST_F(Render, PlacedMeshMatchesMovedVertices) {
  const std::vector<Point> corners = {{-0.3F, -0.2F, 0}, {0.3F, -0.2F, 0.1F}, {0.1F, 0.4F, -0.1F}};
  const float s = std::sin(0.4F), c = std::cos(0.4F);  // half of 0.8 rad about Z
  for (const float mirror : {1.0F, -1.0F}) {
    const Placement placement{{0.2F, 1.1F, 0.3F}, {0, 0, s, c}, {1.5F * mirror, 0.8F, 1}};
    std::vector<Point> moved;
    for (const auto& p : corners) {
      const float x = p.x * placement.scale.x, y = p.y * placement.scale.y;
      const float cos2 = c * c - s * s, sin2 = 2 * s * c;
      moved.push_back({cos2 * x - sin2 * y + 0.2F, sin2 * x + cos2 * y + 1.1F, p.z + 0.3F});
    }
    const Image placed = draw({.position = corners, .triangle = forward, .colour = red, .placement = {&placement, 1}});
    const Image direct = draw({.position = moved, .triangle = forward, .colour = red, .flip = mirror < 0});
    ASSERT_TRUE(is_red(at(direct, empty_scene().camera, placement.position)));
    int unlike = 0;
    for (std::size_t i = 0; i < placed.rgba.size(); ++i) unlike += std::abs(placed.rgba[i] - direct.rgba[i]) > 3;
    EXPECT_LT(unlike, 40) << "mirror " << mirror;
  }
}

TEST_F(Render, AKeyedMeshIsReadOnceUntilForgotten) {
  auto corners = triangle_at(0);
  const DrawMesh mesh{.position = corners, .triangle = forward, .colour = red, .key = 7};
  const Image first = draw(mesh);
  for (auto& p : corners) p.x += 0.4F;
  EXPECT_EQ(differing_bytes(first, draw(mesh)), 0);
  EXPECT_EQ(differing_bytes(first, draw({.colour = red, .key = 7})), 0);
  renderer->forget(7);
  const Image anew = draw(mesh);
  EXPECT_EQ(differing_bytes(anew, draw({.position = corners, .triangle = forward, .colour = red})), 0);
  EXPECT_GT(differing_bytes(anew, first), 100);
}

TEST_F(Render, AWireframeShowsItsEdgesAndTheBackgroundThroughItsFaces) {
  const auto corners = triangle_at(0);
  const Image bare = draw(DrawMesh{});
  const Image wires = draw({.position = corners, .triangle = forward, .colour = red, .wireframe = true});
  const Camera camera = empty_scene().camera;
  const auto *through = at(wires, camera, {0, 1, 0}), *behind = at(bare, camera, {0, 1, 0});
  EXPECT_TRUE(std::equal(through, through + 3, behind));
  const Point edge = project(camera, width, height, {0, 0.7F, 0});
  bool seen = false;
  for (int dy = -2; dy <= 2; ++dy) {
    const auto* p = wires.pixel(static_cast<int>(edge.x), static_cast<int>(edge.y) + dy);
    seen = seen || p[0] > p[1] + 30;
  }
  EXPECT_TRUE(seen);
  EXPECT_GT(differing_bytes(bare, draw({.position = corners, .triangle = backward, .wireframe = true})), 100);
}

TEST_F(Render, GroundHidesObjectsBelowAndShowsItsGridFromAbove) {
  Scene scene = empty_scene();
  scene.camera = {.eye = {0.5F, 2, 4.5F}, .target = {0.5F, 0, 0.5F}, .vertical_fov_deg = 40};
  const std::vector<Point> under = {{0.2F, -0.3F, 0.8F}, {0.8F, -0.3F, 0.8F}, {0.5F, -0.3F, 0.2F}};
  const DrawMesh mesh{.position = under, .triangle = forward, .colour = red};
  scene.meshes = {&mesh, 1};
  const auto any_red = [](const Image& image) {
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
      if (is_red(&image.rgba[i])) return true;
    }
    return false;
  };
  EXPECT_TRUE(any_red(draw(scene)));
  scene.ground = true;
  const Image covered = draw(scene);
  EXPECT_FALSE(any_red(covered));
  const int line = at(covered, scene.camera, {0.5F, 0, 1})[0], between = at(covered, scene.camera, {0.5F, 0, 1.1F})[0];
  EXPECT_LT(line, between - 8);
  scene.camera.eye.y = -2;
  scene.meshes = {};
  const Image with = draw(scene);
  scene.ground = false;
  EXPECT_EQ(differing_bytes(with, draw(scene)), 0);
}

TEST_F(Render, AShadowFallsOnTheGroundAwayFromTheLight) {
  Scene scene = empty_scene();
  scene.camera = {.eye = {0, 6, 5}, .target = {0, 0, 0}, .vertical_fov_deg = 40};
  scene.ground = true;
  scene.light = {1, 1, 0};  // a ball 1 m up casts its shadow 1 m towards -x
  const std::vector<Point> centre = {{0, 1, 0}};
  const DrawPoints ball{.position = centre, .radius_m = 0.25F};
  scene.points = {&ball, 1};
  const Image image = draw(scene);
  const int shaded = at(image, scene.camera, {-0.9F, 0, 0.1F})[1], sunny = at(image, scene.camera, {0.9F, 0, 0.1F})[1];
  EXPECT_LT(shaded, sunny - 30);
  scene.shadows = false;
  EXPECT_NEAR(at(draw(scene), scene.camera, {-0.9F, 0, 0.1F})[1], sunny, 10);
}

TEST_F(Render, LinesAndBallsHaveTheGivenSize) {
  Scene scene = empty_scene();
  const std::vector<Point> ends = {{-0.8F, 1, 0}, {0.8F, 1, 0}}, centre = {{0, 1, 0}};
  const auto rows_of_red = [&](int column) {
    const Image image = draw(scene);
    int rows = 0;
    for (int y = 0; y < height; ++y) rows += is_red(image.pixel(column, y));
    return rows;
  };
  const float pixels_per_metre = project(scene.camera, width, height, {0, 0, 0}).y - height / 2.0F;
  const int middle = static_cast<int>(project(scene.camera, width, height, {0, 1, 0}).x);
  DrawLines line{.position = ends, .colour = red, .width = 0.2F, .unit = LineUnit::metre};
  scene.lines = {&line, 1};
  EXPECT_NEAR(rows_of_red(middle + 20), 0.2F * pixels_per_metre, 2.1F);
  line.unit = LineUnit::pixel;
  line.width = 9;
  EXPECT_NEAR(rows_of_red(middle + 20), 9, 2.1F);
  scene.lines = {};
  const DrawPoints ball{.position = centre, .colour = red, .radius_m = 0.3F};
  scene.points = {&ball, 1};
  EXPECT_NEAR(rows_of_red(middle), 0.6F * pixels_per_metre, 3.1F);
}

TEST_F(Render, SceneRendersEquallyEveryTimeInEveryRenderer) {
  Scene scene = empty_scene();
  scene.ground = true;
  const auto corners = triangle_at(0);
  const DrawMesh mesh{.position = corners, .triangle = forward};
  const std::vector<Point> centre = {{0.4F, 1, 0}};
  const DrawPoints ball{.position = centre, .radius_m = 0.2F};
  scene.meshes = {&mesh, 1};
  scene.points = {&ball, 1};
  const Image first = draw(scene), second = draw(scene);
  EXPECT_EQ(differing_bytes(first, second), 0);
  auto other = Renderer::create(width, height);
  ASSERT_TRUE(other.has_value());
  Renderer moved = std::move(*other);
  EXPECT_EQ(differing_bytes(first, *moved.render(scene)), 0);
  EXPECT_EQ(differing_bytes(first, draw(scene)), 0);
}

TEST_F(Render, InvalidScenesAreRefusedInOneLine) {
  const auto corners = triangle_at(0);
  const std::vector<std::uint32_t> beyond = {0, 1, 3}, two = {0, 1};
  const auto message = [&](const Scene& scene) {
    const auto image = renderer->render(scene);
    EXPECT_FALSE(image.has_value());
    return image.has_value() ? std::string() : image.error().message;
  };
  Scene scene = empty_scene();
  DrawMesh mesh{.position = corners, .triangle = beyond};
  scene.meshes = {&mesh, 1};
  EXPECT_NE(message(scene).find("vertex 3"), std::string::npos);
  mesh.triangle = two;
  EXPECT_NE(message(scene).find("2 triangle indices"), std::string::npos);
  scene.meshes = {};
  scene.camera.vertical_fov_deg = 0;
  EXPECT_NE(message(scene).find("1-170"), std::string::npos);
  scene = empty_scene();
  scene.camera.target = scene.camera.eye;
  EXPECT_NE(message(scene).find("two different points"), std::string::npos);
  scene = empty_scene();
  scene.light = {0, -1, 0};
  EXPECT_NE(message(scene).find("above 0"), std::string::npos);
  EXPECT_TRUE(renderer->render(empty_scene()).has_value());
  EXPECT_NE(Renderer::create(0, 10).error().message.find("1-8192"), std::string::npos);
}

RC_GTEST_PROP(CaptureCamera, EyesAgreeAtTheTargetAndNearerThingsCross, ()) {
  const auto within = [](int low, int high) { return static_cast<float>(*rc::gen::inRange(low, high)) * 0.01F; };
  Camera camera;
  camera.eye = {within(-500, 500), within(10, 300), within(200, 600)};
  camera.target = {within(-50, 50), within(50, 150), 0};
  const StereoPair eyes = stereo_pair(camera, 0.064F);
  const auto seen = [&](float t) {
    const Point d = {camera.eye.x - camera.target.x, camera.eye.y - camera.target.y, camera.eye.z - camera.target.z};
    const Point p = {camera.target.x + t * d.x, camera.target.y + t * d.y, camera.target.z + t * d.z};
    const Point left = project(eyes.left, 640, 480, p), right = project(eyes.right, 640, 480, p);
    RC_ASSERT(std::abs(left.y - right.y) < 0.01F);
    return left.x - right.x;
  };
  RC_ASSERT(std::abs(seen(0)) < 0.01F);
  RC_ASSERT(seen(0.3F) > 0.5F);
  RC_ASSERT(seen(-0.3F) < -0.5F);
}

RC_GTEST_PROP(CaptureNormals, PointOutwardsOnASphereAndTurnWithTheWinding, ()) {
  const int rings = *rc::gen::inRange(6, 20), sectors = *rc::gen::inRange(6, 20);
  std::vector<Point> position, normal, turned;
  std::vector<std::uint32_t> triangle;
  for (int j = 1; j < rings; ++j) {
    for (int i = 0; i < sectors; ++i) {
      const float v = 3.14159265F * static_cast<float>(j) / static_cast<float>(rings);
      const float u = 6.2831853F * static_cast<float>(i) / static_cast<float>(sectors);
      position.push_back({std::sin(v) * std::cos(u), std::cos(v), -std::sin(v) * std::sin(u)});
    }
  }
  for (int j = 0; j + 2 < rings; ++j) {
    for (int i = 0; i < sectors; ++i) {
      const auto a = static_cast<std::uint32_t>(j * sectors + i);
      const auto b = static_cast<std::uint32_t>(j * sectors + (i + 1) % sectors),
                 n = static_cast<std::uint32_t>(sectors);
      triangle.insert(triangle.end(), {a, a + n, b, b, a + n, b + n});
    }
  }
  vertex_normals(position, triangle, normal);
  for (std::size_t i = 0; i < triangle.size(); i += 3) std::swap(triangle[i], triangle[i + 1]);
  vertex_normals(position, triangle, turned);
  for (std::size_t i = 0; i < position.size(); ++i) {
    const Point p = position[i], n = normal[i], t = turned[i];
    RC_ASSERT(p.x * n.x + p.y * n.y + p.z * n.z > 0.75F);
    RC_ASSERT(std::abs(n.x * n.x + n.y * n.y + n.z * n.z - 1) < 1e-5F);
    RC_ASSERT(std::abs(n.x + t.x) + std::abs(n.y + t.y) + std::abs(n.z + t.z) < 1e-4F);
  }
}

Image any_picture(bool opaque) {
  Image image{*rc::gen::inRange(1, 40), *rc::gen::inRange(1, 40), {}};
  const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  image.rgba = *rc::gen::container<std::vector<std::uint8_t>>(4 * pixels, rc::gen::arbitrary<std::uint8_t>());
  if (opaque) {
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  }
  return image;
}

RC_GTEST_PROP(CapturePng, ReadsBackAsTheSamePixels, (bool opaque)) {
  const Folder folder;
  const Image image = any_picture(opaque);
  const std::string path = folder.file("picture.png");
  RC_ASSERT(write_png(path, image).has_value());
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  RC_ASSERT(png_image_begin_read_from_file(&png, path.c_str()) != 0);
  RC_ASSERT(static_cast<int>(png.width) == image.width);
  RC_ASSERT(static_cast<int>(png.height) == image.height);
  png.format = PNG_FORMAT_RGBA;
  std::vector<std::uint8_t> back(PNG_IMAGE_SIZE(png));
  RC_ASSERT(png_image_finish_read(&png, nullptr, back.data(), 0, nullptr) != 0);
  RC_ASSERT(back == image.rgba);
  RC_ASSERT(folder.files() == 1U);
}

TEST(CapturePng, AFailedWriteIsOneLineAndLeavesNothing) {
  const Folder folder;
  const Image image{2, 2, std::vector<std::uint8_t>(16, 255)};
  fs::create_directory(folder.path / "taken.png");  // a folder has that name, so the last step fails
  std::ofstream(folder.path / "taken.png" / "inside") << "x";
  for (const auto& path : {folder.file("missing/picture.png"), folder.file("taken.png")}) {
    EXPECT_TRUE(is_refused(write_png(path, image), path)) << path;
  }
  EXPECT_EQ(folder.files(), 1U);
  EXPECT_FALSE(write_png(folder.file("empty.png"), Image{}).has_value());
  EXPECT_FALSE(write_png(folder.file("short.png"), Image{3, 3, std::vector<std::uint8_t>(16)}).has_value());
  EXPECT_EQ(folder.files(), 1U);
}

TEST(CapturePng, AFullDiskIsAnErrorAndLeavesNothing) {
  if (access("/dev/full", W_OK) != 0) GTEST_SKIP() << "no /dev/full here";
  const Folder folder;
  fs::create_symlink("/dev/full", folder.path / "picture.png");
  EXPECT_FALSE(write_png(folder.file("picture.png"), Image{64, 64, std::vector<std::uint8_t>(16384, 9)}).has_value());
  EXPECT_EQ(folder.files(), 1U);
  EXPECT_TRUE(fs::is_symlink(folder.path / "picture.png"));
}

class CaptureVideo : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v ffmpeg >/dev/null") != 0) GTEST_SKIP() << "no ffmpeg; apt-get install ffmpeg";
  }
  const Folder folder;
  const Image image{64, 48, std::vector<std::uint8_t>(std::size_t{4} * 64 * 48, 200)};
};

TEST_F(CaptureVideo, TenPicturesMakeAFilmWithItsIndexInFront) {
  const std::string path = folder.file("ten 'quoted' $pictures.mp4");
  auto video = VideoWriter::create(path, 64, 48, 30);
  ASSERT_TRUE(video.has_value()) << video.error().message;
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(video->add(image).has_value());
  EXPECT_FALSE(fs::exists(path));
  const auto closed = video->close();
  ASSERT_TRUE(closed.has_value()) << closed.error().message;
  EXPECT_EQ(folder.files(), 1U);
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(bytes.substr(4, 4), "ftyp");
  ASSERT_NE(bytes.find("moov"), std::string::npos);
  EXPECT_LT(bytes.find("moov"), bytes.find("mdat"));
  const auto sizes = bytes.find("stsz");  // type, flags, common size, then the number of pictures
  ASSERT_NE(sizes, std::string::npos);
  EXPECT_EQ(bytes[sizes + 15], 10);
  EXPECT_FALSE(video->close().has_value());
  EXPECT_FALSE(video->add(image).has_value());
}

TEST_F(CaptureVideo, AHostWithoutStandardDescriptorsMakesAFilm) {
  for (const std::vector<int>& closed : std::vector<std::vector<int>>{{0}, {0, 1}, {0, 2}, {1, 2}, {0, 1, 2}}) {
    const std::string path = folder.file("daemon.mp4");
    const pid_t host = fork();
    if (host == 0) {
      for (const int descriptor : closed) close(descriptor);
      auto video = VideoWriter::create(path, 64, 48, 30);
      bool done = video.has_value();
      for (int i = 0; i < 3 && done; ++i) done = video->add(image).has_value();
      _exit(done && video->close().has_value() ? 0 : 1);
    }
    int status = -1;
    ASSERT_EQ(waitpid(host, &status, 0), host);
    EXPECT_EQ(status, 0) << closed.size() << " closed, the first is " << closed.front();
    EXPECT_EQ(folder.files(), 1U);
    fs::remove(path);
  }
}

TEST_F(CaptureVideo, AnAbandonedEmptyOrImpossibleFilmLeavesNothing) {
  {
    auto video = VideoWriter::create(folder.file("abandoned.mp4"), 64, 48, 30);
    ASSERT_TRUE(video.has_value());
    for (int i = 0; i < 2000 && folder.files() == 0; ++i) ASSERT_TRUE(video->add(image).has_value());
    EXPECT_EQ(folder.files(), 1U);  // the film is started under its temporary name
    EXPECT_FALSE(fs::exists(folder.path / "abandoned.mp4"));
    EXPECT_FALSE(video->add(Image{2, 2, std::vector<std::uint8_t>(16)}).has_value());
  }
  auto empty = VideoWriter::create(folder.file("empty.mp4"), 64, 48, 30);
  ASSERT_TRUE(empty.has_value());
  EXPECT_FALSE(empty->close().has_value());
  EXPECT_TRUE(is_refused(VideoWriter::create(folder.file("missing/film.mp4"), 64, 48, 30), "there is no folder"));
  fs::create_symlink("/dev/full", folder.path / "full.mp4");
  auto full = VideoWriter::create(folder.file("full.mp4"), 64, 48, 30);
  ASSERT_TRUE(full.has_value()) << full.error().message;
  Result<void> last;
  for (int i = 0; i < 200 && last; ++i) last = full->add(image);
  if (last) last = full->close();
  ASSERT_FALSE(last.has_value());
  EXPECT_EQ(last.error().message.find('\n'), std::string::npos);
  fs::remove(folder.path / "full.mp4");
  EXPECT_EQ(folder.files(), 0U);
}

TEST_F(CaptureVideo, OutOfRangeRequestsNameTheRange) {
  EXPECT_NE(VideoWriter::create(folder.file("film.avi"), 64, 48, 30).error().message.find(".mp4"), std::string::npos);
  EXPECT_NE(VideoWriter::create(folder.file("film.mp4"), 63, 48, 30).error().message.find("even"), std::string::npos);
  EXPECT_NE(VideoWriter::create(folder.file("film.mp4"), 64, 48, 0).error().message.find("1-240"), std::string::npos);
  EXPECT_EQ(folder.files(), 0U);
}

TEST(CaptureVideoWithoutFfmpeg, NamesTheMissingPackage) {
  const std::string path = std::getenv("PATH") != nullptr ? std::getenv("PATH") : "";
  setenv("PATH", "/nowhere", 1);
  const auto video = VideoWriter::create((fs::temp_directory_path() / "film.mp4").string(), 64, 48, 30);
  setenv("PATH", path.c_str(), 1);
  ASSERT_FALSE(video.has_value());
  EXPECT_NE(video.error().message.find("apt-get install ffmpeg"), std::string::npos);
}
