#pragma once
// What a leg's skin looks like from the buttock to the ankle, apart from the muscles that move under it.

#include <vector>

#include <mobil/assets/body/body_measures.h>

namespace mobil::inline v0_3 {

/// The radius of the skin about the line hip–knee–ankle. `s`: 0 at the hip's centre, 1 at the knee's, 2 at the ankle's.
/// `turn`: 0 in front, π/2 on the inner side, rad.
class LegProfile {
 public:
  /// Where the profile begins and ends along the leg; `s` as above.
  static constexpr double first_s = 0.10, last_s = 1.90;

  explicit LegProfile(const BodyMeasures& measures);

  /// m; beyond the first and last s as there.
  double radius(double s, double turn) const;
  /// Length of a tape at s, m.
  double girth(double s) const;

 private:
  std::vector<double> radius_;  // station by station
};

}  // namespace mobil::inline v0_3
