#include "demo/crowd/crowd_picture.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "assets/export/walk_recording.h"
#include "demo/walk/drawn_skin.h"
#include "demo/walk/figure.h"
#include "demo/walk/recorded_scene.h"
#include "systems/capture/renderer.h"
#include "systems/surfaces/skin_writer.h"

namespace mobil {
namespace {

constexpr std::size_t most_figures = 64;
constexpr float near_m = 6, far_m = 18;  // who is seen with fewer triangles
constexpr float glass = 0.35F;           // opacity of legs that muscles are seen through
constexpr float person_m = 1;            // half the height of the box that a person is taken for

/// From behind and above who looks, over the crowd.
Camera crowd_camera(const CrowdScene& scene) {
  const Vec3<float> eye = scene.viewer_m();
  Camera camera;
  camera.eye = {eye.x, 3.3F, eye.z - 4.5F};
  camera.target = {eye.x, 0.55F, eye.z + 5.5F};
  camera.vertical_fov_deg = 33;
  return camera;
}

/// What is seen through the skin of who is near: the shirt hides the rest.
bool is_leg(Segment segment) {
  return segment == Segment::pelvis || (segment >= Segment::thigh_right && segment < Segment::clavicle_right);
}

bool in_picture(const Camera& camera, int width, int height, const Vec3<float>& pelvis) {
  const Vec3<float> at = project(camera, width, height, pelvis);
  const Vec3<float> above = project(camera, width, height, {pelvis.x, pelvis.y + person_m, pelvis.z});
  const float margin = 2 * std::abs(above.y - at.y) + 50;
  return at.z > 1 && at.x > -margin && at.x < static_cast<float>(width) + margin && at.y > -margin &&
         at.y < static_cast<float>(height) + margin;
}

}  // namespace

struct CrowdCamera::Parts {
  /// Bones and muscles of one person.
  struct Shown {
    Figure figure;
    WalkRecording recording;
    RecordedScene drawn;
  };

  Parts(Renderer made, int wide, int high) : renderer(std::move(made)), width(wide), height(high) {}

  Renderer renderer;
  int width, height;
  BodySkins skins;
  std::deque<DrawnSkin> drawn;
  std::map<std::uint64_t, Shown> figures;  // by person
  std::vector<DrawMesh> meshes;

  Result<Shown*> figure_of(const Simulation& simulation, const Drawn& person);
  Result<void> add_skin(const BodyRequest& body, const Pose<float>& pose, float distance_m, const Drawn& person,
                        const Shown* muscles);
};

CrowdCamera::CrowdCamera(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
CrowdCamera::CrowdCamera(CrowdCamera&&) noexcept = default;
CrowdCamera& CrowdCamera::operator=(CrowdCamera&&) noexcept = default;
CrowdCamera::~CrowdCamera() = default;

Result<CrowdCamera> CrowdCamera::create(int width, int height) {
  auto renderer = Renderer::create(width, height);
  if (!renderer) return tl::unexpected(renderer.error());
  return CrowdCamera(std::make_unique<Parts>(std::move(*renderer), width, height));
}

Result<CrowdCamera::Parts::Shown*> CrowdCamera::Parts::figure_of(const Simulation& simulation, const Drawn& person) {
  const auto human = simulation.human(person.entity);
  if (!human) return fail("a person who is to be drawn has left");
  auto found = figures.find(person.number);
  if (found == figures.end()) {
    auto figure = make_figure(simulation, *human, std::nullopt);
    if (!figure) return tl::unexpected(figure.error());
    found = figures.emplace(person.number, Shown{std::move(*figure), {}, {}}).first;
  }
  Shown& shown = found->second;
  shown.recording = begin_recording(shown.figure, 1.0F / 30);
  std::erase_if(shown.recording.bones, [](const BoneSurface& bone) { return !is_leg(bone.segment); });
  record_frame(shown.figure, simulation, *human, shown.recording);
  shown.drawn = {};
  add_bones(shown.recording, 0, {0, 0, 0}, 0, shown.drawn);
  if (!human->muscles.empty()) add_muscles(shown.recording, 0, {0, 0, 0}, shown.drawn);
  return &shown;
}

Result<void> CrowdCamera::Parts::add_skin(const BodyRequest& body, const Pose<float>& pose, float distance_m,
                                          const Drawn& person, const Shown* muscles) {
  const SkinDetail detail = distance_m < near_m  ? SkinDetail::near
                            : distance_m < far_m ? SkinDetail::far
                                                 : SkinDetail::distant;
  const auto shape = skins.of(body, detail);
  if (!shape) return tl::unexpected(shape.error());
  DrawnSkin& skin = drawn.emplace_back();
  skin.skin = shape->skin;
  skin.lengths = shape->lengths;
  skin.colours = skin_colours(person.number);
  if (muscles != nullptr) {
    for (const SkinPart part : {SkinPart::legs, SkinPart::shorts}) skin.opacity[static_cast<std::size_t>(part)] = glass;
  }
  skin.pose(pose, muscles != nullptr ? muscles_of(muscles->recording, 0) : LegVertices{});
  skin.draw(meshes);
  return {};
}

void CrowdCamera::forget(std::uint64_t number) {
  parts_->figures.erase(number);
}

Result<void> CrowdCamera::take(const CrowdScene& scene, Image& image) {
  std::vector<Drawn> people;
  for (const CrowdWalker& walker : scene.walkers()) people.push_back({walker.entity, walker.number, walker.near});
  return take(scene.simulation(), crowd_camera(scene), people, image);
}

Result<void> CrowdCamera::take(const Simulation& simulation, const Camera& camera, std::span<const Drawn> people,
                               Image& image) {
  struct Seen {
    float distance_m;
    const Drawn* person;
    Pose<float> pose;
  };
  std::vector<Seen> seen;
  const int width = parts_->width, height = parts_->height;
  for (const Drawn& person : people) {
    const auto pose = simulation.get<Pose>(person.entity);
    if (!pose || !in_picture(camera, width, height, pose->position_m[0])) continue;
    const float distance = project(camera, width, height, pose->position_m[0]).z;
    seen.push_back({distance, &person, *pose});
  }
  std::ranges::sort(seen, [](const Seen& a, const Seen& b) {
    if (a.person->near != b.person->near) return a.person->near;
    return a.distance_m < b.distance_m;
  });
  Parts& parts = *parts_;
  parts.drawn.clear();
  parts.meshes.clear();
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Drawn& person = *seen[i].person;
    const auto size = simulation.get<BodySize>(person.entity);
    const auto physique = simulation.get<Physique>(person.entity);
    if (!size || !physique) return fail("a person who is to be drawn has left");
    BodyRequest body{.height_m = size->height_m, .mass_kg = size->mass_kg};
    body.sex = sex_of(physique->build);
    const Parts::Shown* muscles = nullptr;
    if (i < most_figures && person.near) {
      const auto shown = parts.figure_of(simulation, person);
      if (!shown) return tl::unexpected(shown.error());
      parts.meshes.insert(parts.meshes.end(), (*shown)->drawn.meshes.begin(), (*shown)->drawn.meshes.end());
      muscles = *shown;
    }
    auto added = parts.add_skin(body, seen[i].pose, seen[i].distance_m, person, muscles);
    if (!added) return added;
  }
  Scene drawn;
  drawn.camera = camera;
  drawn.meshes = parts.meshes;
  drawn.light = {-0.55F, 0.80F, -0.35F};
  return parts.renderer.render(drawn, image);
}

}  // namespace mobil
