#include "assets/muscles/belly_axis.h"

#include <algorithm>
#include <utility>

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

BellySpan belly_span(const MemberMuscle& muscle) {
  constexpr int levels = 200;
  const std::span<const LegSection> sections = muscle.sections;
  const auto first = static_cast<double>(sections.front().level), last = static_cast<double>(sections.back().level);
  const auto at = [&](int i) { return std::min(first + (last - first) * i / levels, last); };
  const auto area_at = [&](int i) { return area(*leg_ellipse(sections, at(i))); };
  int thickest = 0;
  for (int i = 0; i <= levels; ++i) {
    if (area_at(i) > area_at(thickest)) thickest = i;
  }
  const double least = belly_share * area_at(thickest);
  int top = thickest, bottom = thickest;
  while (top > 0 && area_at(top - 1) >= least) --top;
  while (bottom < levels && area_at(bottom + 1) >= least) ++bottom;
  const LegFrame leg{{0, 0, 0}, published_leg::thigh_m, published_leg::shank_m, published_leg::thigh_m, unit_m};
  const SectionPlanes planes = section_planes(leg, muscle.across);
  const auto middle = [&](int i) {
    const LegEllipse e = *leg_ellipse(sections, at(i));
    return section_centre(leg, planes, at(i), e.lateral, e.anterior);
  };
  const Vec upper = middle(top), lower = middle(bottom);
  return {upper, lower, muscle.across ? leg_level(leg, (upper.y + lower.y) / 2) : (at(top) + at(bottom)) / 2};
}

/// Returns the number of the largest member that has a shape.
std::size_t largest_shape(std::span<const MemberMuscle> members) {
  std::size_t largest = 0;
  const auto volume = [&](std::size_t i) {
    return handsfield_volume_cm3(members[i], reference_body_height_m, reference_body_mass_kg);
  };
  for (std::size_t i = 1; i < members.size(); ++i) {
    if (!members[i].sections.empty() && volume(i) > volume(largest)) largest = i;
  }
  return largest;
}

}  // namespace

DrawnLine line_through_belly(std::span<const MemberMuscle> members) {
  const std::size_t drawn = largest_shape(members);
  const MemberMuscle& muscle = members[drawn];
  BellySpan belly = belly_span(muscle);
  // Across an axis sections can begin at the insertion.
  const auto end_of = [&](const PathPoint& p, const Vec& end) { return length(place(p) - end); };
  if (muscle.across && end_of(muscle.path.front(), belly.bottom) < end_of(muscle.path.front(), belly.top))
    std::swap(belly.top, belly.bottom);
  DrawnLine line;
  line.anchor = muscle.path.front();
  line.towards = drawn;
  line.origin = muscle.origin;
  line.insertion = muscle.insertion;
  line.along = belly.middle_level < 1 ? LegBone::thigh : LegBone::shank;

  line.point = end_of_path;
  Vec target = place(muscle.kneecap ? PathPoint{LegBone::shank, muscle.kneecap->front()} : muscle.path.back());
  for (std::size_t i = 1; i < muscle.path.size(); ++i) {
    const PathPoint& p = muscle.path[i];
    // On the shank it stays, because tendons turn forward at the ankle.
    const bool stays = p.bone == LegBone::shank || place(p).y < belly.bottom.y;
    if (p.bone == line.anchor.bone && p.hold == PathHold::fixed && stays) {
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
  if (line.point != end_of_path && line.anchor.bone == LegBone::shank)
    line.belly_m = std::min(line.belly_m, length(target - anchor) - line.start_m);
  return line;
}

}  // namespace mobil::inline v0_3
