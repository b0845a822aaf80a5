#pragma once
// A leg's skin as heights over the line hip–knee–ankle: where muscles may lift it.

#include <array>
#include <cstddef>
#include <vector>

#include <mobil/components/body.h>
#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

namespace form {
class BodyForm;
class LegForm;
}  // namespace form

/// Stations along the leg, from above the hip's joint to just above the ankle's (s is 0 at the hip, 1 at the knee, 2 at
/// the ankle), and angles round it, from the front (0) over the inner side; one station after the other.
inline constexpr std::size_t leg_stations = 24, leg_angles = 32, leg_grid_points = leg_stations * leg_angles;
inline constexpr double first_leg_s = -0.08, last_leg_s = 1.97;

/// By angle and station, m.
struct LegGrid {
  std::array<float, leg_grid_points> base;  // the skin's radius where nothing lifts it
  std::array<float, leg_grid_points> fat;   // the least that lies over a muscle
};

/// Fat under the skin of the legs is 0.145 of a person's fat, spread evenly but for: 1.3 times the mean on the thigh,
/// 0.6 on the shank, a quarter over the kneecap and the shin's bone, and at least 1.5 mm. The numbers are our choice;
/// they make 7 mm in the mean of a man of 75 kg.
LegGrid leg_grid(const form::BodyForm& form, const BodyComposition& composition);

/// Where a vertex of the skin lies on its leg, in stations and angles, and how much of what lifts the grid lifts it: 0
/// everywhere but on the legs.
struct LegPlace {
  float along = 0, round = 0, amount = 0;
};
/// Of a place at rest, of the right leg or mirrored onto it; `share`: how much of it is the leg's.
LegPlace leg_place(const form::LegForm& leg, const Vec3<double>& rest, double share);

}  // namespace mobil::inline v0_3
