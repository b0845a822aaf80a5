#include "demo/anatomy/anatomy_picture.h"

#include <cmath>
#include <utility>
#include <vector>

#include <mobil/engine/geometry.h>
#include <mobil/renderer.h>
#include <mobil/systems/capture/matrix.h>
#include "demo/pictures/contact_sheet.h"

namespace mobil {
namespace {

using namespace geometry;

constexpr int panel_width = 560, panel_height = 1080;
constexpr Colour other_rose{0.66F, 0.42F, 0.38F}, sinew_cream{0.81F, 0.75F, 0.67F};
constexpr float narrow_view_deg = 12;  // nearly without perspective, as in an atlas

Colour colour_of(const AnatomyPart& part) {
  if (part.kind == AnatomyKind::bone) return bone_ivory;
  if (part.kind == AnatomyKind::tendon) return sinew_cream;
  return part.group ? muscle_red : other_rose;
}

}  // namespace

Result<Image> anatomy_picture(const AnatomySurvey& survey) {
  std::vector<DrawMesh> meshes;
  for (const auto& mesh : survey.mesh) {
    if (mesh.fault || mesh.part.kind == AnatomyKind::skin) continue;
    meshes.push_back({.position = mesh.part.mesh.position,
                      .triangle = mesh.part.mesh.triangle,
                      .colour = colour_of(mesh.part),
                      .wetness = mesh.part.kind == AnatomyKind::bone ? 0.0F : 0.5F});
  }
  if (meshes.empty()) return fail("no usable mesh to draw; mend the faults first");
  auto renderer = Renderer::create(panel_width, panel_height);
  if (!renderer) return tl::unexpected(renderer.error());
  capture_math::Box box;
  for (const DrawMesh& mesh : meshes) {
    for (const auto& p : mesh.position) box.add(p);
  }
  const Vec3<float> centre = 0.5F * (box.low + box.high);
  const float radius = 0.5F * length(box.high - box.low);
  const float far = 1.05F * radius / std::tan(0.5F * capture_math::radians(narrow_view_deg));
  std::vector<Image> pair;
  for (const Vec3<float>& from : {Vec3<float>{0, 0, 1}, Vec3<float>{-1, 0, 0}}) {
    Scene scene;
    scene.camera.target = centre;
    scene.camera.eye = centre + far * from;
    scene.camera.vertical_fov_deg = narrow_view_deg;
    scene.meshes = meshes;
    scene.light = 0.5F * from + Vec3<float>{-0.2F, 1.1F, 0.1F};
    auto image = renderer->render(scene);
    if (!image) return image;
    pair.push_back(std::move(*image));
  }
  return contact_sheet({&pair, 1}, 0);
}

}  // namespace mobil
