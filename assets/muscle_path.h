#pragma once
// How long a muscle is in a posed leg: its members' published paths, in double.

#include <array>
#include <span>

#include "assets/muscle_table.h"
#include "components/body.h"
#include "components/leg_frames.h"

namespace mobil {

/// A leg's bones in the anatomical position, the body standing at x = z = 0.
LegFrames<double> anatomical_leg(const Body& body);
/// The body's thigh, shank and leg over the published ones.
LegScale<double> leg_scale(const Body& body);
/// Those of a leg of these segment lengths, m.
LegScale<double> leg_scale(double thigh_m, double shank_m);

/// Where a point of a path is in that leg, m.
Vec3<double> path_point(const PathPoint& point, const LegScale<double>& scale, const LegFrames<double>& leg);
/// What the path ends on at that knee flexion, as a point of its bone.
PathPoint path_end(const MemberMuscle& muscle, double flexion_deg);

/// Length (m) of one member's path, in double: what the tick's kernel computes in lanes.
double member_length(const MemberMuscle& muscle, const LegScale<double>& scale, const LegFrames<double>& leg);
/// Volume-weighted mean of a muscle's members.
double muscle_length(Muscle muscle, const LegScale<double>& scale, const LegFrames<double>& leg);
/// The share of one of a row's members in its volume in the reference body: its weight in the mean.
double member_weight(std::span<const MemberMuscle> members, const MemberMuscle& muscle);

/// Knee flexion (rad) from the rotations of the two bones.
double knee_flexion(const LegFrames<double>& leg);

/// Natural cubic spline through a kneecap's track as t₀ + t₁u + Σ cₖ·max(u − k, 0)³, u = flexion / 20°.
struct KneecapSpline {
  Vec3<double> at_zero, slope;
  std::array<Vec3<double>, kneecap_knots> cubic;
};
KneecapSpline kneecap_spline(const KneecapTrack& track);

}  // namespace mobil
