#pragma once
// An eight-node hexahedron at its 2×2×2 Gauss points, and in total: mean gradients and hourglass patterns.

#include <array>
#include <cstddef>

#include <mobil/assets/fem/hexahedral_mesh.h>

namespace mobil::inline v0_3 {

/// Corners of the reference cube in the order of `element_nodes`, and of its Gauss points.
inline constexpr std::array<std::array<int, 3>, 8> hexahedron_corner = {
    {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}};

using Gradient = std::array<double, 3>;

/// Shape functions at one Gauss point: values, gradients in space (1/m), and the point's volume, which is not positive
/// if the element is inverted there.
struct GaussPoint {
  std::array<double, 8> value;
  std::array<Gradient, 8> gradient;
  double volume_m3;
};
GaussPoint gauss_point(const HexahedralMesh& mesh, const Hexahedron& h, std::size_t point);

/// Mean gradients of the shape functions over an element, and its volume (exact: 2×2×2 points integrate them exactly).
struct MeanGradient {
  std::array<Gradient, 8> gradient{};
  double volume_m3 = 0;
};
MeanGradient mean_gradient(const std::array<GaussPoint, 8>& points);

/// Flanagan and Belytschko's γ = h − Σ(h·xᵢ)·∂N/∂xᵢ of the four hourglass patterns. They are orthogonal to every linear
/// displacement, and independent of the element's stretch along the axes.
using HourglassPatterns = std::array<std::array<double, 8>, 4>;
HourglassPatterns hourglass_patterns(const HexahedralMesh& mesh, const Hexahedron& h, const MeanGradient& mean);

/// Resistance of one-point elements to these patterns, N/m: `across`·l + `along`·S²/l in a body of that size.
struct HourglassStiffness {
  double across, along;
};
HourglassStiffness hourglass_stiffness(const MeanGradient& mean, double shear_pa);

}  // namespace mobil::inline v0_3
