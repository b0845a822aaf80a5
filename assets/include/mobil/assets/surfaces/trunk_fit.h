#pragma once
// Fit of a trunk to a body's girths and volume.

namespace mobil::inline v0_3::form {

/// Factors on the trunk's breadths and depths where a girth is measured, to meet the girths, and between those places,
/// to meet the mass. `thighs` scales the thighs' radii at the hips if thighs alone would be wider than the hips should
/// be.
struct TrunkFit {
  double hips = 1, waist = 1, chest = 1, neck = 1, between = 1, thighs = 1;
};

}  // namespace mobil::inline v0_3::form
