#pragma once
// A leg's skin as heights above the line hip–knee–ankle, which muscles can lift.

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

/// Stations along the leg, from the waist to just below the ankle (s is 0 at the hip, 1 at the knee, 2 at the ankle).
/// Angles run round it from the front (0) over the inner side. Points are stored station by station.
inline constexpr std::size_t leg_stations = 29, leg_angles = 32, leg_grid_points = leg_stations * leg_angles;
inline constexpr double first_leg_s = -0.44, last_leg_s = 2.03;

/// Values by angle and station, m.
struct LegGrid {
  std::array<float, leg_grid_points> base;  // radius of the skin that nothing lifts
  std::array<float, leg_grid_points> fat;   // minimum thickness over a muscle
};

/// Returns the grid. The fat under the skin of the legs is 0.145 of a person's fat, and at least 1.5 mm thick. It has
/// 1.3 times the mean thickness on the thigh and 0.6 on the shank, and a quarter of that over kneecap and shin bone.
/// The numbers are our choice; a man of 75 kg has 7 mm on average.
LegGrid leg_grid(const form::BodyForm& form, const BodyComposition& composition);

/// Position of a skin vertex on its leg, in stations and angles, and its share of the grid's lift, which is 0 off the
/// legs.
struct LegPlace {
  float along = 0, round = 0, amount = 0;
};
/// Returns the place of a point at rest, of the right leg or mirrored onto it. `share` is the leg's share of it.
LegPlace leg_place(const form::LegForm& leg, const Vec3<double>& rest, double share);

}  // namespace mobil::inline v0_3
