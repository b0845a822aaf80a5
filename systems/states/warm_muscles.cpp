#include "systems/states/warm_muscles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <mobil/anthropometry.h>
#include <mobil/engine/interrupt.h>
#include "systems/muscles/leg_moments.h"
#include "systems/states/sleep.h"

namespace mobil::inline v0_3 {
namespace {

/// Copies all columns of a muscle except its owner.
void copy_muscle(const World& from, Entity source, World& to, Entity target) {
  const auto row = from.find(source);
  const auto into = to.find(target);
  std::vector<std::uint32_t> words;
  for (const ComponentId& part : into.table->key()) {
    if (!has_column(part.kind) || part.id == type_id<MuscleOwner<float>>()) continue;
    const std::uint32_t column = row.table->column(part.id);
    const auto count = static_cast<std::uint32_t>(part.value);
    if (column == Table::no_column) continue;
    words.resize(count);
    row.table->read(row.row, column, count, words.data());
    into.table->write(into.row, into.table->column(part.id), count, words.data());
  }
}

}  // namespace

std::uint32_t warm_ticks(float within_m, double tick_s) {
  constexpr std::array<std::pair<float, double>, 4> steps = {{{0.015F, 0}, {0.005F, 0.5}, {0.001F, 1}, {4e-6F, 2.1}}};
  double seconds = 3;
  for (auto step = steps.rbegin(); step != steps.rend(); ++step)
    if (within_m >= step->first) seconds = step->second;
  return static_cast<std::uint32_t>(std::ceil(seconds / tick_s - 1e-6));
}

WarmingRoom::WarmingRoom(std::span<const Module> modules, std::pmr::memory_resource* memory)
    : world_(memory), schedule_(*make_schedule(modules, memory)) {
  world_.set_owner_part(component_id<MuscleOwner>());
}

void WarmingRoom::warm(const MuscleScene& scene, std::span<const Entity> people, const LegMuscles& choice,
                       std::uint32_t ticks) {
  const std::uint32_t now = scene.time.tick, then = now - std::min(now, ticks);
  const auto tick_s = static_cast<float>(scene.time.tick_s);
  if (then == now || follows_moments(choice)) return;
  steady_.clear();
  find_steady(scene.world, people, {now, tick_s}, steady_);
  if (steady_.empty()) return;
  people_.assign(steady_.size(), Entity{});
  try {
    warm_people(scene, choice, then);
  } catch (...) {  // removes all people; destroying one at a time allocates no memory
    for (const Entity person : people_) {
      for (Entity member = world_.first_member(person); world_.alive(member); member = world_.first_member(person))
        world_.destroy(member);
      world_.destroy(person);
    }
    throw;
  }
}

void WarmingRoom::warm_people(const MuscleScene& scene, const LegMuscles& choice, std::uint32_t then) {
  const std::uint32_t now = scene.time.tick;
  const auto tick_s = static_cast<float>(scene.time.tick_s);
  create_steady(world_, scene.jobs, steady_, {then, tick_s}, people_, work_);
  const MuscleScene room{world_, scene.library, scene.work, scene.jobs, {then, scene.time.tick_s}};
  if (begin_leg_muscles(room, people_, choice)) {
    for (std::uint32_t tick = then; tick < now; ++tick) {
      check_interrupt();
      schedule_.run(world_, {tick_s, tick}, scene.jobs);
    }
    for (std::size_t i = 0; i < steady_.size(); ++i) {
      check_interrupt();
      const std::vector<MuscleRef> warm = muscles_of(world_, people_[i]);
      const std::vector<MuscleRef> cold = muscles_of(scene.world, steady_[i].entity);
      for (std::size_t m = 0; m < std::min(warm.size(), cold.size()); ++m) {
        for (const Side side : {Side::right, Side::left})
          copy_muscle(world_, warm[m].entity[side], scene.world, cold[m].entity[side]);
      }
    }
  }
  rows_.assign(people_.begin(), people_.end());
  for (const Entity person : people_) world_.each_member(person, [&](Entity member) { rows_.push_back(member); });
  world_.destroy_many(rows_, scene.jobs);
  scene.work.recent = {};
}

}  // namespace mobil::inline v0_3
