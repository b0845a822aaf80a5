#include "systems/simulation_queries.h"

#include <bit>

#include <mobil/anthropometry.h>
#include <mobil/components/sleep.h>
#include <mobil/each.h>
#include <mobil/engine/world.h>
#include <mobil/schedule.h>
#include <mobil/systems/gait/resolve_gait.h>
#include <mobil/systems/limits/limit_monitor.h>
#include <mobil/systems/limits/style_limits.h>
#include "systems/muscles/leg_muscles.h"
#include "systems/people/compact_pose.h"
#include "systems/people/person_requests.h"
#include "systems/states/sleep.h"

namespace mobil::inline v0_3 {

std::optional<Person> read_person(const Simulation& simulation, Entity entity) {
  const World& world = simulation.world();
  if (!is_person(world, entity)) return std::nullopt;
  const auto asleep = kept_choice(world, entity);
  LegMuscles choice = asleep ? *asleep : choice_of(world, entity).value_or(LegMuscles{});
  if (is_compact(world, entity) && choice.muscles.any()) {
    const auto first = static_cast<Muscle>(std::countr_zero(choice.muscles.to_ullong()));
    const MuscleMethod method = simulation.method(entity, first);
    choice.method = method.method;
    choice.modal = method.modal;
  }
  Person person{entity,
                *make_body(body_request(world, entity)),
                gait_of(world, entity).value_or(Gait<float>{}),
                {},
                choice,
                is_posed(world, entity)};
  for (const MuscleRef& own : muscles_of(world, entity)) {
    person.muscles.push_back(
        {*make_muscle_plan(person.body, own.muscle), own.entity, simulation.method(entity, own.muscle)});
  }
  return person;
}

std::vector<Entity> read_people(const World& world) {
  std::vector<Entity> all;
  each(world, [&](const Rows& rows, const Physique<Lanes<float>>&) {
    all.insert(all.end(), rows.entity, rows.entity + rows.live);
  });
  each(world, [&](const Rows& rows, const Asleep<Lanes<float>>&) {
    all.insert(all.end(), rows.entity, rows.entity + rows.live);
  });
  return all;
}

StepReport read_report(const Schedule& schedule, std::uint32_t ticks) {
  const Counted restarted = schedule.tally<RestartedBellies>(), beyond = schedule.tally<LimitViolations>();
  StepReport report{ticks, {}, restarted.last, restarted.all, beyond.last, beyond.all};
  const auto systems = schedule.systems();
  const auto timings = schedule.timings();
  report.systems.reserve(systems.size());
  for (std::size_t s = 0; s < systems.size(); ++s) {
    const Timing& t = timings[s];
    report.systems.push_back({systems[s].name, systems[s].module, t.last_seconds, t.last_rows, t.seconds, t.rows});
  }
  for (const bool after : {false, true})
    for (const TimedPhase& one : after ? schedule.after() : schedule.before())
      report.phases.push_back({one.phase.name, one.module, after, one.last_seconds, one.seconds});
  return report;
}

Result<std::vector<StyleChange>> style_changes(const BodyRequest& body, const GaitRequest& asked) {
  const auto made = make_body(body);
  if (!made) return tl::unexpected(made.error());
  auto gait = resolve_gait(*made, asked);
  if (!gait) return tl::unexpected(gait.error());
  return keep_walk_limits(made->size, *gait);
}

}  // namespace mobil::inline v0_3
