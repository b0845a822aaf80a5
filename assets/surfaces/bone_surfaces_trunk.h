#pragma once
// The vertebrae, ribs and sternum, in mm of a man of reference_height_mm, in the frame of their segments.

#include <mobil/components/segments.h>
#include "assets/surfaces/bone_shapes.h"

namespace mobil::inline v0_3::bones {

SurfaceMesh vertebra(const Proportions& p, Segment segment);  // with its ribs, T4 with the sternum

}  // namespace mobil::inline v0_3::bones
