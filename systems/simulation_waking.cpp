#include "systems/simulation_waking.h"

#include <functional>
#include <vector>

#include <mobil/components/relevance.h>
#include <mobil/systems/relevance/relevance_module.h>
#include "systems/muscles/warm_muscles.h"
#include "systems/standard_modules.h"

namespace mobil::inline v0_3 {

MuscleScene scene_of(const Frame& frame) {
  const auto& means = frame.workspace.get<MuscleMeans>();
  return {frame.world, *means.library, frame.workspace.get<MuscleWork>(), frame.jobs, {frame.tick.index, means.tick_s}};
}

Result<void> wake(const MuscleScene& scene, Workspace& workspace, std::span<const Entity> people, float within_m) {
  World& world = scene.world;
  auto& work = workspace.get<SleepWork>();
  World::Attempt attempt(world, scene.jobs);
  work.asleep.clear();
  work.managed.clear();
  for (const Entity one : people)
    if (is_asleep(world, one)) (world.has<SleepsManaged>(one) ? work.managed : work.asleep).push_back(one);
  if (!work.managed.empty()) {
    if (auto done = wake_managed(scene, work, work.managed, Woken::whole); !done) return done;
  }
  const auto warm = [&](std::span<const Entity> some, const LegMuscles& choice) {
    warm_muscles(scene, workspace, some, choice, within_m);
  };
  auto done = wake_people(scene, work.asleep, {}, {}, work.owned, work, std::cref(warm));
  if (done) attempt.keep();
  return done;
}

Result<void> wake_managed(const MuscleScene& scene, SleepWork& work, std::span<const Entity> people, Woken as) {
  auto done = wake_people(scene, people, {WakingMuscles::later, as}, relevance_parts(), work.owned, work);
  Tiers<float> unseen{};
  unseen.view = static_cast<std::uint32_t>(View::out_of_reach);
  for (const Entity person : people) scene.world.set(person, unseen);
  return done;
}

void warm_muscles(const MuscleScene& scene, Workspace& workspace, std::span<const Entity> people,
                  const LegMuscles& choice, float within_m) {
  const std::uint32_t ticks = warm_ticks(within_m, scene.time.tick_s);
  if (ticks == 0) return;
  auto& room = workspace.get<SleepWork>().warming;
  if (room == nullptr) room = std::make_unique<WarmingRoom>(standard_modules(), workspace.memory());
  room->warm(scene, people, choice, ticks);
}

Phase settled_walkers() {
  return {"settled walkers", [](Frame& frame) {
            auto& work = frame.workspace.get<SleepWork>();
            work.restless.clear();
            end_unsettled(frame.world, frame.jobs, {frame.tick.index, frame.tick.dt_s}, work.unsettled, work.rows,
                          work.restless);
            if (!work.restless.empty()) wake(scene_of(frame), frame.workspace, std::vector(work.restless));
          }};
}

}  // namespace mobil::inline v0_3
