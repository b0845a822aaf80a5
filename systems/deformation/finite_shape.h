#pragma once
// Finite-strain shape of a belly, added to a method's result instead of the linear static shape. The belly keeps its
// volume and is short and thick when active. Vibration passes through.

#include <mobil/components/activation.h>
#include <mobil/components/lanes.h>
#include <mobil/components/muscle.h>
#include "assets/fem/muscle_template.h"
#include "assets/finite/finite_shape.h"

namespace mobil::inline v0_3 {

/// Inputs of the shape of sixteen bellies at a tick's end. `activation` can be null: relaxed.
struct ShapeBlock {
  const FiniteShape& shape;
  const BellyScale<Lanes<float>>& scale;
  const Lanes<float>& far_end_m;  // displacement of the far face along z
  const Lanes<float>* activation;
};

/// Amounts of the shape's modes at the template's size, the part of the far end's displacement (m) within the tables'
/// range, and the rest, which the method's own static solution still shows.
struct ShapeBlend {
  Lanes<float> vector[shape_modes], within_m, beyond_m;
};
ShapeBlend blend_of(const ShapeBlock& block);

/// Writes `shown` = `computed` + shape, three numbers per control point × 16 (the two can be the same). With
/// `in_place_of_linear` it subtracts the linear static solution for `within_m` that `computed` contains, for a body of
/// the template's slenderness. A NaN stays in its lane.
void add_shape(const ShapeBlock& block, const ShapeBlend& blend, bool in_place_of_linear, const float* computed,
               float* shown);

/// Writes to the report the volume enclosed by the shown control points of `control` over that at rest.
void report_volume(const MuscleTemplate& control, const BellyScale<Lanes<float>>& scale, const float* shown,
                   Lanes<float>& volume_ratio);

}  // namespace mobil::inline v0_3
