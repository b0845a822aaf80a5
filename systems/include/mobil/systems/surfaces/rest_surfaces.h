#pragma once
// Surfaces of a body as it stands with its muscles at rest, which skins and contacts are bound over.

#include <span>
#include <vector>

#include <mobil/components/body.h>
#include <mobil/components/lanes.h>
#include <mobil/components/leg_muscles.h>
#include <mobil/components/muscle.h>
#include <mobil/engine/error.h>
#include <mobil/systems/surfaces/body_surfaces.h>
#include <mobil/systems/surfaces/surface_contacts.h>

namespace mobil::inline v0_3 {

/// Of all vertices of some surfaces, in the anatomical position at the origin, m.
struct RestSurfaces {
  std::vector<Vec3<float>> position, normal;
};

/// Of surfaces that were bound to that body, or to one like it. `choice`: the muscles and cells that drive them; what
/// else it says does not matter. Some tens of milliseconds. Errors: as make_body and Simulation::set_muscles;
/// surfaces with a driver that is not among the muscles.
Result<RestSurfaces> surfaces_at_rest(const BodySurfaces& surfaces, const Body& body, const LegMuscles& choice);

/// Who may touch whom in them (find_contacts). Errors: as surfaces_at_rest.
Result<SurfaceContacts> find_contacts(const BodySurfaces& surfaces, const Body& body, const LegMuscles& choice);

/// The muscles' vertices of a side, in the order of the surfaces' parts, out of those of all parts.
std::vector<Vec3<float>> muscle_vertices(const BodySurfaces& surfaces, std::span<const Vec3<float>> position,
                                         Side side);

}  // namespace mobil::inline v0_3
