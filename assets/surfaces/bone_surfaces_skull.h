#pragma once
// The skull, in mm of a man of reference_height_mm, in the frame of its segment.

#include <mobil/components/surface.h>

namespace mobil::inline v0_3::bones {

SurfaceMesh skull();

}  // namespace mobil::inline v0_3::bones
