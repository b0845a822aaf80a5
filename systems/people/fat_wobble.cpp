#include "systems/people/fat_wobble.h"

#include <array>
#include <vector>

#include <mobil/components/body.h>
#include <mobil/components/fat.h>
#include <mobil/components/pose.h>
#include <mobil/components/sleep.h>
#include <mobil/engine/access.h>
#include <mobil/engine/error.h>
#include <mobil/schedule.h>
#include <mobil/systems/people/sleepers.h>
#include "engine/exact_math.h"
#include "engine/snapshot.h"
#include "systems/gait/fat_motion.h"
#include "systems/people/group_by_table.h"

namespace mobil::inline v0_3 {
namespace {

/// Checks that only people, awake or asleep, have fat components.
Result<void> check_fat_key(const Archetype& key, const World&) {
  const auto has = [&](std::uint64_t id) { return find_component(key, id) != nullptr; };
  const bool awake = !has(type_id<FatWobble<float>>()) || has(type_id<BodySize<float>>());
  const bool asleep = !has(type_id<SleepsWithFat>()) || has(type_id<Asleep<float>>());
  if (awake && asleep) return {};
  return damaged("whose fat wobbles");
}

}  // namespace

Module fat_module() {
  return {.name = "fat",
          .parts = {component_id<FatWobble>(), component_id(TagValue<SleepsWithFat>{})},
          .systems = [](ScheduleBuilder& systems) { systems.add("fat", &fat_motion); },
          .check_key = &check_fat_key};
}

Status set_fat_wobble(World& world, const Jobs& jobs, std::span<const Entity> people, bool on) {
  std::vector<Entity> changes;
  for (const Entity person : people) {
    if (!is_person(world, person)) return Status::stale_entity;
    if (has_fat(world, person) != on) changes.push_back(person);
  }
  World::Transaction transaction(world, jobs);
  group_by_table(world, changes, [&](std::span<const Entity> together) {
    const bool asleep = is_asleep(world, together.front());
    const PartValue part =
        asleep ? part_value(TagValue<SleepsWithFat>{1}) : PartValue{component_id<FatWobble>(), nullptr};
    const std::array owned = {part.part.id};
    world.change_archetype(together, std::span(&part, on ? 1 : 0), owned, jobs);
  });
  transaction.commit();
  return Status::ok;
}

bool has_fat(const World& world, Entity person) {
  return world.has<FatWobble>(person) || world.has<SleepsWithFat>(person);
}

void settle_fat(World& world, Entity person) {
  if (world.has<FatWobble>(person)) world.set(person, FatWobble<float>{});
}

void place_fat(World& world, Entity person, const Placing& way) {
  auto fat = world.get<FatWobble>(person);
  if (!fat) return;
  const double s = exact::sin(double{way.turn_rad()}), c = exact::cos(double{way.turn_rad()});
  const auto turn = [&](Vec3<float>& v) {
    const double x = double{v.x}, z = double{v.z};
    v.x = static_cast<float>(x * c + z * s);
    v.z = static_cast<float>(z * c - x * s);
  };
  for (std::size_t r = 0; r < fat_regions; ++r) {
    turn(fat->beside_m[r]);
    turn(fat->speed_m_s[r]);
    Vec3<float>& at = fat->carried_m[r];
    at.x -= way.from_x_m, at.z -= way.from_z_m;
    turn(at);
    at.x += way.to_x_m, at.z += way.to_z_m;
  }
  world.set(person, *fat);
}

}  // namespace mobil::inline v0_3
