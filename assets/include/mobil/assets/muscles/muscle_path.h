#pragma once
// Length of a muscle in a posed leg, from its members' published paths, in double.

#include <array>
#include <span>
#include <vector>

#include <mobil/components/body.h>
#include <mobil/components/leg_frames.h>
#include <mobil/muscle_table.h>

namespace mobil::inline v0_3 {

/// Returns a leg's bones in the anatomical position, the body standing at x = z = 0.
LegFrames<double> anatomical_leg(const Body& body);
/// Returns the body's thigh, shank and leg over the published ones.
LegScale<double> leg_scale(const Body& body);
/// Returns the scale of a leg of these segment lengths, m.
LegScale<double> leg_scale(double thigh_m, double shank_m);

/// Returns the spline through a track.
KneeSpline<double> knee_spline(const KneeTrack& track);
Vec3<double> track_at(const KneeTrack& track, double flexion_deg);

/// Returns the knee flexion (rad) from the rotations of the two bones.
double knee_flexion(const LegFrames<double>& leg);

/// Returns the leg in which paths run: shank and foot move as the published knee rolls (0 in the anatomical position).
LegFrames<double> rolled(const LegScale<double>& scale, const LegFrames<double>& leg);

/// Returns the origin of a bone's frame in that leg, m.
Vec3<double> bone_origin(LegBone bone, const LegFrames<double>& leg);
/// Returns the position of a path's point in that leg, which is not rolled here (m).
Vec3<double> path_point(const PathPoint& point, const LegScale<double>& scale, const LegFrames<double>& leg);
/// Returns the end of the path at that knee flexion, as a point of its bone.
PathPoint path_end(const MemberMuscle& muscle, double flexion_deg);

/// A corner of one member's path. `member_path` returns them from the origin on, without edges that the path clears
/// (m); `leg` must not be rolled yet.
struct PathCorner {
  Vec3<double> at;
  LegBone bone;
};
std::vector<PathCorner> member_path(const MemberMuscle& muscle, const LegScale<double>& scale,
                                    const LegFrames<double>& leg);
/// Returns the path's length (m) in double; the tick's kernel computes it in lanes.
double member_length(const MemberMuscle& muscle, const LegScale<double>& scale, const LegFrames<double>& leg);
/// Returns the lengths of all members of a row, in its order.
std::vector<double> member_lengths(Muscle muscle, const LegScale<double>& scale, const LegFrames<double>& leg);
/// Returns the volume-weighted mean length of a muscle's members.
double muscle_length(Muscle muscle, const LegScale<double>& scale, const LegFrames<double>& leg);
/// Returns that mean from member lengths computed earlier.
double muscle_length(Muscle muscle, std::span<const double> member_m);
/// Returns a member's share in its row's volume in the reference body, which is its weight in the mean.
double member_weight(std::span<const MemberMuscle> members, const MemberMuscle& muscle);

}  // namespace mobil::inline v0_3
