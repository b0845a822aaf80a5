#pragma once
// One muscle group of one body: its size, its line at rest, its belly in the anatomical position.

#include "assets/muscle_table.h"
#include "components/body.h"
#include "components/leg_frames.h"
#include "components/muscle.h"
#include "components/segments.h"
#include "engine/error.h"

namespace mobil {

/// Right side; the left is its mirror image. Lengths m.
struct MusclePlan {
  MuscleGroup group = MuscleGroup::hamstrings;
  /// L₀: the volume-weighted mean of the members' lengths in the anatomical position.
  double rest_length_m = 0;
  /// The belly's span at rest, the length of its mesh; and the drawn line's tendon from there to the insertion.
  double belly_length_m = 0, tendon_length_m = 0;
  /// Volume of the group, and the section of a bar of that volume and of the belly's length.
  double volume_m3 = 0, section_m2 = 0;
  /// The muscle frame in the anatomical position, the body standing at x = z = 0: origin at the belly's origin-side
  /// end, z along it, y the proximal bone's anterior axis as far as orthogonal.
  Vec3<double> start_m{};
  Quat<double> rotation{};
  /// What the surface beyond the belly's ends follows (right side).
  Segment origin = Segment::pelvis, insertion = Segment::shank_right;
  /// Size against the group's template (the reference body's).
  BellyScale<float> scale{};
  LegScale<float> leg_scale{};
  /// How much of L − L₀ the belly's far end takes: all of it, the tendon being inextensible.
  double elongation_factor = 1;
};

/// Fails on a body without positive lengths or masses, in one line.
Result<MusclePlan> make_muscle_plan(const Body& body, MuscleGroup group);

/// k = E·s/L₀ (equation 3 of the paper), N/m. `section_m2`: a plan's own, or the effective one of its mesh.
double bar_stiffness(const Material& material, double section_m2, double rest_length_m);

/// A leg's bones in the anatomical position, the body standing at x = z = 0.
LegFrames<double> anatomical_leg(const Body& body);
LegScale<double> leg_scale(const Body& body);

/// Length (m) of one member's path, in double: what the tick's kernel computes in lanes.
double member_length(const MemberMuscle& muscle, const LegScale<double>& scale, const LegFrames<double>& leg);
/// Volume-weighted mean of a group's members. Weights are the members' volumes in the reference body.
double group_length(MuscleGroup group, const LegScale<double>& scale, const LegFrames<double>& leg);

}  // namespace mobil
