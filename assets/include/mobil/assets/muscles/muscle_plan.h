#pragma once
// Plan of one muscle of one body: size, line at rest, belly in the anatomical position.

#include <array>

#include <mobil/assets/muscles/muscle_path.h>
#include <mobil/components/body.h>
#include <mobil/components/leg_frames.h>
#include <mobil/components/muscle.h>
#include <mobil/components/segments.h>
#include <mobil/engine/error.h>
#include <mobil/muscle_table.h>

namespace mobil::inline v0_3 {

/// Mean stature of the cadavers whose fibres were measured (muscle_architecture.h).
inline constexpr double cadaver_stature_m = 1.684;

/// One member of a row in one body, as a fibre and a tendon in series (systems/activation/musculotendon.h).
struct MemberPlan {
  double rest_length_m = 0, volume_m3 = 0;  // of the path in the anatomical position; of the muscle
  double fibre_m = 0, tendon_m = 0;         // optimal and slack, as in the published model for that path
};
/// Makes the plan of a member. `rest_length_m` is the length of its path in the anatomical position.
MemberPlan plan_member(const Body& body, const MemberMuscle& member, double rest_length_m);

/// Plan of a muscle, right side; the left is its mirror image. Lengths in m.
struct MusclePlan {
  Muscle muscle = Muscle::hamstrings;
  /// L₀, the volume-weighted mean of the members' lengths in the anatomical position.
  double rest_length_m = 0;
  /// Span of the belly at rest, which is the length of its mesh. The drawn line's tendon runs from there to the
  /// insertion (0 if the belly extends past it).
  double belly_length_m = 0, tendon_length_m = 0;
  /// Volume of the muscle, and section of a bar of that volume and of the belly's length.
  double volume_m3 = 0, section_m2 = 0;
  /// The muscle frame in the anatomical position, the body standing at x = z = 0. Its origin is the belly's origin-side
  /// end and z runs along the belly. y is the proximal bone's anterior axis, carried without twist from that bone's
  /// long axis to z; x = y×z.
  Vec3<double> start_m{};
  Quat<double> rotation{};
  /// Segments that the surface beyond the belly's ends follows (right side).
  Segment origin = Segment::pelvis, insertion = Segment::shank_right;
  /// Size relative to the muscle's template (the reference body's).
  BellyScale<float> scale{};
  LegScale<float> leg_scale{};
  std::array<MemberPlan, max_row_members> member{};  // in the row's order
};

/// Makes the plan of a muscle. Fails on a body without positive lengths or masses, an unknown muscle or constitution.
Result<MusclePlan> make_muscle_plan(const Body& body, Muscle muscle);

/// Returns k = E·s/L₀ (equation 3 of the paper), N/m. `section_m2` is a plan's own, or the effective one of its mesh.
double bar_stiffness(const Material& material, double section_m2, double rest_length_m);

/// Returns the belly length of a muscle's template, which is that of the reference body.
double reference_belly_m(Muscle muscle);

/// Returns the volume of a member in a body. The part of the regression that scales with the limb's volume is
/// multiplied by the body's muscle factor, the constant part is not. A muscle has at least half of its share in the
/// reference body's limb. The volume rises with height, mass and mesomorphy.
double member_volume_m3(const Body& body, const MemberMuscle& member);

}  // namespace mobil::inline v0_3
