#pragma once
// From an implicit body to triangles.

#include <cstdint>
#include <span>
#include <vector>

#include <mobil/assets/surfaces/body_form.h>
#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// Triangles of the body's surface in the pose that is meshed (body_form.h), closed, wound outwards; vertices lie on
/// the surface to 0.1 mm. Cells are 12 mm wide (of 1.75 m), half of that on head, hands and feet, a quarter on face and
/// fingers. One vertex a cell that the surface passes through, at the middle of where it cuts the cell's edges (surface
/// nets, Gibson 1998; between cells of two sizes as in Ju et al. 2002), then moved along the surface for even
/// triangles. Takes about a second. `coarseness`: times as wide cells, from 1 on.
SurfaceMesh mesh_form(const form::BodyForm& body, double coarseness = 1);

/// Splits the edges of a mesh of the body that are longer than `longest_m`, their middles moved onto the surface; all
/// but a few, of triangles that are split again and again. Closed meshes stay closed.
void split_long_edges(const form::BodyForm& body, SurfaceMesh& mesh, double longest_m);

/// The middle of each place's neighbours in these triangles; where there are none, the place itself.
std::vector<form::Vec> neighbour_means(std::span<const std::uint32_t> triangle, std::span<const form::Vec> place);

/// Moves a place to the body's surface along its slope.
form::Vec onto_surface(const form::BodyForm& body, form::Vec p, int steps);

}  // namespace mobil::inline v0_3
