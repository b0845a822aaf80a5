#pragma once
// Helpers that draw the skeleton's bones, in mm of a man of reference_height_mm, in the frame of their segment, right
// side.

#include <array>
#include <initializer_list>

#include <mobil/assets/muscles/leg_sections.h>
#include <mobil/components/body.h>
#include "assets/surfaces/tube.h"

namespace mobil::inline v0_3::bones {

/// A body's lengths in mm of the measured man, so that shapes can be drawn in his numbers.
struct Proportions {
  std::array<Vec3<double>, segment_count> joint, tip;  // origin in the parent's frame, end in its own
  std::array<Vec3<double>, segment_count> world;       // origin in the world, standing on legs in proportion
  LegFrame leg;                                        // hip at the origin, unit 1
};
/// Returns the unit body at reference_height_mm.
Proportions proportions();

inline constexpr Vec3<double> forward{0, 0, 1}, up{0, 1, 0}, down{0, -1, 0}, across{1, 0, 0};

/// A station drawn as centre x y z, semi-axes, angle in degrees.
struct Station {
  double x, y, z, semi_u, semi_v, angle_deg = 0, bow = 0;
};

void add_tube(SurfaceMesh& mesh, std::initializer_list<Station> stations, const TubeShape& shape);
void add_ellipsoid(SurfaceMesh& mesh, const Vec3<double>& centre, const Vec3<double>& semi, int rings = 5,
                   int segments = 9);
/// Adds `part` and its mirror image.
void add_pair(SurfaceMesh& mesh, const SurfaceMesh& part);
/// Returns one bone of overlapping parts as one closed surface with rounded creases and about as many triangles. Builds
/// that cannot simplify a mesh (coarser_surface.h) return the parts.
SurfaceMesh united(const SurfaceMesh& parts);

}  // namespace mobil::inline v0_3::bones
