#include "assets/muscles/muscle_table.h"

#include <algorithm>
#include <vector>

#include "assets/muscles/drawn_line.h"
#include "assets/muscles/muscle_paths.h"
#include "assets/muscles/muscle_sections.h"

namespace mobil {
namespace {

using enum Muscle;
using enum Segment;

// Name, group, path, kneecap, share of the limb's volume and its offset, bones it is attached to, sections.
// Plantaris is not among the published regressions. Its belly is 9.6 cm long and 1.8 cm wide (means of 146 legs: Lee,
// Heo, Kim, Hwang: Morphological classification of the plantaris muscle origin, a cadaveric study, 2025); as a spheroid
// 0.53 as thick as wide, as its sections there are in the mean, it has 8.6 cm³. That this is 0.0015 of the limb's
// volume takes their owners to be of 1.65 m and 60 kg, which is a guess.
constexpr std::array<MemberMuscle, member_muscle_count> members = {{
    {"semimembranosus", hamstrings, paths::semimembranosus, nullptr, 0.0319, 18.2, pelvis, shank_right,
     sections::semimembranosus},
    {"semitendinosus", hamstrings, paths::semitendinosus, nullptr, 0.0285, -16.8, pelvis, shank_right,
     sections::semitendinosus},
    {"biceps_femoris_long_head", hamstrings, paths::biceps_femoris_long_head, nullptr, 0.0256, 24.3, pelvis,
     shank_right, sections::biceps_femoris_long_head},
    {"biceps_femoris_short_head", hamstrings, paths::biceps_femoris_short_head, nullptr, 0.016, -13.8, thigh_right,
     shank_right, sections::biceps_femoris_short_head},
    {"rectus_femoris", quadriceps, paths::rectus_femoris, &paths::rectus_femoris_kneecap, 0.0371, 4.97, pelvis,
     patella_right, sections::rectus_femoris},
    {"vastus_medialis", quadriceps, paths::vastus_medialis, &paths::vastus_medialis_kneecap, 0.0631, -16.3, thigh_right,
     patella_right, sections::vastus_medialis},
    {"vastus_intermedius", quadriceps, paths::vastus_intermedius, &paths::vastus_intermedius_kneecap, 0.0273, 76.5,
     thigh_right, patella_right, sections::vastus_intermedius},
    {"vastus_lateralis", quadriceps, paths::vastus_lateralis, &paths::vastus_lateralis_kneecap, 0.125, -55.7,
     thigh_right, patella_right, sections::vastus_lateralis},
    {"gastrocnemius_medial", triceps_surae, paths::gastrocnemius_medial, nullptr, 0.0348, 9.42, thigh_right, foot_right,
     sections::gastrocnemius_medial},
    {"gastrocnemius_lateral", triceps_surae, paths::gastrocnemius_lateral, nullptr, 0.0199, 8.21, thigh_right,
     foot_right, sections::gastrocnemius_lateral},
    {"soleus", triceps_surae, paths::soleus, nullptr, 0.0507, 78.2, shank_right, foot_right, sections::soleus},
    {"plantaris", triceps_surae, paths::plantaris, nullptr, 0.0015, 0, thigh_right, foot_right, sections::plantaris},
    {"tibialis_anterior", tibialis_anterior, paths::tibialis_anterior, nullptr, 0.0161, 20.3, shank_right, foot_right,
     sections::tibialis_anterior},
}};

/// Where the paths of groups are drawn; of muscles on their own that follows from their sections.
struct GroupRow {
  std::string_view name;
  Muscle group;
  DrawnLine drawn;
};
constexpr std::array<GroupRow, muscle_group_count> groups = {{
    {"hamstrings",
     hamstrings,
     {paths::semimembranosus[0], 0, end_of_path, LegBone::thigh, 0.0463, 0.2686, pelvis, shank_right}},
    {"quadriceps",
     quadriceps,
     {{LegBone::thigh, {-0.0362, -0.0817, 0.0259}},
      0,
      end_of_path,
      LegBone::thigh,
      0,
      0.285,
      thigh_right,
      patella_right}},
    {"triceps_surae",
     triceps_surae,
     {{LegBone::shank, {-0.0056, -0.0083, -0.0294}},
      2,
      end_of_path,
      LegBone::shank,
      0,
      0.2498,
      shank_right,
      foot_right}},
    {"tibialis_anterior", tibialis_anterior, {}},
}};

/// Groups, then the members of those that have several.
std::vector<MuscleRow> make_rows() {
  std::vector<MuscleRow> rows, single;
  for (const GroupRow& g : groups) {
    const auto in_group = [&g](const MemberMuscle& m) { return m.group == g.group; };
    const auto first = std::find_if(members.begin(), members.end(), in_group);
    const std::span<const MemberMuscle> own{first, std::find_if_not(first, members.end(), in_group)};
    rows.push_back({g.name, own, own.size() == 1 ? line_through_belly(own[0]) : g.drawn});
    if (own.size() == 1) continue;
    for (const MemberMuscle& m : own) single.push_back({m.name, {&m, 1}, line_through_belly(m)});
  }
  rows.insert(rows.end(), single.begin(), single.end());
  return rows;
}

}  // namespace

std::span<const MuscleRow> muscles() {
  static const std::vector<MuscleRow> rows = make_rows();
  return rows;
}

std::string_view muscle_name(Muscle muscle) {
  return muscle_row(muscle).name;
}

std::optional<Muscle> find_muscle(std::string_view name) {
  const auto rows = muscles();
  const auto found = std::find_if(rows.begin(), rows.end(), [name](const MuscleRow& r) { return r.name == name; });
  if (found == rows.end()) return std::nullopt;
  return static_cast<Muscle>(found - rows.begin());
}

MuscleSet muscle_groups() {
  return MuscleSet((1ULL << muscle_group_count) - 1);
}

MuscleSet muscle_members() {
  MuscleSet set;
  for (std::size_t i = 0; i < muscles().size(); ++i) set[i] = muscles()[i].members.size() == 1;
  return set;
}

const KneeTrack& knee_rolling() {
  return paths::rolling;
}

std::span<const MemberMuscle> member_muscles() {
  return members;
}

const MemberMuscle* find_member_muscle(std::string_view name) {
  const auto found = std::find_if(members.begin(), members.end(), [name](const auto& m) { return m.name == name; });
  return found == members.end() ? nullptr : &*found;
}

double handsfield_volume_cm3(const MemberMuscle& muscle, double height_m, double mass_kg) {
  return muscle.limb_share * (47 * mass_kg * height_m + 1285) + muscle.offset_cm3;
}

}  // namespace mobil
