#include <mobil/systems/surfaces/rest_surfaces.h>

#include <mobil/simulation.h>
#include <mobil/surfaces.h>
#include <mobil/systems/muscles/person.h>

namespace mobil::inline v0_3 {

Result<RestSurfaces> surfaces_at_rest(const BodySurfaces& surfaces, const Body& body, const LegMuscles& choice) {
  Simulation still;
  const auto model = still.spawn_posed(body.request);
  if (!model) return tl::unexpected(model.error());
  LegMuscles at_rest = choice;
  at_rest.method = Method::none;
  at_rest.activation = ExcitationSource::none;
  at_rest.inertia = false;
  if (at_rest.muscles.any()) {
    if (auto done = still.set_muscles(*model, at_rest); !done) return tl::unexpected(done.error());
  }
  still.tick();
  std::vector<SurfaceMuscle> muscles;
  for (const BodySurfaces::Driver& driver : surfaces.driver)
    muscles.push_back(
        {driver.muscle,
         {still.muscle(*model, driver.muscle, Side::right), still.muscle(*model, driver.muscle, Side::left)}});
  RestSurfaces rest{std::vector<Vec3<float>>(surfaces.vertices), std::vector<Vec3<float>>(surfaces.vertices)};
  const SurfaceFit fit = fit_surfaces(surfaces, body);
  SurfaceRequest request{*model, muscles, &surfaces};
  request.fit = &fit;
  request.positions.bytes = std::as_writable_bytes(std::span(rest.position));
  request.normals.bytes = std::as_writable_bytes(std::span(rest.normal));
  if (auto done = SurfaceWriter().write(still.world(), {&request, 1}); !done) return tl::unexpected(done.error());
  return rest;
}

Result<SurfaceContacts> find_contacts(const BodySurfaces& surfaces, const Body& body, const LegMuscles& choice) {
  const auto rest = surfaces_at_rest(surfaces, body, choice);
  if (!rest) return tl::unexpected(rest.error());
  return find_contacts(surfaces, rest->position, rest->normal);
}

std::vector<Vec3<float>> muscle_vertices(const BodySurfaces& surfaces, std::span<const Vec3<float>> position,
                                         Side side) {
  std::vector<Vec3<float>> of_side;
  for (const SurfacePart& part : surfaces.part) {
    if (!part.driver || part.side != side) continue;
    const auto own = position.subspan(part.first_vertex, part.vertices);
    of_side.insert(of_side.end(), own.begin(), own.end());
  }
  return of_side;
}

}  // namespace mobil::inline v0_3
