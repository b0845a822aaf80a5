#pragma once
// The bones of the right leg, in mm of a man of reference_height_mm, in the frame of their segments.

#include "assets/surfaces/bone_shapes.h"

namespace mobil::inline v0_3::bones {

SurfaceMesh femur(const Proportions& p);
SurfaceMesh patella();
SurfaceMesh tibia_and_fibula(const Proportions& p);
SurfaceMesh foot(const Proportions& p);
SurfaceMesh toes(const Proportions& p);

}  // namespace mobil::inline v0_3::bones
