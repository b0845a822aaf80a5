#pragma once
// Closed surfaces from few numbers: tubes lofted through elliptical sections, and ellipsoids.

#include <optional>
#include <span>
#include <vector>

#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// One elliptical section: its centre, its two semi-axes, and the angle (rad) of the first from the tube's reference
/// direction u towards v = normal × u. `bow` bends the section: its points move along its second axis by
/// bow · (1 − 2ξ²), where ξ (−1 to 1) runs along the first. All lengths in the caller's unit.
struct TubeStation {
  Vec3<double> centre;
  double semi_u, semi_v;
  double angle = 0;
  double bow = 0;
};

/// Shape of a tube on its stations. Sections are orthogonal to the centre line, or to `normal` if set (either sense;
/// parallel sections never cut each other). `reference` is made orthogonal to the normal.
struct TubeShape {
  Vec3<double> reference{0, 0, 1};
  std::optional<Vec3<double>> normal = std::nullopt;
  int rings = 12;     // along the tube, caps apart; at least 2
  int segments = 10;  // round the tube; at least 3
  double cap = 0.6;   // length of the rounded ends over the end section's smaller semi-axis
};

/// One point along a tube between its stations, as `loft` interpolates it: centre, and the symmetric matrix that maps
/// the unit circle to the section in (u, v).
struct TubeSection {
  Vec3<double> centre, tangent;
  double uu, uv, vv;
  double angle, bow;
};

/// Returns the section at the fraction `t` (0–1) of the polyline's length through the centres. Centres follow a
/// Catmull–Rom curve on chord lengths, sections a monotone cubic of the matrix's entries. Requires at least two
/// stations whose neighbours differ, with positive semi-axes.
TubeSection tube_section(std::span<const TubeStation> stations, double t);

/// Returns a closed surface through the stations, wound outwards. Requires the same as tube_section.
SurfaceMesh loft(std::span<const TubeStation> stations, const TubeShape& shape = {});

/// Returns a closed ellipsoid with its axes along x, y and z.
SurfaceMesh ellipsoid(const Vec3<double>& centre, const Vec3<double>& semi, int rings = 8, int segments = 10);

}  // namespace mobil::inline v0_3
