#include "demo/walk/figure.h"

#include <mobil/assets/surfaces/muscle_surfaces.h>
#include <mobil/assets/surfaces/surface_binding.h>
#include <mobil/engine/world.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/systems/surfaces/rest_surfaces.h>

namespace mobil {
namespace {

constexpr Vec3<float> belly_colour{0.40F, 0.055F, 0.04F};

/// Vertices of a body's surfaces, all at the origin if its muscles are gone.
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

}  // namespace

SurfaceChoice simulated_surfaces(const Person& person) {
  SurfaceChoice choice{.bones = false, .simulated = {}, .cells = person.leg_muscles.cells};
  for (const PersonMuscle& own : person.muscles) {
    const auto& [method, modal] = own.method;
    const bool belly = method != Method::none && (method != Method::modal || modal.control_points);
    choice.simulated.set(static_cast<std::size_t>(own.plan.muscle), belly);
  }
  return choice;
}

Result<Figure> bound_figure(const Person& person, DrawnSurfaces drawn, const SurfaceChoice& choice, bool contact) {
  Figure figure;
  figure.bones = std::move(drawn.bones);
  drawn.bones = contact ? figure.bones : std::vector<BoneSurface>{};
  auto muscles = bind_surfaces(person.body, drawn, choice);
  if (!muscles) return tl::unexpected(muscles.error());
  figure.muscles = std::move(*muscles);
  if (!contact) return figure;
  auto contacts = find_contacts(figure.muscles, person.body, person.leg_muscles);
  if (!contacts) return tl::unexpected(contacts.error());
  figure.contacts = std::move(*contacts);
  return figure;
}

Result<Figure> make_figure(const Person& person, bool contact) {
  SurfaceChoice choice = simulated_surfaces(person);
  choice.bones = true;
  auto drawn = draw_surfaces(person.body, choice);
  if (!drawn) return tl::unexpected(drawn.error());
  return bound_figure(person, std::move(*drawn), choice, contact);
}

WalkRecording begin_recording(const Figure& figure, double frame_s) {
  WalkRecording recording;
  recording.frame_s = frame_s;
  recording.bones = figure.bones;
  for (const SurfacePart& part : figure.muscles.part) {
    if (!part.driver) continue;
    RecordedMuscle recorded;
    recorded.name = part.name;
    recorded.segment = part.segment;
    recorded.colour = belly_colour;
    const auto first = figure.muscles.tissue.begin() + part.first_vertex;
    recorded.tissue.assign(first, first + part.vertices);
    recorded.fibres = part.fibres;
    for (std::uint32_t k = 0; k < part.indices; ++k)
      recorded.triangle.push_back(figure.muscles.index[part.first_index + k] - part.first_vertex);
    recording.muscles.push_back(std::move(recorded));
  }
  return recording;
}

void record_frame(const Figure& figure, const Simulation& simulation, const Person& person, WalkRecording& recording) {
  const auto pose = simulation.get<Pose>(person.entity);
  if (!pose) return;
  recording.frames.push_back(*pose);
  WrittenSurfaces now = written(figure.muscles, simulation, person.entity);
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
