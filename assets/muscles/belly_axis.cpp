#include "assets/muscles/belly_axis.h"

#include <algorithm>

#include <mobil/anthropometry.h>
#include <mobil/assets/muscles/muscle_path.h>
#include <mobil/engine/geometry.h>

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

constexpr double belly_share = 0.2;  // of the largest section

/// A millimetre of the measured man in a leg of the published size, m.
constexpr double unit_m = published_leg::leg_m / (fraction::thigh + fraction::shank) / reference_height_mm;

double area(const LegEllipse& e) {
  return e.aa * e.ll - e.al * e.al;
}

constexpr Quat<double> upright{0, 0, 0, 1};
/// The published leg, straight, with its hip at the origin.
constexpr LegFrames<double> published_bones = {
    {0, 0, 0}, {0, -published_leg::thigh_m, 0}, {0, -published_leg::leg_m, 0}, upright, upright, upright, upright};

Vec place(const PathPoint& p) {
  return bone_origin(p.bone, published_bones) + p.at_m;
}

struct BellySpan {
  Vec top, bottom;  // middles of its end sections
  double middle_level;
};

BellySpan belly_span(std::span<const LegSection> sections) {
  constexpr int levels = 200;
  const auto first = static_cast<double>(sections.front().level), last = static_cast<double>(sections.back().level);
  const auto at = [&](int i) { return std::min(first + (last - first) * i / levels, last); };
  double largest = 0;
  for (int i = 0; i <= levels; ++i) largest = std::max(largest, area(*leg_ellipse(sections, at(i))));
  int top = levels, bottom = 0;
  for (int i = 0; i <= levels; ++i) {
    if (area(*leg_ellipse(sections, at(i))) < belly_share * largest) continue;
    top = std::min(top, i);
    bottom = std::max(bottom, i);
  }
  const LegFrame leg{{0, 0, 0}, published_leg::thigh_m, published_leg::shank_m, published_leg::thigh_m, unit_m};
  const auto middle = [&](int i) {
    const LegEllipse e = *leg_ellipse(sections, at(i));
    return leg_point(leg, at(i), e.lateral, e.anterior);
  };
  return {middle(top), middle(bottom), (at(top) + at(bottom)) / 2};
}

}  // namespace

DrawnLine line_through_belly(const MemberMuscle& muscle) {
  const BellySpan belly = belly_span(muscle.sections);
  DrawnLine line;
  line.anchor = muscle.path.front();
  line.origin = muscle.origin;
  line.insertion = muscle.insertion;
  line.along = belly.middle_level < 1 ? LegBone::thigh : LegBone::shank;

  line.point = end_of_path;
  Vec target = place(muscle.kneecap ? PathPoint{LegBone::shank, muscle.kneecap->front()} : muscle.path.back());
  for (std::size_t i = 1; i < muscle.path.size(); ++i) {
    const PathPoint& p = muscle.path[i];
    if (p.bone == line.anchor.bone && p.hold == PathHold::fixed && place(p).y < belly.bottom.y) {
      line.point = i;
      target = place(p);
    }
  }
  const Vec from_origin = target - place(line.anchor);
  if (dot(belly.top - place(line.anchor), from_origin) < 0) {
    line.anchor = {muscle.path.front().bone, belly.top - bone_origin(muscle.path.front().bone, published_bones)};
  }
  const Vec anchor = place(line.anchor), z = normalised(target - anchor);
  line.start_m = dot(belly.top - anchor, z);
  line.belly_m = dot(belly.bottom - belly.top, z);
  return line;
}

}  // namespace mobil::inline v0_3
