#pragma once
// The muscles of a leg as published figures: where each one runs, how large it is, what it looks like. To add a muscle
// is to add rows.
//
// Sources. Paths: the gait2392 model of OpenSim (CC BY 3.0; Delp, Loan, Hoy, Zajac, Topp, Rosen: An interactive
// graphics-based model of the lower extremity, IEEE Trans. Biomed. Eng. 37, 1990). Volumes: regression of Handsfield,
// Meyer, Hart, Abel, Blemker: Relationships of 35 lower limb muscles to height and body mass, J. Biomech. 47, 2014.
// Sections: measured for this project from the surfaces of BodyParts3D 3.0 (© The Database Center for Life Science,
// licensed under CC Attribution-Share Alike 2.1 Japan), a man of about 1.69 m.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "assets/hexahedral_mesh.h"
#include "assets/leg_sections.h"
#include "components/lanes.h"
#include "components/muscle.h"
#include "components/segments.h"

namespace mobil {

/// The bones of one leg that a path is fixed to. Their frames have mobil's axes and these origins: pelvis the hip
/// centre, thigh the hip centre, shank the knee, foot the ankle.
enum class LegBone : std::uint8_t { pelvis, thigh, shank, foot };

/// Sizes of the leg that the paths were published for, m. Its rolling knee is replaced by the pin that fits it best
/// from 0° to 100° (0.6 mm rms), so that its segments end there.
namespace published_leg {
inline constexpr double thigh_m = 0.40846, shank_m = 0.41736, leg_m = thigh_m + shank_m;
}  // namespace published_leg

/// One point of a path, right side, in its bone's frame at the published leg's size, m. In a body: y of thigh and shank
/// times that segment's length over the published one, all else times the leg's.
struct PathPoint {
  LegBone bone;
  Vec3<double> at_m;
  /// Knee flexion (deg) between which the path bends round the point; ±180 means at all angles.
  double from_deg = -180, to_deg = 180;
};
constexpr bool bends_always(const PathPoint& p) {
  return p.from_deg <= -180 && p.to_deg >= 180;
}

/// Over this many degrees to either side of `from_deg` or `to_deg` a point moves from the straight line into its place,
/// so that a path's length has no corner in time.
inline constexpr double path_blend_deg = 8;

/// Where the quadriceps ends on the kneecap, in the shank's frame, at knee flexions of 0°, 20°, … 100°: a natural cubic
/// spline, straight beyond its ends.
inline constexpr std::size_t kneecap_knots = 6;
inline constexpr double kneecap_knot_deg = 20;
using KneecapTrack = std::array<Vec3<double>, kneecap_knots>;

struct MemberMuscle {
  std::string_view name;
  MuscleGroup group;
  std::span<const PathPoint> path;  // origin first
  const KneecapTrack* kneecap;      // what a path ends on after its last point, or null
  /// Volume (cm³) = limb_share · (47 · mass · height + 1285) + offset_cm3, in kg and m.
  double limb_share, offset_cm3;
  /// The muscle's shape, upper end first, tendon included: see assets/leg_sections.h for what a section means.
  std::span<const LegSection> sections;
};

inline constexpr std::size_t member_muscle_count = 11;

/// All muscles, groups one after the other in the order of MuscleGroup.
std::span<const MemberMuscle> member_muscles();
std::span<const MemberMuscle> members_of(MuscleGroup group);

/// The muscle of that name, or null.
const MemberMuscle* find_member_muscle(std::string_view name);

/// Volume of a member in a body of that height and mass, cm³ (Handsfield et al. 2014).
double handsfield_volume_cm3(const MemberMuscle& muscle, double height_m, double mass_kg);

/// How a group is drawn, at the published leg's size: from `anchor` towards an insertion of one of its members. Its
/// belly's mesh begins `start_m` from the anchor and is `belly_m` long; both scale as y of the bone `along` does.
/// Hamstrings and triceps surae follow their largest member, semimembranosus and soleus, the latter from the middle of
/// the calf under the knee, because soleus' published origin is the centroid of a long one. The quadriceps runs from
/// the middle of its bellies to the middle of the kneecap: its largest member's line would leave the other three aside.
struct GroupLine {
  MuscleGroup group;
  PathPoint anchor;
  std::string_view towards;  // the member whose path's end it is
  LegBone along;
  double start_m, belly_m;
  Segment origin, insertion;  // right side: what the surface beyond the belly's ends follows
};
const GroupLine& group_line(MuscleGroup group);

/// The body that templates are made for: 1.80 m, 80 kg, average.
inline constexpr double reference_body_height_m = 1.80, reference_body_mass_kg = 80;

/// The cage of a group's template, muscle frame, reference body: t ascending from 0 to 1 over the belly. It encloses
/// its members' bellies with a tenth to spare; its ends are no thinner than 0.35 of its middle.
inline constexpr std::size_t cage_station_count = 9;
using CageStations = std::array<CageStation, cage_station_count>;
const CageStations& group_cage(MuscleGroup group);

}  // namespace mobil
