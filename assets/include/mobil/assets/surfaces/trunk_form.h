#pragma once
// Forms of trunk, neck and head in the anatomical position, as distances (form_shapes.h), m. They are symmetric.

#include <vector>

#include <mobil/assets/body/body_measures.h>
#include <mobil/assets/surfaces/form_shapes.h>
#include <mobil/assets/surfaces/trunk_fit.h>
#include <mobil/components/body.h>

namespace mobil::inline v0_3::form {

class TrunkForm {
 public:
  TrunkForm(const Body& body, const BodyMeasures& measures, const TrunkFit& fit);
  /// Returns the distance of a point in the anatomical position.
  double distance(const Vec& p) const;
  /// Returns the distance to either side that the trunk does not exceed.
  double reach() const { return reach_; }

 private:
  /// An oval between two half breadths: |x/a|ⁿ + |z/b|ⁿ = 1.
  struct Section {
    double y, half, back, front, exponent;
  };
  double sections(const Vec& p) const;

  double size_;  // relative to 1.75 m
  Vec shoulder_;
  bool woman_;
  double breast_front_, blade_back_, chest_wide_, buttock_, breast_m_ = 0;
  double full_, round_;  // chest and buttocks, relative to 75 kg
  double reach_;
  std::vector<Section> section_;
};

/// Returns the distance to the head of a body of 1.75 m in its usual place. Other heads scale with the body's height.
double head_distance(const Vec& p, Sex sex);

}  // namespace mobil::inline v0_3::form
