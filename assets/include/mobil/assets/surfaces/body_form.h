#pragma once
// The skin of a whole body as one implicit surface, for it to be meshed: arms and legs are held away from the trunk, so
// that hands and thighs do not grow together.

#include <mobil/assets/surfaces/limb_forms.h>
#include <mobil/assets/surfaces/trunk_form.h>
#include <mobil/components/body.h>

namespace mobil::inline v0_3::form {

/// How far arms and legs are turned outwards about shoulder and hip, rad, in the pose that is meshed.
inline constexpr double arm_out = 0.70, leg_out = 0.17;

class BodyForm {
 public:
  explicit BodyForm(const Body& body, const TrunkFit& fit = {}, bool shod = false);

  /// Distance of a place in the pose that is meshed; negative inside.
  double distance(const Vec& p) const { return united(parts(p)); }
  /// The same of a place in the anatomical position, where arms and thighs may lie in each other.
  double rest_distance(const Vec& p) const;
  /// The gradient of `distance`, by differences.
  Vec slope(const Vec& p) const;
  /// In the anatomical position, how far the skin of trunk, legs and head lies from a place within them, in a unit
  /// direction; at most `longest_m`.
  double armless_radius(const Vec& from, const Vec& direction, double longest_m) const;
  /// A tape's length round trunk, legs and neck at that height, without the arms.
  double girth(double y) const;
  struct Parts {
    double trunk, leg, arm, head;
  };
  Parts parts(const Vec& p) const;

  /// From the pose that is meshed to the anatomical position and back, as the right arm or leg carries a point.
  Vec in_arm(const Vec& p, double share = 1) const { return turned(p, arm_.shoulder(), share * arm_out); }
  Vec in_leg(const Vec& p, double share = 1) const { return turned(p, leg_.hip(), share * leg_out); }

  double size() const { return size_; }  // over 1.75 m
  Sex sex() const { return sex_; }
  const ArmForm& arm() const { return arm_; }
  const LegForm& leg() const { return leg_; }

 private:
  double armless_distance(const Vec& p) const;
  static double united(const Parts& part);
  static Vec turned(const Vec& p, const Vec& about, double angle);

  double size_;
  Sex sex_;
  TrunkForm trunk_;
  LegForm leg_;
  ArmForm arm_;
};

}  // namespace mobil::inline v0_3::form
