#pragma once
// Walks that certainly keep the limits (mobil/systems/limits/walk_limits.h), found without examining them.

#include <mobil/components/body.h>
#include <mobil/components/gait.h>

namespace mobil::inline v0_3 {

/// Returns true if each number of a style is within a tenth of the usual one. Those that differ between sexes and ages
/// (usual_style) have wider ranges, as far as people of 6 to 95 years differ and a tenth more.
bool is_within_usual(const GaitStyle& style);
/// Returns true if a style is within the usual, and its numbers deviate by at most 70 % rms of their ranges. Numbers
/// drawn uniformly deviate by 58 % rms; 299 of 300 such styles are near.
bool is_near_usual(const GaitStyle& style);

/// Returns true if the walk certainly keeps the limits; false has no meaning. It requires a style within the usual, and
/// steps of 0.88 to 1.20 times the step table's. It estimates the walk's extremes from the usual walk of legs of that
/// length at that speed by the first-order effect of each number, plus a quarter of all effects as a margin. The first
/// call computes the effects, in some tens of milliseconds.
bool surely_keeps_limits(const BodySize<float>& size, const Gait<float>& gait);

}  // namespace mobil::inline v0_3
