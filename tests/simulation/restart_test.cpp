// A belly that is not finite restarts, is counted, and converges to its undisturbed state. Other people are unaffected.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <mobil/engine/world.h>
#include <mobil/host_parts.h>
#include <mobil/schedule.h>
#include <mobil/simulation.h>
#include <mobil/step_report.h>
#include <mobil/systems/surfaces/nodal_view.h>
#include "tests/world_of.h"

namespace mobil {
namespace {
namespace restart {

/// Drives a muscle's end for one tick by this value, unless it is 0.
template <class F>
struct Poison {
  F value;
};

void poison(Poison<Lanes<float>>& poison, EndDrive<Lanes<float>>& end) {
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    if (poison.value[lane] == 0) continue;
    end.to[lane] = poison.value[lane];
    poison.value[lane] = 0;
  }
}

Module poisoning() {
  return {.name = "poisoning", .parts = {component_id<Poison>()}, .systems = [](ScheduleBuilder& systems) {
            systems.add("poison", &poison).after("lines of action").after("activation");
          }};
}

struct Way {
  std::string name;
  LegMuscles choice;
};

std::vector<Way> ways() {
  LegMuscles plain;
  plain.muscles = MuscleSet{3};
  std::vector<Way> all;
  for (const Method method : {Method::explicit_central, Method::implicit_central, Method::newmark, Method::statics,
                              Method::modal, Method::finite}) {
    LegMuscles choice = plain;
    choice.method = method;
    all.push_back({std::string(method_name[static_cast<std::size_t>(method)]), choice});
    choice.inertia = true;
    choice.activation = ExcitationSource::phase;
    all.push_back({all.back().name + ", inertia and activation", choice});
  }
  LegMuscles pulled = plain;
  pulled.method = Method::explicit_central;
  pulled.drive = Drive::force;
  all.push_back({"explicit-central, pulled", pulled});
  LegMuscles tuned = plain;
  tuned.method = Method::modal;
  tuned.modal.tuned = true;
  tuned.activation = ExcitationSource::phase;
  all.push_back({"modal, tuned", tuned});
  return all;
}

/// Three equal people, whose muscles share blocks. Only a muscle of the first is poisoned.
struct Scene {
  Simulation simulation{sharing({.threads = 2, .modules = {poisoning()}})};
  std::vector<Entity> people;

  explicit Scene(const LegMuscles& choice) {
    for (int i = 0; i < 3; ++i) {
      people.push_back(*simulation.spawn({.height_m = 1.8F, .mass_kg = 80}));
      const auto added = simulation.set_muscles(people.back(), choice);
      EXPECT_TRUE(added) << added.error().message;
      for (const MuscleRef& own : simulation.muscles(people.back()))
        for (const Entity one : own.entity) EXPECT_EQ(simulation.parts().add(one, Poison<float>{0}), Status::ok);
    }
    for (int i = 0; i < 30; ++i) simulation.tick();
  }

  Entity muscle() const { return simulation.muscle(people[0], Muscle::quadriceps, Side::right); }

  std::vector<float> shown(Entity muscle) const {
    std::vector<float> all;
    const NodalView view = nodal_displacement(simulation.world(), muscle);
    for (std::size_t i = 0; view.first != nullptr && i < 3 * view.nodes; ++i) all.push_back(view.first[i * lane_count]);
    EXPECT_EQ(all.size(), 3 * 81U);
    return all;
  }

  std::vector<float> shown_of_others() const {
    std::vector<float> all;
    for (const Entity person : people) {
      for (const MuscleRef& own : simulation.muscles(person)) {
        for (const Entity one : own.entity) {
          if (one == muscle()) continue;
          const std::vector<float> points = shown(one);
          all.insert(all.end(), points.begin(), points.end());
        }
      }
    }
    return all;
  }
};

bool finite(const std::vector<float>& numbers) {
  return std::ranges::all_of(numbers, [](float x) { return std::isfinite(x); });
}

float largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
  float most = a.size() == b.size() ? 0 : std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) most = std::max(most, std::fabs(a[i] - b[i]));
  return most;
}

/// Writes one number of the belly's state, away from its faces.
template <class Tag>
void write_state(Scene& scene, std::mt19937& random, float value) {
  const auto width = scene.simulation.world().get<Tag>(scene.muscle());
  ASSERT_TRUE(width);
  std::vector<float> words(*width);
  ASSERT_EQ(scene.simulation.world().template get_field<Tag>(scene.muscle(), words), Status::ok);
  words[words.size() / 4 + random() % (words.size() / 2)] = value;
  ASSERT_EQ(world_of(scene.simulation).template set_field<Tag>(scene.muscle(), words), Status::ok);
}

constexpr float no_numbers[] = {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity(),
                                3e38F};

/// The report and a snapshot are finite in the tick of a restart as well.
void expect_reported_and_saved(Scene& scene, const std::string& what) {
  const auto report = scene.simulation.get<BellyReport>(scene.muscle());
  ASSERT_TRUE(report);
  for (const float number : {report->elongation_m, report->reaction_n, report->volume_ratio, report->kinetic_energy_j,
                             report->strain_energy_j})
    EXPECT_TRUE(std::isfinite(number)) << what;
  std::vector<std::byte> bytes(scene.simulation.snapshot_bytes());
  const auto saved = scene.simulation.save(bytes);
  ASSERT_TRUE(saved) << what << ": " << saved.error().message;
  const auto restored = scene.simulation.restore(bytes);
  EXPECT_TRUE(restored) << what << ": " << restored.error().message;
}

/// Expects all values to be finite within three ticks and the restart to be counted; after three seconds the belly
/// matches its twin. `numbers`: also checks the report and a snapshot in each of the three ticks.
void expect_restarted(Scene& scene, Scene& twin, const std::string& what, bool numbers) {
  const std::uint64_t before = scene.simulation.report().total_restarted_bellies;
  for (int i = 0; i < 3; ++i) {
    scene.simulation.tick();
    twin.simulation.tick();
    EXPECT_EQ(scene.shown_of_others(), twin.shown_of_others()) << what;
    if (numbers) expect_reported_and_saved(scene, what);
  }
  EXPECT_TRUE(finite(scene.shown(scene.muscle()))) << what;
  EXPECT_EQ(scene.simulation.report().restarted_bellies, 0U) << what;
  const std::uint64_t counted = scene.simulation.report().total_restarted_bellies - before;
  EXPECT_GE(counted, 1U) << what;
  EXPECT_LE(counted, 2U) << what;
  for (int i = 0; i < 180; ++i) scene.simulation.tick(), twin.simulation.tick();
  EXPECT_LT(largest_difference(scene.shown(scene.muscle()), twin.shown(twin.muscle())), 2e-3F) << what;
  EXPECT_EQ(twin.simulation.report().total_restarted_bellies, 0U);
}

/// First a number of its state is not finite, then its end drive.
TEST(Restart, NonFiniteBellyRestarts) {
  std::mt19937 random(1);
  for (const Way& way : ways()) {
    Scene scene(way.choice), twin(way.choice);
    for (const float value : no_numbers) {
      const std::string what = way.name + ", " + std::to_string(value);
      if (way.choice.method == Method::modal) {
        write_state<ModalState>(scene, random, value);
      } else if (way.choice.method == Method::statics || random() % 2 == 0) {
        write_state<NodalDisplacement>(scene, random, value);
      } else {
        write_state<NodalVelocity>(scene, random, value);
      }
      expect_restarted(scene, twin, what, true);
      ASSERT_TRUE(scene.simulation.parts().set(scene.muscle(), Poison<float>{value}));
      expect_restarted(scene, twin, what + " at its end", false);
    }
  }
}

}  // namespace restart
}  // namespace
}  // namespace mobil
