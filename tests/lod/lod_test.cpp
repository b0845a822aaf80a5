// Level of detail in running simulations: chosen methods for the requests of a scene.
#include <mobil/each.h>
#include <mobil/engine/world.h>
#include <mobil/lod.h>
#include <mobil/step_report.h>
#include <mobil/systems/surfaces/nodal_view.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <random>
#include <vector>

#include "tests/engine/counting_malloc.h"
#include "tests/interfaces.h"
#include "tests/labels.h"
#include "tests/refused.h"
#include "tests/simulation/people.h"
#include "tests/simulation/simulation_hash.h"
#include "tests/world_of.h"

MOBIL_TEST_LABELS("threads");

namespace mobil::lod_test {
/// Modal bellies of a single body need only one basis a muscle, which is quick to make.
SamplePerson one_body(int i) {
  SamplePerson p;
  p.body.height_m = 1.8F;
  p.body.mass_kg = 80;
  p.gait.speed_m_s = 1.0F + 0.05F * static_cast<float>(i % 12);
  return p;
}

constexpr std::size_t fine_level = 9;
static_assert(levels[fine_level].cells == Cells{8, 8, 32});

/// The library's table with an error of 1 m for the fine mesh, because its bases take a second each to make.
const AccuracyTable& quick_table() {
  static const std::vector<AccuracyRow> rows = [] {
    std::vector<AccuracyRow> all(accuracy_table().rows.begin(), accuracy_table().rows.end());
    for (AccuracyRow& row : all) row.error_m[fine_level] = 1;
    return all;
  }();
  static const AccuracyTable table{rows, accuracy_table().cost};
  return table;
}

LodOptions quick(LodOptions options) {
  options.table = &quick_table();
  return options;
}

/// People with two muscles, or with as many of the first groups as set. Tests wait for the preparation of each muscle.
struct Scene {
  Simulation simulation;
  Lod lod;
  std::vector<Entity> people;
  std::size_t muscle_count = 2;

  explicit Scene(int count, const LodOptions& options = {.stagger = 1, .machine_factor = 1}, int threads = 1)
      : simulation({.threads = threads}), lod(lod_of(simulation, quick(options))) {
    for (int i = 0; i < count; ++i) add(i);
  }
  void add(int i) {
    const Entity person = join(simulation, one_body(i), false);
    auto state = *simulation.get<GaitState>(person);
    state.line_x_m = state.anchor_x_m = 3.0F * static_cast<float>(i % 8);
    state.line_z_m = state.anchor_z_m = 3.0F * static_cast<float>(i / 8);
    world_of(simulation).set(person, state);
    people.push_back(person);
  }
  Result<void> ask(LodScene needs) {
    needs.muscles = MuscleSet((1U << muscle_count) - 1);
    return lod.set_scene(needs);
  }
  void manage_all(const LodOverrides& needs = {}) {
    for (const Entity person : people) {
      const auto done = lod.manage(person, needs);
      ASSERT_TRUE(done) << done.error().message;
    }
  }
  LodReport last{};
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      simulation.tick();
      last = lod.report();
    }
  }
  template <class F>
  void each(F what) const {
    for (const Entity person : people) {
      for (std::size_t m = 0; m < muscle_count; ++m) what(person, static_cast<Muscle>(m));
    }
  }
  std::vector<std::size_t> levels_of() const {
    std::vector<std::size_t> all;
    each([&](Entity person, Muscle muscle) { all.push_back(lod.why(person, muscle)->level); });
    return all;
  }
};

std::uint64_t deformed(const Simulation& simulation) {
  std::uint64_t sum = 0;
  for (const SystemReport& system : simulation.report().systems) {
    if (system.name.starts_with("deformation")) sum += system.entities;
  }
  return sum;
}

TEST(Lod, EveryMuscleHasTheCheapestSufficientMethod) {
  constexpr std::array tolerances_m = {0.001F, 0.002F, 0.005F, 0.02F};  // scene's, then per person
  Scene scene(6 * static_cast<int>(tolerances_m.size()), {.switching_s = 1, .stagger = 1, .machine_factor = 1});
  scene.muscle_count = usual_muscle_count;
  ASSERT_TRUE(scene.ask({.tolerance_m = tolerances_m[0]}));
  scene.manage_all();
  const auto tolerance_of = [&](std::size_t i) { return tolerances_m[i / 6]; };
  for (std::size_t i = 6; i < scene.people.size(); ++i) {
    ASSERT_TRUE(scene.lod.manage(scene.people[i], {.tolerance_m = tolerance_of(i)}));
  }
  scene.simulation.tick();
  const auto report = scene.lod.report();
  EXPECT_EQ(report.refused, 0U) << report.refusal;
  const LodTable lod_table(quick_table());
  for (std::size_t i = 0; i < scene.people.size(); ++i) {
    const Entity person = scene.people[i];
    const float tolerance_m = tolerance_of(i);
    for (std::uint32_t m = 0; m < usual_muscle_count; ++m) {
      const auto muscle = static_cast<Muscle>(m);
      const auto choice = *scene.lod.why(person, muscle);
      const auto lod_state = *scene.simulation.get<LodState>(person);
      const LevelCase of{m, lod_state.speed_step, false, true};
      EXPECT_EQ(choice.level, lod_table.cheapest(of, tolerance_m / lod_state.relative_size));
      if (choice.reason == Reason::tolerance) {
        EXPECT_LE(choice.predicted_error_m, tolerance_m);
      } else {
        EXPECT_EQ(choice.reason, Reason::best) << choice.text;
      }
      EXPECT_EQ(scene.simulation.method(person, muscle).method, levels[choice.level].method);
      EXPECT_FALSE(choice.text.empty());
    }
  }
}

/// Detected by the heap: making a basis takes more than a thousand requests.
TEST(Lod, PreparedUpdatesMakeNoSharedData) {
  if (!counts_malloc) GTEST_SKIP() << "malloc is another's here";
  std::array<std::size_t, 2> most{};
  for (const bool prepared : {false, true}) {
    Scene scene(30, {.stagger = 1, .machine_factor = 1});
    scene.muscle_count = 1;
    Viewpoint camera{.position_m = {0, 1, -400}};
    ASSERT_TRUE(scene.ask({.camera = camera}));
    std::size_t meshes = 0;
    const auto count = [&](std::size_t done, std::size_t of) { meshes += done < of ? 1 : 0; };
    if (prepared) {
      ASSERT_TRUE(scene.lod.prepare({}, count));
    }
    EXPECT_EQ(meshes > 4, prepared);
    EXPECT_LT(meshes, level_count - 1) << "what is never the cheapest is not made";
    scene.manage_all();
    for (int t = 0; t < 40; ++t) {
      camera.position_m.z = -400 + 10.0F * static_cast<float>(t);  // out of reach, then among them
      ASSERT_TRUE(scene.ask({.camera = camera}));
      const std::size_t before = malloc_requests;
      scene.simulation.tick();
      most[prepared ? 1 : 0] = std::max(most[prepared ? 1 : 0], malloc_requests - before);
      scene.simulation.tick();
    }
  }
  EXPECT_GT(most[0], most[1] + 1000);
}

TEST(Lod, PreparingRefusesInvalidTolerances) {
  Scene scene(1);
  for (const float bad : {0.0F, -1.0F, std::numeric_limits<float>::quiet_NaN()}) {
    EXPECT_TRUE(is_refused(scene.lod.prepare({&bad, 1}), "tolerance"));
  }
}

TEST(Lod, UnmanagedPeopleAreUnchanged) {
  Simulation plain, watched;
  for (Simulation* simulation : {&plain, &watched}) {
    for (int i = 0; i < 2; ++i) {
      ASSERT_TRUE(simulation->set_muscles(join(*simulation, one_body(i), false), {.muscles = MuscleSet(3)}));
    }
  }
  Lod lod = watched.lod();
  ASSERT_TRUE(lod.set_scene({.camera = Viewpoint{}, .budget_s = 1e-6}));
  for (int t = 0; t < 20; ++t) {
    plain.tick();
    watched.tick();
    const auto report = lod.report();
    EXPECT_EQ(report.evaluated + report.switched + report.waiting, 0U);
  }
  EXPECT_EQ(hash_world(plain), hash_world(watched));
  EXPECT_EQ(plain.world().tables().size(), watched.world().tables().size());
}

TEST(Lod, NothingDeformsOutOfReachAndPeopleKeepWalking) {
  Scene scene(8);
  ASSERT_TRUE(scene.ask({.tolerance_m = 0.002F}));
  scene.manage_all();
  scene.run(2);
  ASSERT_GT(deformed(scene.simulation), 0U);
  Viewpoint away;
  away.position_m = {0, 1.7F, 1000};
  away.reach_m = 100;
  ASSERT_TRUE(scene.ask({.camera = away}));
  scene.run(60);  // fades have ended
  EXPECT_EQ(deformed(scene.simulation), 0U);
  const float before = scene.simulation.get<Pose>(scene.people[0])->position_m[0].z;
  scene.run(30);
  EXPECT_GT(scene.simulation.get<Pose>(scene.people[0])->position_m[0].z, before + 0.2F);
  scene.each([&](Entity person, Muscle muscle) {
    EXPECT_EQ(scene.simulation.method(person, muscle).method, Method::none);
    EXPECT_EQ(scene.lod.why(person, muscle)->reason, Reason::out_of_reach);
    EXPECT_EQ(nodal_displacement(scene.simulation.world(), scene.simulation.muscle(person, muscle, Side::right)).first,
              nullptr);
  });
}

TEST(Lod, FartherPeopleHaveNoCostlierMethod) {
  Scene scene(40);
  Viewpoint camera;
  camera.position_m = {10, 1.5F, -4};
  camera.half_angle_rad = 1.5F;
  ASSERT_TRUE(scene.ask({.camera = camera, .tolerance_px = 0.3F}));
  scene.manage_all();
  scene.simulation.tick();
  scene.each([&](Entity a, Muscle muscle) {
    scene.each([&](Entity b, Muscle other) {
      if (muscle != other) return;
      const auto of_a = *scene.lod.why(a, muscle), of_b = *scene.lod.why(b, muscle);
      if (of_a.reason != Reason::tolerance || of_b.reason != Reason::tolerance) return;
      const bool alike = scene.simulation.get<LodState>(a)->speed_step == scene.simulation.get<LodState>(b)->speed_step;
      if (alike && of_a.tolerance_m > of_b.tolerance_m) {
        EXPECT_LE(of_a.predicted_cost_us, of_b.predicted_cost_us);
      }
    });
  });
}

TEST(Lod, ControlPointsArePlacedOnlyForPeopleLookedAt) {
  Scene scene(8);
  ASSERT_TRUE(scene.ask({.tolerance_m = 0.002F, .looked_at = false}));
  scene.manage_all();
  ASSERT_TRUE(scene.lod.manage(scene.people[3], {.looked_at = true}));
  scene.run(60);
  for (std::size_t i = 0; i < scene.people.size(); ++i) {
    const Entity muscle = scene.simulation.muscle(scene.people[i], Muscle::hamstrings, Side::left);
    EXPECT_EQ(nodal_displacement(scene.simulation.world(), muscle).first != nullptr, i == 3) << i;
  }
}

TEST(Lod, PersonRequestsOverrideTheScene) {
  Scene scene(2);
  ASSERT_TRUE(scene.ask({.tolerance_m = 0.05F}));
  scene.manage_all();
  MuscleSet one;
  one.set(static_cast<std::size_t>(Muscle::quadriceps));
  ASSERT_TRUE(scene.lod.manage(scene.people[1], {.muscles = one, .tolerance_m = 0.001F}));
  scene.simulation.tick();
  EXPECT_EQ(scene.lod.why(scene.people[1], Muscle::hamstrings)->reason, Reason::not_wanted);
  EXPECT_EQ(scene.simulation.method(scene.people[1], Muscle::hamstrings).method, Method::none);
  EXPECT_EQ(scene.lod.why(scene.people[1], Muscle::quadriceps)->tolerance_m, 0.001F);
  EXPECT_GT(scene.lod.why(scene.people[1], Muscle::quadriceps)->predicted_cost_us,
            scene.lod.why(scene.people[0], Muscle::quadriceps)->predicted_cost_us);
}

TEST(Lod, SameOnAnyThreads) {
  const auto fly = [](int threads) {
    Scene scene(40, {.switches = 12, .stagger = 3, .machine_factor = 2}, threads);
    EXPECT_TRUE(scene.ask({}));
    scene.manage_all();
    std::vector<std::uint64_t> hashes;
    for (int t = 0; t < 60; ++t) {
      Viewpoint camera;
      camera.position_m = {static_cast<float>(t) * 0.4F, 1.7F, -5};
      camera.half_angle_rad = 0.4F;
      EXPECT_TRUE(scene.ask({.camera = camera, .budget_s = 10e-6}));
      scene.run(1);
      if (t % 10 == 9) hashes.push_back(hash_world(scene.simulation));
    }
    return hashes;
  };
  const auto one = fly(1);
  EXPECT_EQ(fly(2), one);
  EXPECT_EQ(fly(1), one);
}

TEST(Lod, SpawnOrderIndependent) {
  constexpr int people = 24;
  const auto choices = [](const std::vector<int>& order) {
    Scene scene(0);
    for (const int i : order) scene.add(i);
    Viewpoint camera;
    camera.position_m = {10, 1.5F, -4};
    EXPECT_TRUE(scene.ask({.camera = camera, .tolerance_px = 0.5F}));
    scene.manage_all();
    scene.run(3);
    std::vector<std::size_t> by_person(people * scene.muscle_count);
    const auto all = scene.levels_of();
    for (std::size_t at = 0; at < order.size(); ++at) {
      for (std::size_t m = 0; m < scene.muscle_count; ++m) {
        by_person[static_cast<std::size_t>(order[at]) * scene.muscle_count + m] = all[at * scene.muscle_count + m];
      }
    }
    return by_person;
  };
  std::vector<int> order(people);
  std::iota(order.begin(), order.end(), 0);
  const auto in_order = choices(order);
  EXPECT_GT(std::ranges::max(in_order), std::ranges::min(in_order));
  std::shuffle(order.begin(), order.end(), std::mt19937(5));
  EXPECT_EQ(choices(order), in_order);
}

TEST(Lod, ChangesAtOnceAreLimitedWorstFirst) {
  Scene scene(20, {.switches = 7, .stagger = 1, .machine_factor = 1});
  ASSERT_TRUE(scene.ask({.tolerance_m = 0.002F}));
  scene.manage_all();
  std::size_t waiting = scene.people.size() * scene.muscle_count;
  while (waiting > 0) {
    scene.simulation.tick();
    const auto report = scene.lod.report();
    ASSERT_EQ(report.switched, std::min<std::size_t>(7, waiting));
    waiting -= report.switched;
    EXPECT_EQ(report.waiting, waiting);
    float min_done = INFINITY, max_left = 0;
    const LodTable lod_table(quick_table());
    scene.each([&](Entity person, Muscle muscle) {
      const auto choice = *scene.lod.why(person, muscle);
      const auto lod_state = *scene.simulation.get<LodState>(person);
      const float unmoved =
          lod_table.error_m({static_cast<std::uint32_t>(muscle), lod_state.speed_step, false, true}, 0);
      (choice.reason == Reason::switch_pending ? max_left = std::max(max_left, unmoved)
                                               : min_done = std::min(min_done, unmoved));
    });
    EXPECT_GE(min_done, max_left);
  }
}

TEST(Lod, ForcedMethodsStayUntilUnforced) {
  Scene scene(2);
  ASSERT_TRUE(scene.ask({.tolerance_m = 0.005F}));
  scene.manage_all();
  scene.run(1);
  const Entity person = scene.people[0];
  const std::size_t chosen = scene.lod.why(person, Muscle::hamstrings)->level;
  ASSERT_TRUE(scene.lod.force(person, Muscle::hamstrings, level_method(10, true)));
  scene.run(3);
  EXPECT_EQ(scene.simulation.method(person, Muscle::hamstrings).method, Method::explicit_central);
  EXPECT_EQ(scene.lod.why(person, Muscle::hamstrings)->reason, Reason::forced);
  ASSERT_EQ(scene.lod.unforce(person, Muscle::hamstrings), Status::ok);
  scene.run(1);
  EXPECT_EQ(scene.lod.why(person, Muscle::hamstrings)->level, chosen);
}

TEST(Lod, ForcedMethodsOfRemovedMusclesAreDropped) {
  Scene scene(2);
  ASSERT_TRUE(scene.ask({.tolerance_m = 0.005F}));
  scene.manage_all();
  scene.run(1);
  const Entity person = scene.people[0];
  ASSERT_TRUE(scene.lod.force(person, Muscle::hamstrings, level_method(10, true)));
  LegMuscles choice;
  for (const bool there : {false, true}) {
    choice.muscles.set(static_cast<std::size_t>(Muscle::hamstrings), there);
    ASSERT_TRUE(scene.simulation.set_muscles(person, choice));
    scene.run(1);
  }
  EXPECT_NE(scene.lod.why(person, Muscle::hamstrings)->reason, Reason::forced);
}

TEST(Lod, ReleasedPeopleKeepTheirMusclesUnchanged) {
  Scene scene(2);
  ASSERT_TRUE(scene.ask({.tolerance_m = 0.001F}));
  scene.manage_all();
  scene.run(1);
  const auto method = scene.simulation.method(scene.people[0], Muscle::quadriceps);
  ASSERT_EQ(scene.lod.release(scene.people[0]), Status::ok);
  EXPECT_EQ(scene.lod.release(scene.people[0]), Status::missing);
  ASSERT_TRUE(scene.ask({.tolerance_m = 1}));
  scene.run(2);
  EXPECT_EQ(scene.simulation.method(scene.people[0], Muscle::quadriceps).method, method.method);
  EXPECT_EQ(scene.simulation.method(scene.people[1], Muscle::quadriceps).method, Method::none);
  EXPECT_EQ(scene.lod.why(scene.people[0], Muscle::quadriceps).error(), Status::missing);
}

TEST(Lod, PeopleCanBeDespawnedMeanwhile) {
  Scene scene(20, {.stagger = 3, .machine_factor = 1});
  ASSERT_TRUE(scene.ask({.tolerance_m = 0.002F, .budget_s = 7e-6}));
  scene.manage_all();
  for (int i = 0; i < 15; ++i) {
    scene.run(2);
    ASSERT_EQ(scene.simulation.despawn(scene.people.back()), Status::ok);
    scene.people.pop_back();
  }
  scene.run(12);
  double sum_us = 0;
  scene.each([&](Entity person, Muscle muscle) { sum_us += 2 * scene.lod.why(person, muscle)->predicted_cost_us; });
  scene.simulation.tick();
  EXPECT_NEAR(1e6 * scene.lod.report().predicted_s, sum_us, 1e-3);
}

TEST(Lod, RefusesValuesOutOfRangeInOneLine) {
  Scene scene(1);
  for (const LodScene& bad : {LodScene{.tolerance_m = 0.0F}, LodScene{.tolerance_m = NAN}, LodScene{.budget_s = -1},
                              LodScene{.tolerance_px = INFINITY}, LodScene{.camera = Viewpoint{.forward = {0, 0, 0}}},
                              LodScene{.camera = Viewpoint{.half_angle_rad = 4}}}) {
    EXPECT_TRUE(is_refused(scene.lod.set_scene(bad)));
  }
  EXPECT_FALSE(scene.lod.manage(Entity{77, 1}));
  EXPECT_FALSE(scene.lod.manage(scene.people[0], {.tolerance_m = -1.0F}));
  EXPECT_FALSE(scene.lod.force(scene.people[0], Muscle::hamstrings, {}));
  EXPECT_EQ(scene.lod.why(Entity{77, 1}, Muscle::hamstrings).error(), Status::stale_entity);
  EXPECT_FALSE(scene.lod.set_options({.slack = 0}));
  EXPECT_FALSE(scene.lod.set_options({.stagger = 0}));
}

/// Returns the time of the current methods on a machine slower than the table's by a factor.
double clock_s(const Scene& scene, double slower) {
  double sum_us = 0;
  const AccuracyTable& table = accuracy_table();
  scene.each([&](Entity person, Muscle muscle) {
    const MuscleMethod method = scene.simulation.method(person, muscle);
    for (std::size_t r = 0; r < level_count; ++r) {
      const MuscleMethod of = level_method(r, method.modal.control_points);
      const bool same = of.method == method.method && of.modal.moving == method.modal.moving &&
                        of.modal.modes == method.modal.modes && of.modal.cells == method.modal.cells;
      if (same) {
        sum_us += 2 * static_cast<double>(table.cost[0].state_us[r] +
                                          (method.modal.control_points ? table.cost[0].points_us[r] : 0.0F));
        break;
      }
    }
  });
  return 1e-6 * slower * sum_us;
}

TEST(Lod, BudgetHoldsOnASlowAndUnsteadyMachine) {
  std::mt19937 dice(3);
  std::normal_distribution<double> bell;
  constexpr int people = 64;
  const std::unique_ptr<Scene>* self = nullptr;
  double spent_s = 0, slower = 3;
  LodOptions options;
  options.switches = 20;
  options.measured_s = [&](const Schedule&) { return spent_s; };
  const auto scene = std::make_unique<Scene>(people, options);
  self = &scene;
  ASSERT_TRUE(scene->ask({}));
  scene->manage_all();
  std::vector<double> parts;
  double budget_s = 0;
  for (int t = 0; t < 700; ++t) {
    Viewpoint camera;
    camera.position_m = {12 + 12 * std::sin(0.02F * static_cast<float>(t)), 1.7F, static_cast<float>(t) * 0.02F - 6};
    camera.half_angle_rad = 0.7F;
    LodScene needs{.camera = camera, .tolerance_px = 0.5F};
    if (t >= 60) needs.budget_s = budget_s;
    ASSERT_TRUE((*self)->ask(needs));
    (*self)->run(1);
    if (t > 400) slower = 4;  // other programs are running
    const double exact_s = clock_s(**self, slower);
    spent_s = exact_s * std::max(0.5, 1 + 0.03 * bell(dice));
    if (t == 59) budget_s = 0.4 * exact_s;
    if (t > 160 && (t < 400 || t > 460)) parts.push_back(spent_s / budget_s);
  }
  ASSERT_GT(budget_s, 0);
  std::ranges::sort(parts);
  EXPECT_LE(parts[static_cast<std::size_t>(0.99 * static_cast<double>(parts.size()))], 1.1);
  EXPECT_GE(parts[parts.size() / 2], 0.5) << "and is made use of";
}

}  // namespace mobil::lod_test
