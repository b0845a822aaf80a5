#pragma once
// The drawn bones at which the leg's muscles end, in a body's anatomical position: distances and nearest points.

#include <array>
#include <vector>

#include <mobil/components/body.h>
#include <mobil/components/surface.h>
#include "assets/surfaces/distance_field.h"

namespace mobil::inline v0_3 {

/// Bones of the right leg with the pelvis and the spine's lower end, in world axes, the body standing at x = z = 0, m.
class LegBones {
 public:
  explicit LegBones(const Body& body);

  /// Bones that flesh must not enter: pelvis, femur, kneecap, tibia with fibula, foot.
  static constexpr std::array<Segment, 5> hard = {Segment::pelvis, Segment::thigh_right, Segment::patella_right,
                                                  Segment::shank_right, Segment::foot_right};

  /// Returns the distance from a segment's bones, negative inside, m; some 15 mm at points farther away.
  double distance(Segment segment, const Vec3<double>& at) const;
  /// Returns the direction away from a segment's bones; 0 far away and deep inside.
  Vec3<double> outward(Segment segment, const Vec3<double>& at) const;
  /// Returns the nearest point of a segment's bones.
  Vec3<double> nearest(Segment segment, const Vec3<double>& to) const;
  /// Returns true if a ball can touch a segment's bones.
  bool can_touch(Segment segment, const Vec3<double>& centre, double radius) const;
  /// Returns the distances from a segment's bones, mm in a man of reference_height_mm, in the segment's frame. The
  /// segment is one of these bones', L3 or the toes.
  static const DistanceField& field(Segment segment) { return shape(segment).field; }
  /// Returns a segment's of `bone_scales`.
  const Vec3<double>& m_per_mm(Segment segment) const { return place_[index(segment)].m_per_mm; }

 private:
  struct Shape {
    SurfaceMesh mesh;  // mm of reference_height_mm, in the segment's frame
    DistanceField field;
  };
  using Shapes = std::vector<Shape>;
  static const Shapes& shapes();
  Vec3<double> in_shape(Segment segment, const Vec3<double>& at) const;
  static const Shape& shape(Segment segment);

  struct Place {
    Vec3<double> joint_m, m_per_mm;
  };
  std::vector<Place> place_;  // of every segment
};

}  // namespace mobil::inline v0_3
