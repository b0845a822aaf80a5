// Order of phases around the systems, row changes in phases, and the state after a phase throws.
#include <gtest/gtest.h>

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include <mobil/engine/module.h>
#include <mobil/engine/phase.h>
#include <mobil/schedule.h>

namespace mobil::phase_test {
template <class F>
struct Age {
  F ticks;
};
struct Births {
  std::vector<Entity> all;
};

/// Writes the name of each phase that runs into `said`, with the number of finished ticks.
Module telling(std::string& said, const std::string& name) {
  const auto tell = [&said](const std::string& what) {
    return Phase{what, [&said, what](const Frame& frame) { said += what + std::to_string(frame.tick.index) + ' '; }};
  };
  return {.name = name,
          .systems =
              [&said, name](ScheduleBuilder& systems) {
                systems.add(name, [&said, name](const Age<Lanes<float>>&, Tick tick) {
                  said += name + std::to_string(tick.index) + ' ';
                });
              },
          .before = {tell("before " + name)},
          .after = {tell("after " + name)}};
}

/// Creates an entity before each tick. After it, destroys entities that are three ticks old.
Module generations() {
  return {.name = "generations",
          .parts = {component_id<Age>()},
          .systems =
              [](ScheduleBuilder& systems) {
                systems.add("age", [](Age<Lanes<float>>& age) {
                  for (std::size_t lane = 0; lane < lane_count; ++lane) age.ticks[lane] += 1;
                });
              },
          .before = {{"births",
                      [](const Frame& frame) {
                        frame.workspace.get<Births>().all.push_back(frame.world.create(Age<float>{0}));
                      }}},
          .after = {{"deaths", [](const Frame& frame) {
                       for (const Entity one : frame.workspace.get<Births>().all)
                         if (frame.world.alive(one) && frame.world.get<Age>(one)->ticks == 3) frame.world.destroy(one);
                     }}}};
}

TEST(Phases, RunAroundTheSystemsInTheOrderOfModules) {
  std::string said;
  auto schedule = *make_schedule(std::array{telling(said, "a"), telling(said, "b")});
  World world;
  world.create(Age<float>{0});
  Workspace workspace;
  Tick tick{0.01F, 7};
  schedule.tick(world, tick, workspace);
  EXPECT_EQ(said, "before a7 before b7 a7 b7 after a8 after b8 ");
  EXPECT_EQ(tick.index, 8U);
  EXPECT_EQ(schedule.describe(),
            "before: before a\nbefore: before b\n1. a; reads Age\n2. b; reads Age\n"
            "after: after a\nafter: after b\n");
}

TEST(Phases, ChangeRowsAndKeepTheirWorkspace) {
  auto schedule = *make_schedule(std::array{generations()});
  World world;
  Workspace workspace;
  Tick tick{0.01F, 0};
  for (int i = 0; i < 20; ++i) schedule.tick(world, tick, workspace);
  const std::vector<Entity>& all = workspace.get<Births>().all;
  ASSERT_EQ(all.size(), 20U);
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(world.alive(all[i]), i >= 18) << i;
  EXPECT_EQ(world.get<Age>(all[18])->ticks, 2);
}

TEST(Phases, ThrowingFirstPhaseVoidsTheTick) {
  std::string said;
  Module failing = telling(said, "b");
  failing.before.front().run = [](const Frame&) { throw std::runtime_error("no room"); };
  auto schedule = *make_schedule(std::array{telling(said, "a"), failing});
  World world;
  world.create(Age<float>{0});
  Workspace workspace;
  Tick tick{0.01F, 3};
  EXPECT_THROW(schedule.tick(world, tick, workspace), std::runtime_error);
  EXPECT_EQ(tick.index, 3U);
  EXPECT_EQ(said, "before a3 ");
}

TEST(Phases, NextTickResumesWithThePhaseThatThrew) {
  std::string said;
  Module failing = telling(said, "b");
  int left = 2;
  failing.before.front().run = [&](const Frame&) {
    if (left-- > 0) throw std::runtime_error("no room");
    said += "at last ";
  };
  auto schedule = *make_schedule(std::array{telling(said, "a"), failing, telling(said, "c")});
  World world;
  world.create(Age<float>{0});
  Workspace workspace;
  Tick tick{0.01F, 3};
  for (int i = 0; i < 2; ++i) EXPECT_THROW(schedule.tick(world, tick, workspace), std::runtime_error);
  schedule.tick(world, tick, workspace);
  EXPECT_EQ(said, "before a3 at last before c3 a3 b3 c3 after a4 after b4 after c4 ");
  said.clear();
  left = 1;
  EXPECT_THROW(schedule.tick(world, tick, workspace), std::runtime_error);
  schedule.begin_anew();
  schedule.tick(world, tick, workspace);
  EXPECT_TRUE(said.starts_with("before a4 before a4 at last ")) << said;
}

TEST(Phases, AreTimed) {
  static double now = 0;
  auto schedule = *make_schedule(std::array<Module, 1>{{{.name = "slow",
                                                         .before = {{"slow", [](const Frame&) { now += 2; }}},
                                                         .after = {{"slow", [](const Frame&) { now += 5; }}}}}});
  schedule.measure_with([] { return now; });
  World world;
  Workspace workspace;
  Tick tick{0.01F, 0};
  for (int i = 0; i < 3; ++i) schedule.tick(world, tick, workspace);
  EXPECT_EQ(schedule.before().front().last_seconds, 2);
  EXPECT_EQ(schedule.before().front().seconds, 6);
  EXPECT_EQ(schedule.after().front().seconds, 15);
  EXPECT_EQ(schedule.after().front().module, "slow");
  schedule.reset_timings();
  EXPECT_EQ(schedule.after().front().seconds, 0);
}

TEST(Phases, NeedAUniqueNameAndAFunction) {
  const Phase good{"one", [](const Frame&) {}}, same{"one", [](const Frame&) {}}, nameless{"", [](const Frame&) {}},
      empty{"two", {}};
  for (const Phase& bad : {same, nameless, empty}) {
    const auto refused = make_schedule(std::array<Module, 1>{{{.name = "host", .after = {good, bad}}}});
    ASSERT_FALSE(refused) << bad.name;
    EXPECT_NE(refused.error().message.find("of module 'host'"), std::string::npos) << refused.error().message;
  }
}

}  // namespace mobil::phase_test
