// Relevance under cameras that flicker and budgets of nothing.

#include <algorithm>
#include <array>
#include <vector>

#include <mobil/components/fade.h>
#include <mobil/relevance.h>
#include "demo/lab/stress/stress.h"
#include "demo/lab/stress/stress_world.h"

namespace mobil {
namespace {

Result<std::vector<Entity>> rows_of_walkers(Simulation& simulation, int count) {
  std::vector<SpawnRequest> people(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    SpawnRequest& one = people[static_cast<std::size_t>(i)];
    one.body = {.height_m = 1.5F + 0.4F * static_cast<float>(i % 37) / 37, .mass_kg = 60};
    one.body.mass_kg = 22.5F * one.body.height_m * one.body.height_m;
    one.gait.speed_m_s = 0.9F + 0.6F * static_cast<float>(i % 23) / 23;
    one.x_m = 1.2F * static_cast<float>(i % 100);
    one.z_m = 1.5F * static_cast<float>(i / 100);
  }
  std::vector<Entity> made(people.size());
  if (auto done = simulation.spawn(people, made); !done) return tl::unexpected(done.error());
  return made;
}

}  // namespace

Result<void> stress_relevance(StressRun& run) {
  const int crowd = run.quick ? 60 : 400, updates = run.quick ? 120 : 600;
  struct Scene {
    const char* name;
    int turns_every;  // updates
    bool asleep, compact;
    double budget_s;
  };
  constexpr std::array scenes = {
      Scene{"a camera that turns round in every update", 1, false, false, 0},
      Scene{"a camera that turns round in every update, people out of sight compact", 1, false, true, 0},
      Scene{"a camera that turns round every 20 updates, people out of sight asleep", 20, true, true, 0},
      Scene{"a budget of a nanosecond", 0, false, false, 1e-9},
      Scene{"a budget of a nanosecond and a camera that turns round", 7, false, true, 1e-9}};
  double part = 0;
  for (const Scene& scene : scenes) {
    Simulation simulation;
    const auto people = rows_of_walkers(simulation, crowd);
    if (!people) return tl::unexpected(people.error());
    RelevanceOptions options;
    options.machine_factor = 1;
    auto relevance = Relevance::make(simulation, options);
    if (!relevance) return tl::unexpected(relevance.error());
    SceneNeeds needs;
    needs.muscles.reset();
    needs.muscles.set(static_cast<std::size_t>(Muscle::triceps_surae));
    needs.camera = Viewpoint{.position_m = {20, 1.6F, -5}, .near_m = 3, .reach_m = 60};
    needs.compact_unseen = scene.compact;
    if (scene.asleep) needs.asleep_beyond_m = 20;
    if (scene.budget_s > 0) needs.budget_s = scene.budget_s;
    if (auto set = relevance->set_scene(needs); !set) return set;
    if (auto done = relevance->manage(*people); !done) return done;
    std::size_t refused = 0;
    double worst_m = 0, cheapest_s = 1e9;
    for (int update = 0; update < updates; ++update) {
      if (scene.turns_every > 0 && update % scene.turns_every == 0) {
        needs.camera->forward.z = -needs.camera->forward.z;
        if (auto set = relevance->set_scene(needs); !set) return set;
      }
      const RelevanceReport report = relevance->update();
      refused += report.refused;
      cheapest_s = std::min(cheapest_s, report.predicted_s);
      simulation.tick();
      for (const Entity human : *people) keep_worst(worst_m, largest(control_points(simulation, human)));
    }
    run.at_most(scene.name, "refusals", 0, static_cast<double>(refused),
                "every choice is one that the simulation takes");
    run.at_most(scene.name, "largest displacement of a control point, m", 0.1, worst_m,
                "twice what these walks show: changes of method do not kick");
    std::size_t there = 0;
    for (const Entity human : *people) there += simulation.get<Pose>(human).has_value() ? 1 : 0;
    run.at_least(scene.name, "people with a pose", static_cast<double>(crowd), static_cast<double>(there),
                 "awake, compact or asleep, everybody is somewhere");
    run.progress(++part / static_cast<double>(scenes.size()));
  }
  return {};
}

}  // namespace mobil
