#pragma once
// Spawns people: checks all requests first, then creates many rows at once.

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/leg_muscles.h>
#include <mobil/engine/archetype.h>
#include <mobil/engine/entity.h>
#include <mobil/engine/error.h>
#include <mobil/engine/jobs.h>

namespace mobil::inline v0_3 {

class World;

/// Request for one of many walkers: a position on the ground, m, and a heading (rad about +Y, 0 toward +Z, positive to
/// the left).
struct SpawnRequest {
  BodyRequest body{};
  GaitRequest gait{};
  float x_m = 0, z_m = 0, heading_rad = 0;
  std::optional<LegMuscles> muscles{};
  /// Further parts of the person's row, initially zero: parts of the host, or `managed_parts()` for people whom level
  /// of detail will manage, so that their rows need not move then. The caller owns the memory.
  std::span<const ComponentId> parts{};
};

struct StyleChange;  // mobil/systems/limits/style_limits.h
struct StyleLimitWork;

/// Returns the corrections that Simulation::spawn, change_gait and set_gait make to a requested walk, in their order.
/// They correct a walk that would violate, or nearly reach, a limit of joints or ground. Simulation::gait_request then
/// returns the corrected walk. Errors: those of spawn.
Result<std::vector<StyleChange>> style_changes(const BodyRequest& body, const GaitRequest& gait);
/// Corrects a gait requested of a walker, awake or asleep, to keep the limits of walks
/// (mobil/systems/limits/style_limits.h). Does nothing if the walker has that gait already.
void keep_walk_limits(const World& world, const Jobs& jobs, Entity person, Gait<float>& gait, StyleLimitWork& work);

/// The error of a request, and the index of its person.
struct NotMade {
  std::size_t person = 0;
  Error error;
};

/// Checks all requests in parallel and computes body sizes and gaits, both as long as `people`. Gaits are corrected
/// where they violate limits (mobil/systems/limits/style_limits.h). `each(person, body)` is an additional check, called
/// from several threads. Errors: that of the first person with an error.
tl::expected<void, NotMade> check_people(const Jobs& jobs, std::span<const SpawnRequest> people,
                                         std::span<BodySize<float>> size, std::span<Gait<float>> gait,
                                         const std::function<Result<void>(std::size_t, const Body&)>& each);
/// Creates the rows of checked people with the same `parts`, at right heel strike, without muscles. If it throws
/// std::bad_alloc, no row was created.
void create_walkers(World& world, const Jobs& jobs, std::span<const SpawnRequest> people,
                    std::span<const BodySize<float>> size, std::span<const Gait<float>> gait,
                    std::span<Entity> entities);
/// Creates a posed person in the anatomical position at the origin. Errors: a body out of range.
Result<Entity> spawn_posed(World& world, const BodyRequest& body);

}  // namespace mobil::inline v0_3
