#pragma once
// Signed distances to closed surfaces, sampled on a grid: unions of overlapping parts, and tests of points against
// bones.

#include <array>
#include <cstddef>
#include <vector>

#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// Samples of a signed distance on a grid of cubes, negative inside, each at most `band`. All lengths are in the
/// unit of the mesh. A field without samples is `band` everywhere.
struct DistanceField {
  Vec3<double> corner{0, 0, 0};  // first sample
  double cell = 1, band = 0;
  std::array<int, 3> count{};  // samples along x, y and z
  std::vector<float> value;    // x first

  float at(int x, int y, int z) const {
    return value[(static_cast<std::size_t>(z) * static_cast<std::size_t>(count[1]) + static_cast<std::size_t>(y)) *
                     static_cast<std::size_t>(count[0]) +
                 static_cast<std::size_t>(x)];
  }
};

/// Returns the distance to the union of a mesh's closed parts, which can overlap. Their common surface is rounded where
/// the distances to two parts differ by less than `rounding` (smooth_union in form_shapes.h). Requires closed
/// parts wound outwards, and a band of at least two cells. More than the band inside, distances are sums of steps
/// between samples, up to 8 % too long.
DistanceField distance_field(const SurfaceMesh& mesh, double cell, double band, double rounding = 0);

/// Return the distance at a point, interpolated linearly, and its slope, which points outwards. Outside the grid the
/// distance is `band` and the slope 0.
double distance(const DistanceField& field, const Vec3<double>& at);
Vec3<double> slope(const DistanceField& field, const Vec3<double>& at);

/// Returns the surface where the distance is 0: closed, wound outwards, one vertex in each cell that it crosses
/// (surface nets, Gibson 1998), moved along the surface for even triangles.
SurfaceMesh zero_surface(const DistanceField& field);

/// Returns the point of a surface that is nearest to `to`. Requires at least one triangle.
Vec3<double> nearest_point(const SurfaceMesh& mesh, const Vec3<double>& to);

}  // namespace mobil::inline v0_3
