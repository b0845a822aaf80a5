#include "demo/lab/paper/paper_stage.h"

#include <cmath>
#include <deque>

#include <mobil/engine/geometry.h>
#include <mobil/renderer.h>
#include <mobil/systems/capture/matrix.h>
#include "demo/walk/recorded_scene.h"

namespace mobil {
namespace {

using namespace geometry;
using capture_math::radians;

constexpr Colour mesh_ink{0.13F, 0.16F, 0.20F};
constexpr float field_deg = 8;  // so narrow that rows of people are seen alike

bool in_right_leg(Segment s) {
  return s == Segment::pelvis || (s >= Segment::thigh_right && s <= Segment::toes_right);
}

/// What is to be drawn of a walk, of one frame.
WalkRecording part_of(const Actor& actor) {
  const WalkRecording& whole = actor.walk->recording;
  WalkRecording part;
  part.frames = {whole.frames[actor.frame]};
  for (const BoneSurface& bone : whole.bones) {
    const bool drawn =
        actor.bones == Actor::Bones::all || (actor.bones == Actor::Bones::right_leg && in_right_leg(bone.segment));
    if (drawn) part.bones.push_back(bone);
  }
  for (const RecordedMuscle& muscle : whole.muscles) {
    const bool drawn = actor.muscles == Actor::Muscles::both ||
                       (actor.muscles == Actor::Muscles::right && !muscle.name.ends_with("_left"));
    if (drawn) {
      part.muscles.push_back(
          {muscle.name, muscle.segment, muscle.colour, muscle.triangle, {muscle.position_m[actor.frame]}});
    }
  }
  return part;
}

}  // namespace

Camera camera_at(const Vec3<float>& target, float tall_m, float turn_deg, float rise_deg) {
  const float distance = tall_m / 2 / std::tan(radians(field_deg / 2));
  const float turn = radians(turn_deg), rise = radians(rise_deg);
  Camera camera;
  camera.target = target;
  camera.eye = target + distance * Vec3<float>{-std::cos(turn) * std::cos(rise), std::sin(rise),
                                               std::sin(turn) * std::cos(rise)};
  camera.vertical_fov_deg = field_deg;
  return camera;
}

Vec3<float> across(const Camera& camera) {
  return camera_axes(camera).right;
}

std::vector<Actor> side_by_side(std::span<const PaperCycle> walks, const Camera& camera, float apart_m) {
  std::vector<Actor> actors;
  const float middle = (static_cast<float>(walks.size()) - 1) / 2;
  for (std::size_t i = 0; i < walks.size(); ++i) {
    const float place = apart_m * (static_cast<float>(i) - middle);
    actors.push_back({.walk = &walks[i].shown, .frame = 0, .at = place * across(camera)});
  }
  return actors;
}

Result<Image> take_picture(const Stage& stage, std::span<const Actor> actors) {
  auto renderer = Renderer::create(stage.width, stage.height);
  if (!renderer) return tl::unexpected(renderer.error());
  RecordedScene drawn;
  std::deque<WalkRecording> part;
  std::vector<Vec3<float>> edges;
  for (const Actor& actor : actors) {
    const WalkRecording& own = part.emplace_back(part_of(actor));
    const Vec3<float> pelvis = own.frames[0].position_m[index(Segment::pelvis)];
    const Vec3<float> shift = actor.at - Vec3<float>{0, 0, pelvis.z};
    add_bones(own, 0, shift, 0, drawn);
    add_muscles(own, 0, shift, drawn);
    if (!actor.mesh) continue;
    for (const auto& p : actor.walk->mesh_edge[actor.frame]) edges.push_back(p + shift);
  }
  std::vector<DrawLines> lines;
  if (!edges.empty()) lines.push_back({.position = edges, .colour = mesh_ink, .width = 1.3F});
  Scene scene;
  scene.camera = stage.camera;
  scene.meshes = drawn.meshes;
  scene.lines = lines;
  scene.light = {-0.55F, 0.80F, 0.45F};
  scene.ground = stage.ground;
  return renderer->render(scene);
}

}  // namespace mobil
