#pragma once
// Static shapes of a belly over shortening and activation, and those of bodies of some slenderness as control points:
// the samples for a shape table.

#include <array>
#include <span>
#include <vector>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/engine/error.h>
#include "assets/fem/finite_tissue.h"
#include "assets/finite/finite_belly.h"

namespace mobil::inline v0_3 {

/// Shortenings and activations for which tables are made, and slenderness r. It is a body's size across over that
/// along, relative to the template's; bodies in use have 0.80 to 1.26.
inline constexpr std::array<double, 10> sampled_shortenings = {-0.2, -0.15, -0.1, -0.05, 0, 0.05, 0.1, 0.15, 0.2, 0.25};
inline constexpr std::array<double, 5> sampled_activations = {0, 0.05, 0.15, 0.4, 1};
inline constexpr std::array<double, 3> sampled_ratios = {0.8, 1, 1.26};

/// Fascia in the static shapes, relative to the foundation of a moving belly. With the latter's own, slender relaxed
/// bellies buckle at e = 0.16 to 0.25, and bent active ones straighten by up to 7.6 mm, into the bone that bends them.
/// With sixteen times it, sections' means stay within 0.6 mm of their rest; bulging is not resisted.
inline constexpr double static_foundation_factor = 16;

/// Returns one shape for every pair, activations slowest; both lists ascending. Fails without a shape, naming the pair.
Result<std::vector<FiniteState>> static_shapes(const FiniteBelly& belly, std::span<const double> shortenings,
                                               std::span<const double> activations);

/// A belly to sample: its mesh at the template's size with n and with m > n elements a side, whose shapes are
/// extrapolated to elements of no size (order 2). In all muscles, displacement across from 4×4×16 and 6×6×24 elements
/// is within 1.6 % rms, 3.5 % at worst, of that from 6×6×24 and 8×8×32. Without extrapolation 8×8×32 is off by 1.7 and
/// 3.9 %. Nodes taken directly from the meshes converge worse, at corners of the held faces.
struct SampledBelly {
  HexahedralMesh coarse, fine;
  FiniteTissue tissue;
  double foundation_hz = 0;  // of the static shapes
  Cells control = {2, 2, 8};
};

/// Displacement of the control points in a body of the template's length and `ratio` times its width, over that width:
/// x and y are divided by the ratio, so that they are the template's. Three a point, m. The cells keep their volume.
struct ShapeSample {
  double shortening = 0, activation = 0, ratio = 1;
  std::vector<double> displacement_m;
};

/// Returns samples of static_shapes. Fails like it and like make_control_mesh.
Result<std::vector<ShapeSample>> shape_samples(const SampledBelly& belly, double ratio,
                                               std::span<const double> shortenings,
                                               std::span<const double> activations);

}  // namespace mobil::inline v0_3
