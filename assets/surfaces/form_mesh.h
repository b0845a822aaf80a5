#pragma once
// Conversion of an implicit body to triangles.

#include <cstdint>
#include <span>
#include <vector>

#include <mobil/assets/surfaces/body_form.h>
#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// Returns triangles of the body's surface in the meshing pose (body_form.h), closed, wound outwards; vertices are on
/// the surface to 0.1 mm. Cells are 12 mm wide (at 1.75 m), half of that on head, hands and feet, a quarter on face and
/// fingers. Each cell that the surface crosses has one vertex, in the middle of its crossings of the cell's edges
/// (surface nets, Gibson 1998; between cells of two sizes as in Ju et al. 2002). It then moves along the surface for
/// even triangles. Takes about a second. `coarseness` is a factor on cell widths, from 1.
SurfaceMesh mesh_form(const form::BodyForm& body, double coarseness = 1);

/// Splits the edges of a mesh of the body that are longer than `longest_m` and moves their middles onto the surface. A
/// few can stay longer, in triangles that are split repeatedly. Closed meshes stay closed.
void split_long_edges(const form::BodyForm& body, SurfaceMesh& mesh, double longest_m);

/// Returns the mean of each point's neighbours in these triangles, or the point itself if it has none.
std::vector<form::Vec> neighbour_means(std::span<const std::uint32_t> triangle, std::span<const form::Vec> place);

/// Moves a point to the body's surface along its slope.
form::Vec onto_surface(const form::BodyForm& body, form::Vec p, int steps);

}  // namespace mobil::inline v0_3
