#pragma once
// Walkers asleep: rows of about one hundred bytes instead of four thousand, from which the walker is reconstructed
// bit-exactly. Requests to sleepers take effect at the same steps as those to awake walkers.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/sleep.h>
#include <mobil/engine/jobs.h>
#include <mobil/engine/module.h>
#include <mobil/engine/world.h>

namespace mobil::inline v0_3 {

/// Number of ticks run, and their length, s.
struct SleepTime {
  std::uint32_t tick;
  float tick_s;
};

bool is_asleep(const World& world, Entity person);
/// Return the request that a sleeper's body was made from, and its sizes.
BodyRequest body_of(const Asleep<float>& asleep);
BodySize<float> size_of(const Asleep<float>& asleep);
/// Returns the requested gait of a steady walk.
Gait<float> gait_of(float leg_scale_m, const SteadyWalk<float>& walk, const GaitStyle& style);
GaitStyle sleeper_style(const World& world, Entity person);
/// Returns the last change of a sleeper; nothing after its removal from the row. `is_unsettled`: it is in progress.
std::optional<Unsettled<float>> unsettled_of(const World& world, Entity person);
bool is_unsettled(const std::optional<Unsettled<float>>& since, const SleepTime& time);
/// Return a sleeper's body request and requested gait.
BodyRequest sleeper_body(const World& world, Entity person);
Gait<float> sleeper_gait(const World& world, Entity person);

/// A walker in the form of a sleeper. `style` is empty if it is not on the grid; `own_style` is used then.
struct Sleeper {
  Entity entity;
  Asleep<float> asleep;
  std::optional<SleepingStyle<float>> style;
  OwnStyle<float> own_style;
};
/// Appends those of `people` who can fall asleep now: walkers who walk steadily or stand, without a pending change.
void find_steady(const World& world, std::span<const Entity> people, const SleepTime& time, std::vector<Sleeper>& out);
/// Scratch memory of `put_to_sleep`, reused between calls.
struct FallingAsleep {
  std::vector<Asleep<Lanes<float>>> asleep;
  std::vector<SleepingStyle<Lanes<float>>> style;
  std::vector<OwnStyle<Lanes<float>>> own_style;
  std::vector<Entity> people;
  std::vector<PartValue> parts;
};
/// Puts walkers of one table to sleep. Either all or none of their styles are on the grid. Their rows lose the parts in
/// `owned` (sorted ids), except those of sleepers, and get `more`.
void put_to_sleep(World& world, const Jobs& jobs, std::span<const Sleeper* const> sleepers,
                  std::span<const ComponentId> more, std::span<const std::uint64_t> owned, FallingAsleep& work);

/// Returns true if a sleeper still carries out the last request, and must wake for another one.
bool is_busy(const World& world, Entity person, const SleepTime& time);
/// A new gait for a sleeper.
struct AskedSleeper {
  Entity entity;
  Gait<float> gait;
};
/// Sets new gaits, in the present style, of sleepers who are not busy, each named once. The next tick plans the steps.
void ask_sleepers(World& world, const Jobs& jobs, std::span<const AskedSleeper> asked, const SleepTime& time);
/// Tables of sleepers with a change in progress, ordered by archetype instead of creation, so that rows leave them in
/// the same order in a restored world.
struct UnsettledTables {
  std::size_t seen = 0;                                          // tables of the world that were checked
  std::vector<std::pair<std::uint64_t, std::uint32_t>> by_hash;  // hash of the archetype, and index of the table
};
/// Removes finished changes from the rows of sleepers after a tick. Checks a part of the sleepers in each tick. Appends
/// those who reach no steady walk to `restless`, to be woken. `work` is scratch memory.
void end_unsettled(World& world, const Jobs& jobs, const SleepTime& time, UnsettledTables& tables,
                   std::vector<Entity>& work, std::vector<Entity>& restless);
/// Subtracts (x, 0, z) from the positions of all sleepers.
void shift_sleepers(World& world, const SleepTime& time, float x_m, float z_m);

}  // namespace mobil::inline v0_3
