#pragma once
// From a leg's pose to the length, force and place of its lines of action, sixteen legs a block.

#include <cstddef>
#include <span>

#include <mobil/components/leg_frames.h>
#include <mobil/components/muscle.h>
#include <mobil/components/pose.h>
#include "engine/fetch_ahead.h"
#include "systems/lines/muscle_lines.h"

namespace mobil::inline v0_3 {

/// Copies one leg of one person into a lane: joint centres and rotations of thigh, shank and foot, and the pelvis'
/// rotation; a left leg as its mirror image. `pose`: the person's lane of a block of Pose, that is its first word, the
/// others following at a distance of `lane_count` floats; no NaN is looked for.
void gather_leg(const float* pose, Side side, LegFrames<Lanes<float>>& legs, std::size_t lane);
/// The same of both legs of sixteen people, for their muscles to look up. `next`: the block that follows, fetched
/// meanwhile and never read; may be null.
void post_legs(const Pose<Lanes<float>>& pose, const Pose<Lanes<float>>* next, PublishedLeg* posts);
/// Sixteen of them side by side.
void take_legs(const PublishedLeg::Leg* const (&from)[lane_count], LegFrames<Lanes<float>>& legs);
/// The same from one row.
void gather_leg(const Pose<float>& pose, Side side, LegFrames<Lanes<float>>& legs, std::size_t lane);

/// Length L along the path (origin, points that bend it, kneecap, insertion), force −k(L − L₀) (equation 2 of the
/// paper; k and L₀ are `line.stiffness_n_per_m` and `line.rest_length_m`), and the muscle's frame: origin at the
/// belly's origin-side end, z along the drawn line, y the proximal bone's anterior axis carried without twist from that
/// bone's long axis to z. For a left leg all of it is the mirror image's.
///
/// `end` gets what drives the belly's far end over this tick, from where the last tick ended: where it is held, to L −
/// L₀ (the tendon does not stretch), m; where it slides, to +k(L − L₀) along z, N. A line of length 0 has not been
/// computed yet: then it begins where it ends.
///
/// `member_m`, unless null: the length of each member's path, m. `ahead` is fetched meanwhile.
///
/// Defined while no bone's long axis points along the line against its usual sense. A NaN stays in its lane.
void lines_of_action(const MuscleLines& lines, const LegScale<Lanes<float>>& scale, const LegFrames<Lanes<float>>& legs,
                     FarEnd far_end, LineOfAction<Lanes<float>>& line, EndDrive<Lanes<float>>& end,
                     Lanes<float>* member_m = nullptr, std::span<FetchAhead> ahead = {});

}  // namespace mobil::inline v0_3
