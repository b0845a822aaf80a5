#pragma once
// Lift of a leg's skin over muscles that are not simulated, as a polynomial in the angles of its joints. The rest
// shapes of muscles follow from these angles. Their vibration is not included.

#include <array>
#include <cstddef>

#include <mobil/assets/surfaces/leg_grid.h>
#include <mobil/components/muscle.h>
#include <mobil/components/pose.h>

namespace mobil::inline v0_3 {

/// Angles of a leg's joints about the x axis, rad. Flexion of hip and knee and dorsiflexion are positive.
struct LegAngles {
  float hip = 0, knee = 0, ankle = 0;
};
/// Returns the angles between pelvis, thigh, shank and foot of a pose (world frame), −π to π.
LegAngles leg_angles_of(const Pose<float>& pose, Side side);

/// Range of angles that tables are fitted to. Angles beyond it are clamped.
inline constexpr LegAngles min_leg_angles{-0.35F, 0, -0.70F}, max_leg_angles{1.57F, 1.92F, 0.35F};

/// Number of terms of the polynomial: 1, h, k, a; their squares, hk and ka; k³, hk² and k²a (hip, knee, ankle).
inline constexpr std::size_t skin_terms = 12;
/// Returns the values of the terms for clamped angles.
std::array<float, skin_terms> skin_term_values(const LegAngles& angles);

/// Number of shapes that a leg's lift is a sum of.
inline constexpr std::size_t skin_modes = 6;

/// Weights of the terms for each mode, and each mode's lift of the grid's points, m, in a body as tall as that of the
/// skin.
struct SkinTable {
  std::array<std::array<float, skin_modes>, skin_terms> weight;
  alignas(64) std::array<std::array<float, leg_grid_points>, skin_modes> mode;
};

/// Computes the lift of one leg from the table, like cover_muscles, in m of the skin at rest. It reads 19 kB. The bits
/// are the same on every instruction set with fused multiply-add.
void cover_by_table(const SkinTable& table, const LegAngles& angles, std::array<float, leg_grid_points>& lift_m);

}  // namespace mobil::inline v0_3
