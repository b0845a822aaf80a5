#pragma once
// Axes of hosts relative to the library's: the library's axis for each of the host's, and its sign.

#include <array>
#include <cstddef>

#include <mobil/components/lanes.h>
#include <mobil/pose_writer.h>

namespace mobil::inline v0_3 {

struct AxisMap {
  std::array<std::size_t, 3> ours;
  std::array<float, 3> sign;

  /// Returns −1 if the host's frame is a mirror image of the library's; rotations then have the opposite sense.
  constexpr float mirrored() const { return sign[0] * sign[1] * sign[2]; }
};

/// Axis maps, indexed by PoseAxes.
inline constexpr AxisMap axes_of[] = {{{0, 1, 2}, {1, 1, 1}},
                                      {{0, 1, 2}, {-1, 1, 1}},
                                      {{2, 0, 1}, {1, 1, 1}},
                                      {{2, 0, 1}, {1, -1, 1}},
                                      {{0, 1, 2}, {-1, 1, -1}}};

/// Returns a host's position in the library's axes, m.
constexpr Vec3<double> place_from(PoseAxes axes, float units_per_m, const Vec3<float>& theirs) {
  const AxisMap& map = axes_of[static_cast<std::size_t>(axes)];
  const float from[3] = {theirs.x, theirs.y, theirs.z};
  double to[3] = {};
  for (std::size_t i = 0; i < 3; ++i)
    to[map.ours[i]] =
        static_cast<double>(map.sign[i]) * static_cast<double>(from[i]) / static_cast<double>(units_per_m);
  return {to[0], to[1], to[2]};
}

/// Returns a host's rotation in the library's axes.
constexpr Quat<double> rotation_from(PoseAxes axes, const Quat<float>& theirs) {
  const AxisMap& map = axes_of[static_cast<std::size_t>(axes)];
  const float from[3] = {theirs.x, theirs.y, theirs.z};
  double to[3] = {};
  for (std::size_t i = 0; i < 3; ++i)
    to[map.ours[i]] = static_cast<double>(map.sign[i] * map.mirrored()) * static_cast<double>(from[i]);
  return {to[0], to[1], to[2], static_cast<double>(theirs.w)};
}

}  // namespace mobil::inline v0_3
