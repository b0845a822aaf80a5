#pragma once
// The bones of the right arm and shoulder, in mm of a man of reference_height_mm, in the frame of their segments.

#include "assets/surfaces/bone_shapes.h"

namespace mobil::inline v0_3::bones {

SurfaceMesh clavicle_and_scapula(const Proportions& p);
SurfaceMesh humerus(const Proportions& p);
SurfaceMesh radius_and_ulna(const Proportions& p);
SurfaceMesh hand(const Proportions& p);
SurfaceMesh fingers(const Proportions& p);
SurfaceMesh thumb(const Proportions& p);

}  // namespace mobil::inline v0_3::bones
