// A game calls only `advance`: level of detail, avoidance and terrain are part of each tick, and their memory is state.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <vector>

#include <mobil/avoidance.h>
#include <mobil/lod.h>
#include <mobil/snapshot_file.h>
#include <mobil/step_report.h>
#include <mobil/systems/snapshot/restore_limits.h>
#include <mobil/terrain.h>
#include "tests/interfaces.h"
#include "tests/labels.h"
#include "tests/simulation/people.h"

MOBIL_TEST_LABELS("threads");

namespace mobil::one_tick_test {
namespace {

constexpr std::size_t crowd_size = 90;

void hills(std::span<const TerrainQuery> at, std::span<TerrainHeight> out) {
  for (std::size_t i = 0; i < at.size(); ++i)
    out[i] = {0.4F * std::sin(0.3F * at[i].x_m), 0.12F * std::cos(0.3F * at[i].x_m), 0};
}

/// Sets a host's inputs, which are not state. The camera goes round and round.
void look(Simulation& simulation) {
  const float yaw = 0.4F * static_cast<float>(simulation.time_s());
  Viewpoint camera{.position_m = {0, 1.7F, 0}, .forward = {std::sin(yaw), 0, std::cos(yaw)}};
  camera.half_angle_rad = 0.4F;
  camera.near_m = 3;
  camera.reach_m = 12;
  LodScene needs{.camera = camera, .tolerance_px = 2, .asleep_beyond_m = 4, .compact_unseen = true};
  needs.muscles = MuscleSet(3);
  ASSERT_TRUE(simulation.lod().set_scene(needs));
}

std::unique_ptr<Simulation> equipped(int threads = 1) {
  auto simulation = std::make_unique<Simulation>(sharing({.threads = threads}));
  EXPECT_TRUE(simulation->lod().set_options({.switches = 9, .wakes = 4, .sleeps = 5, .begins = 3, .stagger = 3}));
  EXPECT_TRUE(simulation->avoidance().set_walls({{Wall{{-8, 9}, {8, 9}}}}));
  simulation->terrain().set_heights(&hills);
  simulation->terrain().set_options({.slows_down = true});
  look(*simulation);
  return simulation;
}

/// Spawns a crowd: a third avoids others, a third walks on hills, and all are managed.
void populate(Simulation& simulation) {
  std::vector<SpawnRequest> requests(crowd_size);
  for (std::size_t i = 0; i < crowd_size; ++i) {
    const SamplePerson one = sample_person(static_cast<int>(i));
    requests[i].body = one.body;
    requests[i].gait = {.speed_m_s = 0.7F + 0.01F * static_cast<float>(i % 60)};
    requests[i].x_m = 3.0F * (static_cast<float>(i % 10) - 4.5F);
    requests[i].z_m = 3.0F * (static_cast<float>(i / 10) - 4);  // NOLINT(bugprone-integer-division)
    requests[i].heading_rad = 0.9F * static_cast<float>(i);
    requests[i].parts = managed_parts();
  }
  std::vector<Entity> people(crowd_size);
  ASSERT_TRUE(simulation.spawn(requests, people));
  ASSERT_TRUE(simulation.lod().manage(people));
  ASSERT_TRUE(simulation.avoidance().manage(std::span(people).first(crowd_size / 3)));
  ASSERT_TRUE(simulation.terrain().manage(std::span(people).subspan(crowd_size / 3, crowd_size / 3)));
}

/// Advances in frames of uneven length, with requests determined by the tick's number.
void play(Simulation& simulation, std::uint32_t to_tick) {
  while (simulation.ticks() < to_tick) {
    look(simulation);
    const std::uint32_t now = simulation.ticks();
    const auto people = simulation.people();
    const Entity one = *std::ranges::min_element(people, {}, [&](Entity e) { return (e.index * 7919U + now) % 101U; });
    if (simulation.world().has<AvoidanceState>(one))
      (void)simulation.avoidance().set_desired_velocity({{{one, 1.1F, 0.01F * static_cast<float>(now)}}});
    else
      (void)simulation.turn_to(one, 0.01F * static_cast<float>(now));
    simulation.tick(now % 3 == 0 && now + 2 <= to_tick ? 2 : 1);
  }
}

std::vector<std::byte> saved(const Simulation& simulation) {
  std::vector<std::byte> bytes(simulation.snapshot_bytes());
  EXPECT_TRUE(simulation.save(bytes));
  return bytes;
}

TEST(OneTick, SnapshotContinuesUndisturbed) {
  MOBIL_SLOW();
  const auto undisturbed = equipped();
  populate(*undisturbed);
  play(*undisturbed, 240);
  const auto bytes = saved(*undisturbed);
  const auto other = equipped(3);
  ASSERT_TRUE(other->restore(bytes, RestoreLimits::none()));
  EXPECT_EQ(other->state_hash(), undisturbed->state_hash());
  play(*undisturbed, 840);
  play(*other, 840);
  EXPECT_EQ(other->state_hash(), undisturbed->state_hash());
  // Also back, in the simulation that continued.
  const std::uint64_t after = undisturbed->state_hash();
  ASSERT_TRUE(undisturbed->restore(bytes));
  play(*undisturbed, 840);
  EXPECT_EQ(undisturbed->state_hash(), after);
}

TEST(OneTick, RollsBack) {
  MOBIL_SLOW();
  const auto simulation = equipped();
  populate(*simulation);
  play(*simulation, 200);
  Rollback window(12);
  std::vector<std::uint64_t> first;
  const auto run = [&](std::vector<std::uint64_t>& hashes, bool keeps) {
    for (std::uint32_t t = 0; t < 12; ++t) {
      if (keeps) {
        ASSERT_TRUE(window.keep(*simulation));
      }
      play(*simulation, 201 + t);
      hashes.push_back(simulation->state_hash());
    }
  };
  run(first, true);
  ASSERT_TRUE(window.back(*simulation, 12));
  std::vector<std::uint64_t> second;
  run(second, false);
  EXPECT_EQ(first.size(), 12U);
  EXPECT_EQ(simulation->ticks(), 212U);
  EXPECT_EQ(first, second);
}

TEST(OneTick, AllFeaturesAreUsed) {
  MOBIL_SLOW();
  const auto simulation = equipped();
  populate(*simulation);
  LodReport chosen;
  std::size_t steps = 0, places = 0, compact = 0, asleep = 0;
  for (std::uint32_t tick = 1; tick <= 600; ++tick) {
    play(*simulation, tick);
    const LodReport& now = simulation->lod().report();
    chosen.switched += now.switched, chosen.woken += now.woken, chosen.slept += now.slept, chosen.begun += now.begun;
    EXPECT_EQ(now.refused, 0U) << now.refusal;
    steps += simulation->avoidance().report().chose;
    places += simulation->terrain().report().places;
    for (const Entity one : simulation->people()) {
      compact += simulation->state(one) == PersonState::compact ? 1 : 0;
      asleep += simulation->state(one) == PersonState::asleep ? 1 : 0;
    }
  }
  EXPECT_GT(chosen.switched, 50U);
  EXPECT_GT(chosen.woken, 20U);
  EXPECT_GT(chosen.slept, 20U);
  EXPECT_GT(chosen.begun, 20U);
  EXPECT_GT(steps, 200U);
  EXPECT_GT(places, 1000U);
  EXPECT_GT(compact, 1000U);
  EXPECT_GT(asleep, 1000U);
}

/// Reports cover all ticks of one call.
TEST(OneTick, FrameOfSeveralTicksReportsAll) {
  const auto one = equipped(), other = equipped();
  for (Simulation* simulation : {one.get(), other.get()}) populate(*simulation);
  std::size_t evaluated = 0, chose = 0, asked = 0;
  for (int tick = 0; tick < 12; ++tick) {
    one->tick();
    evaluated += one->lod().report().evaluated;
    chose += one->avoidance().report().chose;
    asked += one->terrain().report().asked;
  }
  other->advance(12.0 / 60 + 1e-9);
  ASSERT_EQ(other->ticks(), 12U);
  EXPECT_EQ(other->lod().report().evaluated, evaluated);
  EXPECT_EQ(other->avoidance().report().chose, chose);
  EXPECT_EQ(other->terrain().report().asked, asked);
  EXPECT_EQ(other->state_hash(), one->state_hash());
}

TEST(OneTick, EvaluationIntervalIsRespected) {
  Simulation simulation(sharing());
  ASSERT_TRUE(simulation.lod().set_options({.stagger = 1, .every = 4}));
  ASSERT_TRUE(simulation.lod().set_scene({.muscles = MuscleSet(1), .tolerance_m = 0.002F}));
  ASSERT_TRUE(simulation.lod().manage(*simulation.spawn(BodyRequest{})));
  std::size_t looked = 0;
  for (int tick = 0; tick < 40; ++tick) {
    simulation.tick();
    looked += simulation.lod().report().evaluated;
  }
  EXPECT_EQ(looked, 10U);
  EXPECT_FALSE(simulation.lod().set_options({.every = 0}));
}

/// A phase that throws stops time, and no time is lost.
TEST(OneTick, MissedTimeRunsLater) {
  int left = 0;
  Module failing{.name = "failing", .before = {{"failing", [&](const Frame& frame) {
                                                  if (frame.tick.index == 2 && left-- > 0)
                                                    throw std::runtime_error("no");
                                                }}}};
  Simulation simulation(sharing({.modules = {failing}}));
  left = 1;
  EXPECT_THROW(simulation.advance(12.0 / 60 + 1e-9), std::runtime_error);
  EXPECT_EQ(simulation.ticks(), 2U);
  EXPECT_EQ(simulation.advance(0).count, 10U);
  EXPECT_EQ(simulation.ticks(), 12U);
}

/// A phase can restore a snapshot: the current tick continues with the phases after it.
TEST(OneTick, PhaseCanRestoreButNotTick) {
  Simulation* running = nullptr;
  std::vector<std::byte> bytes;
  int calls = 0;
  Module back{.name = "back", .before = {{"back", [&](const Frame&) {
                                            if (++calls == 5) {
                                              EXPECT_TRUE(running->restore(bytes));
                                            }
                                            if (calls == 7) {
                                              EXPECT_THROW(running->tick(), std::logic_error);
                                            }
                                          }}}};
  Simulation simulation(sharing({.modules = {back}}));
  running = &simulation;
  ASSERT_TRUE(simulation.spawn(BodyRequest{}));
  bytes = saved(simulation);
  simulation.tick(4);
  simulation.tick();
  EXPECT_EQ(simulation.ticks(), 1U);
  simulation.tick(3);
  EXPECT_EQ(simulation.ticks(), 4U);
  EXPECT_EQ(calls, 8);
}

}  // namespace
}  // namespace mobil::one_tick_test
