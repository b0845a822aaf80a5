#include <mobil/retarget.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include <mobil/anthropometry.h>
#include <mobil/engine/geometry.h>
#include "systems/gait/kinematics.h"
#include "systems/people/person_requests.h"
#include "systems/people/pose_measures.h"
#include "systems/poses/pose_axes.h"

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;
using Rotation = Quat<double>;

constexpr std::int32_t no_bone = SkeletonBones::no_bone;

/// Returns the shortest rotation from one direction to another.
Rotation arc(const Vec& from, const Vec& to) {
  const Vec a = normalised(from), b = normalised(to);
  const double cosine = dot(a, b);
  if (cosine < -1 + 1e-9) {
    const Vec across = orthogonal({1, 0, 0}, a);
    return {across.x, across.y, across.z, 0};
  }
  const Vec axis = cross(a, b);
  const double w = std::sqrt((1 + cosine) / 2), part = 1 / (2 * w);
  return {part * axis.x, part * axis.y, part * axis.z, w};
}

Rotation turn_about_y(double angle) {
  return {0, std::sin(angle / 2), 0, std::cos(angle / 2)};
}

Rotation normalised_rotation(const Rotation& q) {
  const double part = 1 / std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  return {part * q.x, part * q.y, part * q.z, part * q.w};
}

/// Interpolates between two rotations along the shorter arc.
Rotation part_way(const Rotation& from, const Rotation& to, double share) {
  const double sign = from.x * to.x + from.y * to.y + from.z * to.z + from.w * to.w < 0 ? -1 : 1;
  const double cosine = std::min(std::abs(from.x * to.x + from.y * to.y + from.z * to.z + from.w * to.w), 1.0);
  const double angle = std::acos(cosine);
  double a = 1 - share, b = share;
  if (angle > 1e-6) {
    a = std::sin((1 - share) * angle) / std::sin(angle);
    b = std::sin(share * angle) / std::sin(angle);
  }
  b *= sign;
  return normalised_rotation(
      {a * from.x + b * to.x, a * from.y + b * to.y, a * from.z + b * to.z, a * from.w + b * to.w});
}

Rotation turn_about_x(double angle) {
  return {std::sin(angle / 2), 0, 0, std::cos(angle / 2)};
}

Result<void> check_place(const BonePlace& bone, std::size_t number, float units_per_m) {
  const auto& [at, turn] = bone;
  const float most = farthest_m * units_per_m;
  // Comparisons with NaN are false.
  const bool placed = std::fabs(at.x) < most && std::fabs(at.y) < most && std::fabs(at.z) < most;
  if (!placed)
    return fail(fmt::format("retarget: bone {} is at ({}, {}, {}); give a finite place within 1000 km", number, at.x,
                            at.y, at.z));
  if (!is_rotation(turn))
    return fail(fmt::format("retarget: the quaternion of bone {} has the length {:.4g}; give one of length 1", number,
                            std::sqrt(turn.x * turn.x + turn.y * turn.y + turn.z * turn.z + turn.w * turn.w)));
  return {};
}

/// Checks that each named bone exists and is named once, and that all required bones are named.
Result<void> check_bones(const SkeletonBones& bones, std::size_t count) {
  std::vector<std::pair<std::string_view, std::int32_t>> named = {{"pelvis", bones.pelvis}, {"head", bones.head}};
  for (const std::int32_t bone : bones.spine) named.emplace_back("spine", bone);
  for (const SkeletonBones::Limbs& l : bones.limbs) {
    named.insert(named.end(), {{"thigh", l.thigh},
                               {"shank", l.shank},
                               {"foot", l.foot},
                               {"toes", l.toes},
                               {"clavicle", l.clavicle},
                               {"upper_arm", l.upper_arm},
                               {"forearm", l.forearm},
                               {"hand", l.hand}});
  }
  std::vector<std::int32_t> seen;
  for (const auto& [name, bone] : named) {
    const bool needed = name == "pelvis" || name == "spine" || name == "thigh" || name == "shank" || name == "foot";
    if (bone == no_bone && needed) return fail(fmt::format("retarget: no bone is named for the {}; name one", name));
    if (bone == no_bone) continue;
    if (bone < 0 || std::cmp_greater_equal(bone, count))
      return fail(fmt::format("retarget: bone {} for the {} is none of the {} at rest", bone, name, count));
    if (std::ranges::count(seen, bone) != 0)
      return fail(fmt::format("retarget: bone {} is named twice, last for the {}", bone, name));
    seen.push_back(bone);
  }
  if (bones.spine.empty()) return fail("retarget: no bone is named for the spine; name one at least");
  for (const SkeletonBones::Limbs& l : bones.limbs) {
    const bool arm_ends_early =
        (l.upper_arm == no_bone && l.forearm != no_bone) || (l.forearm == no_bone && l.hand != no_bone);
    if (arm_ends_early) return fail("retarget: an arm has a bone but not the one above it; name both");
  }
  return {};
}

/// Returns the positions of the joints at rest, m, in the library's axes.
Result<std::vector<Vec>> rest_joints(const SkeletonBones& bones, std::span<const BonePlace> rest,
                                     const BoneUnits& units) {
  if (units.axes > PoseAxes::y_up_z_back || !(units.units_per_m >= 1e-3F && units.units_per_m <= 1e6F))
    return fail("retarget: units_per_m must lie between 0.001 and 1e6, axes be one of PoseAxes");
  if (auto ok = check_bones(bones, rest.size()); !ok) return tl::unexpected(ok.error());
  std::vector<Vec> joint;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    if (auto ok = check_place(rest[i], i, units.units_per_m); !ok) return tl::unexpected(ok.error());
    joint.push_back(place_from(units.axes, units.units_per_m, rest[i].position));
  }
  const auto at = [&](std::int32_t bone) { return joint[static_cast<std::size_t>(bone)]; };
  for (const SkeletonBones::Limbs& l : bones.limbs) {
    constexpr double min_m = 0.01;
    if (length(at(l.shank) - at(l.thigh)) < min_m || length(at(l.foot) - at(l.shank)) < min_m)
      return fail("retarget: a leg has no length at rest; are the units right?");
  }
  return joint;
}

}  // namespace

Result<LimbLengths<float>> limb_lengths(const SkeletonBones& bones, std::span<const BonePlace> rest,
                                        const BoneUnits& units) {
  const auto joint = rest_joints(bones, rest, units);
  if (!joint) return tl::unexpected(joint.error());
  using Limbs = SkeletonBones::Limbs;
  const auto mean = [&](std::int32_t Limbs::*upper, std::int32_t Limbs::*lower) {
    double sum = 0;
    for (const Limbs& l : bones.limbs) {
      if (l.*upper == no_bone || l.*lower == no_bone) return 0.0F;
      const auto a = static_cast<std::size_t>(l.*upper), b = static_cast<std::size_t>(l.*lower);
      sum += 0.5 * length((*joint)[b] - (*joint)[a]);
    }
    return static_cast<float>(sum);
  };
  return LimbLengths<float>{mean(&Limbs::thigh, &Limbs::shank), mean(&Limbs::shank, &Limbs::foot),
                            mean(&Limbs::upper_arm, &Limbs::forearm), mean(&Limbs::forearm, &Limbs::hand)};
}

Result<Retarget> Retarget::make(const Body& body, const SkeletonBones& bones, std::span<const BonePlace> rest,
                                const BoneUnits& units) {
  const auto joint = rest_joints(bones, rest, units);
  if (!joint) return tl::unexpected(joint.error());
  Retarget map;
  map.body_ = body;
  map.units_ = units;
  for (const BonePlace& bone : rest)
    map.rest_.push_back(conjugate(normalised_rotation(rotation_from(units.axes, bone.rotation))));
  const auto at = [&](std::int32_t bone) { return (*joint)[static_cast<std::size_t>(bone)]; };
  const Vec across = at(bones.limbs[Side::left].thigh) - at(bones.limbs[Side::right].thigh);
  if (std::hypot(across.x, across.z) < 1e-3) return fail("retarget: the hips lie upon each other at rest");
  map.facing_ = turn_about_y(std::atan2(-across.z, across.x));
  for (const Side side : {Side::right, Side::left}) map.hip_[side] = bones.limbs[side].thigh;
  for (Source& source : map.source_) source.rest = map.facing_;
  map.set_column(bones, *joint);
  for (const Side side : {Side::right, Side::left}) {
    map.set_leg(bones.limbs[side], side, *joint);
    map.set_arm(bones.limbs[side], side, *joint);
  }
  return map;
}

/// Each bone rotates the spine above its joint; vertebrae are interpolated between the midpoints of two bones.
void Retarget::set_column(const SkeletonBones& bones, std::span<const Vec> joint) {
  std::vector<std::int32_t> column = {bones.pelvis};
  column.insert(column.end(), bones.spine.begin(), bones.spine.end());
  if (bones.head != no_bone) column.push_back(bones.head);
  const double hips = 0.5 * (joint[static_cast<std::size_t>(hip_[Side::right])].y +
                             joint[static_cast<std::size_t>(hip_[Side::left])].y);
  const double top = joint[static_cast<std::size_t>(column.back())].y;
  const double whole = std::max(top - hips, 1e-3);
  std::vector<double> middle;
  for (std::size_t i = 0; i < column.size(); ++i) {
    const auto height = [&](std::size_t b) { return (joint[static_cast<std::size_t>(column[b])].y - hips) / whole; };
    middle.push_back(i == 0 ? 0 : i + 1 == column.size() ? 1 : 0.5 * (height(i) + height(i + 1)));
    if (i > 0) middle[i] = std::max(middle[i], middle[i - 1] + 1e-6);
  }
  double own_top = 0;
  for (std::size_t s = index(Segment::L5); s <= index(Segment::head); ++s)
    own_top += static_cast<double>(body_.joint_offset_m[s].y);
  source_[index(Segment::pelvis)].bone = bones.pelvis;
  double height = 0;
  for (std::size_t s = index(Segment::L5); s <= index(Segment::head); ++s) {
    height += static_cast<double>(body_.joint_offset_m[s].y);
    const double of_all = height / own_top;
    std::size_t i = 0;
    while (i + 2 < column.size() && middle[i + 1] < of_all) ++i;
    Source& source = source_[s];
    source.bone = column[i];
    source.next = column[i + 1];
    source.share = std::clamp((of_all - middle[i]) / (middle[i + 1] - middle[i]), 0.0, 1.0);
  }
}

void Retarget::set_leg(const SkeletonBones::Limbs& limbs, std::size_t side, std::span<const Vec> joint) {
  using enum Segment;
  const auto at = [&](std::int32_t bone) { return joint[static_cast<std::size_t>(bone)]; };
  const auto of = [&](Segment s) -> Source& { return source_[index(on_side(s, side))]; };
  const Vec down = rotated(facing_, {0, -1, 0});
  const Rotation thigh = product(arc(down, at(limbs.shank) - at(limbs.thigh)), facing_);
  const Rotation shank = product(arc(rotated(thigh, {0, -1, 0}), at(limbs.foot) - at(limbs.shank)), thigh);
  of(thigh_right) = {limbs.thigh, no_bone, 0, thigh};
  of(shank_right) = {limbs.shank, no_bone, 0, shank};
  Rotation foot = facing_;  // flat, in the direction of the toes
  if (limbs.toes != no_bone) {
    const Vec ahead = at(limbs.toes) - at(limbs.foot);
    if (std::hypot(ahead.x, ahead.z) > 1e-3) foot = turn_about_y(std::atan2(ahead.x, ahead.z));
  }
  of(foot_right) = {limbs.foot, no_bone, 0, foot};
  of(toes_right) = {limbs.toes != no_bone ? limbs.toes : limbs.foot, no_bone, 0, foot};
}

void Retarget::set_arm(const SkeletonBones::Limbs& limbs, std::size_t side, std::span<const Vec> joint) {
  using enum Segment;
  const auto at = [&](std::int32_t bone) { return joint[static_cast<std::size_t>(bone)]; };
  const auto of = [&](Segment s) -> Source& { return source_[index(on_side(s, side))]; };
  const Source chest = source_[index(T1)];
  of(clavicle_right) = limbs.clavicle != no_bone ? Source{limbs.clavicle, no_bone, 0, facing_} : chest;
  Source arm = of(clavicle_right);
  const auto next = [&](std::int32_t bone, std::int32_t beyond) {
    if (bone == no_bone) return arm;
    Rotation rest = arm.rest;
    if (beyond != no_bone && length(at(beyond) - at(bone)) > 1e-3)
      rest = product(arc(rotated(arm.rest, {0, -1, 0}), at(beyond) - at(bone)), arm.rest);
    return arm = {bone, no_bone, 0, rest};
  };
  of(upper_arm_right) = next(limbs.upper_arm, limbs.forearm);
  of(forearm_right) = next(limbs.forearm, limbs.hand);
  of(hand_right) = next(limbs.hand, no_bone);
  of(fingers_right) = of(thumb_right) = of(hand_right);
}

Result<Pose<float>> Retarget::pose(std::span<const BonePlace> bones) const {
  using enum Segment;
  if (bones.size() < rest_.size())
    return fail(
        fmt::format("retarget: {} bones, and at rest there were {}; give them all", bones.size(), rest_.size()));
  for (std::size_t i = 0; i < rest_.size(); ++i) {
    if (auto ok = check_place(bones[i], i, units_.units_per_m); !ok) return tl::unexpected(ok.error());
  }
  const auto turned = [&](std::int32_t bone) {
    const auto b = static_cast<std::size_t>(bone);
    return product(normalised_rotation(rotation_from(units_.axes, bones[b].rotation)), rest_[b]);
  };
  const auto hip = [&](Side side) {
    return place_from(units_.axes, units_.units_per_m, bones[static_cast<std::size_t>(hip_[side])].position);
  };
  std::array<Vec, segment_count> place;
  std::array<Rotation, segment_count> rotation;
  place[index(pelvis)] = 0.5 * (hip(Side::right) + hip(Side::left));
  for (std::size_t s = 0; s < segment_count; ++s) {
    const std::size_t parent = index(segment_parent[s]);
    const Source& source = source_[s];
    if (s == index(patella_right) || s == index(patella_left)) continue;
    Rotation turn = turned(source.bone);
    if (source.next != no_bone) turn = part_way(turn, turned(source.next), source.share);
    rotation[s] = product(turn, source.rest);
    if (s != parent) place[s] = place[parent] + rotated(rotation[parent], to_double(body_.joint_offset_m[s]));
  }
  for (const Side side : {Side::right, Side::left}) {
    const std::size_t thigh = index(on_side(thigh_right, side)), shank = index(on_side(shank_right, side));
    const std::size_t cap = index(on_side(patella_right, side));
    const double flexion = twist_about_x(product(conjugate(rotation[thigh]), rotation[shank]));
    rotation[cap] = product(rotation[thigh], turn_about_x(static_cast<double>(kneecap_part) * flexion));
    place[cap] = place[shank] +
                 rotated(rotation[cap], to_double(body_.joint_offset_m[cap]) - to_double(body_.joint_offset_m[shank]));
  }
  Pose<float> pose;
  for (std::size_t s = 0; s < segment_count; ++s) {
    pose.position_m[s] = to_float(place[s]);
    pose.rotation[s] = to_float(normalised_rotation(rotation[s]));
  }
  return pose;
}

}  // namespace mobil::inline v0_3
