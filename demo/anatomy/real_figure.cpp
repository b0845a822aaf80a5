#include "demo/anatomy/real_figure.h"

#include <array>

#include <mobil/assets/surfaces/muscle_surfaces.h>
#include <mobil/assets/surfaces/surface_binding.h>
#include <mobil/fit_anatomy.h>
#include <mobil/systems/surfaces/rest_surfaces.h>

namespace mobil {
namespace {

/// Binds a muscle's surface, and its part beyond the kneecap if any, to the mesh of the muscle that deforms it.
Result<void> bind(const Person& person, const SurfaceChoice& choice, FittedMuscle& muscle, DrawnSurfaces& drawn) {
  const auto driver = driving_muscle(choice.simulated, muscle.group, muscle.muscle);
  if (!driver) return {};
  const auto mesh = rest_mesh(person.body, *driver, choice.cells);
  if (!mesh) return tl::unexpected(mesh.error());
  auto ligament = cut_at_kneecap(muscle, person.body);
  const Passages passages =
      bind_muscle(muscle.surface, mesh->lattice, mesh->frame, muscle.attachments, mesh->min_passage_m);
  if (ligament) bind_beyond(ligament->surface, muscle.surface, mesh->lattice, mesh->frame, passages, ligament->ends);
  const auto all_tendon = [](const MuscleSurface& surface) {
    return std::vector<float>(surface.mesh.position.size(), 1.0F);
  };
  const bool tendon = members_of(muscle.muscle).size() > 1;  // a group's
  drawn.muscles.push_back(
      {*driver, muscle.muscle, muscle.surface, tendon ? all_tendon(muscle.surface) : std::vector<float>{}});
  if (ligament) drawn.muscles.push_back({*driver, muscle.muscle, ligament->surface, all_tendon(ligament->surface)});
  return {};
}

std::vector<std::string> all_said(const Anatomy& anatomy) {
  std::vector<std::string> said = anatomy.said;
  for (const AnatomyPart& part : anatomy.part) {
    for (const std::string& line : part.report.said) said.push_back(part.mesh.name + ": " + line);
  }
  return said;
}

}  // namespace

Result<Figure> real_figure(const Person& person, const std::filesystem::path& folder, bool contact) {
  const SurfaceChoice choice = simulated_surfaces(person);
  const auto anatomy = load_anatomy(folder.string(), {.skin = true});
  if (!anatomy) return tl::unexpected(anatomy.error());
  auto fitted = fit_anatomy(*anatomy, person.body);
  if (!fitted) return tl::unexpected(fitted.error());
  DrawnSurfaces drawn;
  // The folder holds a pelvis and legs; the rest of the skeleton is generated.
  std::array<bool, segment_count> real{};
  for (const auto& bone : fitted->bones) real[index(bone.segment)] = true;
  drawn.bones = std::move(fitted->bones);
  auto generated = draw_surfaces(person.body, {.bones = true, .simulated = {}, .cells = choice.cells});
  if (!generated) return tl::unexpected(generated.error());
  for (auto& bone : generated->bones) {
    if (!real[index(bone.segment)]) drawn.bones.push_back(std::move(bone));
  }
  for (auto& muscle : fitted->muscles) {
    if (auto done = bind(person, choice, muscle, drawn); !done) return tl::unexpected(done.error());
  }
  std::vector<Vec3<float>> rest_m;
  for (const auto& muscle : drawn.muscles)
    rest_m.insert(rest_m.end(), muscle.surface.mesh.position.begin(), muscle.surface.mesh.position.end());
  auto figure = bound_figure(person, std::move(drawn), choice, contact);
  if (!figure) return figure;
  figure->said = all_said(*anatomy);
  figure->skins = std::move(fitted->skins);
  figure->rest_m = std::move(rest_m);
  return figure;
}

}  // namespace mobil
