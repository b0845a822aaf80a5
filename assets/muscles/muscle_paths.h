#pragma once
// The published paths of the leg's muscles, as printed there (x forward, y up, z to the right, m), and their way into
// the table's frames. Of assets/muscles/muscle_table.cpp alone.
//
// Source: the gait2392 model of OpenSim (CC BY 3.0; Delp et al. 1990), but for plantaris, whose origin is the area
// centroid of its patch on the femur of BodyParts3D as drawn by Z-Anatomy (CC BY-SA 4.0; https://www.z-anatomy.com); it
// goes round the condyle as the lateral gastrocnemius does and ends where that ends.
//
// What is an edge here is there a point that bends the path from or up to some knee flexion; the edge takes over within
// a few degrees of it. The kneecap's track at 120° is rectus femoris' own; there the vasti's lie from it as at 100°.
// Tibialis anterior has one point more, on the front of the tibia, through which the published straight line runs 10 mm
// deep.

#include <array>

#include "assets/muscles/muscle_table.h"

namespace mobil::paths {

/// The best pin's place from the origin of the published shank, and the published hip–knee and knee–ankle vectors.
inline constexpr double pin_x = -0.00478, pin_y = -0.01264;
inline constexpr double knee_x = -0.0045 + pin_x, knee_y = -0.39582 + pin_y;
inline constexpr double ankle_x = -pin_x, ankle_y = -0.43 - pin_y;
static_assert(knee_y == -published_leg::thigh_m && ankle_y == -published_leg::shank_m);

constexpr Vec3<double> to_mobil(double x, double y, double z) {
  return {-z, y, x};
}
constexpr PathPoint pelvis(double x, double y, double z) {
  return {LegBone::pelvis, to_mobil(x + 0.0707, y + 0.0661, z - 0.0835)};
}
/// The slanting lines of the published joint centres become this skeleton's vertical ones.
constexpr PathPoint femur(double x, double y, double z) {
  return {LegBone::thigh, to_mobil(x - knee_x * y / knee_y, y, z)};
}
constexpr PathPoint tibia(double x, double y, double z) {
  return {LegBone::shank, to_mobil(x - pin_x - ankle_x * (y - pin_y) / ankle_y, y - pin_y, z)};
}
constexpr PathPoint calcaneus(double x, double y, double z) {
  return {LegBone::foot, to_mobil(x - 0.04877, y - 0.04195, z + 0.00792)};
}
/// An edge that the path passes in front of, or behind.
constexpr PathPoint before(PathPoint p) {
  p.hold = PathHold::front;
  return p;
}
constexpr PathPoint behind(PathPoint p) {
  p.hold = PathHold::back;
  return p;
}
inline constexpr KneeTrack kneecap(const KneeTrack& tibial) {
  KneeTrack track{};
  for (std::size_t i = 0; i < knee_knots; ++i) track[i] = tibia(tibial[i].x, tibial[i].y, tibial[i].z).at_m;
  return track;
}

/// The published tibia from the pin's, in the tibia's frame: R(−flexion)·(its origin in the femur) against the pin.
inline constexpr KneeTrack rolling = {{{0, 0, 0},
                                       to_mobil(-0.000714, 0.000397, 0),
                                       to_mobil(-0.000952, 0.000533, 0),
                                       to_mobil(-0.000653, 0.000427, 0),
                                       to_mobil(0.000106, 0.000095, 0),
                                       to_mobil(0.001649, -0.000266, 0),
                                       to_mobil(0.004426, -0.000305, 0)}};

inline constexpr std::array semimembranosus = {
    pelvis(-0.1192, -0.09747, 0.07151), behind(tibia(-0.0348, -0.03519, -0.01891)), tibia(-0.027, -0.04771, -0.01957)};
inline constexpr std::array semitendinosus = {
    pelvis(-0.12635, -0.10988, 0.06039), behind(tibia(-0.04203, -0.02859, -0.02277)),
    tibia(-0.03322, -0.05282, -0.02288), tibia(-0.0113, -0.0746, -0.0245), tibia(0.0027, -0.0956, -0.0193)};
inline constexpr std::array biceps_femoris_long_head = {
    pelvis(-0.12596, -0.10257, 0.06944), tibia(-0.0301, -0.036, 0.02943), tibia(-0.0234, -0.0563, 0.0343)};
inline constexpr std::array biceps_femoris_short_head = {femur(0.005, -0.2111, 0.0234), tibia(-0.0301, -0.036, 0.02943),
                                                         tibia(-0.0234, -0.0563, 0.0343)};
inline constexpr std::array rectus_femoris = {pelvis(-0.0295, -0.0311, 0.0968), before(femur(0.0334, -0.403, 0.0019))};
inline constexpr KneeTrack rectus_femoris_kneecap = kneecap({{{0.06176, 0.02098, 0.0014},
                                                              {0.04839, 0.02342, 0.0014},
                                                              {0.04221, 0.02424, 0.0014},
                                                              {0.03657, 0.02492, 0.0014},
                                                              {0.03076, 0.02531, 0.0014},
                                                              {0.02391, 0.02466, 0.0014},
                                                              {0.01558, 0.02341, 0.0014}}});
inline constexpr std::array vastus_medialis = {femur(0.014, -0.2099, 0.0188), femur(0.0356, -0.2769, 0.0009),
                                               before(femur(0.037, -0.4048, -0.0125)),
                                               before(femur(0.0274, -0.4255, -0.0131))};
inline constexpr KneeTrack vastus_medialis_kneecap = kneecap({{{0.05596, 0.02179, -0.0146},
                                                               {0.04257, 0.02283, -0.0146},
                                                               {0.03642, 0.02336, -0.0146},
                                                               {0.0308, 0.02395, -0.0146},
                                                               {0.02499, 0.02433, -0.0146},
                                                               {0.01814, 0.02367, -0.0146},
                                                               {0.00981, 0.02242, -0.0146}}});
inline constexpr std::array vastus_intermedius = {femur(0.029, -0.1924, 0.031), femur(0.0335, -0.2084, 0.0285),
                                                  before(femur(0.0343, -0.403, 0.0055))};
inline constexpr KneeTrack vastus_intermedius_kneecap = kneecap({{{0.05546, 0.02529, 0.0018},
                                                                  {0.04126, 0.02612, 0.0018},
                                                                  {0.03495, 0.02657, 0.0018},
                                                                  {0.02927, 0.02714, 0.0018},
                                                                  {0.02346, 0.02752, 0.0018},
                                                                  {0.01661, 0.02685, 0.0018},
                                                                  {0.00828, 0.02561, 0.0018}}});
inline constexpr std::array vastus_lateralis = {femur(0.0048, -0.1854, 0.0349), femur(0.0269, -0.2591, 0.0409),
                                                before(femur(0.0361, -0.403, 0.0205)),
                                                before(femur(0.0253, -0.4243, 0.0184))};
inline constexpr KneeTrack vastus_lateralis_kneecap = kneecap({{{0.05996, 0.01959, 0.0165},
                                                                {0.04697, 0.02164, 0.0165},
                                                                {0.04088, 0.02238, 0.0165},
                                                                {0.03527, 0.02304, 0.0165},
                                                                {0.02947, 0.02344, 0.0165},
                                                                {0.02262, 0.02278, 0.0165},
                                                                {0.01429, 0.02154, 0.0165}}});
inline constexpr std::array gastrocnemius_medial = {
    femur(-0.019, -0.3929, -0.0235), behind(femur(-0.03, -0.4022, -0.0258)), calcaneus(0, 0.031, -0.0053)};
inline constexpr std::array gastrocnemius_lateral = {
    femur(-0.022, -0.3946, 0.0272), behind(femur(-0.03, -0.4018, 0.0274)), calcaneus(0, 0.031, -0.0053)};
inline constexpr std::array soleus = {tibia(-0.0024, -0.1533, 0.0071), calcaneus(0, 0.031, -0.0053)};
constexpr PathPoint on_femur(double lateral, double up, double forward) {
  return {LegBone::thigh, {-lateral, up, forward}};
}
constexpr PathPoint on_shank(double lateral, double up, double forward) {
  return {LegBone::shank, {-lateral, up, forward}};
}
inline constexpr std::array plantaris = {on_femur(0.0190, -0.3781, -0.0004), behind(femur(-0.03, -0.4018, 0.0274)),
                                         calcaneus(0, 0.031, -0.0053)};
inline constexpr std::array tibialis_anterior = {tibia(0.0179, -0.1624, 0.0115), on_shank(0.0160, -0.2000, 0.0200),
                                                 tibia(0.0329, -0.3951, -0.0177), calcaneus(0.1166, 0.0178, -0.0305)};

}  // namespace mobil::paths
