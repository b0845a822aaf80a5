#pragma once
// The 48 rigid segments of the skeleton, parents before children, and the parent of each.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace mobil::inline v0_3 {

/// A rigid segment of the skeleton. Vertebrae and head are numbered upward from the pelvis. Legs and arms follow, right
/// side first.
enum class Segment : std::uint8_t {
  pelvis,
  L5,
  L4,
  L3,
  L2,
  L1,
  T12,
  T11,
  T10,
  T9,
  T8,
  T7,
  T6,
  T5,
  T4,
  T3,
  T2,
  T1,
  C7,
  C6,
  C5,
  C4,
  C3,
  C2,
  C1,
  head,
  thigh_right,
  patella_right,
  shank_right,
  foot_right,
  toes_right,
  thigh_left,
  patella_left,
  shank_left,
  foot_left,
  toes_left,
  clavicle_right,
  upper_arm_right,
  forearm_right,
  hand_right,
  fingers_right,
  thumb_right,
  clavicle_left,
  upper_arm_left,
  forearm_left,
  hand_left,
  fingers_left,
  thumb_left,
};

/// Number of segments.
inline constexpr std::size_t segment_count = 48;

/// Returns the index of a segment in arrays over all segments.
constexpr std::size_t index(Segment s) {
  return static_cast<std::size_t>(s);
}

/// Parent of each segment; the pelvis is its own. The kneecap's parent is the thigh, the arms' is T1.
inline constexpr std::array<Segment, segment_count> segment_parent = [] {
  using enum Segment;
  std::array<Segment, segment_count> parent{};
  parent[index(pelvis)] = pelvis;
  for (std::size_t i = index(L5); i <= index(head); ++i) parent[i] = static_cast<Segment>(i - 1);
  for (std::size_t side = 0; side < 2; ++side) {
    const std::size_t leg = index(thigh_right) + 5 * side;
    parent[leg] = pelvis;
    parent[leg + 1] = static_cast<Segment>(leg);
    parent[leg + 2] = static_cast<Segment>(leg);
    parent[leg + 3] = static_cast<Segment>(leg + 2);
    parent[leg + 4] = static_cast<Segment>(leg + 3);
    const std::size_t arm = index(clavicle_right) + 6 * side;
    parent[arm] = T1;
    parent[arm + 1] = static_cast<Segment>(arm);
    parent[arm + 2] = static_cast<Segment>(arm + 1);
    parent[arm + 3] = static_cast<Segment>(arm + 2);
    parent[arm + 4] = static_cast<Segment>(arm + 3);
    parent[arm + 5] = static_cast<Segment>(arm + 3);
  }
  return parent;
}();

/// Names of the segments in tables and files.
inline constexpr std::array<std::string_view, segment_count> segment_name = {
    "pelvis",
    "L5",
    "L4",
    "L3",
    "L2",
    "L1",
    "T12",
    "T11",
    "T10",
    "T9",
    "T8",
    "T7",
    "T6",
    "T5",
    "T4",
    "T3",
    "T2",
    "T1",
    "C7",
    "C6",
    "C5",
    "C4",
    "C3",
    "C2",
    "C1",
    "head",
    "thigh_right",
    "patella_right",
    "shank_right",
    "foot_right",
    "toes_right",
    "thigh_left",
    "patella_left",
    "shank_left",
    "foot_left",
    "toes_left",
    "clavicle_right",
    "upper_arm_right",
    "forearm_right",
    "hand_right",
    "fingers_right",
    "thumb_right",
    "clavicle_left",
    "upper_arm_left",
    "forearm_left",
    "hand_left",
    "fingers_left",
    "thumb_left",
};

/// Returns the segment of the same name on the given side (0 right, 1 left), given the right-hand one.
constexpr Segment on_side(Segment right_segment, std::size_t side) {
  const std::size_t step = right_segment < Segment::clavicle_right ? 5 : 6;
  return static_cast<Segment>(index(right_segment) + step * side);
}

}  // namespace mobil::inline v0_3
