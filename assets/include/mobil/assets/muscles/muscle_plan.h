#pragma once
// One muscle of one body: its size, its line at rest, its belly in the anatomical position.

#include <array>

#include <mobil/assets/muscles/muscle_path.h>
#include <mobil/components/body.h>
#include <mobil/components/leg_frames.h>
#include <mobil/components/muscle.h>
#include <mobil/components/segments.h>
#include <mobil/engine/error.h>
#include <mobil/muscle_table.h>

namespace mobil::inline v0_3 {

/// Mean stature of those whose fibres were measured (muscle_architecture.h).
inline constexpr double cadaver_stature_m = 1.684;

/// One of a row's members in one body, as a fibre and a tendon in line (systems/activation/musculotendon.h).
struct MemberPlan {
  double rest_length_m = 0, volume_m3 = 0;  // of the path in the anatomical position; of the muscle
  double fibre_m = 0, tendon_m = 0;         // optimal and slack, as the published model has them for that path
};
/// `rest_length_m`: of the member's path in the anatomical position.
MemberPlan plan_member(const Body& body, const MemberMuscle& member, double rest_length_m);

/// Right side; the left is its mirror image. Lengths m.
struct MusclePlan {
  Muscle muscle = Muscle::hamstrings;
  /// L₀: the volume-weighted mean of the members' lengths in the anatomical position.
  double rest_length_m = 0;
  /// The belly's span at rest, the length of its mesh; and the drawn line's tendon from there to the insertion
  /// (0 where the belly goes on beside it).
  double belly_length_m = 0, tendon_length_m = 0;
  /// Its volume, and the section of a bar of that volume and of the belly's length.
  double volume_m3 = 0, section_m2 = 0;
  /// The muscle frame in the anatomical position, the body standing at x = z = 0: origin at the belly's origin-side
  /// end, z along it, y the proximal bone's anterior axis carried without twist from that bone's long axis to z, x =
  /// y×z.
  Vec3<double> start_m{};
  Quat<double> rotation{};
  /// What the surface beyond the belly's ends follows (right side).
  Segment origin = Segment::pelvis, insertion = Segment::shank_right;
  /// Size against the muscle's template (the reference body's).
  BellyScale<float> scale{};
  LegScale<float> leg_scale{};
  std::array<MemberPlan, max_row_members> member{};  // in the row's order
};

/// Fails on a body without positive lengths or masses, in one line.
Result<MusclePlan> make_muscle_plan(const Body& body, Muscle muscle);

/// k = E·s/L₀ (equation 3 of the paper), N/m. `section_m2`: a plan's own, or the effective one of its mesh.
double bar_stiffness(const Material& material, double section_m2, double rest_length_m);

/// Length of the belly of a muscle's template: that of the reference body.
double reference_belly_m(Muscle muscle);

/// Volume of a member in a body: of the regression the part that goes with the limb's volume, times the body's muscle
/// factor, and the part that does not. It rises with height, mass and mesomorphy.
double member_volume_m3(const Body& body, const MemberMuscle& member);

}  // namespace mobil::inline v0_3
