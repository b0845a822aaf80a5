#pragma once
// The shape of a belly at finite strain in place of the linear static one, on top of what a method computes: it keeps
// its volume, and where it pulls it is short and thick. Vibration passes through.

#include <mobil/components/activation.h>
#include <mobil/components/lanes.h>
#include <mobil/components/muscle.h>
#include "assets/fem/muscle_template.h"
#include "assets/finite/finite_shape.h"

namespace mobil::inline v0_3 {

/// What sixteen bellies are to look like at a tick's end. `activation` may be null: relaxed.
struct ShapeBlock {
  const FiniteShape& shape;
  const BellyScale<Lanes<float>>& scale;
  const Lanes<float>& far_end_m;  // displacement of the far face along z
  const Lanes<float>* activation;
};

/// How much of each vector there is, at the template's size; and what of the far end's displacement (m) is within the
/// tables' range, and what is left over, which the method's own statics go on to show.
struct ShapeBlend {
  Lanes<float> vector[shape_modes], within_m, beyond_m;
};
ShapeBlend blend_of(const ShapeBlock& block);

/// `shown` = `computed` + shape, three a control point × 16 (they may be the same). `in_place_of_linear`: less the
/// linear static answer to `within_m`, which is in `computed`, as a body of the template's slenderness has it. A NaN
/// stays in its lane.
void add_shape(const ShapeBlock& block, const ShapeBlend& blend, bool in_place_of_linear, const float* computed,
               float* shown);

/// Volume that the shown control points of `control` enclose over that at rest, into the report.
void report_volume(const MuscleTemplate& control, const BellyScale<Lanes<float>>& scale, const float* shown,
                   Lanes<float>& volume_ratio);

}  // namespace mobil::inline v0_3
