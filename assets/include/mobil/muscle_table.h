#pragma once
// Published figures of the leg's muscles: path, size and shape. A new muscle needs its name in Muscle
// (mobil/components/muscle.h), a row, which is a file in assets/muscles/rows, and a line in muscle_table.cpp.
//
// Sources. Paths of knee and ankle: the gait2392 model of OpenSim (CC BY 3.0; Delp, Loan, Hoy, Zajac, Topp, Rosen: An
// interactive graphics-based model of the lower extremity, IEEE Trans. Biomed. Eng. 37, 1990). For each edge of this
// table, it has a point that bends the path from or up to some knee flexion; the edge starts to act within a few
// degrees of it. Paths of the hip, except pectineus' and quadratus femoris': fitted to lengths in the model of
// Rajagopal, Dembia, DeMers, Delp, Hicks & Delp (Full-body musculoskeletal model for muscle-driven simulation of human
// gait, IEEE Trans. Biomed. Eng. 63, 2016; as distributed with OpenSim, Apache License 2.0), which bends them round
// cylinders. Within walking, running and stairs they have its lengths to 0.3 mm rms. Toe muscles run to the toes as if
// these were a part of the foot (1 to 2.1 mm rms). Obturators and popliteus: centre lines of the surfaces named below.
// Volumes: regression of Handsfield, Meyer, Hart, Abel, Blemker, Relationships of 35 lower limb muscles to height and
// body mass, J. Biomech. 47, 2014. Sections (area, centroid, second moments): measured for this project on cuts of
// BodyParts3D 3.0 (© The Database Center for Life Science, licensed under CC Attribution-Share Alike 2.1 Japan), a man
// of about 1.69 m. Fibres and tendons: assets/muscles/muscle_architecture.h.

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

/// Bones of one leg to which a path is fixed. Their frames have mobil's axes. The origins of pelvis and thigh are the
/// hip centre, that of the shank is the knee and that of the foot is the ankle.
enum class LegBone : std::uint8_t { pelvis, thigh, shank, foot };

/// Sizes of the leg for which the paths were published, m. Its segments end at the pin that fits its rolling knee best
/// from 0° to 100°. knee_rolling() has the remaining motion (0.6 mm rms there, 4 mm at 120°).
namespace published_leg {
inline constexpr double thigh_m = 0.40846, shank_m = 0.41736, leg_m = thigh_m + shank_m;
}  // namespace published_leg

/// Constraint of a path at a point. The path passes through it, or the point is on an edge across its bone (parallel to
/// the bone's x axis) that the path must pass in front of, or behind. Over an edge the path slides to where it is
/// shortest, like a taut string without friction; where the straight line clears the edge, it is straight. The length
/// therefore has a continuous derivative, and no switching angle is needed.
enum class PathHold : std::uint8_t { fixed, front, back };

/// One point of a path, right side, in its bone's frame at the published leg's size, m. In a body, y of thigh and shank
/// scales with that segment's length over the published one, all else with the leg's. The foot has no edges. Edges are
/// neither the first nor the last point.
struct PathPoint {
  LegBone bone;
  Vec3<double> at_m;
  PathHold hold = PathHold::fixed;
};

/// A point that moves in the shank's frame, given at knee flexions of 0°, 20°, … 120°. Between them it is a natural
/// cubic spline, beyond its ends it is straight.
inline constexpr std::size_t knee_knots = 7;
inline constexpr double knee_knot_deg = 20;
using KneeTrack = std::array<Vec3<double>, knee_knots>;

/// Spline of a KneeTrack: t₀ + t₁u + Σ cₖ·max(u − k, 0)³, u = flexion / 20°.
template <class F>
struct KneeSpline {
  Vec3<F> at_zero, slope;
  std::array<Vec3<F>, knee_knots> cubic;
};

/// One line of a published muscle of the leg: a row of the table, assets/muscles/rows/NAME.inl. A muscle has one line,
/// except gluteus medius, whose parts act differently. Fields without a default must be set; muscle_table.cpp checks
/// the rest at compile time.
struct MemberMuscle {
  std::string_view name;
  Muscle group;               // of no group: the muscle itself
  Segment origin, insertion;  // right side: segments that the surface beyond the belly's ends follows

  FixedList<PathPoint, 6> path;                     // origin first
  std::optional<KneeTrack> kneecap = std::nullopt;  // the path's end after its last point

  /// Volume (cm³) = limb_share · (47 · mass · height + 1285) + offset_cm3, in kg and m.
  double limb_share, offset_cm3;

  /// Architecture: see assets/muscles/muscle_architecture.h. `model_…` is gait2392's value, 0 if it has none.
  double fibre_m, pennation_deg, belly_m;
  double model_fibre_m = 0, model_pennation_deg = 0, model_tendon_m = 0, model_path_m = 0;

  /// Measured shape, upper end first, tendon included (the quadriceps down to the kneecap).
  /// mobil/assets/muscles/leg_sections.h defines a section. A further line of a muscle has none.
  std::optional<SectionAxis> across = std::nullopt;  // sections are across this axis; else horizontal
  FixedList<LegSection, 16> sections = {};
  /// Differences of the drawn shape, whose ends are the muscle's attachments. It lacks the last `not_drawn` measured
  /// sections, which do not suit this skeleton's kneecap or bones, and has others above and below.
  std::size_t not_drawn = 0;
  FixedList<LegSection, 4> drawn_above = {};
  FixedList<LegSection, 12> drawn_below = {};
  std::string_view lies_on = {};      // the member that it covers and that pushes it out
  std::string_view cut_back_to = {};  // the member at which its drawn shape ends; empty: the one in `lies_on`
  bool in_calcaneal_tendon = false;   // its drawn shape continues in that tendon
  /// Sections of a sheet that its drawn tendon ends in. It is a surface of its own on the thigh: these sections, then
  /// those of `drawn_below` under them. The muscle alone (MuscleRoom) has all of `drawn_below` instead.
  std::string_view sheet_name = {};
  FixedList<LegSection, 6> sheet = {};
};

/// Returns the displacement of the published shank and foot, with all that is fixed to them, from their positions on
/// the pin: along the shank's axes, m, at the published leg's size. It is 0 in the anatomical position.
const KneeTrack& knee_rolling();

/// Returns all lines, group by group; those of a muscle and of a group stand together.
std::span<const MemberMuscle> member_muscles();
/// Returns the single muscle that a line belongs to; a group of one muscle is that muscle.
Muscle muscle_of_line(const MemberMuscle& line);

/// Returns the calcaneal tendon as drawn, under the calf muscles down to the heel.
std::span<const LegSection> calcaneal_tendon();

/// Returns the volume of a member in a body of that height and mass, cm³ (Handsfield et al. 2014).
double handsfield_volume_cm3(const MemberMuscle& muscle, double height_m, double mass_kg);

/// Line along which a muscle is drawn, at the published leg's size: from `anchor` towards point `point` of the path of
/// member `towards` of its row. The belly's mesh begins `start_m` from the anchor and is `belly_m` long. Both scale
/// like y of the bone `along`.
struct DrawnLine {
  PathPoint anchor;
  std::size_t towards = 0, point = 0;
  LegBone along{};
  double start_m = 0, belly_m = 0;
  Segment origin{}, insertion{};  // right side: segments that the surface beyond the belly's ends follows
};
/// Value of DrawnLine::point for the end of the path.
inline constexpr std::size_t end_of_path = static_cast<std::size_t>(-1);

/// A muscle that can be simulated: a group, or a single muscle. Its line of action has the volume-weighted mean length
/// of its members. Hamstrings and triceps surae are drawn along their largest members, semimembranosus and
/// soleus. The latter starts in the middle of the calf under the knee, because soleus' published origin is the centroid
/// of a long one. The quadriceps are drawn from the middle of their bellies to that of the kneecap, because their
/// largest member's line would leave the other three to one side. Single muscles: assets/muscles/belly_axis.h.
struct MuscleRow {
  std::string_view name;
  std::span<const MemberMuscle> members;  // lines
  DrawnLine drawn;
};

/// Maximum number of members of a row.
inline constexpr std::size_t max_row_members = 4;

/// Returns all rows, numbered as Muscle.
std::span<const MuscleRow> muscles();
inline const MuscleRow& muscle_row(Muscle muscle) {
  return muscles()[static_cast<std::size_t>(muscle)];
}
inline std::span<const MemberMuscle> members_of(Muscle muscle) {
  return muscle_row(muscle).members;
}
/// Returns true if a muscle's belly scales with the shank, false if it scales with the thigh.
inline bool on_shank(Muscle muscle) {
  return muscle_row(muscle).drawn.along == LegBone::shank;
}
std::string_view muscle_name(Muscle muscle);
/// Returns the muscle of that name, or nothing.
std::optional<Muscle> find_muscle(std::string_view name);

/// Return the default choice, which is the first four groups; all twelve groups; and the 38 single muscles. Groups of
/// one muscle (tibialis anterior, gluteus maximus, adductor magnus) are in both of the latter.
MuscleSet usual_muscles();
MuscleSet muscle_groups();
MuscleSet muscle_members();
bool is_muscle_group(Muscle muscle);
bool is_single_muscle(Muscle muscle);
/// Returns the single muscles of these groups.
MuscleSet muscles_of_groups(const MuscleSet& groups);

/// The body for which templates are made: 1.80 m, 80 kg, average.
inline constexpr double reference_body_height_m = 1.80, reference_body_mass_kg = 80;

}  // namespace mobil::inline v0_3
