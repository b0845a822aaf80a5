#pragma once
// How long a muscle is in a posed leg: its members' published paths, in double.

#include <array>
#include <span>
#include <vector>

#include <mobil/components/body.h>
#include <mobil/components/leg_frames.h>
#include <mobil/muscle_table.h>

namespace mobil::inline v0_3 {

/// A leg's bones in the anatomical position, the body standing at x = z = 0.
LegFrames<double> anatomical_leg(const Body& body);
/// The body's thigh, shank and leg over the published ones.
LegScale<double> leg_scale(const Body& body);
/// Those of a leg of these segment lengths, m.
LegScale<double> leg_scale(double thigh_m, double shank_m);

/// The spline through a track.
KneeSpline<double> knee_spline(const KneeTrack& track);
Vec3<double> track_at(const KneeTrack& track, double flexion_deg);

/// Knee flexion (rad) from the rotations of the two bones.
double knee_flexion(const LegFrames<double>& leg);

/// The leg with shank and foot where the published knee rolls to; paths run there. In the anatomical position the same.
LegFrames<double> rolled(const LegScale<double>& scale, const LegFrames<double>& leg);

/// The origin of a bone's frame in that leg, m.
Vec3<double> bone_origin(LegBone bone, const LegFrames<double>& leg);
/// Where a point of a path is in that leg, as it is given (m).
Vec3<double> path_point(const PathPoint& point, const LegScale<double>& scale, const LegFrames<double>& leg);
/// What the path ends on at that knee flexion, as a point of its bone.
PathPoint path_end(const MemberMuscle& muscle, double flexion_deg);

/// The corners of one member's path, origin first, edges that it is free of left out (m); `leg` as it stands, not yet
/// rolled.
struct PathCorner {
  Vec3<double> at;
  LegBone bone;
};
std::vector<PathCorner> member_path(const MemberMuscle& muscle, const LegScale<double>& scale,
                                    const LegFrames<double>& leg);
/// Its length (m) in double: what the tick's kernel computes in lanes.
double member_length(const MemberMuscle& muscle, const LegScale<double>& scale, const LegFrames<double>& leg);
/// Of each of a row's members, in its order.
std::vector<double> member_lengths(Muscle muscle, const LegScale<double>& scale, const LegFrames<double>& leg);
/// Volume-weighted mean of a muscle's members.
double muscle_length(Muscle muscle, const LegScale<double>& scale, const LegFrames<double>& leg);
/// The same of lengths that are known.
double muscle_length(Muscle muscle, std::span<const double> member_m);
/// The share of one of a row's members in its volume in the reference body: its weight in the mean.
double member_weight(std::span<const MemberMuscle> members, const MemberMuscle& muscle);

}  // namespace mobil::inline v0_3
