#pragma once
// How a trunk is fitted to a body's girths and volume.

namespace mobil::inline v0_3::form {

/// By what the trunk's breadths and depths are multiplied where a girth is measured, for the girths to be met, and
/// between those places, for the volume to meet the mass; and the thighs' radii at the hips, where thighs alone would
/// be wider than the hips are to be.
struct TrunkFit {
  double hips = 1, waist = 1, chest = 1, neck = 1, between = 1, thighs = 1;
};

}  // namespace mobil::inline v0_3::form
