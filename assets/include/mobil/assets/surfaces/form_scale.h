#pragma once
// Lengths of a body's skin forms relative to those of a man of 1.75 m, in whose lengths they are drawn.

#include <mobil/assets/surfaces/form_shapes.h>
#include <mobil/components/body.h>

namespace mobil::inline v0_3::form {

/// Scales of a body's parts.
struct FormScale {
  double size, leg, trunk, head, head_wide, arm;
  double unit;      // of blends, bumps and depths: 1 in adults, `size` up to 14 years
  double young;     // child's part of a face: 1 at 6 years, 0 from 16 on
  double womanly;   // woman's part of a trunk: 0 in men and up to 10 years, 1 from 16 on
  double head_z_m;  // displacement of the head from its place in a man

  /// Converts a height in that man to the height in this body.
  double height(double y) const;
  /// Converts a point to that man's lengths.
  Vec usual(const Vec& p) const;
  /// Converts a point of the head to the lengths of that man's head.
  Vec in_head(const Vec& p) const;
  /// Converts a height in that man's head to the height in this face, in his lengths.
  double face_height(double y) const;

  double usual_height(double y) const;  // inverse of `height`
};
FormScale form_scale(const Body& body);

}  // namespace mobil::inline v0_3::form
