#pragma once
// Length, force and position of a leg's lines of action from its pose, in blocks of sixteen legs.

#include <cstddef>
#include <span>

#include <mobil/components/leg_frames.h>
#include <mobil/components/muscle.h>
#include <mobil/components/pose.h>
#include "engine/fetch_ahead.h"
#include "systems/lines/muscle_lines.h"

namespace mobil::inline v0_3 {

/// Copies one leg of one person into a lane: joint centres and rotations of thigh, shank and foot, and rotation of the
/// pelvis. A left leg becomes its mirror image. `pose` points to the first word of the person's lane in a block of
/// Pose. The other words follow at a distance of `lane_count` floats. NaNs are not detected.
void gather_leg(const float* pose, Side side, LegFrames<Lanes<float>>& legs, std::size_t lane);
/// Publishes both legs of sixteen people for their muscles. `next`, the following block or null, is prefetched, not
/// read.
void post_legs(const Pose<Lanes<float>>& pose, const Pose<Lanes<float>>* next, PublishedLeg* posts);
/// Gathers sixteen published legs into the lanes of a block.
void take_legs(const PublishedLeg::Leg* const (&from)[lane_count], LegFrames<Lanes<float>>& legs);
/// Copies one leg from a single row.
void gather_leg(const Pose<float>& pose, Side side, LegFrames<Lanes<float>>& legs, std::size_t lane);

/// Computes length L along the path (origin, points that bend it, kneecap, insertion), force −k(L − L₀), and the
/// muscle's frame. The force is equation 2 of the paper. k and L₀ are `line.stiffness_n_per_m` and
/// `line.rest_length_m`. The frame's origin is the belly's origin-side end, and z runs along the drawn line. y is the
/// anterior axis of the proximal bone, carried without twist from that bone's long axis to z. For a left leg all
/// results are those of its mirror image.
///
/// `end` receives the drive of the belly's far end over this tick, starting where the last tick ended. A held end is
/// moved to L − L₀, m (the tendon does not stretch). A sliding end is loaded by +k(L − L₀) along z, N. A line of length
/// 0 has not been computed yet, so its drive starts at its final value.
///
/// `member_m`, unless null, receives the length of each member's path, m. `ahead` is prefetched meanwhile.
///
/// Undefined where the line runs opposite to its usual sense along the bone's long axis. A NaN stays in its lane.
void lines_of_action(const MuscleLines& lines, const LegScale<Lanes<float>>& scale, const LegFrames<Lanes<float>>& legs,
                     FarEnd far_end, LineOfAction<Lanes<float>>& line, EndDrive<Lanes<float>>& end,
                     Lanes<float>* member_m = nullptr, std::span<FetchAhead> ahead = {});

}  // namespace mobil::inline v0_3
