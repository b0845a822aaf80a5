// Modules: a host's components and systems next to the library's, and how they are kept.
#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <mobil/engine/world.h>
#include <mobil/host_parts.h>
#include <mobil/schedule.h>
#include <mobil/simulation.h>
#include <mobil/snapshot_file.h>
#include <mobil/step_report.h>
#include <mobil/systems/snapshot/restore_limits.h>
#include "systems/muscles/muscle_parts.h"
#include "tests/simulation/crowd_play.h"

namespace mobil::module_test {
/// A number of the host's on a row, incremented each tick.
template <class F>
struct Counter {
  UInt32<F> ticks, key;
};
struct Trace {};  // a field
struct Palette {  // a resource
  int colours = 0;
};

void count(Counter<Lanes<float>>& counter, Field<Trace> trace) {
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    ++counter.ticks[lane];
    trace.data[lane] += 0.5F;
  }
}

Module counting(std::uint32_t version = 1, std::shared_ptr<const Palette> palette = nullptr) {
  Module module{.name = "counting",
                .version = version,
                .parts = {component_id<Counter>(), component_id(FieldWidth<Trace>{}), component_id(Shared<Palette>{})},
                .systems = [](ScheduleBuilder& systems) { systems.add("count", &count); }};
  if (palette != nullptr) module.resources = {named_resource("palette", std::move(palette))};
  return module;
}

void mark(Simulation& simulation, Entity entity, std::uint32_t key) {
  EXPECT_EQ(simulation.parts().add(entity, Counter<float>{0, key}), Status::ok);
  EXPECT_EQ(simulation.parts().add(entity, FieldWidth<Trace>{1}), Status::ok);
}
void expect_marked(const Simulation& simulation, Entity entity, std::uint32_t key, std::uint32_t ticks) {
  const auto counter = simulation.get<Counter>(entity);
  ASSERT_TRUE(counter);
  EXPECT_EQ(counter->key, key);
  EXPECT_EQ(counter->ticks, ticks);
  float trace = 0;
  EXPECT_EQ(simulation.world().get_field<Trace>(entity, {&trace, 1}), Status::ok);
  EXPECT_EQ(trace, 0.5F * static_cast<float>(ticks));
}

struct Marked {
  Entity person, muscle;
};

/// A walker with coarse muscles that has the host's components, as does one of the muscles.
Marked marked_walker(Simulation& simulation) {
  Marked made;
  made.person = *simulation.spawn({});
  EXPECT_TRUE(simulation.set_muscles(made.person, {.cells = play::coarse}));
  made.muscle = simulation.muscle(made.person, Muscle::hamstrings, Side::left);
  mark(simulation, made.person, 11);
  mark(simulation, made.muscle, 22);
  return made;
}

TEST(Modules, HostComponentsSurviveEveryMuscleChange) {
  Simulation simulation({.modules = {counting()}});
  const Marked marked = marked_walker(simulation);
  std::uint32_t ticks = 0;
  const auto run = [&] {
    simulation.tick();
    expect_marked(simulation, marked.person, 11, ++ticks);
    expect_marked(simulation, marked.muscle, 22, ticks);
  };
  for (const MuscleMethod& method : play::every_method()) {
    ASSERT_TRUE(simulation.set_method(marked.person, Muscle::hamstrings, method));
    run();
  }
  for (std::uint64_t draw = 0; draw < 27; ++draw) {
    ASSERT_TRUE(simulation.set_muscles(marked.person, play::choice_of(draw)));
    run();
  }
  EXPECT_EQ(simulation.enable(marked.person, Feature::forces), Status::ok);
  run();
  for (int i = 0; i < 30; ++i) run();  // fades end
}

TEST(Modules, HostComponentsSurviveSpawnsAndDespawns) {
  Simulation simulation({.modules = {counting()}});
  const Marked marked = marked_walker(simulation);
  const std::vector<SpawnRequest> people(100, SpawnRequest{.muscles = LegMuscles{.cells = play::coarse}});
  for (std::uint32_t round = 0; round < 3; ++round) {
    std::vector<Entity> others(people.size());
    ASSERT_TRUE(simulation.spawn(people, others));
    mark(simulation, others[50], 33);
    simulation.tick();
    expect_marked(simulation, others[50], 33, 1);
    EXPECT_EQ(simulation.despawn(others), Status::ok);
    expect_marked(simulation, marked.person, 11, round + 1);
    expect_marked(simulation, marked.muscle, 22, round + 1);
  }
}

TEST(Modules, SnapshotsAndRollbackKeepNamedComponents) {
  const auto palette = std::make_shared<const Palette>(Palette{7});
  Simulation simulation({.modules = {counting(1, palette)}});
  const Marked marked = marked_walker(simulation);
  simulation.parts().add(marked.person, simulation.parts().share(palette));
  simulation.tick();
  std::vector<std::byte> bytes(simulation.snapshot_bytes());
  ASSERT_TRUE(simulation.save(bytes));
  const std::uint64_t then = simulation.state_hash();
  Rollback window(2);
  ASSERT_TRUE(window.keep(simulation));
  for (int i = 0; i < 5; ++i) simulation.tick();
  const std::uint64_t later = simulation.state_hash();
  EXPECT_NE(then, later);
  ASSERT_TRUE(window.back(simulation, 1));
  EXPECT_EQ(simulation.state_hash(), then);
  expect_marked(simulation, marked.muscle, 22, 1);

  // Another simulation creates resources in another order, and no entity has ever had these components.
  Simulation other({.modules = {counting(1, palette)}});
  ASSERT_TRUE(other.restore(bytes, RestoreLimits::none())) << other.restore(bytes).error().message;
  EXPECT_EQ(other.state_hash(), then);
  expect_marked(other, marked.person, 11, 1);
  ASSERT_NE(other.world().shared<Palette>(marked.person), nullptr);
  EXPECT_EQ(other.world().shared<Palette>(marked.person)->colours, 7);
  for (int i = 0; i < 5; ++i) other.tick();
  EXPECT_EQ(other.state_hash(), later);
}

TEST(Modules, SnapshotsOfOtherModulesOrVersionsAreRefused) {
  Simulation simulation({.modules = {counting()}});
  marked_walker(simulation);
  std::vector<std::byte> bytes(simulation.snapshot_bytes());
  ASSERT_TRUE(simulation.save(bytes));
  const auto refusal = [&](const SimulationOptions& options) {
    Simulation other(options);
    const std::uint64_t before = other.state_hash();
    const auto done = other.restore(bytes, RestoreLimits::none());
    if (!done) {
      EXPECT_EQ(other.state_hash(), before);
    }
    return done ? std::string() : done.error().message;
  };
  EXPECT_NE(refusal({}).find("a module named 'counting'"), std::string::npos) << refusal({});
  EXPECT_NE(refusal({.modules = {counting(2)}}).find("version 1 of module 'counting'"), std::string::npos);
  EXPECT_EQ(refusal({.modules = {counting()}}), "");

  // A resource that no module names cannot be saved. A named one cannot be restored without its module.
  const auto palette = std::make_shared<const Palette>(Palette{7});
  const Entity person = *simulation.spawn({});
  simulation.parts().add(person, simulation.parts().share(palette));
  const auto unnamed = simulation.save(bytes);
  EXPECT_FALSE(unnamed);
  Simulation named({.modules = {counting(1, palette)}});
  named.parts().add(*named.spawn({}), named.parts().share(palette));
  bytes.resize(named.snapshot_bytes());
  ASSERT_TRUE(named.save(bytes));
  EXPECT_NE(refusal({.modules = {counting()}}).find("named resource"), std::string::npos);
}

TEST(Modules, InconsistentOnesAreRefused) {
  EXPECT_THROW(Simulation({.modules = {counting(), counting()}}), std::invalid_argument);
  EXPECT_THROW(Simulation({.modules = {Module{}}}), std::invalid_argument);
  EXPECT_THROW(Simulation({.modules = {Module{.name = "mine", .parts = {component_id<Pose>()}}}}),
               std::invalid_argument);
  const Module late{.name = "late",
                    .systems = [](ScheduleBuilder& systems) { systems.add("late", &count).after("no such system"); }};
  EXPECT_THROW(Simulation({.modules = {late}}), std::invalid_argument);
}

/// For any creation and change of a muscle, its components are in the one list, and each belongs to a module.
TEST(Modules, CoverEveryComponentOfACrowd) {
  play::Crowd crowd(sharing(), {.seed = 5});
  std::size_t muscles = 0;
  for (int tick = 0; tick < 120; ++tick) {
    crowd.tick();
    const Simulation& simulation = crowd.simulation();
    for (const Table& table : simulation.world().tables()) {
      for (const ComponentId& part : table.key()) {
        EXPECT_NE(module_of(simulation.modules(), part.id), nullptr) << part.name << " is no module's";
      }
      if (find_component(table.key(), type_id<MuscleOwner<float>>()) == nullptr) continue;
      EXPECT_TRUE(muscle_kind(table.key(), simulation.world())) << "tick " << tick;
      muscles += table.row_count();
    }
  }
  EXPECT_GT(muscles, 1000U);
}

/// A host's phases spawn and despawn walkers within `advance`, on any number of threads.
TEST(Modules, HostPhasesSpawnAndDespawn) {
  struct Arrivals {
    std::vector<Entity> all;
  };
  const auto run = [](int threads) {
    Simulation* running = nullptr;
    Module arrivals{.name = "arrivals",
                    .before = {{"arrivals",
                                [&running](const Frame& frame) {
                                  auto& all = frame.workspace.get<Arrivals>().all;
                                  if (frame.tick.index % 10 == 0) all.push_back(*running->spawn(BodyRequest{}));
                                }}},
                    .after = {{"departures", [&running](const Frame& frame) {
                                 auto& all = frame.workspace.get<Arrivals>().all;
                                 if (all.size() < 4) return;
                                 EXPECT_TRUE(running->despawn(all.front()));
                                 all.erase(all.begin());
                               }}}};
    Simulation simulation({.threads = threads, .modules = {arrivals}});
    running = &simulation;
    for (int frame = 0; frame < 30; ++frame) simulation.advance(0.05);
    EXPECT_EQ(simulation.people().size(), 3U);
    const StepReport report = simulation.report();
    std::string names;
    for (const PhaseReport& one : report.phases)
      names += std::string(one.name) + (one.after ? " after, " : " before, ");
    EXPECT_EQ(names,
              "level of detail before, avoidance before, ground before, arrivals before, memory of step events before, "
              "step events after, faded muscles after, settled walkers after, departures after, ");
    return simulation.state_hash();
  };
  EXPECT_EQ(run(1), run(2));
}

}  // namespace mobil::module_test
