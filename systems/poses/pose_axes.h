#pragma once
// The hosts' axes against ours: which of ours becomes each of theirs, and its sign.

#include <array>
#include <cstddef>

#include <mobil/components/lanes.h>
#include <mobil/pose_writer.h>

namespace mobil::inline v0_3 {

struct AxisMap {
  std::array<std::size_t, 3> ours;
  std::array<float, 3> sign;

  /// −1 where the host's frame is a mirror image of ours: rotations then turn the other way round.
  constexpr float mirrored() const { return sign[0] * sign[1] * sign[2]; }
};

/// By PoseAxes.
inline constexpr AxisMap axes_of[] = {{{0, 1, 2}, {1, 1, 1}},
                                      {{0, 1, 2}, {-1, 1, 1}},
                                      {{2, 0, 1}, {1, 1, 1}},
                                      {{2, 0, 1}, {1, -1, 1}},
                                      {{0, 1, 2}, {-1, 1, -1}}};

/// A host's place in our axes, m.
constexpr Vec3<double> place_from(PoseAxes axes, float units_per_m, const Vec3<float>& theirs) {
  const AxisMap& map = axes_of[static_cast<std::size_t>(axes)];
  const float from[3] = {theirs.x, theirs.y, theirs.z};
  double to[3] = {};
  for (std::size_t i = 0; i < 3; ++i)
    to[map.ours[i]] =
        static_cast<double>(map.sign[i]) * static_cast<double>(from[i]) / static_cast<double>(units_per_m);
  return {to[0], to[1], to[2]};
}

/// A host's rotation in our axes.
constexpr Quat<double> rotation_from(PoseAxes axes, const Quat<float>& theirs) {
  const AxisMap& map = axes_of[static_cast<std::size_t>(axes)];
  const float from[3] = {theirs.x, theirs.y, theirs.z};
  double to[3] = {};
  for (std::size_t i = 0; i < 3; ++i)
    to[map.ours[i]] = static_cast<double>(map.sign[i] * map.mirrored()) * static_cast<double>(from[i]);
  return {to[0], to[1], to[2], static_cast<double>(theirs.w)};
}

}  // namespace mobil::inline v0_3
