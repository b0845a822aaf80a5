#include "demo/crowd/crowd_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include <mobil/assets/export/recorded_skin.h>
#include <mobil/gltf_writer.h>
#include <mobil/renderer.h>
#include <mobil/shard_bytes.h>
#include <mobil/skin_writer.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/usd_writer.h>
#include "demo/program/commands.h"
#include "demo/walk/drawn_skin.h"
#include "demo/walk/walk_export.h"

namespace mobil {
namespace {

/// Returns true for bones visible through the skin of near people; the shirt hides the others.
bool is_leg(Segment segment) {
  return segment == Segment::pelvis || (segment >= Segment::thigh_right && segment < Segment::clavicle_right);
}

template <class T>
void put_list(PlainBytes& bytes, const std::vector<T>& list) {
  bytes.put(std::uint64_t{list.size()});
  bytes.put_all(std::span<const T>(list));
}

template <class T>
void take_list(PlainReader& reader, std::vector<T>& list) {
  std::uint64_t count = 0;
  reader.take(count);
  list = reader.take_many<T>(static_cast<std::size_t>(count));
}

/// Returns true if all triangles are complete and use existing vertices.
bool whole(std::size_t vertices, const std::vector<std::uint32_t>& triangle) {
  return triangle.size() % 3 == 0 &&
         std::ranges::all_of(triangle, [&](std::uint32_t vertex) { return vertex < vertices; });
}

constexpr std::string_view side_name[] = {"_right", "_left"};

constexpr float near_m = 6, far_m = 18;  // beyond these distances skins have fewer triangles
constexpr float glass = 0.35F;           // opacity of legs with visible muscles
constexpr float person_m = 1;            // half the height of a person's bounding box

bool in_picture(const Camera& camera, int width, int height, const Vec3<float>& pelvis) {
  const Vec3<float> at = project(camera, width, height, pelvis);
  const Vec3<float> above = project(camera, width, height, {pelvis.x, pelvis.y + person_m, pelvis.z});
  const float margin = 2 * std::abs(above.y - at.y) + 50;
  return at.z > 1 && at.x > -margin && at.x < static_cast<float>(width) + margin && at.y > -margin &&
         at.y < static_cast<float>(height) + margin;
}

constexpr double recorded_frame_s = 1.0 / 30;

/// Returns the index of the recording's figure for a skin, and adds the figure if the skin is new.
std::size_t figure_of(const BodySkin& skin, std::map<const BodySkin*, std::size_t>& known, CrowdRecording& recording) {
  const auto [found, is_new] = known.try_emplace(&skin, recording.figures.size());
  if (is_new) recording.figures.push_back({{}, {}, recorded_skin(skin), standing_of(skin)});
  return found->second;
}

Result<void> record_poses(const CrowdScene& scene, CrowdRecording& recording) {
  for (std::size_t i = 0; i < scene.walkers().size(); ++i) {
    const auto pose = scene.simulation().get<Pose>(scene.walkers()[i].entity);
    if (!pose) return fail(fmt::format("{} has left", recording.people[i].name));
    recording.people[i].frames.push_back(*pose);
    const Entity entity = scene.walkers()[i].entity;
    if (auto done = record_root(scene.simulation(), entity, recording.people[i].root); !done) return done;
  }
  return {};
}

}  // namespace

Result<const WalkRecording*> CrowdLegs::of(const Simulation& simulation, Entity person, std::uint64_t number) {
  const auto subject = simulation.person(person);
  if (!subject) return fail("a person to be drawn has left");
  auto found = shown_.find(number);
  if (found == shown_.end()) {
    auto figure = make_figure(*subject);
    if (!figure) return tl::unexpected(figure.error());
    found = shown_.emplace(number, Shown{std::move(*figure), {}}).first;
  }
  Shown& shown = found->second;
  shown.recording = begin_recording(shown.figure, 1.0F / 30);
  std::erase_if(shown.recording.bones, [](const BoneSurface& bone) { return !is_leg(bone.segment); });
  record_frame(shown.figure, simulation, *subject, shown.recording);
  return &shown.recording;
}

std::vector<std::byte> pack_legs(const WalkRecording& legs) {
  PlainBytes bytes;
  bytes.put(legs.frames.front());
  bytes.put(std::uint64_t{legs.bones.size()});
  for (const BoneSurface& bone : legs.bones) {
    bytes.put(bone.segment);
    put_list(bytes, bone.mesh.position);
    put_list(bytes, bone.mesh.triangle);
  }
  bytes.put(std::uint64_t{legs.muscles.size()});
  for (const RecordedMuscle& muscle : legs.muscles) {
    bytes.put(static_cast<std::uint8_t>(muscle.name.ends_with(side_name[1]) ? 1 : 0));
    bytes.put(muscle.colour);
    put_list(bytes, muscle.position_m.front());
    put_list(bytes, muscle.triangle);
    put_list(bytes, muscle.tissue);
    bytes.put(muscle.fibres);
  }
  return bytes.bytes();
}

Result<WalkRecording> unpack_legs(std::span<const std::byte> packed) {
  constexpr std::uint64_t most = 10'000;  // surfaces
  WalkRecording legs;
  PlainReader reader(packed);
  std::uint64_t bones = 0, muscles = 0;
  bool good = true;
  reader.take(legs.frames.emplace_back());
  reader.take(bones);
  for (std::uint64_t i = 0; i < std::min(bones, most); ++i) {
    BoneSurface& bone = legs.bones.emplace_back();
    reader.take(bone.segment);
    take_list(reader, bone.mesh.position);
    take_list(reader, bone.mesh.triangle);
    good = good && index(bone.segment) < segment_count && whole(bone.mesh.position.size(), bone.mesh.triangle);
  }
  reader.take(muscles);
  for (std::uint64_t i = 0; i < std::min(muscles, most); ++i) {
    RecordedMuscle& muscle = legs.muscles.emplace_back();
    std::uint8_t left = 0;
    reader.take(left);
    muscle.name = side_name[left == 0 ? 0 : 1];
    reader.take(muscle.colour);
    take_list(reader, muscle.position_m.emplace_back());
    take_list(reader, muscle.triangle);
    take_list(reader, muscle.tissue);
    reader.take(muscle.fibres);
    const bool tissue = muscle.tissue.empty() || muscle.tissue.size() == muscle.position_m.front().size();
    good = good && tissue && whole(muscle.position_m.front().size(), muscle.triangle);
  }
  if (!good || !reader.whole()) return fail("the bytes of a person's bones and muscles are inconsistent");
  return legs;
}

Camera crowd_camera(double side_m) {
  const Vec3<float> eye = CrowdScene::viewer_m(side_m);
  Camera camera;
  camera.eye = {eye.x, 3.3F, eye.z - 4.5F};
  camera.target = {eye.x, 0.55F, eye.z + 5.5F};
  camera.vertical_fov_deg = 33;
  return camera;
}

void arrange(std::vector<PicturedPerson>& seen) {
  std::ranges::sort(seen, [](const PicturedPerson& a, const PicturedPerson& b) {
    return std::tuple(b.near, a.distance_m, a.number) < std::tuple(a.near, b.distance_m, b.number);
  });
}

struct CrowdCamera::Parts {
  Parts(Renderer made, int wide, int high) : renderer(std::move(made)), width(wide), height(high) {}

  Renderer renderer;
  int width, height;
  BodySkins skins;
  std::deque<DrawnSkin> drawn;
  RecordedScene legs_drawn;
  CrowdLegs legs;
  std::vector<DrawMesh> meshes;
  std::span<const DrawMesh> backdrop;
  std::span<const DrawLines> backdrop_lines;

  Result<void> add_skin(const PicturedPerson& person, const WalkRecording* legs);
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

Result<void> CrowdCamera::Parts::add_skin(const PicturedPerson& person, const WalkRecording* of_legs) {
  const SkinDetail detail = person.distance_m < near_m  ? SkinDetail::near
                            : person.distance_m < far_m ? SkinDetail::far
                                                        : SkinDetail::distant;
  BodyRequest body{.height_m = person.height_m, .mass_kg = person.mass_kg};
  body.sex = person.sex == 0 ? Sex::man : Sex::woman;
  body.age_y = person.age_y;
  const auto shape = skins.of(body, detail);
  if (!shape) return tl::unexpected(shape.error());
  DrawnSkin& skin = drawn.emplace_back();
  skin.skin = shape->skin;
  skin.lengths = shape->lengths;
  skin.colours = skin_colours(person.number);
  if (of_legs != nullptr) {
    for (const SkinPart part : {SkinPart::legs, SkinPart::shorts}) skin.opacity[static_cast<std::size_t>(part)] = glass;
  }
  skin.pose(person.pose, of_legs != nullptr ? muscles_of(*of_legs, 0) : LegVertices{});
  skin.draw(meshes);
  return {};
}

void CrowdCamera::set_backdrop(std::span<const DrawMesh> meshes, std::span<const DrawLines> lines) {
  parts_->backdrop = meshes;
  parts_->backdrop_lines = lines;
}

void CrowdCamera::forget(std::uint64_t number) {
  parts_->legs.forget(number);
}

Result<void> CrowdCamera::take(const CrowdScene& scene, Image& image) {
  std::vector<Drawn> people;
  for (const CrowdWalker& walker : scene.walkers()) people.push_back({walker.entity, walker.number, walker.near});
  return take(scene.simulation(), crowd_camera(scene.side_m()), people, image);
}

std::vector<PicturedPerson> CrowdCamera::see(const Simulation& simulation, const Camera& camera,
                                             std::span<const Drawn> people, int width, int height) {
  std::vector<PicturedPerson> seen;
  for (const Drawn& person : people) {
    const auto pose = simulation.get<Pose>(person.entity);
    if (!pose || !in_picture(camera, width, height, pose->position_m[0])) continue;
    const auto size = simulation.get<BodySize>(person.entity);
    const auto physique = simulation.get<Physique>(person.entity);
    if (!size || !physique) continue;
    const float distance_m = project(camera, width, height, pose->position_m[0]).z;
    const auto sex = static_cast<std::uint32_t>(sex_of(physique->build));
    seen.push_back({person.number, distance_m, person.near ? 1U : 0U, size->height_m, size->mass_kg, sex,
                    age_of(physique->build), *pose});
  }
  return seen;
}

Result<void> CrowdCamera::take(const Simulation& simulation, const Camera& camera, std::span<const Drawn> people,
                               Image& image) {
  auto seen = see(simulation, camera, people, parts_->width, parts_->height);
  arrange(seen);
  std::map<std::uint64_t, Entity> entity;
  for (const Drawn& person : people)
    if (person.near) entity.emplace(person.number, person.entity);
  Legs legs;
  for (std::size_t i = 0; i < std::min(seen.size(), max_legs) && seen[i].near != 0; ++i) {
    const auto own = parts_->legs.of(simulation, entity.at(seen[i].number), seen[i].number);
    if (!own) return tl::unexpected(own.error());
    legs.emplace(seen[i].number, *own);
  }
  return draw(camera, seen, legs, image);
}

Result<void> CrowdCamera::draw(const Camera& camera, std::span<const PicturedPerson> seen, const Legs& legs,
                               Image& image) {
  Parts& parts = *parts_;
  parts.drawn.clear();
  parts.meshes.assign(parts.backdrop.begin(), parts.backdrop.end());
  parts.legs_drawn = {};
  for (const PicturedPerson& person : seen) {
    const auto found = legs.find(person.number);
    const WalkRecording* const own = found == legs.end() ? nullptr : found->second;
    if (own != nullptr) {
      const std::size_t before = parts.legs_drawn.meshes.size();
      add_bones(*own, 0, {0, 0, 0}, 0, parts.legs_drawn);
      if (!own->muscles.empty()) add_muscles(*own, 0, {0, 0, 0}, parts.legs_drawn);
      const auto& made = parts.legs_drawn.meshes;
      parts.meshes.insert(parts.meshes.end(), made.begin() + static_cast<std::ptrdiff_t>(before), made.end());
    }
    if (auto added = parts.add_skin(person, own); !added) return added;
  }
  Scene drawn;
  drawn.camera = camera;
  drawn.meshes = parts.meshes;
  drawn.lines = parts.backdrop_lines;
  drawn.ground = parts.backdrop.empty();
  drawn.light = {-0.55F, 0.80F, -0.35F};
  return parts.renderer.render(drawn, image);
}

Result<void> check_crowd_exports(const std::vector<std::filesystem::path>& files) {
  std::set<std::filesystem::path> taken;
  for (const auto& file : files) {
    const auto ending = file.extension();
    if (ending != ".glb" && ending != ".usda") {
      return fail(fmt::format("--export {}: is not a format for crowds; use one of .glb, .usda", file.string()));
    }
    if (!taken.insert(file).second) {
      return fail(fmt::format("--export {}: is given twice; remove one", file.string()));
    }
    if (auto place = check_result_place("--export", file); !place) return place;
  }
  return {};
}

Result<CrowdRecording> record_crowd(CrowdScene& scene, double seconds, const CrowdScene::Progress& progress) {
  CrowdRecording recording;
  recording.frame_s = recorded_frame_s;
  BodySkins skins;
  std::map<const BodySkin*, std::size_t> known;
  for (const CrowdWalker& walker : scene.walkers()) {
    RecordedPerson& person = recording.people.emplace_back();
    person.name = fmt::format("person_{}", walker.number);
    const auto subject = scene.simulation().person(walker.entity);
    if (!subject) return fail(fmt::format("{} has left", person.name));
    const auto shape = skins.of(subject->body.request, SkinDetail::far);
    if (!shape) return tl::unexpected(shape.error());
    person.facts =
        recorded_facts(subject->body.request, subject->gait,
                       scene.simulation().get<GaitState>(walker.entity).value_or(GaitState<float>{}).heading_rad);
    person.figure = figure_of(*shape->skin, known, recording);
    person.scale = {shape->lengths, shape->lengths, shape->lengths};
    for (const Colour& colour : skin_colours(walker.number)) person.colours.push_back(linear_colour(colour));
  }
  const auto frames =
      static_cast<std::size_t>(std::max(1L, std::lround(seconds / recorded_frame_s))) + 1;  // the first at 0
  const auto ticks_a_frame = std::lround(recorded_frame_s / scene.simulation().tick_s());
  for (std::size_t f = 0; f < frames; ++f) {
    for (long tick = 0; f > 0 && tick < ticks_a_frame; ++tick) {
      if (auto done = scene.decide(); !done) return tl::unexpected(done.error());
      scene.tick();
    }
    if (auto done = record_poses(scene, recording); !done) return tl::unexpected(done.error());
    if (progress) progress("recording", f + 1, frames);
  }
  return recording;
}

Result<void> write_crowd_exports(const CrowdRecording& recording, const std::vector<std::filesystem::path>& files) {
  for (const auto& file : files) {
    Result<void> done;
    if (file.extension() == ".glb") {
      const auto written = write_glb(file, recording);
      if (!written) done = tl::unexpected(written.error());
    } else {
      done = write_usda(file, recording);
    }
    if (!done) return fail("--export " + done.error().message);
    say_written(file);
  }
  return {};
}

}  // namespace mobil
