#pragma once
// Shape of a leg's skin from the buttock to the ankle, without the muscles that move under it.

#include <vector>

#include <mobil/assets/body/body_measures.h>

namespace mobil::inline v0_3 {

/// Radius of the skin about the line hip–knee–ankle. `s` is 0 at the hip centre, 1 at the knee's and 2 at the ankle's.
/// `turn` is 0 in front and π/2 on the inner side, rad.
class LegProfile {
 public:
  /// Ends of the profile along the leg; `s` as above.
  static constexpr double first_s = 0.10, last_s = 1.90;

  explicit LegProfile(const BodyMeasures& measures);

  /// Returns the radius, m. `s` is clamped to the ends of the profile.
  double radius(double s, double turn) const;
  /// Returns the length of a tape round the leg at s, m.
  double girth(double s) const;

 private:
  std::vector<double> radius_;  // station by station
};

}  // namespace mobil::inline v0_3
