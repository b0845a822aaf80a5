#pragma once
// Position of a muscle's belly, from its sections.

#include <mobil/muscle_table.h>

namespace mobil::inline v0_3 {

/// Returns the line along which a muscle is drawn, that of its largest member. It runs from the path's origin to its
/// end, or to the last point fixed to the origin's bone if that is beyond the belly. The belly is where the section is
/// at least a fifth of the largest. The middle of its upper end replaces an origin inside the belly, such as the
/// centroid of a long one.
DrawnLine line_through_belly(std::span<const MemberMuscle> members);

}  // namespace mobil::inline v0_3
