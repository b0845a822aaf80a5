#pragma once
// Converts published places on the leg's bones (x forward, y up, z to the right, m) to the table's frames. Used by the
// rows of assets/muscles/muscle_table.cpp.
//
// Source: the gait2392 model of OpenSim (CC BY 3.0; Delp et al. 1990).

#include <mobil/muscle_table.h>

namespace mobil::inline v0_3::published {

/// The best pin's position from the published shank's origin, and the published hip–knee and knee–ankle vectors.
inline constexpr double pin_x = -0.00478, pin_y = -0.01264;
inline constexpr double knee_x = -0.0045 + pin_x, knee_y = -0.39582 + pin_y;
inline constexpr double ankle_x = -pin_x, ankle_y = -0.43 - pin_y;
static_assert(knee_y == -published_leg::thigh_m && ankle_y == -published_leg::shank_m);

constexpr Vec3<double> to_mobil(double x, double y, double z) {
  return {-z, y, x};
}
constexpr PathPoint on_pelvis(double x, double y, double z) {
  return {LegBone::pelvis, to_mobil(x + 0.0707, y + 0.0661, z - 0.0835)};
}
/// Shears the slanting lines of the published joint centres to this skeleton's vertical ones.
constexpr PathPoint on_femur(double x, double y, double z) {
  return {LegBone::thigh, to_mobil(x - knee_x * y / knee_y, y, z)};
}
constexpr PathPoint on_tibia(double x, double y, double z) {
  return {LegBone::shank, to_mobil(x - pin_x - ankle_x * (y - pin_y) / ankle_y, y - pin_y, z)};
}
constexpr PathPoint on_calcaneus(double x, double y, double z) {
  return {LegBone::foot, to_mobil(x - 0.04877, y - 0.04195, z + 0.00792)};
}
/// Places already in the table's frames, except that x counts towards the leg's outside.
constexpr PathPoint in_pelvis(double lateral, double up, double forward) {
  return {LegBone::pelvis, {-lateral, up, forward}};
}
constexpr PathPoint in_thigh(double lateral, double up, double forward) {
  return {LegBone::thigh, {-lateral, up, forward}};
}
constexpr PathPoint in_shank(double lateral, double up, double forward) {
  return {LegBone::shank, {-lateral, up, forward}};
}
constexpr PathPoint in_foot(double lateral, double up, double forward) {
  return {LegBone::foot, {-lateral, up, forward}};
}

/// Mark an edge that the path passes in front of, or behind.
constexpr PathPoint before(PathPoint p) {
  p.hold = PathHold::front;
  return p;
}
constexpr PathPoint behind(PathPoint p) {
  p.hold = PathHold::back;
  return p;
}

constexpr KneeTrack along_tibia(const KneeTrack& track) {
  KneeTrack placed{};
  for (std::size_t i = 0; i < knee_knots; ++i) placed[i] = on_tibia(track[i].x, track[i].y, track[i].z).at_m;
  return placed;
}

/// Published tibia relative to the pin's, in the tibia's frame: R(−flexion)·(its origin in the femur) less the pin.
inline constexpr KneeTrack rolling = {{{0, 0, 0},
                                       to_mobil(-0.000714, 0.000397, 0),
                                       to_mobil(-0.000952, 0.000533, 0),
                                       to_mobil(-0.000653, 0.000427, 0),
                                       to_mobil(0.000106, 0.000095, 0),
                                       to_mobil(0.001649, -0.000266, 0),
                                       to_mobil(0.004426, -0.000305, 0)}};

}  // namespace mobil::inline v0_3::published
