#pragma once
// Where a single muscle's belly lies, from its sections.

#include <mobil/muscle_table.h>

namespace mobil::inline v0_3 {

/// The line that a single muscle is drawn along: from its path's origin to its end, or to the last point fixed to the
/// bone of its origin where one lies beyond the belly. The belly is where the section is at least a fifth of the
/// largest. An origin inside the belly, as a long one's centroid is, gives way to the middle of the belly's upper end.
DrawnLine line_through_belly(const MemberMuscle& muscle);

}  // namespace mobil::inline v0_3
