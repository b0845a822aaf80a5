#pragma once
// Measures the accuracy table (mobil/systems/relevance/accuracy_table.h): people walk with each rung, beside
// references.

#include <array>
#include <functional>
#include <string>
#include <vector>

#include <mobil/components/body.h>
#include <mobil/engine/error.h>
#include <mobil/simulation.h>
#include <mobil/systems/relevance/accuracy_table.h>
#include "demo/lab/bench/bench_crowd.h"

namespace mobil {

/// Of whom errors are told; others' are taken in proportion to height, and their speeds to its root.
inline constexpr float accuracy_height_m = static_cast<float>(reference_body_height_m);

struct AccuracyPlan {
  std::vector<Muscle> muscles;
  std::vector<BodyRequest> bodies;  // each walks at every class' speed, in proportion to the root of height
  double settle_s = 3, seconds = 6;
  std::function<void(double)> progress{};  // parts done
};
/// Four groups; light, middling and heavy bodies, small and tall.
AccuracyPlan accuracy_plan();

/// Rows of `inertia` or without: the worst body's 99.9th percentile, in parts of its height over the reference body's.
Result<std::vector<AccuracyRow>> measure_errors(const AccuracyPlan& plan, bool inertia);

/// What rungs cost in a crowd, processor time.
Result<RungCost> measure_costs(std::size_t humans, bool inertia, bool living);

/// Rows and costs as systems/relevance/accuracy_table.cpp has them.
std::string accuracy_source(const std::vector<AccuracyRow>& rows);
std::string cost_source(const RungCost& cost);

/// Copies of one walker with muscles of the choice, one for each rung of a ladder. Fails as Simulation does.
Result<std::array<Entity, rung_count>> spawn_copies(Simulation& simulation, const BodyRequest& body, float speed_m_s,
                                                    const LegMuscles& choice, bool living);

/// Takes the value below which `part` of them lie; reorders. 0 of none.
float percentile(std::vector<float>& values, double part);

}  // namespace mobil
