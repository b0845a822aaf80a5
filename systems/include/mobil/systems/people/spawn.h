#pragma once
// People who come: checked first, then many rows at once.

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/leg_muscles.h>
#include <mobil/engine/archetype.h>
#include <mobil/engine/error.h>
#include <mobil/engine/jobs.h>

namespace mobil::inline v0_3 {

class World;

/// One person of many to come, at a place on the ground, walking where they look (rad about +Y, 0 toward +Z, positive
/// to the left).
struct SpawnRequest {
  BodyRequest body{};
  GaitRequest gait{};
  float x_m = 0, z_m = 0, heading_rad = 0;
  std::optional<LegMuscles> muscles{};
  /// Further parts of the person's row, components of zeros: of a host's own, or `managed_parts()` where a level of
  /// detail will manage them, so that nothing moves then. The memory is the caller's.
  std::span<const ComponentId> parts{};
};

struct StyleChange;  // mobil/systems/limits/style_limits.h
struct StyleLimitWork;

/// Lists what Simulation::spawn, change_gait and set_gait change of a requested walk, in the order of the changes.
/// They change it where it would break, or nearly reach, a limit of joints or ground. Simulation::gait_request then
/// returns the changed walk. Errors: as of spawn.
Result<std::vector<StyleChange>> style_changes(const BodyRequest& body, const GaitRequest& gait);
/// Moves a gait requested of a walker, awake or asleep, within the limits of walks
/// (mobil/systems/limits/style_limits.h). Does nothing if the walker has that gait already.
void keep_walk_limits(const World& world, const Jobs& jobs, Entity person, Gait<float>& gait, StyleLimitWork& work);

/// What could not be made, and of which of the people.
struct NotMade {
  std::size_t person = 0;
  Error error;
};

/// Checks all people, with jobs, finds their bodies' sizes and resolves their gaits, both as long as `people`, gaits
/// drawn nearer to the usual ones where they break limits (mobil/systems/limits/style_limits.h). `each(person, body)`
/// looks at more of each; several threads call it. Errors: those of the first person who has one.
tl::expected<void, NotMade> check_people(const Jobs& jobs, std::span<const SpawnRequest> people,
                                         std::span<BodySize<float>> size, std::span<Gait<float>> gait,
                                         const std::function<Result<void>(std::size_t, const Body&)>& each);
/// The rows of checked people who have the same `parts`, right heel striking; their muscles are not made. Throws
/// std::bad_alloc: then there are none of them.
void create_walkers(World& world, const Jobs& jobs, std::span<const SpawnRequest> people,
                    std::span<const BodySize<float>> size, std::span<const Gait<float>> gait,
                    std::span<Entity> entities);
/// A person whose host animates the skeleton, in the anatomical position at the origin. Errors: a body out of range.
Result<Entity> spawn_posed(World& world, const BodyRequest& body);

}  // namespace mobil::inline v0_3
