#include "assets/surfaces/muscle_shapes.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/muscle_table.h>

namespace mobil::inline v0_3 {

namespace {

/// Cuts the sheet in which a muscle ends off it.
MuscleShape sheet_of(const MemberMuscle& row, MuscleShape& muscle) {
  MuscleShape sheet = muscle;
  const float from = row.sheet.back().level;
  const auto below = std::ranges::find_if(muscle.sections, [&](const LegSection& s) { return s.level > from; });
  sheet.name = row.sheet_name;
  sheet.origin = muscle.insertion = Segment::thigh_right;
  sheet.sections.assign(row.sheet.begin(), row.sheet.end());
  sheet.sections.insert(sheet.sections.end(), below, muscle.sections.end());
  sheet.volume_m3 = 0;
  sheet.sheet = true;
  muscle.sections.erase(below, muscle.sections.end());
  return sheet;
}

}  // namespace

std::vector<MuscleShape> muscle_shapes(const Body& body, const LegFrame& leg, bool with_sheets) {
  std::vector<MuscleShape> all;
  std::vector<const MemberMuscle*> row;
  for (const MemberMuscle& m : member_muscles()) {
    if (m.sections.empty()) continue;  // a further line of a muscle
    const Muscle own = muscle_of_line(m);
    MuscleShape shape{muscle_name(own), m.group, own, m.origin, m.insertion, {}, section_planes(leg, m.across)};
    for (const MemberMuscle& line : members_of(own)) shape.volume_m3 += member_volume_m3(body, line);
    auto& to = shape.sections;
    to.insert(to.end(), m.drawn_above.begin(), m.drawn_above.end());
    to.insert(to.end(), m.sections.begin(), m.sections.end() - m.not_drawn);
    to.insert(to.end(), m.drawn_below.begin(), m.drawn_below.end());
    row.push_back(&m);
    all.push_back(std::move(shape));
  }
  for (std::size_t i = 0; i < row.size(); ++i) {
    const auto number_of = [&](std::string_view name) {
      const auto found = std::ranges::find(all, name, &MuscleShape::name);
      return found == all.end() ? no_muscle : static_cast<std::size_t>(found - all.begin());
    };
    all[i].lies_on = number_of(row[i]->lies_on);
    all[i].cut_back_to = number_of(row[i]->cut_back_to.empty() ? row[i]->lies_on : row[i]->cut_back_to);
    if (row[i]->in_calcaneal_tendon) all[i].ends_in = row.size();
  }
  const auto tendon = calcaneal_tendon();
  all.push_back({"calcaneal_tendon",
                 Muscle::triceps_surae,
                 Muscle::triceps_surae,
                 Segment::shank_right,
                 Segment::foot_right,
                 {tendon.begin(), tendon.end()},
                 section_planes(leg, std::nullopt)});
  for (std::size_t i = 0; with_sheets && i < row.size(); ++i) {
    if (row[i]->sheet.empty()) continue;
    MuscleShape sheet = sheet_of(*row[i], all[i]);
    all[i].ends_in = all.size();
    all.push_back(std::move(sheet));
  }
  return all;
}

}  // namespace mobil::inline v0_3
