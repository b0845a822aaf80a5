#pragma once
// Walkers who fall asleep and wake: a row of some hundred bytes instead of one of four thousand, of which the same
// walker comes back to the bit. What a sleeper is asked meanwhile is kept to the step.

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

/// Ticks that have been run, and their length.
struct SleepTime {
  std::uint32_t tick;
  float tick_s;
};

bool is_asleep(const World& world, Entity person);
/// What was asked of a sleeper's body, and its sizes.
BodyRequest body_of(const Asleep<float>& asleep);
BodySize<float> size_of(const Asleep<float>& asleep);
/// What is asked of who walks so.
Gait<float> gait_of(float height_m, const SteadyWalk<float>& walk, const GaitStyle& style);
GaitStyle sleeper_style(const World& world, Entity person);
/// What a sleeper is still about, or was: nothing where that has been taken off the row; whether it goes on.
std::optional<Unsettled<float>> unsettled_of(const World& world, Entity person);
bool is_unsettled(const std::optional<Unsettled<float>>& since, const SleepTime& time);
/// The same of somebody by handle, and what is to be walked.
BodyRequest sleeper_body(const World& world, Entity person);
Gait<float> sleeper_gait(const World& world, Entity person);

/// A walker as a sleeper. `style`: on the grid, or nothing where it is not.
struct Sleeper {
  Entity entity;
  Asleep<float> asleep;
  std::optional<SleepingStyle<float>> style;
  OwnStyle<float> own_style;
};
/// Of `people` those walkers who may fall asleep now: who walk steadily or stand, and are to go on so. Appended.
void find_steady(const World& world, std::span<const Entity> people, const SleepTime& time, std::vector<Sleeper>& out);
/// Memory that people fall asleep in, kept from one time to the next.
struct FallingAsleep {
  std::vector<Asleep<Lanes<float>>> asleep;
  std::vector<SleepingStyle<Lanes<float>>> style;
  std::vector<OwnStyle<Lanes<float>>> own_style;
  std::vector<Entity> people;
  std::vector<PartValue> parts;
};
/// Walkers of one table, whose styles are all on the grid or all not: their rows keep of the parts that `owned` names
/// (ids, sorted) none but what sleepers have, and `more`; all others stay.
void put_to_sleep(World& world, const Jobs& jobs, std::span<const Sleeper* const> sleepers,
                  std::span<const ComponentId> more, std::span<const std::uint64_t> owned, FallingAsleep& work);

/// Whether a sleeper is still about what was asked last: then they must wake to be asked for more.
bool is_busy(const World& world, Entity person, const SleepTime& time);
/// Asks sleepers who are not busy, each named once, in the style that there is; times and places of the steps are
/// worked out in the next tick.
struct AskedSleeper {
  Entity entity;
  Gait<float> gait;
};
void ask_sleepers(World& world, const Jobs& jobs, std::span<const AskedSleeper> asked, const SleepTime& time);
/// Tables of sleepers who are not settled, by what they are and not by which came first: rows that leave them come to
/// lie in the same order in a world that was restored.
struct UnsettledTables {
  std::size_t seen = 0;                                          // tables of the world
  std::vector<std::pair<std::uint64_t, std::uint32_t>> by_hash;  // of the key; the table's number
};
/// After a tick: who is steady again has nothing but that on the row. Looks at a part of the sleepers each tick.
/// Appends to `restless` who does not come to walk steadily: they are to be woken. `work`: memory to work in.
void end_unsettled(World& world, const Jobs& jobs, const SleepTime& time, UnsettledTables& tables,
                   std::vector<Entity>& work, std::vector<Entity>& restless);
/// All sleepers' places, less (x, 0, z).
void shift_sleepers(World& world, const SleepTime& time, float x_m, float z_m);

}  // namespace mobil::inline v0_3
