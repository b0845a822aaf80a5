#pragma once
// Forms of the right leg, foot, arm and hand in the anatomical position, as distances (form_shapes.h), m.

#include <vector>

#include <mobil/assets/body/leg_profile.h>
#include <mobil/assets/surfaces/form_scale.h>
#include <mobil/components/body.h>

namespace mobil::inline v0_3::form {

/// One body's right leg and foot, m. Origin and axes are those of the standing body (mobil/components/body.h).
class LegForm {
 public:
  /// Builds the form. `shod` replaces the toes by a shoe's tip. `hip_part` is a factor on the radii at the hip; from
  /// the middle of the thigh on they are the profile's.
  LegForm(const Body& body, const BodyMeasures& measures, bool shod, double hip_part = 1);
  /// Returns the distance of a point to the right leg, standing straight.
  double distance(const Vec& p) const;
  /// Converts a height to the position along the leg: 0 at the hip centre, 1 at the knee's, 2 at the ankle's.
  double s(double y) const { return y > knee_y_ ? (hip_.y - y) / (hip_.y - knee_y_) : 1 + (knee_y_ - y) / shank_m_; }
  double y(double s) const { return s < 1 ? hip_.y - s * (hip_.y - knee_y_) : knee_y_ - (s - 1) * shank_m_; }
  /// Returns the radius of the skin about the leg's line, m; `s` and `turn` as in LegProfile.
  double radius(double s, double turn) const;
  const Vec& hip() const { return hip_; }
  const LegProfile& profile() const { return profile_; }

 private:
  double foot(const Vec& p) const;

  double unit_;  // of the foot, m
  Vec hip_;
  double knee_y_, shank_m_, dome_m_;
  double long_, wide_;  // of the foot, relative to 1.75 m and 75 kg, in its unit
  LegProfile profile_;
  std::vector<Ring> foot_;
  bool shod_;
  double hip_part_;
};

/// One body's right arm and hand, in the same frame.
class ArmForm {
 public:
  ArmForm(const Body& body, const BodyMeasures& measures);
  /// Returns the distance of a point to the right arm, hanging, palm forward.
  double distance(const Vec& p) const;
  const Vec& shoulder() const { return shoulder_; }

 private:
  double hand(const Vec& p) const;

  double unit_;
  Vec shoulder_;
  // In that unit: shoulder to wrist; wrist to fingertip; hand's breadth over the usual one.
  double length_m_, hand_m_, wide_;
  std::vector<Ring> ring_;
};

}  // namespace mobil::inline v0_3::form
