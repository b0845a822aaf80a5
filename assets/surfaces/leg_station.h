#pragma once
// Conversion of the leg's measured sections to stations of tubes.

#include <mobil/assets/muscles/leg_sections.h>
#include "assets/surfaces/tube.h"

namespace mobil::inline v0_3 {

/// Returns a station for `loft`, whose reference must be the planes' anterior and whose normal theirs: metres, world
/// axes. Without `planes` they are horizontal.
TubeStation leg_station(const LegFrame& leg, const SectionPlanes& planes, const LegSection& section);
TubeStation leg_station(const LegFrame& leg, const LegSection& section);

}  // namespace mobil::inline v0_3
