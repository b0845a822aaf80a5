// Masses of the groups. Adults: de Leva, Adjustments to Zatsiorsky-Seluyanov's segment inertia parameters, J. Biomech.
// 29, 1996. Children: times the change with age in Jensen's boys (Body segment mass, radius and radius of gyration
// proportions of children, J. Biomech. 19, 1986), and the trunk has the rest. Our estimate: from 45 years on, legs lose
// muscle and the trunk gains its mass.

#include "assets/body/segment_masses.h"

#include <algorithm>
#include <cmath>

#include <mobil/assets/body/between.h>
#include <mobil/body_composition.h>
#include "assets/body/fat_distribution.h"
#include "assets/body/growth.h"

namespace mobil::inline v0_3 {
namespace {

using G = MassGroup;
constexpr std::size_t at(G group) {
  return static_cast<std::size_t>(group);
}
constexpr bool is_limb(G group) {
  return group >= G::upper_arm && group <= G::foot;
}

constexpr GroupMasses de_leva_women = {0.0668, 0.1545, 0.1465, 0.0255, 0.0194, 0.1478, 0.0481, 0.0129, 0.1247};

/// Jensen's masses at 6, 12, 15 and 18 years.
constexpr std::array<double, 4> jensen_ages_y = {6, 12, 15, 18};
using Jensen = std::array<double, 4>;
constexpr Jensen jensen_head = {0.18164, 0.1008, 0.06707, 0.06986}, jensen_arm = {0.02395, 0.03194, 0.03504, 0.03593},
                 jensen_forearm = {0.01297, 0.01697, 0.01702, 0.01896},
                 jensen_hand = {0.00798, 0.00898, 0.00801, 0.00898},
                 jensen_thigh = {0.08483, 0.10978, 0.12112, 0.11377},
                 jensen_shank = {0.04591, 0.05289, 0.05606, 0.0479}, jensen_foot = {0.01896, 0.02096, 0.02102, 0.01697};

/// Returns the change against 18 years.
double change(const Jensen& of, double age_y) {
  const auto [i, part] = form::between(of.size(), age_y, [](std::size_t k) { return jensen_ages_y[k]; });
  return std::lerp(of[i], of[i + 1], part) / of.back();
}

double sum_of(const GroupMasses& masses) {
  double sum = 0;
  for (std::size_t g = 0; g < mass_groups; ++g) sum += (is_limb(static_cast<G>(g)) ? 2 : 1) * masses[g];
  return sum;
}

/// Scales the trunk so that all masses add up to 1.
void leave_rest_to_trunk(GroupMasses& masses) {
  const double trunk = masses[at(G::upper_trunk)] + masses[at(G::middle_trunk)] + masses[at(G::lower_trunk)];
  const double by = (1 - (sum_of(masses) - trunk)) / trunk;
  for (const G group : {G::upper_trunk, G::middle_trunk, G::lower_trunk}) masses[at(group)] *= by;
}

GroupMasses usual_masses(Sex sex, double age_y) {
  GroupMasses masses = sex == Sex::woman ? de_leva_women : de_leva_men;
  if (age_y < adult_age_y) {
    constexpr double hand = 0.28;  // of forearm and hand
    const auto grow = [&](G group, double by) { masses[at(group)] *= by; };
    grow(G::head, change(jensen_head, age_y));
    grow(G::upper_arm, change(jensen_arm, age_y));
    grow(G::forearm, (1 - hand) * change(jensen_forearm, age_y) + hand * change(jensen_hand, age_y));
    grow(G::thigh, change(jensen_thigh, age_y));
    grow(G::shank, change(jensen_shank, age_y));
    grow(G::foot, change(jensen_foot, age_y));
  }
  const double older = std::clamp((age_y - 45) / 30, 0.0, 1.5), lost = (sex == Sex::woman ? 0.007 : 0.010) * older;
  masses[at(G::thigh)] -= lost;
  masses[at(G::shank)] -= 0.2 * lost;
  leave_rest_to_trunk(masses);
  return masses;
}

}  // namespace

GroupMasses group_masses(const BodyRequest& request, double fat_share) {
  const auto age = static_cast<double>(half_years(request.age_y));
  GroupMasses masses = usual_masses(request.sex, age);
  const double usual = usual_fat_share(request.sex, request.age_y), extra = (fat_share - usual) / (1 - usual);
  const FatRegions& fat = fat_regions_of(request.sex);
  // The loins are L5 to L1, the chest T12 to T1.
  const GroupMasses where = {fat.head,
                             0.75 * fat.chest,
                             0.6 * fat.loins + 0.25 * fat.chest,
                             fat.upper_arm,
                             fat.forearm,
                             fat.thigh,
                             fat.shank,
                             0,
                             fat.pelvis + 0.4 * fat.loins};
  for (std::size_t g = 0; g < mass_groups; ++g) masses[g] += extra * (where[g] - masses[g]);
  return masses;
}

GroupMasses group_masses(const BodySize<float>& size) {
  GroupMasses masses = {size.head_mass,      size.upper_trunk_mass, size.middle_trunk_mass,
                        size.upper_arm_mass, size.forearm_mass,     size.thigh_mass,
                        size.shank_mass,     size.foot_mass,        0};
  masses[at(G::lower_trunk)] = 1 - sum_of(masses);
  return masses;
}

double mass_fraction(const BodySize<float>& size, std::size_t segment) {
  return group_masses(size)[at(mass_group[segment])] * unit_body.mass_share[segment];
}

}  // namespace mobil::inline v0_3
