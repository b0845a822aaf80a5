#pragma once
// Lengthening speeds of lines of action, and their moment arms about the joints.

#include <mobil/components/leg_frames.h>
#include <mobil/components/muscle.h>
#include "systems/lines/muscle_lines.h"

namespace mobil::inline v0_3 {

/// Computes the speed (line.length_m − motion.length_m) / tick_s, 0 where motion.length_m is 0, and the moment arms, of
/// this tick's leg and length. Arms are about the x axes of pelvis, thigh and shank, through hip, knee and ankle
/// (flexion).
///
/// The arms are exact derivatives, not differences. By the principle of virtual work, a rotation of all distal parts
/// changes the length as the unit vector of the segment that crosses the joint rotates with it. Over an edge the path
/// is the shortest one, so sliding along the edge adds nothing to first order. The kneecap's movement and the rolling
/// of the knee are included. In single precision the arms are accurate to 8 µm.
///
/// A left leg is computed as its mirror image, a right leg. A NaN stays in its lane.
void line_motion(const MuscleLines& lines, const LegScale<Lanes<float>>& scale, const LegFrames<Lanes<float>>& legs,
                 const LineOfAction<Lanes<float>>& line, LineMotion<Lanes<float>>& motion, float tick_s);

}  // namespace mobil::inline v0_3
