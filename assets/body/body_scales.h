#pragma once
// Groups of lengths that scale together, and their scales in people of both sexes and all ages.

#include <array>
#include <cstddef>
#include <cstdint>

#include <mobil/anthropometry.h>
#include <mobil/components/body.h>
#include <mobil/components/segments.h>

namespace mobil::inline v0_3 {

/// Group of lengths with a common scale.
enum class LengthGroup : std::uint8_t { height, leg, hips, trunk, head, shoulders, arm };
inline constexpr std::size_t length_groups = 7;

/// Returns the height of a joint of the column in the unit body.
constexpr double column_height(Segment vertebra) {
  double at = fraction::hip_height;
  for (std::size_t s = index(Segment::L5); s <= index(vertebra); ++s) at += unit_body.joint_offset[s].y;
  return at;
}

/// Neck and head, from the joint of C7 on, close the stature: their scale is the height's plus these factors times what
/// the scales of leg and trunk leave of it.
inline constexpr auto head_per_leg = static_cast<float>(fraction::hip_height / (1 - column_height(Segment::C7))),
                      head_per_trunk = static_cast<float>((column_height(Segment::C7) - fraction::hip_height) /
                                                          (1 - column_height(Segment::C7)));

/// The scale of the hips' distance is this many m, plus these factors times the scale of the leg and the height. Hara,
/// McGinley, Briggs, Baker & Sangeux, Sci. Rep. 6, 2016: each hip is 8 mm + 0.086 of the leg's length from the middle,
/// for both sexes from 5 years on. That length ends at the crest of the pelvis; we take it from the hip's height.
namespace hara {
inline constexpr double per_m = 0.086 / 0.922 / fraction::hip_half_spacing;
inline constexpr auto at_zero_m = static_cast<float>(0.008 / fraction::hip_half_spacing + 0.009 * per_m),
                      per_leg = static_cast<float>(fraction::hip_height * per_m),
                      per_height = static_cast<float>(-0.0455 * per_m);
}  // namespace hara

/// Returns the scales in the order of LengthGroup, m.
inline std::array<float, length_groups> group_scales(const BodySize<float>& size) {
  const float height = size.height_m, leg = size.leg_scale_m, trunk = size.trunk_scale_m;
  const float hips = hara::at_zero_m + (leg * hara::per_leg + height * hara::per_height);
  const float head = height + ((height - leg) * head_per_leg + (height - trunk) * head_per_trunk);
  return {height, leg, hips, trunk, head, size.shoulders_scale_m, size.arm_scale_m};
}

/// Groups of a vector's three components.
struct AxisGroups {
  LengthGroup x, y, z;
};

/// Groups of each segment's origin in its parent's frame.
inline constexpr std::array<AxisGroups, segment_count> joint_groups = [] {
  using enum Segment;
  using G = LengthGroup;
  std::array<AxisGroups, segment_count> groups{};
  const auto all = [](G g) { return AxisGroups{g, g, g}; };
  groups[index(pelvis)] = all(G::leg);
  for (std::size_t s = index(L5); s <= index(C7); ++s) groups[s] = {G::height, G::trunk, G::height};
  for (std::size_t s = index(C7) + 1; s <= index(head); ++s) groups[s] = all(G::head);
  for (std::size_t side = 0; side < 2; ++side) {
    const auto put = [&](Segment right_one, AxisGroups g) { groups[index(on_side(right_one, side))] = g; };
    put(thigh_right, all(G::hips));
    for (const Segment s : {patella_right, shank_right, foot_right, toes_right}) put(s, all(G::leg));
    put(clavicle_right, {G::shoulders, G::trunk, G::height});
    put(upper_arm_right, {G::shoulders, G::height, G::height});
    put(forearm_right, all(G::arm));
    for (const Segment s : {hand_right, fingers_right, thumb_right}) put(s, all(G::arm));
  }
  return groups;
}();

/// Groups of each segment's own geometry: tip and centre of mass.
inline constexpr std::array<AxisGroups, segment_count> segment_groups = [] {
  using enum Segment;
  using G = LengthGroup;
  std::array<AxisGroups, segment_count> groups{};
  const auto all = [](G g) { return AxisGroups{g, g, g}; };
  for (std::size_t s = index(pelvis); s <= index(T1); ++s) groups[s] = {G::height, G::trunk, G::height};
  for (std::size_t s = index(C7); s <= index(head); ++s) groups[s] = all(G::head);
  for (std::size_t side = 0; side < 2; ++side) {
    const auto put = [&](Segment right_one, AxisGroups g) { groups[index(on_side(right_one, side))] = g; };
    for (const Segment s : {thigh_right, patella_right, shank_right, foot_right, toes_right}) put(s, all(G::leg));
    put(clavicle_right, {G::shoulders, G::height, G::height});
    put(upper_arm_right, all(G::arm));
    for (const Segment s : {forearm_right, hand_right, fingers_right, thumb_right}) put(s, all(G::arm));
  }
  return groups;
}();

/// Returns a vector of the unit body at a person's size, m.
inline Vec3<double> scaled(const Vec3<double>& unit, const std::array<float, length_groups>& scales,
                           const AxisGroups& groups) {
  const auto by = [&](LengthGroup g) { return static_cast<double>(scales[static_cast<std::size_t>(g)]); };
  return {by(groups.x) * unit.x, by(groups.y) * unit.y, by(groups.z) * unit.z};
}

/// Returns the sizes of a request with that share of fat in the mass (mobil/body_composition.h).
BodySize<float> make_size(const BodyRequest& request, float fat_share);

}  // namespace mobil::inline v0_3
