#pragma once
// The skin of a whole body as one implicit surface for meshing. Arms and legs are held away from the trunk, so that
// hands and thighs do not merge.

#include <mobil/assets/surfaces/limb_forms.h>
#include <mobil/assets/surfaces/trunk_form.h>
#include <mobil/components/body.h>

namespace mobil::inline v0_3::form {

/// Outward turn of arms and legs about shoulder and hip in the meshing pose, rad.
inline constexpr double arm_out = 0.70, leg_out = 0.17;

class BodyForm {
 public:
  explicit BodyForm(const Body& body, const TrunkFit& fit = {}, bool shod = false);

  /// Returns the distance of a point in the meshing pose; negative inside.
  double distance(const Vec& p) const { return united(parts(p)); }
  /// Returns the distance of a point in the anatomical position, where arms and thighs can overlap.
  double rest_distance(const Vec& p) const;
  double armless_distance(const Vec& p) const;
  /// Returns the gradient of `distance`, by differences.
  Vec slope(const Vec& p) const;
  /// Returns the distance from a point within to the skin of trunk, legs and head in a unit direction, in the
  /// anatomical position; at most `longest_m`.
  double armless_radius(const Vec& from, const Vec& direction, double longest_m) const;
  /// Returns the length of a tape round trunk, legs and neck at that height, without the arms.
  double girth(double y) const;
  struct Parts {
    double trunk, leg, arm, head;
  };
  Parts parts(const Vec& p) const;

  /// Move a point from the meshing pose to the anatomical position with the right arm or leg; `share` −1 moves it back.
  Vec in_arm(const Vec& p, double share = 1) const { return turned(p, arm_.shoulder(), share * arm_out); }
  Vec in_leg(const Vec& p, double share = 1) const { return turned(p, leg_.hip(), share * leg_out); }

  double size() const { return scale_.size; }  // relative to 1.75 m
  const FormScale& scale() const { return scale_; }
  Sex sex() const { return sex_; }
  const ArmForm& arm() const { return arm_; }
  const LegForm& leg() const { return leg_; }

 private:
  double united(const Parts& part) const;
  double head(const Vec& p) const;
  static Vec turned(const Vec& p, const Vec& about, double angle);

  FormScale scale_;
  Sex sex_;
  double soft_;  // jaw and brow, 0 a man's, 1 a woman's
  TrunkForm trunk_;
  LegForm leg_;
  ArmForm arm_;
};

}  // namespace mobil::inline v0_3::form
