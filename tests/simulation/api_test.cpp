// Host access to rows: a host's components are accepted, the library's are refused.
#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include <mobil/each.h>
#include <mobil/host_parts.h>
#include <mobil/lod.h>
#include <mobil/systems/snapshot/restore_limits.h>
#include "tests/labels.h"
#include "tests/refused.h"
#include "tests/simulation/leg_muscles.h"

MOBIL_TEST_LABELS("threads");

namespace mobil::api_test {

template <class F>
struct Score {
  UInt32<F> points;
  F weight;
};
struct Trail {};
struct Palette {
  int colours = 3;
};

TEST(Door, HostComponentsAreAccepted) {
  Simulation simulation;
  const Entity person = *simulation.spawn(sample_person(1).body);
  ASSERT_TRUE(simulation.set_muscles(person));
  const Entity muscle = simulation.muscle(person, Muscle::hamstrings, Side::left);
  for (const Entity entity : {person, muscle}) {
    EXPECT_EQ(simulation.parts().add(entity, Score<float>{3, 0.5F}), Status::ok);
    EXPECT_EQ(simulation.parts().add(entity, FieldWidth<Trail>{2}), Status::ok);
    EXPECT_EQ(simulation.parts().add(entity, simulation.parts().share(std::make_shared<const Palette>())), Status::ok);
    EXPECT_EQ(simulation.parts().set(entity, Score<float>{4, 0.5F}), Status::ok);
    EXPECT_EQ(simulation.parts().set_field<Trail>(entity, std::array{1.0F, 2.0F}), Status::ok);
    EXPECT_EQ(simulation.get<Score>(entity)->points, 4U);
  }
  const std::uint64_t before = simulation.state_hash();
  EXPECT_EQ(simulation.parts().each([](const Rows& rows, Score<Lanes<float>>& score) {
    for (std::uint32_t lane = 0; lane < rows.live; ++lane) score.weight[lane] += 1;
  }),
            Status::ok);
  EXPECT_NE(simulation.state_hash(), before);
  float sum = 0;
  each(simulation.world(), [&](const Rows& rows, const Score<Lanes<float>>& score, Field<const Trail> trail) {
    for (std::uint32_t lane = 0; lane < rows.live; ++lane) sum += score.weight[lane] + trail.data[16 + lane];
  });
  EXPECT_EQ(sum, 2 * (1.5F + 2));
  EXPECT_EQ(simulation.parts().remove<Score>(muscle), Status::ok);
  EXPECT_EQ(simulation.parts().remove<Trail>(muscle), Status::ok);
  EXPECT_EQ(simulation.get<Score>(muscle).error(), Status::missing);

  const auto own = simulation.parts().create(Score<float>{1, 2});
  ASSERT_TRUE(own);
  EXPECT_EQ(simulation.get<Score>(*own)->weight, 2);
  EXPECT_EQ(simulation.parts().destroy(*own), Status::ok);
  EXPECT_EQ(simulation.parts().destroy(*own), Status::stale_entity);
}

TEST(Door, LibraryComponentsAreRefused) {
  Simulation simulation;
  const Entity person = *simulation.spawn(sample_person(1).body);
  ASSERT_TRUE(simulation.set_muscles(person));
  const Entity muscle = simulation.muscle(person, Muscle::hamstrings, Side::left);
  const std::uint64_t before = simulation.state_hash();
  EXPECT_EQ(simulation.parts().destroy(person), Status::not_yours);
  EXPECT_EQ(simulation.parts().destroy(muscle), Status::not_yours);
  EXPECT_EQ(simulation.parts().remove<GaitState>(person), Status::not_yours);
  EXPECT_EQ(simulation.parts().remove<NodalDisplacement>(muscle), Status::not_yours);
  EXPECT_EQ(simulation.parts().set(person, *simulation.get<Pose>(person)), Status::not_yours);
  EXPECT_EQ(simulation.parts().add(person, BellyScale<float>{1, 1}), Status::not_yours);
  EXPECT_EQ(simulation.parts().set_field<NodalDisplacement>(muscle, std::vector<float>(243)), Status::not_yours);
  EXPECT_EQ(simulation.parts().create(BodySize<float>{}, Score<float>{}).error(), Status::not_yours);
  bool called = false;
  EXPECT_EQ(simulation.parts().each([&](Pose<Lanes<float>>&) { called = true; }), Status::not_yours);
  EXPECT_FALSE(called);
  EXPECT_EQ(simulation.state_hash(), before);
  EXPECT_EQ(simulation.people().size(), 1U);
  EXPECT_FALSE(status_text(Status::not_yours).empty());
}

/// A snapshot with a component that no module names is refused by that name in a program that lacks it.
TEST(Door, SnapshotNamesUnknownComponents) {
  Simulation simulation, other;
  const Entity person = *simulation.spawn(sample_person(1).body);
  ASSERT_EQ(simulation.parts().add(person, Score<float>{3, 0.5F}), Status::ok);
  std::vector<std::byte> bytes(simulation.snapshot_bytes());
  ASSERT_TRUE(simulation.save(bytes));
  EXPECT_TRUE(is_refused(other.restore(bytes), "Score<float>"));
  Simulation knows({.modules = {{.name = "game", .parts = {component_id<Score>()}}}});
  const auto done = knows.restore(bytes, RestoreLimits::none());
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(knows.get<Score>(person)->points, 3U);
}

TEST(Made, ErrorsAreValues) {
  EXPECT_TRUE(is_refused(Simulation::make({.tick_s = 0})));
  EXPECT_FALSE(Simulation::make({.modules = {Module{}}}));
  Simulation simulation;
  EXPECT_FALSE(simulation.lod().set_options({.slack = 2}));
  EXPECT_FALSE(simulation.lod().set_options({.switching_s = 0}));
  EXPECT_TRUE(simulation.lod().set_options({}));
}

TEST(Made, SimulationIsMovable) {
  const auto fill = [](Simulation& simulation) {
    const Entity person = *simulation.spawn(sample_person(2).body);
    EXPECT_TRUE(simulation.set_muscles(person));
    for (int i = 0; i < 20; ++i) simulation.tick();
  };
  Simulation stays;
  fill(stays);
  std::vector<Simulation> all;
  for (int i = 0; i < 3; ++i) {
    auto made = Simulation::make({.threads = 2});
    ASSERT_TRUE(made);
    fill(*made);
    all.push_back(std::move(*made));
  }
  all.erase(all.begin());
  for (int i = 0; i < 20; ++i) stays.tick();
  for (Simulation& moved : all) {
    for (int i = 0; i < 20; ++i) moved.tick();
    EXPECT_EQ(moved.state_hash(), stays.state_hash());
  }
}

/// A change sets only named fields. Other fields stay and can be read back.
TEST(GaitChanges, UnsetFieldsKeepTheirValue) {
  Simulation simulation;
  GaitRequest asked{.speed_m_s = 1.2F, .step_length_m = 0.66F};
  asked.style.toe_out_deg = 15;
  const Entity person = *simulation.spawn(sample_person(1).body, asked);
  const auto now = [&] { return *simulation.gait_request(person); };
  EXPECT_FLOAT_EQ(*now().speed_m_s, 1.2F);
  EXPECT_FLOAT_EQ(*now().step_length_m, 0.66F);
  EXPECT_EQ(now().style.toe_out_deg, 15);
  ASSERT_TRUE(simulation.change_gait(person, {.speed_m_s = 1.5F}));
  EXPECT_FLOAT_EQ(*now().speed_m_s, 1.5F);
  EXPECT_NE(*now().step_length_m, 0.66F) << "a speed alone has the usual steps";
  EXPECT_EQ(now().style.toe_out_deg, 15);
  const float length_m = *now().step_length_m;
  GaitStyle style = now().style;
  style.toe_out_deg = 3;
  ASSERT_TRUE(simulation.change_gait(person, {.style = style}));
  EXPECT_FLOAT_EQ(*now().speed_m_s, 1.5F);
  EXPECT_FLOAT_EQ(*now().step_length_m, length_m);
  EXPECT_EQ(now().style.toe_out_deg, 3);
  ASSERT_TRUE(simulation.change_gait(person, {.speed_m_s = 0.0F}));
  EXPECT_EQ(*now().speed_m_s, 0);
  ASSERT_TRUE(simulation.change_gait(person, {}));
  EXPECT_EQ(*now().speed_m_s, 0);
  EXPECT_EQ(now().style.toe_out_deg, 3);
  ASSERT_TRUE(simulation.set_gait(person, {}));
  EXPECT_EQ(now().style.toe_out_deg, GaitStyle{}.toe_out_deg);
  EXPECT_FALSE(simulation.change_gait(person, {.speed_m_s = 9.0F}));
  EXPECT_GT(*now().speed_m_s, 1);
  EXPECT_FALSE(simulation.gait_request(*simulation.spawn_posed({})));
  EXPECT_FALSE(simulation.gait_request({}));
}

}  // namespace mobil::api_test
