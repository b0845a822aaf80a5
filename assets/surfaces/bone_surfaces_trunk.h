#pragma once
// The vertebrae, ribs and sternum, in mm of a man of reference_height_mm, in the frame of their segments.

#include "assets/surfaces/bone_shapes.h"
#include "components/segments.h"

namespace mobil::bones {

SurfaceMesh vertebra(const Proportions& p, Segment segment);  // with its ribs, T4 with the sternum

}  // namespace mobil::bones
