#pragma once
// The static shapes of a muscle's belly in all bodies, as a few modes of control points:
//   displacement = −e·z along z + Σ_v b_v·c_v,  c = C(r)·f(e, ρ(a)),  C(r) = C₀ + C₁ ln r + C₂ ln² r
// e the shortening over the length at rest, a the activation, r a body's size across over that along. All at the
// template's size: in a body x and y are times its size across, z times that along. Both ends are exact: b is 0 there.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/engine/error.h>
#include "assets/finite/shape_amounts.h"
#include "assets/finite/shape_samples.h"

namespace mobil::inline v0_3 {

/// `vector[v][i]`: b_v at the points between the ends, three numbers a point, m. `coefficient[t][v][f]`: C_t.
struct ShapeTable {
  Cells control = {2, 2, 8};
  std::vector<std::vector<double>> vector;
  std::array<std::vector<std::array<double, shape_amount_count>>, shape_ratio_terms> coefficient;
};

/// A body's C(r), one row a vector: made once a body.
std::vector<std::array<double, shape_amount_count>> body_coefficients(const ShapeTable& table, double ratio);

/// Displacement of all control points, three a point, m, at the template's size; `rest`: the control mesh of the
/// template, whose planes are numbered along z.
std::vector<double> shape_at(const ShapeTable& table,
                             std::span<const std::array<double, shape_amount_count>> coefficients,
                             const HexahedralMesh& rest, double shortening, double activation);

/// The table of the samples (of the control mesh `rest`): least squares, then the `modes` that keep the most of it,
/// displacements along z counting `along_weight` times as much as those across, which are what is seen. Fails on no
/// more samples than there are coefficients (three an amount), on one that has not three numbers a point, or on no or
/// more modes than those.
Result<ShapeTable> fit_shape_table(std::span<const ShapeSample> samples, const HexahedralMesh& rest, std::size_t modes,
                                   double along_weight = 0.2);

/// What a table makes of samples that it was not made from: of the displacement across of all control points, root of
/// the sum of squares, over that of the sample or, where this is more, of the largest of |e| 0.07 to 0.13; the farthest
/// that any point is off; and the enclosed volume at worst.
struct ShapeErrors {
  double rms = 0, worst = 0, farthest_m = 0, volume = 0;
};
/// Without samples all 0.
ShapeErrors shape_errors(const ShapeTable& table, const HexahedralMesh& rest, std::span<const ShapeSample> samples);

}  // namespace mobil::inline v0_3
