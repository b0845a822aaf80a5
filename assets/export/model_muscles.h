#pragma once
// Muscles of a body as musculoskeletal models have them: points on segments, fibre, tendon, force.

#include <mobil/assets/muscles/muscle_path.h>
#include <mobil/components/body.h>
#include <mobil/components/segments.h>
#include <mobil/muscle_table.h>

namespace mobil::inline v0_3 {

/// Returns a bone's segment on that side.
Segment bone_segment(LegBone bone, std::size_t side);
/// Returns the place of a path's point in its segment's frame, m.
Vec3<double> member_place(const Body& body, const PathPoint& point, std::size_t side);

/// A muscle of fibre and tendon in series, as the simulation has them.
struct HillMuscle {
  double force_n = 0;                // isometric, along the fibres: 0.3 MPa on volume over fibre length
  double fibre_m = 0, tendon_m = 0;  // optimal and slack
  double pennation_rad = 0;
};
HillMuscle hill_muscle(const Body& body, const MemberMuscle& member);

/// Returns a right leg in the anatomical position, but bent in the sagittal plane: hip and knee flexed, ankle
/// dorsiflexed by these angles, degrees.
LegFrames<double> bent_leg(const Body& body, double hip_deg, double knee_deg, double ankle_deg);

}  // namespace mobil::inline v0_3
