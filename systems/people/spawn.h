#pragma once
// Spawns people: checks all requests first, then creates many rows at once.

#include <cstddef>
#include <functional>
#include <span>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/engine/entity.h>
#include <mobil/engine/error.h>
#include <mobil/engine/jobs.h>
#include <mobil/systems/people/people.h>

namespace mobil::inline v0_3 {

class World;

struct StyleLimitWork;  // mobil/systems/limits/style_limits.h

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
