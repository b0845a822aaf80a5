#pragma once
// From a leg's pose to the length, force and place of its lines of action, sixteen legs a block.

#include <cstddef>
#include <vector>

#include "assets/muscle_table.h"
#include "components/leg_frames.h"
#include "components/muscle.h"
#include "components/pose.h"

namespace mobil {

/// The paths of a muscle's members as the kernel reads them: the table's rows in single precision, at the
/// published leg's size. Immutable, the same for everybody.
struct MuscleLines {
  struct Point {
    LegBone bone;
    Vec3<float> at_m;
    /// Of a point that bends the path at some knee angles only: which of the member's points (their number: the path's
    /// end) closes the straight line that it bends. 0: it always bends it.
    std::size_t straight_to = 0;
    /// Knee flexions (rad) at which it begins to bend the path, and to let go of it.
    float from_rad = 0, to_rad = 0;
  };
  struct Member {
    std::vector<Point> path;
    float weight;
    bool on_kneecap;
    Vec3<float> kneecap_at_zero, kneecap_slope, kneecap_cubic[kneecap_knots];  // a spline: assets/muscle_path.h
  };
  std::vector<Member> members;
  // The drawn line: from the anchor towards a point of members[towards], or what its path ends on where it has no such
  // point; the belly begins start_m from the anchor.
  Point anchor;
  std::size_t towards, point;
  LegBone along;  // the bone that start_m scales with
  float start_m;
};

/// A muscle's lines: its length is the volume-weighted mean of its members'.
MuscleLines make_muscle_lines(Muscle muscle);

/// Copies one leg of one human into a lane: joint centres and rotations of thigh, shank and foot, and the pelvis'
/// rotation; a left leg as its mirror image. `pose`: the human's lane of a block of Pose, that is its first word, the
/// others following at a distance of `lane_count` floats; no NaN is looked for.
void gather_leg(const float* pose, Side side, LegFrames<Lanes<float>>& legs, std::size_t lane);
/// The same from one row.
void gather_leg(const Pose<float>& pose, Side side, LegFrames<Lanes<float>>& legs, std::size_t lane);

/// Length L along the path (origin, points that bend it, kneecap, insertion), force −k(L − L₀) (equation 2 of the
/// paper; k and L₀ are `line.stiffness_n_per_m` and `line.rest_length_m`), and the muscle's frame: origin at the
/// belly's origin-side end, z along the drawn line, y the proximal bone's anterior axis carried without twist from that
/// bone's long axis to z. For a left leg all of it is the mirror image's.
///
/// `end` gets what moves the belly's far end over this tick: from where the last tick ended to L − L₀ (the tendon does
/// not stretch). A line of length 0 has not been computed yet: then it begins where it ends.
///
/// Defined while no bone's long axis points along the line against its usual sense. A NaN stays in its lane.
void lines_of_action(const MuscleLines& lines, const LegScale<Lanes<float>>& scale, const LegFrames<Lanes<float>>& legs,
                     LineOfAction<Lanes<float>>& line, EndDisplacement<Lanes<float>>& end);
/// The same for a belly that is pulled: by +k(L − L₀) along z.
void lines_of_action(const MuscleLines& lines, const LegScale<Lanes<float>>& scale, const LegFrames<Lanes<float>>& legs,
                     LineOfAction<Lanes<float>>& line, EndForce<Lanes<float>>& end);

/// Knee flexion (rad) of sixteen legs, from their thigh and shank.
void knee_flexions(const LegFrames<Lanes<float>>& legs, Lanes<float>& flexion_rad);

}  // namespace mobil
