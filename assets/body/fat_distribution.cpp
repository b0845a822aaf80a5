#include "assets/body/fat_distribution.h"

#include <mobil/anthropometry.h>
#include "assets/body/growth.h"

namespace mobil::inline v0_3 {

double usual_fat_share(Sex sex, float age_y) {
  const double adult = sex == Sex::woman ? 0.248 : usual_mans_fat_share;
  if (static_cast<double>(half_years(age_y)) >= adult_age_y) return adult;
  const auto share = [&](float age) { return fat_share_of_mass_index(growth(sex, age).mass_index.median, sex, age); };
  // At 18 years, the charts' median differs a little from the adults who were weighed.
  return share(age_y) * adult / share(static_cast<float>(adult_age_y));
}

const FatRegions& fat_regions_of(Sex sex) {
  static constexpr FatRegions man = {0.22, 0.30, 0.18, 0.01, 0.085, 0.02, 0.03, 0.01},
                              woman = {0.19, 0.27, 0.16, 0.006, 0.115, 0.025, 0.035, 0.012};
  return sex == Sex::woman ? woman : man;
}

}  // namespace mobil::inline v0_3
