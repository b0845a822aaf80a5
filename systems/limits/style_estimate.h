#pragma once
// Whether a walk whose style is near the usual one keeps all limits, told without walking it.

#include <mobil/components/body.h>
#include <mobil/components/gait.h>

namespace mobil::inline v0_3 {

/// Whether each number of a style is within that part of the usual one, or as near as rounding makes it (`snapped`).
bool is_within_usual(const GaitStyle& style, float part);
/// Whether each number is within a tenth of the usual one, and all are off by 7 % in the root mean square. Numbers
/// drawn evenly within a tenth are off by 5.8 %: 299 of 300 such styles are near.
bool is_near_usual(const GaitStyle& style);

/// Whether a walk has steps of the lengths that the table of steps has, 0.76 to 1.12 of the usual one at that speed
/// (assets/gait/README.md).
bool has_usual_steps(float height_m, float speed_m_s, float step_length_m);

/// True where the walk surely keeps the limits of mobil/systems/limits/walk_limits.h: steps of the usual length, each
/// number of the style within a tenth of the usual one, and what the usual walk of that height and speed goes to, with
/// what each number adds to first order and a quarter of what all of them add either way, stays clear of every limit.
/// False says nothing. Of 180 000 random styles with every number up to a tenth off, a third of the numbers at that
/// end, 4000 broke a limit, two thirds were told to keep all, and all those did (the nearest came within 0.9° of one).
/// The numbers are found when first asked for (some tens of milliseconds).
bool surely_keeps_limits(const BodySize<float>& size, const Gait<float>& gait);

}  // namespace mobil::inline v0_3
