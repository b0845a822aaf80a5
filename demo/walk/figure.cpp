#include "demo/walk/figure.h"

#include <array>

#include <mobil/assets/surfaces/muscle_surfaces.h>
#include <mobil/assets/surfaces/surface_binding.h>
#include <mobil/fit_anatomy.h>
#include <mobil/systems/skin/rest_surfaces.h>

namespace mobil {
namespace {

constexpr Vec3<float> belly_colour{0.40F, 0.055F, 0.04F}, tendon_colour{0.62F, 0.53F, 0.42F};

bool is_tendon(const std::string& name) {
  return name.find("tendon") != std::string::npos || name.find("ligament") != std::string::npos;
}

/// Of muscles alone, those with a belly, whose mesh a surface may follow.
SurfaceChoice choice_of(const Human& human) {
  SurfaceChoice choice{.bones = false, .simulated = {}, .cells = human.leg_muscles.cells};
  for (const HumanMuscle& own : human.muscles) {
    const auto& [method, reduced] = own.method;
    const bool belly = method != Method::none && (method != Method::reduced || reduced.control_points);
    choice.simulated.set(static_cast<std::size_t>(own.plan.muscle), belly);
  }
  return choice;
}

/// Writes a body's surfaces into memory of its own; nothing where muscles are gone.
struct WrittenSurfaces {
  std::vector<Vec3<float>> position, normal;
};
WrittenSurfaces written(const BodySurfaces& surfaces, const Simulation& simulation, Entity person) {
  std::vector<SurfaceMuscle> muscles;
  for (const BodySurfaces::Driver& driver : surfaces.driver) {
    muscles.push_back({driver.muscle,
                       {simulation.muscle(person, driver.muscle, Side::right),
                        simulation.muscle(person, driver.muscle, Side::left)}});
  }
  WrittenSurfaces to{std::vector<Vec3<float>>(surfaces.vertices), std::vector<Vec3<float>>(surfaces.vertices)};
  SurfaceRequest request{person, muscles, &surfaces};
  request.positions.bytes = std::as_writable_bytes(std::span(to.position));
  request.normals.bytes = std::as_writable_bytes(std::span(to.normal));
  SurfaceWriter writer;
  if (!writer.write(simulation.world(), {&request, 1})) to.position.assign(to.position.size(), {});
  return to;
}

Result<Figure> bound_figure(const Human& human, DrawnSurfaces drawn, const SurfaceChoice& choice, bool contact) {
  Figure figure;
  figure.bones = std::move(drawn.bones);
  drawn.bones = contact ? figure.bones : std::vector<BoneSurface>{};
  auto muscles = bind_surfaces(human.body, drawn, choice);
  if (!muscles) return tl::unexpected(muscles.error());
  figure.muscles = std::move(*muscles);
  for (const SurfacePart& part : figure.muscles.part)
    figure.colours.push_back(is_tendon(part.name) ? tendon_colour : belly_colour);
  if (!contact) return figure;
  auto contacts = find_contacts(figure.muscles, human.body, human.leg_muscles);
  if (!contacts) return tl::unexpected(contacts.error());
  figure.contacts = std::move(*contacts);
  return figure;
}

/// Binds a surface, and what there is of it beyond the kneecap, to the mesh of the muscle that drives it.
Result<void> bind(const Human& human, const SurfaceChoice& choice, FittedMuscle& muscle, DrawnSurfaces& drawn) {
  const auto driver = driving_muscle(choice.simulated, muscle.group, muscle.muscle);
  if (!driver) return {};
  const auto mesh = rest_mesh(human.body, *driver, choice.cells);
  if (!mesh) return tl::unexpected(mesh.error());
  auto ligament = cut_at_kneecap(muscle, human.body);
  const Passages passages =
      bind_muscle(muscle.surface, mesh->cage, mesh->frame, muscle.attachments, mesh->least_passage_m);
  if (ligament) bind_beyond(ligament->surface, muscle.surface, mesh->cage, mesh->frame, passages, ligament->ends);
  drawn.muscles.push_back({*driver, std::move(muscle.surface)});
  if (ligament) drawn.muscles.push_back({*driver, std::move(ligament->surface)});
  return {};
}

std::vector<std::string> all_said(const Anatomy& anatomy) {
  std::vector<std::string> said = anatomy.said;
  for (const AnatomyPart& part : anatomy.part) {
    for (const std::string& line : part.report.said) said.push_back(part.mesh.name + ": " + line);
  }
  return said;
}

Result<Figure> real_figure(const Human& human, const SurfaceChoice& choice, const std::filesystem::path& folder,
                           bool contact) {
  const auto anatomy = load_anatomy(folder.string(), {.skin = true});
  if (!anatomy) return tl::unexpected(anatomy.error());
  auto fitted = fit_anatomy(*anatomy, human.body);
  if (!fitted) return tl::unexpected(fitted.error());
  DrawnSurfaces drawn;
  // The folder holds a pelvis and legs; the rest of the skeleton is generated.
  std::array<bool, segment_count> real{};
  for (const auto& bone : fitted->bones) real[index(bone.segment)] = true;
  drawn.bones = std::move(fitted->bones);
  auto generated = draw_surfaces(human.body, {.bones = true, .simulated = {}, .cells = choice.cells});
  if (!generated) return tl::unexpected(generated.error());
  for (auto& bone : generated->bones) {
    if (!real[index(bone.segment)]) drawn.bones.push_back(std::move(bone));
  }
  for (auto& muscle : fitted->muscles) {
    if (auto done = bind(human, choice, muscle, drawn); !done) return tl::unexpected(done.error());
  }
  std::vector<Vec3<float>> rest_m;
  for (const auto& muscle : drawn.muscles)
    rest_m.insert(rest_m.end(), muscle.surface.mesh.position.begin(), muscle.surface.mesh.position.end());
  auto figure = bound_figure(human, std::move(drawn), choice, contact);
  if (!figure) return figure;
  figure->said = all_said(*anatomy);
  figure->skins = std::move(fitted->skins);
  figure->rest_m = std::move(rest_m);
  return figure;
}

}  // namespace

Result<Figure> make_figure(const Human& human, const std::optional<std::filesystem::path>& anatomy, bool contact) {
  SurfaceChoice choice = choice_of(human);
  if (anatomy) return real_figure(human, choice, *anatomy, contact);
  choice.bones = true;
  auto drawn = draw_surfaces(human.body, choice);
  if (!drawn) return tl::unexpected(drawn.error());
  return bound_figure(human, std::move(*drawn), choice, contact);
}

WalkRecording begin_recording(const Figure& figure, double frame_s) {
  WalkRecording recording;
  recording.frame_s = frame_s;
  recording.bones = figure.bones;
  for (std::size_t i = 0; i < figure.muscles.part.size(); ++i) {
    const SurfacePart& part = figure.muscles.part[i];
    if (!part.driver) continue;
    RecordedMuscle recorded;
    recorded.name = part.name;
    recorded.segment = part.segment;
    recorded.colour = figure.colours[i];
    for (std::uint32_t k = 0; k < part.indices; ++k)
      recorded.triangle.push_back(figure.muscles.index[part.first_index + k] - part.first_vertex);
    recording.muscles.push_back(std::move(recorded));
  }
  return recording;
}

void record_frame(const Figure& figure, const Simulation& simulation, const Human& human, WalkRecording& recording) {
  const auto pose = simulation.get<Pose>(human.entity);
  if (!pose) return;
  recording.frames.push_back(*pose);
  WrittenSurfaces now = written(figure.muscles, simulation, human.entity);
  if (figure.contacts) {
    ContactWork work;
    keep_apart(*figure.contacts, now.position, now.normal, work);
  }
  std::size_t muscle = 0;
  for (const SurfacePart& part : figure.muscles.part) {
    if (!part.driver) continue;
    const auto first = now.position.begin() + part.first_vertex;
    recording.muscles[muscle++].position_m.emplace_back(first, first + part.vertices);
  }
}

}  // namespace mobil
