#include "demo/town/town_picture.h"

#include <utility>

#include <mobil/engine/geometry.h>

namespace mobil {
namespace {

using namespace geometry;

/// From where the camera looks at who is followed: to the left of the tour's way and behind, m.
constexpr Vec3<float> beside{-4.2F, 2.1F, -5.2F};
constexpr float hips_m = 0.95F, follows_per_frame = 0.04F;
constexpr Colour joint{0.66F, 0.64F, 0.60F};

}  // namespace

TownCamera::TownCamera(CrowdCamera camera, TownView view)
    : people_(std::move(camera)), view_(view), town_(town_meshes()), paving_(town_paving()) {
  for (const TownMesh& mesh : town_)
    meshes_.push_back(
        {.position = mesh.position, .triangle = mesh.triangle, .normal = mesh.normal, .colour = mesh.colour});
  lines_.push_back({.position = paving_, .colour = joint, .width = 0.012F, .unit = LineUnit::metre});
}

Result<TownCamera> TownCamera::create(int width, int height, TownView view) {
  auto camera = CrowdCamera::create(width, height);
  if (!camera) return tl::unexpected(camera.error());
  return TownCamera(std::move(*camera), view);
}

void TownCamera::follow(const TownScene& scene) {
  if (view_ == TownView::above) {
    camera_.eye = {-13, 13, -17};
    camera_.target = {-0.5F, 0, 4.5F};
    camera_.vertical_fov_deg = 42;
    return;
  }
  const Root guide = scene.guide();
  const auto x = static_cast<float>(guide.x_m), z = static_cast<float>(guide.z_m);
  const Vec3<float> target{x, town_ground(x, z).height_m + hips_m, z};
  const Vec3<float> by = target - camera_.target;
  camera_.target = looks_ ? camera_.target + follows_per_frame * by : target;
  camera_.eye = camera_.target + beside;
  camera_.vertical_fov_deg = 42;
  looks_ = true;
}

Result<void> TownCamera::take(const TownScene& scene, Image& image) {
  people_.set_backdrop(meshes_, lines_);
  std::vector<CrowdCamera::Drawn> people;
  for (std::size_t i = 0; i < scene.people().size(); ++i) people.push_back({scene.people()[i], i, false});
  return people_.take(scene.simulation(), camera_, people, image);
}

}  // namespace mobil
