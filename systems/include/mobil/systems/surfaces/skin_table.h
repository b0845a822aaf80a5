#pragma once
// Skin over muscles that nobody simulates: how far they would lift a leg's skin, as a polynomial in its joints' angles.
// Muscles that are as long as their lines follow from these angles alone; what shakes them is left out.

#include <array>
#include <cstddef>

#include <mobil/assets/surfaces/leg_grid.h>
#include <mobil/components/muscle.h>
#include <mobil/components/pose.h>

namespace mobil::inline v0_3 {

/// Angles of a leg's joints about its x axis, rad: hip and knee flexed above 0, ankle dorsiflexed above 0.
struct LegAngles {
  float hip = 0, knee = 0, ankle = 0;
};
/// Of a pose (world): between pelvis, thigh, shank and foot; −π to π.
LegAngles leg_angles_of(const Pose<float>& pose, Side side);

/// The least and the greatest angles that tables are fitted to. A table reads angles beyond as these.
inline constexpr LegAngles min_leg_angles{-0.35F, 0, -0.70F}, max_leg_angles{1.57F, 1.92F, 0.35F};

/// 1 and the products of angles that a table has: h, k, a; their squares, hk and ka; k³, hk² and k²a.
inline constexpr std::size_t skin_terms = 12;
/// These numbers for some angles, each within the angles above.
std::array<float, skin_terms> skin_term_values(const LegAngles& angles);

/// Shapes that a leg's lifts are sums of.
inline constexpr std::size_t skin_modes = 6;

/// By how much a term's number moves each mode; and of each mode the lift of the grid's points, m of a body as tall as
/// the skin was made for.
struct SkinTable {
  std::array<std::array<float, skin_modes>, skin_terms> weight;
  alignas(64) std::array<std::array<float, leg_grid_points>, skin_modes> mode;
};

/// What the table says of one leg, in `lift_m` as cover_muscles has it: m of the skin at rest. 19 kB are read. The same
/// bits on every instruction set with fused multiply-add.
void cover_by_table(const SkinTable& table, const LegAngles& angles, std::array<float, leg_grid_points>& lift_m);

}  // namespace mobil::inline v0_3
