#include "assets/surfaces/leg_bones.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <mobil/anthropometry.h>
#include <mobil/assets/muscles/leg_sections.h>
#include <mobil/engine/geometry.h>
#include "assets/surfaces/bone_surfaces.h"

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

constexpr std::array<Segment, 7> leg_segments = {Segment::pelvis,        Segment::L3,          Segment::thigh_right,
                                                 Segment::patella_right, Segment::shank_right, Segment::foot_right,
                                                 Segment::toes_right};

}  // namespace

const LegBones::Shapes& LegBones::shapes() {
  constexpr double cell_mm = 3, band_mm = 15;
  static const Shapes all = [] {
    Shapes shapes;
    for (const Segment segment : leg_segments) {
      const SurfaceMesh& mesh = usual_bones()[index(segment)].mesh;
      shapes.push_back({mesh, distance_field(mesh, cell_mm, band_mm)});
    }
    return shapes;
  }();
  return all;
}

LegBones::LegBones(const Body& body) {
  const Pose<float> standing = standing_pose(body);
  const BoneScales scales = bone_scales(body);
  for (std::size_t s = 0; s < segment_count; ++s) place_.push_back({to_double(standing.position_m[s]), scales[s]});
}

const LegBones::Shape& LegBones::shape(Segment segment) {
  return shapes()[static_cast<std::size_t>(std::ranges::find(leg_segments, segment) - leg_segments.begin())];
}

Vec LegBones::in_shape(Segment segment, const Vec& at) const {
  const Place& own = place_[index(segment)];
  const Vec from = at - own.joint_m, &by = own.m_per_mm;
  return {(1 / by.x) * from.x, (1 / by.y) * from.y, (1 / by.z) * from.z};
}

double LegBones::distance(Segment segment, const Vec& at) const {
  return m_per_mm(segment).x * mobil::distance(shape(segment).field, in_shape(segment, at));
}

Vec LegBones::outward(Segment segment, const Vec& at) const {
  const Vec up = slope(shape(segment).field, in_shape(segment, at));
  const double steep = length(up);
  return steep < 1e-6 ? Vec{0, 0, 0} : (1 / steep) * up;
}

Vec LegBones::nearest(Segment segment, const Vec& to) const {
  const Place& own = place_[index(segment)];
  const Vec at = nearest_point(shape(segment).mesh, in_shape(segment, to));
  return own.joint_m + Vec{own.m_per_mm.x * at.x, own.m_per_mm.y * at.y, own.m_per_mm.z * at.z};
}

bool LegBones::can_touch(Segment segment, const Vec& centre, double radius) const {
  const DistanceField& field = shape(segment).field;
  const Vec at = in_shape(segment, centre), corner = field.corner;
  const double reach = radius / m_per_mm(segment).x - field.band;  // the field is wider than the bone by its band
  const auto is_near = [&](double p, double low, int count) {
    return p > low - reach && p < low + field.cell * count + reach;
  };
  return is_near(at.x, corner.x, field.count[0]) && is_near(at.y, corner.y, field.count[1]) &&
         is_near(at.z, corner.z, field.count[2]);
}

}  // namespace mobil::inline v0_3
