#pragma once
// Ways to move and show a muscle that pulls and is shaken, for `mobil frontier --finite`: the kernels, as people's
// muscles call them.

#include <array>
#include <span>
#include <string>
#include <vector>

#include <mobil/components/leg_muscles.h>
#include <mobil/engine/error.h>
#include "systems/muscles/belly_library.h"

namespace mobil {

inline constexpr double living_tick_s = 1.0 / 60;
inline constexpr Cells living_points = {2, 2, 8};

/// What a belly goes through. At a tick's end; between ticks shortening (over the mesh's length) and acceleration go
/// straight, activation stays.
struct LivingLoad {
  double shortening = 0, activation = 0;
  std::array<double, 3> acceleration_m_s2{};
};

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
Result<LivingPoints> living_points_of(Muscle muscle, const LivingWay& way, std::span<const LivingLoad> loads,
                                      BellyLibrary& library);

/// A muscle's tick with its control points, µs, among a thousand alike.
Result<double> living_cost_us(Muscle muscle, const LivingWay& way, BellyLibrary& library);

}  // namespace mobil
