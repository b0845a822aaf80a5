#include <mobil/muscle_table.h>

#include <algorithm>
#include <vector>

#include <mobil/components/activation.h>
#include "assets/muscles/belly_axis.h"
#include "assets/muscles/published_frames.h"

namespace mobil::inline v0_3 {
namespace {

using namespace published;

// Lines group by group.
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
#include "assets/muscles/rows/gluteus_maximus.inl"
#include "assets/muscles/rows/gluteus_medius_anterior.inl"
#include "assets/muscles/rows/gluteus_medius_rear.inl"
#include "assets/muscles/rows/gluteus_minimus.inl"
#include "assets/muscles/rows/iliacus.inl"
#include "assets/muscles/rows/psoas.inl"
#include "assets/muscles/rows/pectineus.inl"
#include "assets/muscles/rows/adductor_longus.inl"
#include "assets/muscles/rows/adductor_brevis.inl"
#include "assets/muscles/rows/adductor_magnus.inl"
#include "assets/muscles/rows/tibialis_posterior.inl"
#include "assets/muscles/rows/flexor_digitorum_longus.inl"
#include "assets/muscles/rows/flexor_hallucis_longus.inl"
#include "assets/muscles/rows/peroneus_longus.inl"
#include "assets/muscles/rows/peroneus_brevis.inl"
#include "assets/muscles/rows/extensor_digitorum_longus.inl"
#include "assets/muscles/rows/extensor_hallucis_longus.inl"
#include "assets/muscles/rows/peroneus_tertius.inl"
#include "assets/muscles/rows/tensor_fasciae_latae.inl"
#include "assets/muscles/rows/sartorius.inl"
#include "assets/muscles/rows/gracilis.inl"
#include "assets/muscles/rows/piriformis.inl"
#include "assets/muscles/rows/quadratus_femoris.inl"
#include "assets/muscles/rows/obturator_internus.inl"
#include "assets/muscles/rows/obturator_externus.inl"
#include "assets/muscles/rows/popliteus.inl"
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
    if (p.hold != PathHold::fixed && p.bone == LegBone::foot) return false;
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
  if (m.sections.empty()) return m.drawn_above.empty() && m.drawn_below.empty() && m.not_drawn == 0;
  return m.sections.size() > 1 && m.not_drawn + 1 < m.sections.size() && descends(m.sections) &&
         descends(m.drawn_above) && descends(m.drawn_below) && descends(m.sheet) &&
         m.sheet.empty() == m.sheet_name.empty();
}

constexpr bool has_architecture(const MemberMuscle& m) {
  const bool modelled = m.model_fibre_m > 0 && m.model_tendon_m > 0 && m.model_path_m > 0;
  const bool not_modelled = m.model_fibre_m == 0 && m.model_tendon_m == 0 && m.model_path_m == 0;
  return m.fibre_m > 0 && m.belly_m > 0 && m.pennation_deg >= 0 && m.pennation_deg < 90 && (modelled || not_modelled);
}

/// True if the muscle is on deep muscles only, and is cut back to a deep muscle or one before it. Surfaces are made in
/// this order.
constexpr bool lies_on_a_member(const MemberMuscle& m) {
  const auto is_there = [&m](std::string_view name, bool can_be_earlier) {
    return name.empty() || std::any_of(std::begin(members), std::end(members), [&](const MemberMuscle& beneath) {
             const bool is_deep = beneath.lies_on.empty() && beneath.cut_back_to.empty();
             return beneath.name == name && (is_deep || (can_be_earlier && beneath.group < m.group));
           });
  };
  return is_there(m.lies_on, false) && is_there(m.cut_back_to, true);
}

static_assert(all_members([](const MemberMuscle& m) { return !m.name.empty() && members_named(m.name) == 1; }),
              "every muscle has a name of its own");
static_assert(std::is_sorted(std::begin(members), std::end(members),
                             [](const MemberMuscle& a, const MemberMuscle& b) { return a.group < b.group; }),
              "the members of a group stand together, in the order of Muscle");
static_assert(all_members(has_path), "a path runs down the leg between fixed points, its edges are not of the foot");
static_assert(all_members([](const MemberMuscle& m) { return m.limb_share > 0; }), "every muscle has a volume");
static_assert(all_members(has_shape), "every muscle has sections, from its upper end down, or is a further line");
static_assert(all_members(has_architecture), "every muscle has fibres, and all three figures of the model or none");
static_assert(all_members(lies_on_a_member), "a muscle lies on another of the table, which is drawn before it");

/// Returns the lines for which `belongs` is true, which must stand together.
template <class Rule>
constexpr std::span<const MemberMuscle> lines_of(Rule belongs) {
  const auto* const first = std::find_if(std::begin(members), std::end(members), belongs);
  return {first, std::find_if_not(first, std::end(members), belongs)};
}
constexpr std::span<const MemberMuscle> members_of_group(Muscle group) {
  return lines_of([group](const MemberMuscle& m) { return m.group == group; });
}

/// Names of all rows, in the order of Muscle. A single muscle's name begins the names of its lines.
constexpr std::array<std::string_view, muscle_count> names = {
    "hamstrings",
    "quadriceps",
    "triceps_surae",
    "tibialis_anterior",
    "semimembranosus",
    "semitendinosus",
    "biceps_femoris_long_head",
    "biceps_femoris_short_head",
    "rectus_femoris",
    "vastus_medialis",
    "vastus_intermedius",
    "vastus_lateralis",
    "gastrocnemius_medial",
    "gastrocnemius_lateral",
    "soleus",
    "plantaris",
    "gluteus_maximus",
    "hip_abductors",
    "iliopsoas",
    "short_adductors",
    "adductor_magnus",
    "deep_calf",
    "peroneals",
    "toe_extensors",
    "gluteus_medius",
    "gluteus_minimus",
    "iliacus",
    "psoas",
    "pectineus",
    "adductor_longus",
    "adductor_brevis",
    "tibialis_posterior",
    "flexor_digitorum_longus",
    "flexor_hallucis_longus",
    "peroneus_longus",
    "peroneus_brevis",
    "extensor_digitorum_longus",
    "extensor_hallucis_longus",
    "peroneus_tertius",
    "tensor_fasciae_latae",
    "sartorius",
    "gracilis",
    "piriformis",
    "quadratus_femoris",
    "obturator_internus",
    "obturator_externus",
    "popliteus",
};

constexpr bool is_group(Muscle muscle) {
  return muscle <= Muscle::tibialis_anterior || (muscle >= Muscle::gluteus_maximus && muscle <= Muscle::toe_extensors);
}

constexpr std::span<const MemberMuscle> members_of_row(std::size_t row) {
  if (is_group(static_cast<Muscle>(row))) return members_of_group(static_cast<Muscle>(row));
  return lines_of([name = names[row]](const MemberMuscle& m) { return m.name.starts_with(name); });
}

/// True if the rule holds for all rows' lines.
template <class Rule>
constexpr bool all_rows(Rule rule) {
  for (std::size_t row = 0; row < muscle_count; ++row) {
    if (!rule(members_of_row(row))) return false;
  }
  return true;
}
static_assert(all_rows([](std::span<const MemberMuscle> of) { return !of.empty() && of.size() <= max_row_members; }),
              "every row has lines");
static_assert(all_rows([](std::span<const MemberMuscle> of) { return !of.front().sections.empty(); }),
              "the first line of a muscle has its shape");
static_assert(std::size(members) == leg_member_count);
static_assert(static_cast<std::size_t>(Muscle::popliteus) + 1 == muscle_count && muscle_count <= max_muscles);

/// Lines of groups along which more is drawn than their largest member's belly.
DrawnLine drawn_line(Muscle muscle, std::span<const MemberMuscle> of) {
  switch (muscle) {
    case Muscle::hamstrings:
      return {.anchor = of[0].path[0],
              .point = end_of_path,
              .along = LegBone::thigh,
              .start_m = 0.0463,
              .belly_m = 0.2686,
              .origin = Segment::pelvis,
              .insertion = Segment::shank_right};
    case Muscle::quadriceps:
      return {.anchor = {LegBone::thigh, {-0.0362, -0.0817, 0.0259}},
              .point = end_of_path,
              .along = LegBone::thigh,
              .belly_m = 0.285,
              .origin = Segment::thigh_right,
              .insertion = Segment::patella_right};
    case Muscle::triceps_surae:
      return {.anchor = {LegBone::shank, {-0.0056, -0.0083, -0.0294}},
              .towards = 2,
              .point = end_of_path,
              .along = LegBone::shank,
              .belly_m = 0.2498,
              .origin = Segment::shank_right,
              .insertion = Segment::foot_right};
    default:
      return line_through_belly(of);
  }
}

std::vector<MuscleRow> make_rows() {
  std::vector<MuscleRow> rows;
  for (std::size_t row = 0; row < muscle_count; ++row) {
    const auto of = members_of_row(row);
    rows.push_back({names[row], of, drawn_line(static_cast<Muscle>(row), of)});
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

MuscleSet usual_muscles() {
  return MuscleSet((1ULL << usual_muscle_count) - 1);
}

bool is_muscle_group(Muscle muscle) {
  return is_group(muscle);
}

bool is_single_muscle(Muscle muscle) {
  return !is_group(muscle) || members_of(muscle).size() == 1;
}

MuscleSet muscle_groups() {
  MuscleSet set;
  for (std::size_t i = 0; i < muscle_count; ++i) set[i] = is_group(static_cast<Muscle>(i));
  return set;
}

MuscleSet muscle_members() {
  MuscleSet set;
  for (std::size_t i = 0; i < muscle_count; ++i) set[i] = is_single_muscle(static_cast<Muscle>(i));
  return set;
}

MuscleSet muscles_of_groups(const MuscleSet& groups) {
  MuscleSet set;
  for (const MemberMuscle& line : members)
    if (groups[static_cast<std::size_t>(line.group)]) set.set(static_cast<std::size_t>(muscle_of_line(line)));
  return set;
}

Muscle muscle_of_line(const MemberMuscle& line) {
  if (members_of(line.group).size() == 1) return line.group;
  const auto own = std::ranges::find_if(names, [&](std::string_view name) { return line.name.starts_with(name); });
  return static_cast<Muscle>(own - names.begin());
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
