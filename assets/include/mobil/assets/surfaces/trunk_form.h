#pragma once
// Forms of trunk, neck and head in the anatomical position, as distances (form_shapes.h), m. They are symmetric.

#include <vector>

#include <mobil/assets/body/body_measures.h>
#include <mobil/assets/surfaces/form_scale.h>
#include <mobil/assets/surfaces/trunk_fit.h>
#include <mobil/components/body.h>

namespace mobil::inline v0_3::form {

class TrunkForm {
 public:
  TrunkForm(const Body& body, const BodyMeasures& measures, const TrunkFit& fit);
  /// Returns the distance of a point in the anatomical position.
  double distance(const Vec& p) const;
  /// Returns the distance to either side that the trunk does not exceed.
  double reach() const { return scale_.unit * reach_; }

 private:
  /// An oval between two half breadths: |x/a|ⁿ + |z/b|ⁿ = 1.
  struct Section {
    double y, half, back, front, exponent;
  };
  double sections(const Vec& p) const;
  double height(double y) const { return scale_.height(y) / scale_.unit; }

  // Lengths are in the form's own unit.
  FormScale scale_;
  double size_;
  Vec shoulder_;
  double breast_front_, blade_back_, chest_wide_, buttock_, breast_m_ = 0;
  double full_, round_;  // chest and buttocks, relative to 75 kg
  double reach_;
  std::vector<Section> section_;
};

/// Returns the distance to the head of a man of 1.75 m. `soft` mixes in a woman's jaw, brow and nose, which children
/// have as well.
double head_distance(const Vec& p, double soft);

}  // namespace mobil::inline v0_3::form
