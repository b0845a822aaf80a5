#pragma once
// How fast lines of action lengthen, and by which moment arms they turn the joints.

#include <mobil/components/leg_frames.h>
#include <mobil/components/muscle.h>
#include "systems/lines/muscle_lines.h"

namespace mobil::inline v0_3 {

/// Speed (line.length_m − motion.length_m) / tick_s, 0 where motion.length_m is 0, and moment arms about the flexion
/// axes (the x axes of pelvis, thigh and shank, through hip, knee and ankle), of the leg and the length of this tick.
///
/// The arms are exact derivatives, not differences: by the principle of virtual work a rotation of all that is distal
/// changes the length as the unit vector of the segment that crosses the joint turns with it. Over an edge the path is
/// the shortest one, so that its sliding along the edge adds nothing to first order; the kneecap's own movement and the
/// knee's rolling add theirs. In single precision they are right to 8 µm.
///
/// For a left leg as for the right one, its mirror image. A NaN stays in its lane.
void line_motion(const MuscleLines& lines, const LegScale<Lanes<float>>& scale, const LegFrames<Lanes<float>>& legs,
                 const LineOfAction<Lanes<float>>& line, LineMotion<Lanes<float>>& motion, float tick_s);

}  // namespace mobil::inline v0_3
