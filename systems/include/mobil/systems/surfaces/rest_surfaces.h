#pragma once
// Surfaces of a standing body with its muscles at rest, to which skins and contacts are bound.

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

/// Positions, m, and normals of all vertices of surfaces, in the anatomical position at the origin.
struct RestSurfaces {
  std::vector<Vec3<float>> position, normal;
};

/// Computes the rest vertices of surfaces that were bound to that body or a similar one, in some tens of milliseconds.
/// `choice` contains the muscles and cells that drive them; its other fields are ignored. Errors: those of make_body
/// and Simulation::set_muscles, a driver that is not among the muscles.
Result<RestSurfaces> surfaces_at_rest(const BodySurfaces& surfaces, const Body& body, const LegMuscles& choice);

/// Finds the possible contacts of surfaces at rest (surface_contacts.h). Errors: those of surfaces_at_rest.
Result<SurfaceContacts> find_contacts(const BodySurfaces& surfaces, const Body& body, const LegMuscles& choice);

/// Extracts the vertices of one side's muscles from those of all parts, in the order of the parts.
std::vector<Vec3<float>> muscle_vertices(const BodySurfaces& surfaces, std::span<const Vec3<float>> position,
                                         Side side);

}  // namespace mobil::inline v0_3
