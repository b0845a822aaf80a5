#pragma once
// The critical time step of explicit methods, for each muscle.

#include <optional>

#include <mobil/components/muscle.h>
#include <mobil/engine/world.h>

namespace mobil::inline v0_3 {

/// Returns the critical time step of a muscle's mesh at that size, s. The muscle's substeps are shorter. Nothing for a
/// stale handle, a muscle without a mesh, or a size out of the mesh's range.
std::optional<double> critical_step_s(const World& world, Entity muscle, const BellyScale<float>& scale);

}  // namespace mobil::inline v0_3
