#include "demo/walk/figure.h"

#include <array>

#include "assets/fem/muscle_template.h"
#include "assets/import/fit_anatomy.h"
#include "assets/surfaces/bone_surfaces.h"
#include "assets/surfaces/muscle_surfaces.h"
#include "assets/surfaces/surface_binding.h"

namespace mobil {
namespace {

constexpr Vec3<float> belly_colour{0.40F, 0.055F, 0.04F}, tendon_colour{0.62F, 0.53F, 0.42F};

bool is_tendon(const std::string& name) {
  return name.find("tendon") != std::string::npos || name.find("ligament") != std::string::npos;
}

/// Of muscles alone, those with a belly, whose mesh a surface may follow.
SurfaceChoice choice_of(const Simulation& simulation, const Human& human) {
  SurfaceChoice choice{.bones = false, .simulated = {}, .cells = human.leg_muscles.cells};
  for (const HumanMuscle& own : human.muscles) {
    const bool belly = simulation.world().shared<MuscleTemplate>(own.entity[Side::right]) != nullptr;
    choice.simulated.set(static_cast<std::size_t>(own.plan.muscle), belly);
  }
  return choice;
}

Result<Figure> bound_figure(const Human& human, DrawnSurfaces drawn, const SurfaceChoice& choice) {
  Figure figure;
  auto muscles = bind_surfaces(human.body, {{}, std::move(drawn.muscles)}, choice);
  if (!muscles) return tl::unexpected(muscles.error());
  figure.muscles = std::move(*muscles);
  figure.bones = std::move(drawn.bones);
  for (const SurfacePart& part : figure.muscles.part)
    figure.colours.push_back(is_tendon(part.name) ? tendon_colour : belly_colour);
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

Result<Figure> real_figure(const Human& human, const SurfaceChoice& choice, const std::filesystem::path& folder) {
  const auto anatomy = load_anatomy(folder.string(), {.skin = true});
  if (!anatomy) return tl::unexpected(anatomy.error());
  auto fitted = fit_anatomy(*anatomy, human.body);
  if (!fitted) return tl::unexpected(fitted.error());
  DrawnSurfaces drawn;
  // The folder holds a pelvis and legs; the rest of the skeleton is generated.
  std::array<bool, segment_count> real{};
  for (const auto& bone : fitted->bones) real[index(bone.segment)] = true;
  drawn.bones = std::move(fitted->bones);
  for (auto& bone : make_bone_surfaces(human.body)) {
    if (!real[index(bone.segment)]) drawn.bones.push_back(std::move(bone));
  }
  for (auto& muscle : fitted->muscles) {
    if (auto done = bind(human, choice, muscle, drawn); !done) return tl::unexpected(done.error());
  }
  std::vector<Vec3<float>> rest_m;
  for (const auto& muscle : drawn.muscles)
    rest_m.insert(rest_m.end(), muscle.surface.mesh.position.begin(), muscle.surface.mesh.position.end());
  auto figure = bound_figure(human, std::move(drawn), choice);
  if (!figure) return figure;
  figure->said = all_said(*anatomy);
  figure->skins = std::move(fitted->skins);
  figure->rest_m = std::move(rest_m);
  return figure;
}

}  // namespace

Result<Figure> make_figure(const Simulation& simulation, const Human& human,
                           const std::optional<std::filesystem::path>& anatomy) {
  SurfaceChoice choice = choice_of(simulation, human);
  if (anatomy) return real_figure(human, choice, *anatomy);
  choice.bones = true;
  auto drawn = draw_surfaces(human.body, choice);
  if (!drawn) return tl::unexpected(drawn.error());
  return bound_figure(human, std::move(*drawn), choice);
}

WalkRecording begin_recording(const Figure& figure, float frame_s) {
  WalkRecording recording;
  recording.frame_s = frame_s;
  recording.bones = figure.bones;
  for (std::size_t i = 0; i < figure.muscles.part.size(); ++i) {
    const SurfacePart& part = figure.muscles.part[i];
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
  std::vector<SurfaceMuscle> muscles;
  for (const BodySurfaces::Driver& driver : figure.muscles.driver) {
    muscles.push_back({driver.muscle,
                       {simulation.muscle(human.entity, driver.muscle, Side::right),
                        simulation.muscle(human.entity, driver.muscle, Side::left)}});
  }
  std::vector<Vec3<float>> position(figure.muscles.vertices);
  SurfaceRequest request{human.entity, muscles, &figure.muscles};
  request.positions.bytes = std::as_writable_bytes(std::span(position));
  SurfaceWriter writer;
  if (!writer.write(simulation.world(), {&request, 1})) position.assign(position.size(), {});  // muscles that are gone
  for (std::size_t i = 0; i < figure.muscles.part.size(); ++i) {
    const SurfacePart& part = figure.muscles.part[i];
    const auto first = position.begin() + part.first_vertex;
    recording.muscles[i].position_m.emplace_back(first, first + part.vertices);
  }
}

}  // namespace mobil
