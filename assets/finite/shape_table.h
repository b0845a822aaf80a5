#pragma once
// Static shapes of a muscle's belly in all bodies. They are a few modes of control points,
//   displacement = −e·z along z + Σ_v b_v·c_v,  c = C(r)·f(e, ρ(a)),  C(r) = C₀ + C₁ ln r + C₂ ln² r.
// e is the shortening over the length at rest, a the activation, r a body's size across over that along. All are at the
// template's size: a body multiplies x and y by its size across, z by that along. Both ends are exact, with b 0 there.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/engine/error.h>
#include "assets/finite/shape_amounts.h"
#include "assets/finite/shape_samples.h"

namespace mobil::inline v0_3 {

/// `vector[v][i]` is b_v at the points between the ends, three numbers a point, m. `coefficient[t][v][f]` is C_t.
struct ShapeTable {
  Cells control = {2, 2, 8};
  std::vector<std::vector<double>> vector;
  std::array<std::vector<std::array<double, shape_amount_count>>, shape_ratio_terms> coefficient;
};

/// Returns a body's C(r), one row a mode. Made once a body.
std::vector<std::array<double, shape_amount_count>> body_coefficients(const ShapeTable& table, double ratio);

/// Returns the displacement of all control points, three a point, m, at the template's size. `rest` is the template's
/// control mesh, whose planes are numbered along z.
std::vector<double> shape_at(const ShapeTable& table,
                             std::span<const std::array<double, shape_amount_count>> coefficients,
                             const HexahedralMesh& rest, double shortening, double activation);

/// Fits a table to the samples (of the control mesh `rest`) by least squares, then keeps the `modes` modes with most of
/// it. Displacements along z count `along_weight` times as much as those across, which are visible. Fails unless there
/// are more samples than coefficients (three an amount), all with three numbers a point, and 1 mode or up to that many.
Result<ShapeTable> fit_shape_table(std::span<const ShapeSample> samples, const HexahedralMesh& rest, std::size_t modes,
                                   double along_weight = 0.2);

/// Errors of a table on samples outside of its fit. `rms` and `worst` are root sums of squares of the displacement
/// across of all control points, over the sample's or, if larger, the largest of |e| 0.07 to 0.13. `farthest_m` is the
/// largest error of any point, `volume` the largest of the enclosed volume.
struct ShapeErrors {
  double rms = 0, worst = 0, farthest_m = 0, volume = 0;
};
/// Returns the errors, all 0 without samples.
ShapeErrors shape_errors(const ShapeTable& table, const HexahedralMesh& rest, std::span<const ShapeSample> samples);

}  // namespace mobil::inline v0_3
