#pragma once
// A muscle's static shapes at finite strain (assets/finite/shape_table.h) in the tick's layout, over the control points
// of a template's mesh. They are stored with the linear static shapes that they replace.

#include <array>
#include <vector>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/components/muscle.h>
#include "assets/fem/axial_stiffness.h"
#include "assets/finite/shape_amounts.h"

namespace mobil::inline v0_3 {

/// Immutable. Components are three a control point, node-major; m at the template's size.
struct FiniteShape {
  Cells cells{};
  float length_m = 0;          // of the template's belly at rest
  std::vector<float> vector;   // `shape_modes` numbers a component
  std::vector<float> even;     // of a belly stretched evenly by 1 m: the part of the length, only along z
  std::vector<float> stretch;  // of the linear belly stretched by 1 m, statically
  /// By mode, amount and power of ln r.
  std::array<std::array<std::array<float, shape_ratio_terms>, shape_amount_count>, shape_modes> coefficient{};
};

/// Ranges of the tables. Shortenings and slendernesses beyond take the values of these ends.
inline constexpr float min_shortening = -0.2F, max_shortening = 0.25F, min_slenderness = 0.8F, max_slenderness = 1.26F;

/// Makes the shapes for the control points of `mesh`, a template's. Tables have 3×3×9 points. Interpolation is
/// quadratic within a section, and cubic through the nearest four points along the belly.
FiniteShape make_finite_shape(Muscle muscle, const HexahedralMesh& mesh, const StaticStretch& stretch);

}  // namespace mobil::inline v0_3
