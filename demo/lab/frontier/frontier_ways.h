#pragma once
// Ways to move and show a muscle that pulls and is shaken, for `mobil frontier --finite`: the kernels, as people's
// muscles call them.

#include <span>
#include <string>
#include <vector>

#include <mobil/components/leg_muscles.h>
#include "demo/lab/effects/accuracy_living.h"
#include "systems/muscles/belly_library.h"

namespace mobil {

inline constexpr double living_tick_s = 1.0 / 60;
inline constexpr Cells living_points = {2, 2, 8};

struct LivingWay {
  std::string name;
  LegMuscles choice;
};
/// Statics, the paper's explicit mesh and reduced bellies; with and without finite shape and tension.
std::vector<LivingWay> living_ways();

/// Where the control points are at the end of each tick: three displacements a point, m.
using LivingPoints = std::vector<std::vector<double>>;

/// A belly of the muscle's template size over `loads`, that of the first tick's end first; it begins at rest, unloaded.
/// Fails as the library does.
LivingPoints living_points_of(Muscle muscle, const LivingWay& way, std::span<const WalkLoad> loads,
                              BellyLibrary& library);

/// A muscle's tick with its control points, µs, among a thousand alike.
double living_cost_us(Muscle muscle, const LivingWay& way, BellyLibrary& library);

}  // namespace mobil
