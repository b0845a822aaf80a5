#pragma once
// The critical step of explicit methods, for each muscle.

#include <optional>

#include <mobil/components/muscle.h>
#include <mobil/engine/world.h>

namespace mobil::inline v0_3 {

/// The critical step of a muscle's mesh at that size, s; its substeps are shorter. Nothing for a stale handle, without
/// a mesh, and of sizes beyond those that the mesh is good for.
std::optional<double> critical_step_s(const World& world, Entity muscle, const BellyScale<float>& scale);

}  // namespace mobil::inline v0_3
