#include "demo/lab/body/body_picture.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <mobil/assets/surfaces/muscle_surfaces.h>
#include <mobil/engine/geometry.h>
#include <mobil/renderer.h>
#include "assets/body/segment_inertia.h"
#include "assets/surfaces/bone_surfaces.h"
#include "assets/surfaces/surface_mesh.h"
#include "demo/pictures/contact_sheet.h"

namespace mobil {
namespace {

constexpr int view_width = 560, view_height = 1080;
constexpr Colour tendon_cream{0.81F, 0.75F, 0.67F};
constexpr Placement as_it_is{}, mirrored{.scale = {-1, 1, 1}};
constexpr float field_of_view_deg = 12;  // narrow: nearly without perspective, as in an atlas

/// Far enough for the whole stature with a margin.
Camera looking(const Body& body, Vec3<float> from) {
  const float stature = body.request.height_m, far = 5.35F * stature;
  Camera camera;
  camera.target = {0, 0.5F * stature, 0};
  camera.eye = {far * from.x, camera.target.y + far * from.y, far * from.z};
  camera.vertical_fov_deg = field_of_view_deg;
  return camera;
}

}  // namespace

Result<Image> body_picture(const Body& body) {
  auto renderer = Renderer::create(view_width, view_height);
  if (!renderer) return tl::unexpected(renderer.error());

  const auto bones = make_bone_surfaces(body);
  const auto muscles = make_muscle_surfaces(body);
  std::vector<Placement> stand(bones.size());
  std::vector<DrawMesh> meshes;
  for (std::size_t i = 0; i < bones.size(); ++i) {
    stand[i].position = geometry::to_float(joint_centre_m(body, bones[i].segment));
    meshes.push_back({.position = bones[i].mesh.position,
                      .triangle = bones[i].mesh.triangle,
                      .colour = bone_ivory,
                      .placement = {&stand[i], 1}});
  }
  for (const GroupSurface& muscle : muscles) {
    const bool tendon = std::ranges::find(muscle.tendon, 0.0F) == muscle.tendon.end();
    for (const Placement* side : {&as_it_is, &mirrored}) {
      meshes.push_back({.position = muscle.surface.mesh.position,
                        .triangle = muscle.surface.mesh.triangle,
                        .colour = tendon ? tendon_cream : muscle_red,
                        .wetness = 0.5F,
                        .placement = {side, 1}});
    }
  }

  std::vector<Image> pair;
  struct View {
    Vec3<float> from, light;  // steep and from the left, so that no shadow reaches into the other view
  };
  constexpr std::array<View, 2> views = {
      {{{0, 0.05F, 1}, {-0.20F, 1.1F, 0.50F}}, {{-1, 0.05F, 0}, {-0.50F, 1.1F, -0.20F}}}};
  for (const View& view : views) {
    Scene scene;
    scene.camera = looking(body, view.from);
    scene.meshes = meshes;
    scene.light = view.light;
    auto image = renderer->render(scene);
    if (!image) return image;
    pair.push_back(std::move(*image));
  }
  return contact_sheet({&pair, 1}, 0);
}

}  // namespace mobil
