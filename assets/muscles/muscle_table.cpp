#include <mobil/muscle_table.h>

#include <algorithm>
#include <vector>

#include "assets/muscles/belly_axis.h"
#include "assets/muscles/published_frames.h"

namespace mobil::inline v0_3 {
namespace {

using namespace published;

// Members group by group, in the order of Muscle.
// clang-format off
constexpr MemberMuscle members[] = {
#include "assets/muscles/rows/semimembranosus.inl"
#include "assets/muscles/rows/semitendinosus.inl"
#include "assets/muscles/rows/biceps_femoris_long_head.inl"
#include "assets/muscles/rows/biceps_femoris_short_head.inl"
#include "assets/muscles/rows/rectus_femoris.inl"
#include "assets/muscles/rows/vastus_medialis.inl"
#include "assets/muscles/rows/vastus_intermedius.inl"
#include "assets/muscles/rows/vastus_lateralis.inl"
#include "assets/muscles/rows/gastrocnemius_medial.inl"
#include "assets/muscles/rows/gastrocnemius_lateral.inl"
#include "assets/muscles/rows/soleus.inl"
#include "assets/muscles/rows/plantaris.inl"
#include "assets/muscles/rows/tibialis_anterior.inl"
};
// clang-format on

/// True if all rows satisfy the rule.
template <class Rule>
constexpr bool all_members(Rule rule) {
  return std::all_of(std::begin(members), std::end(members), rule);
}

constexpr std::size_t members_named(std::string_view name) {
  return static_cast<std::size_t>(
      std::count_if(std::begin(members), std::end(members), [name](const MemberMuscle& m) { return m.name == name; }));
}

constexpr bool has_path(const MemberMuscle& m) {
  LegBone before = LegBone::pelvis;
  for (const PathPoint& p : m.path) {
    if (p.bone < before) return false;
    before = p.bone;
    if (p.hold != PathHold::fixed && p.bone != LegBone::thigh && p.bone != LegBone::shank) return false;
  }
  if (m.path.empty() || m.path.front().hold != PathHold::fixed) return false;
  return m.kneecap || (m.path.size() > 1 && m.path.back().hold == PathHold::fixed);
}

template <class Sections>
constexpr bool descends(const Sections& sections) {
  for (std::size_t i = 0; i < sections.size(); ++i) {
    if (sections[i].semi_1 <= 0 || sections[i].semi_2 <= 0) return false;
    if (i > 0 && sections[i].level <= sections[i - 1].level) return false;
  }
  return true;
}

constexpr bool has_shape(const MemberMuscle& m) {
  return m.sections.size() > 1 && m.not_drawn + 1 < m.sections.size() && descends(m.sections) &&
         descends(m.drawn_above) && descends(m.drawn_below);
}

constexpr bool has_architecture(const MemberMuscle& m) {
  const bool modelled = m.model_fibre_m > 0 && m.model_tendon_m > 0 && m.model_path_m > 0;
  const bool not_modelled = m.model_fibre_m == 0 && m.model_tendon_m == 0 && m.model_path_m == 0;
  return m.fibre_m > 0 && m.belly_m > 0 && m.pennation_deg >= 0 && m.pennation_deg < 90 && (modelled || not_modelled);
}

/// True if the muscle is on, or cut back to, deep muscles only. Surfaces are made in this order.
constexpr bool lies_on_a_member(const MemberMuscle& m) {
  const auto is_deep = [](std::string_view name) {
    return name.empty() || std::any_of(std::begin(members), std::end(members), [name](const MemberMuscle& beneath) {
             return beneath.name == name && beneath.lies_on.empty() && beneath.cut_back_to.empty();
           });
  };
  return is_deep(m.lies_on) && is_deep(m.cut_back_to);
}

static_assert(all_members([](const MemberMuscle& m) { return !m.name.empty() && members_named(m.name) == 1; }),
              "every muscle has a name of its own");
static_assert(std::is_sorted(std::begin(members), std::end(members),
                             [](const MemberMuscle& a, const MemberMuscle& b) { return a.group < b.group; }),
              "the members of a group stand together, in the order of Muscle");
static_assert(all_members(has_path), "a path runs down the leg between fixed points, its edges are of thigh and shank");
static_assert(all_members([](const MemberMuscle& m) { return m.limb_share > 0; }), "every muscle has a volume");
static_assert(all_members(has_shape), "every muscle has sections, from its upper end down");
static_assert(all_members(has_architecture), "every muscle has fibres, and all three figures of the model or none");
static_assert(all_members(lies_on_a_member), "a muscle lies on another of the table, which lies on none");

constexpr std::span<const MemberMuscle> members_of_group(Muscle group) {
  const auto in_group = [group](const MemberMuscle& m) { return m.group == group; };
  const auto* const first = std::find_if(std::begin(members), std::end(members), in_group);
  return {first, std::find_if_not(first, std::end(members), in_group)};
}

/// Groups with their drawn lines; that of a group of one follows from its sections.
constexpr std::array<MuscleRow, muscle_group_count> groups = {{
    {"hamstrings",
     members_of_group(Muscle::hamstrings),
     {.anchor = members_of_group(Muscle::hamstrings)[0].path[0],
      .point = end_of_path,
      .along = LegBone::thigh,
      .start_m = 0.0463,
      .belly_m = 0.2686,
      .origin = Segment::pelvis,
      .insertion = Segment::shank_right}},
    {"quadriceps",
     members_of_group(Muscle::quadriceps),
     {.anchor = {LegBone::thigh, {-0.0362, -0.0817, 0.0259}},
      .point = end_of_path,
      .along = LegBone::thigh,
      .belly_m = 0.285,
      .origin = Segment::thigh_right,
      .insertion = Segment::patella_right}},
    {"triceps_surae",
     members_of_group(Muscle::triceps_surae),
     {.anchor = {LegBone::shank, {-0.0056, -0.0083, -0.0294}},
      .towards = 2,
      .point = end_of_path,
      .along = LegBone::shank,
      .belly_m = 0.2498,
      .origin = Segment::shank_right,
      .insertion = Segment::foot_right}},
    {"tibialis_anterior", members_of_group(Muscle::tibialis_anterior), {}},
}};
static_assert(std::all_of(groups.begin(), groups.end(),
                          [](const MuscleRow& g) {
                            return g.members.size() == 1 || g.drawn.towards < g.members.size();
                          }),
              "every group has members, and is drawn towards one of them");
static_assert(std::all_of(groups.begin(), groups.end(),
                          [](const MuscleRow& g) { return g.members.size() <= max_row_members; }));
static_assert(groups.size() + std::size(members) <= max_muscles);

/// Returns the groups, then the members of groups with several.
std::vector<MuscleRow> make_rows() {
  std::vector<MuscleRow> rows(groups.begin(), groups.end());
  for (MuscleRow& group : rows) {
    if (group.members.size() == 1) group.drawn = line_through_belly(group.members[0]);
  }
  for (const MuscleRow& group : groups) {
    if (group.members.size() == 1) continue;
    for (const MemberMuscle& m : group.members) rows.push_back({m.name, {&m, 1}, line_through_belly(m)});
  }
  return rows;
}

constexpr std::array<LegSection, 7> tendon = {{{1.580F, 3, -39.5F, 20, 1.8F, 95},
                                               {1.660F, 0, -37, 16, 2.5F, 95},
                                               {1.760F, -3, -33.5F, 11, 3.2F, 95},
                                               {1.860F, -5, -33.5F, 8, 4.2F, 95},
                                               {1.960F, -5, -37, 7, 5, 95},
                                               {2.030F, -4, -42, 8, 4.5F, 95},
                                               {2.090F, -1, -48, 10, 3.5F, 95}}};

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
  return rolling;
}

std::span<const MemberMuscle> member_muscles() {
  return members;
}

std::span<const LegSection> calcaneal_tendon() {
  return tendon;
}

double handsfield_volume_cm3(const MemberMuscle& muscle, double height_m, double mass_kg) {
  return muscle.limb_share * (47 * mass_kg * height_m + 1285) + muscle.offset_cm3;
}

}  // namespace mobil::inline v0_3
