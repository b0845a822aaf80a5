#pragma once
// The muscles of a leg as published figures: where each one runs, how large it is, what it looks like. To add a muscle
// is to add a row: a file in assets/muscles/rows, and its name in muscle_table.cpp.
//
// Sources. Paths: the gait2392 model of OpenSim (CC BY 3.0; Delp, Loan, Hoy, Zajac, Topp, Rosen: An interactive
// graphics-based model of the lower extremity, IEEE Trans. Biomed. Eng. 37, 1990); what is an edge here is there a
// point that bends the path from or up to some knee flexion, and the edge takes over within a few degrees of it.
// Volumes: regression of Handsfield, Meyer, Hart, Abel, Blemker: Relationships of 35 lower limb muscles to height and
// body mass, J. Biomech. 47, 2014. Sections: measured for this project from the surfaces of BodyParts3D 3.0 (© The
// Database Center for Life Science, licensed under CC Attribution-Share Alike 2.1 Japan), a man of about 1.69 m: area,
// centroid and second moments of the cut of each surface. Fibres and tendons: assets/muscles/muscle_architecture.h.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include <mobil/assets/muscles/fixed_list.h>
#include <mobil/assets/muscles/leg_sections.h>
#include <mobil/components/lanes.h>
#include <mobil/components/muscle.h>
#include <mobil/components/segments.h>

namespace mobil::inline v0_3 {

/// The bones of one leg that a path is fixed to. Their frames have mobil's axes and these origins: pelvis the hip
/// centre, thigh the hip centre, shank the knee, foot the ankle.
enum class LegBone : std::uint8_t { pelvis, thigh, shank, foot };

/// Sizes of the leg that the paths were published for, m. Its segments end at the pin that fits its rolling knee best
/// from 0° to 100°; where the knee rolls to besides (0.6 mm rms there, 4 mm at 120°) see knee_rolling().
namespace published_leg {
inline constexpr double thigh_m = 0.40846, shank_m = 0.41736, leg_m = thigh_m + shank_m;
}  // namespace published_leg

/// How a path keeps to a point: it goes through it; or the point lies on an edge across its bone (parallel to the
/// bone's x axis) that the path must pass in front of, or behind. Over an edge it slides to where it is shortest, as a
/// taut string without friction, and where the straight line is free of it, it is that line: so the length has a
/// continuous derivative, and no angle at which to switch needs to be given.
enum class PathHold : std::uint8_t { fixed, front, back };

/// One point of a path, right side, in its bone's frame at the published leg's size, m. In a body: y of thigh and shank
/// times that segment's length over the published one, all else times the leg's. Edges are of thigh and shank, and
/// neither first nor last.
struct PathPoint {
  LegBone bone;
  Vec3<double> at_m;
  PathHold hold = PathHold::fixed;
};

/// A place that moves in the shank's frame, at knee flexions of 0°, 20°, … 120°: a natural cubic spline, straight
/// beyond its ends.
inline constexpr std::size_t knee_knots = 7;
inline constexpr double knee_knot_deg = 20;
using KneeTrack = std::array<Vec3<double>, knee_knots>;

/// That spline: t₀ + t₁u + Σ cₖ·max(u − k, 0)³, u = flexion / 20°.
template <class F>
struct KneeSpline {
  Vec3<F> at_zero, slope;
  std::array<Vec3<F>, knee_knots> cubic;
};

/// One muscle of the leg as it was published: a row of the table, assets/muscles/rows/NAME.inl. What has no value here
/// must be given; muscle_table.cpp checks the rest when it is compiled.
struct MemberMuscle {
  std::string_view name;
  Muscle group;
  Segment origin, insertion;  // right side: what the surface beyond the belly's ends follows

  FixedList<PathPoint, 6> path;                     // origin first
  std::optional<KneeTrack> kneecap = std::nullopt;  // what a path ends on after its last point

  /// Volume (cm³) = limb_share · (47 · mass · height + 1285) + offset_cm3, in kg and m.
  double limb_share, offset_cm3;

  /// Inside: see assets/muscles/muscle_architecture.h. `model_…`: gait2392's; 0 where it has none.
  double fibre_m, pennation_deg, belly_m;
  double model_fibre_m = 0, model_pennation_deg = 0, model_tendon_m = 0, model_path_m = 0;

  /// The muscle's shape as measured, upper end first, tendon included (the quadriceps down to the kneecap): see
  /// mobil/assets/muscles/leg_sections.h for what a section means.
  FixedList<LegSection, 16> sections;
  /// How the drawn shape differs, whose ends are where the muscle is attached: without the last `not_drawn` measured
  /// sections, which do not suit this skeleton's kneecap or bones, and with others above and below.
  std::size_t not_drawn = 0;
  FixedList<LegSection, 4> drawn_above = {};
  FixedList<LegSection, 12> drawn_below = {};
  std::string_view lies_on = {};      // the member that it covers and is pushed out by
  std::string_view cut_back_to = {};  // the member that its drawn shape ends at; empty: the one that it lies on
  bool in_calcaneal_tendon = false;   // it goes on in that
};

/// How far the published knee carries shank and foot from where the pin has them, with all that is fixed to them: along
/// the shank's axes, m, at the published leg's size. Nothing in the anatomical position.
const KneeTrack& knee_rolling();

/// All published muscles, groups one after the other in the order of Muscle.
std::span<const MemberMuscle> member_muscles();

/// The calcaneal tendon as drawn, under the calf's muscles down to the heel.
std::span<const LegSection> calcaneal_tendon();

/// Volume of a member in a body of that height and mass, cm³ (Handsfield et al. 2014).
double handsfield_volume_cm3(const MemberMuscle& muscle, double height_m, double mass_kg);

/// Where a muscle is drawn, at the published leg's size: from `anchor` towards point `point` of the path of member
/// `towards` of its row. The belly's mesh begins `start_m` from the anchor and is `belly_m` long; both scale as y of
/// the bone `along` does.
struct DrawnLine {
  PathPoint anchor;
  std::size_t towards = 0, point = 0;
  LegBone along{};
  double start_m = 0, belly_m = 0;
  Segment origin{}, insertion{};  // right side: what the surface beyond the belly's ends follows
};
/// Instead of a point's number: what the path ends on.
inline constexpr std::size_t end_of_path = static_cast<std::size_t>(-1);

/// What can be simulated: a group, or a single muscle. The group's line of action is as long as its members' are in the
/// mean, by volume. Hamstrings and triceps surae are drawn along their largest member, semimembranosus and soleus, the
/// latter from the middle of the calf under the knee, because soleus' published origin is the centroid of a long one;
/// the quadriceps from the middle of its bellies to the middle of the kneecap: its largest member's line would leave
/// the other three aside. Single muscles: assets/muscles/belly_axis.h.
struct MuscleRow {
  std::string_view name;
  std::span<const MemberMuscle> members;
  DrawnLine drawn;
};

/// Members that a row has at most.
inline constexpr std::size_t max_row_members = 4;

/// All rows, numbered as Muscle: groups first, then the members of groups that have several.
std::span<const MuscleRow> muscles();
inline const MuscleRow& muscle_row(Muscle muscle) {
  return muscles()[static_cast<std::size_t>(muscle)];
}
inline std::span<const MemberMuscle> members_of(Muscle muscle) {
  return muscle_row(muscle).members;
}
std::string_view muscle_name(Muscle muscle);
/// The muscle of that name, or nothing.
std::optional<Muscle> find_muscle(std::string_view name);

/// The groups; and the single muscles, which are tibialis anterior and the others' members.
MuscleSet muscle_groups();
MuscleSet muscle_members();

/// The body that templates are made for: 1.80 m, 80 kg, average.
inline constexpr double reference_body_height_m = 1.80, reference_body_mass_kg = 80;

}  // namespace mobil::inline v0_3
