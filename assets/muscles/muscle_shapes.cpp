#include "assets/muscles/muscle_shapes.h"

#include <array>

#include "assets/muscles/muscle_table.h"

namespace mobil {
namespace {

/// What a member's table of sections lacks: the ends at which it is attached. `keep`: the number of sections
/// that stay, where the measured end does not suit this skeleton's kneecap or bones.
struct Attachment {
  std::string_view member;
  std::string_view lies_on;
  std::size_t keep;
  std::vector<LegSection> before, after;
};

std::vector<Attachment> attachments() {
  return {
      {"semimembranosus",
       "",
       12,
       {{0.140F, -33, -32, 6, 3, 105}},
       {{1.100F, -36, -4, 9, 2.5F, 0}, {1.145F, -33, -1, 7, 2, 0}}},
      {"semitendinosus", "semimembranosus", 14, {{0.128F, -27, -43, 5, 3, 95}}, {}},
      {"biceps_femoris_long_head",
       "biceps_femoris_short_head",
       13,
       {{0.108F, -20, -46, 5, 3, 80}},
       {{1.163F, 45, -9, 6.5F, 1.9F, 11}}},
      {"biceps_femoris_short_head", "", 14, {}, {}},
      {"rectus_femoris", "vastus_intermedius", 13, {}, {{0.992F, 11, 44, 12, 3, 92}}},
      {"vastus_medialis",
       "",
       11,
       {},
       {{0.885F, -18.5F, 36.6F, 25.5F, 15, 42},
        {0.926F, -15.5F, 36.8F, 21, 11.5F, 52},
        {0.962F, -9, 38.5F, 15, 6.5F, 68},
        {0.994F, -1, 41, 9, 2.8F, 80}}},
      {"vastus_intermedius", "", 13, {}, {{0.985F, 13, 39, 10, 2.2F, 92}}},
      {"vastus_lateralis", "", 13, {}, {{0.990F, 25, 41, 8, 3, 110}}},
      {"gastrocnemius_medial", "soleus", 14, {}, {}},
      {"gastrocnemius_lateral", "soleus", 14, {}, {}},
      {"soleus", "", 12, {}, {{1.806F, -4, -29.5F, 12, 3, 89}, {1.845F, -6, -31.5F, 7, 1.9F, 88}}},
      // The measured man's is thicker than in life, its tendon above all.
      {"plantaris",
       "soleus",
       4,
       {{0.896F, 22.6F, 16.2F, 2.4F, 1.6F, 22}},
       {{1.257F, 6.2F, -31.6F, 2.4F, 1.5F, 126},
        {1.354F, -6.3F, -35.1F, 2.1F, 1.0F, 133},
        {1.451F, -19.5F, -33.3F, 2, 0.9F, 124},
        {1.549F, -27.1F, -27, 2, 0.9F, 138},
        {1.646F, -23.5F, -24.5F, 2, 0.9F, 135},
        {1.743F, -18.3F, -26.1F, 2, 0.9F, 144},
        {1.841F, -18.1F, -28.6F, 2, 0.9F, 137},
        {1.938F, -18.4F, -32.5F, 2, 0.9F, 109},
        {2.035F, -20, -35.3F, 2.1F, 0.9F, 92},
        {2.097F, -20, -35.9F, 2.4F, 1, 72}}},
      {"tibialis_anterior", "", 14, {}, {}},
  };
}

/// Drawn: under the calf's muscles down to the heel.
constexpr std::array<LegSection, 7> calcaneal_tendon = {{{1.580F, 3, -39.5F, 20, 1.8F, 95},
                                                         {1.660F, 0, -37, 16, 2.5F, 95},
                                                         {1.760F, -3, -33.5F, 11, 3.2F, 95},
                                                         {1.860F, -5, -33.5F, 8, 4.2F, 95},
                                                         {1.960F, -5, -37, 7, 5, 95},
                                                         {2.030F, -4, -42, 8, 4.5F, 95},
                                                         {2.090F, -1, -48, 10, 3.5F, 95}}};

}  // namespace

std::vector<MuscleShape> muscle_shapes() {
  const auto members = member_muscles();
  const auto place = [&](std::string_view name) {
    for (std::size_t m = 0; m < members.size(); ++m) {
      if (members[m].name == name) return m;
    }
    return no_muscle;
  };
  std::vector<MuscleShape> all(members.size());
  for (const Attachment& a : attachments()) {
    const std::size_t m = place(a.member);
    MuscleShape& shape = all[m];
    const bool ends_in_tendon = a.member.starts_with("gastrocnemius") || a.member == "soleus";
    shape = {members[m].name,
             members[m].group,
             members[m].origin,
             members[m].insertion,
             a.before,
             place(a.lies_on),
             ends_in_tendon ? members.size() : no_muscle};
    const auto measured = members[m].sections.first(a.keep);
    shape.sections.insert(shape.sections.end(), measured.begin(), measured.end());
    shape.sections.insert(shape.sections.end(), a.after.begin(), a.after.end());
  }
  all.push_back({"calcaneal_tendon",
                 Muscle::triceps_surae,
                 Segment::shank_right,
                 Segment::foot_right,
                 {calcaneal_tendon.begin(), calcaneal_tendon.end()},
                 no_muscle,
                 no_muscle});
  return all;
}

}  // namespace mobil
