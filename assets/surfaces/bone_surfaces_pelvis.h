#pragma once
// The pelvis, in mm of a man of reference_height_mm, in the frame of its segment.

#include "components/surface.h"

namespace mobil::bones {

SurfaceMesh pelvis();

}  // namespace mobil::bones
