// Snapshots with excessive sizes or NaN, and faulty hosts: refused, or harmless to other people.

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include <mobil/engine/world.h>
#include <mobil/simulation.h>
#include <mobil/systems/snapshot/restore_limits.h>
#include <mobil/systems/surfaces/nodal_view.h>
#include "engine/snapshot_bytes.h"
#include "tests/labels.h"
#include "tests/simulation/people.h"
#include "tests/simulation/reseal.h"

MOBIL_TEST_LABELS("long");

namespace mobil {
namespace {

using Bytes = std::vector<std::byte>;

Bytes saved(const Simulation& simulation) {
  Bytes bytes(simulation.snapshot_bytes());
  EXPECT_TRUE(simulation.save(bytes));
  return bytes;
}

/// Spawns one person for each method with muscles, and runs some ticks.
void people(Simulation& simulation) {
  for (const Method method : {Method::modal, Method::explicit_central, Method::newmark, Method::statics}) {
    const auto person = simulation.spawn({.height_m = 1.8F, .mass_kg = 80});
    ASSERT_TRUE(person);
    LegMuscles choice;
    choice.method = method;
    choice.inertia = true;
    ASSERT_TRUE(simulation.set_muscles(*person, choice));
  }
  for (int i = 0; i < 20; ++i) simulation.tick();
}

void expect_refused(const Result<void>& done, const std::string& piece) {
  ASSERT_FALSE(done.has_value());
  EXPECT_NE(done.error().message.find(piece), std::string::npos) << done.error().message;
}

/// Used where time is not tested, because sanitizers take longer than the default of ten seconds.
constexpr double any_time = std::numeric_limits<double>::infinity();

TEST(RestoreLimitsOf, RowsAreCounted) {
  Simulation simulation(sharing()), other(sharing());
  people(simulation);
  const Bytes bytes = saved(simulation);
  const std::uint64_t before = other.state_hash();
  expect_refused(other.restore(bytes, {.rows = 35}), "36 people and muscles");  // four people, four muscles a leg
  EXPECT_EQ(other.state_hash(), before);
  ASSERT_TRUE(other.restore(bytes, {.rows = 36, .seconds = any_time}));
  EXPECT_EQ(other.state_hash(), simulation.state_hash());
}

TEST(RestoreLimitsOf, MissingMeshesBeyondThemAreNotMade) {
  Simulation simulation(sharing());
  LegMuscles choice;
  choice.cells = {4, 4, 20};
  choice.muscles = MuscleSet(1);
  choice.method = Method::explicit_central;
  const auto person = simulation.spawn({.height_m = 1.8F, .mass_kg = 80});
  ASSERT_TRUE(simulation.set_muscles(*person, choice));
  const Bytes bytes = saved(simulation);

  Simulation other;  // without any shared data
  const std::uint64_t before = other.state_hash();
  const auto start = std::chrono::steady_clock::now();
  expect_refused(other.restore(bytes), "a mesh of 525 nodes");
  expect_refused(other.restore(bytes, {.mesh_nodes = 0}), "at most 0 may be made");
  expect_refused(other.restore(bytes, {.mesh_nodes = 1000, .seconds = 0}), "at most 0 may be made");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));  // nothing was made
  EXPECT_EQ(other.state_hash(), before);
  ASSERT_TRUE(other.muscle_library().prepare(choice));
  const auto prepared = other.restore(bytes, {.mesh_nodes = 0});
  ASSERT_TRUE(prepared) << prepared.error().message;
  EXPECT_EQ(other.state_hash(), simulation.state_hash());
  Simulation third;
  ASSERT_TRUE(third.restore(bytes, {.mesh_nodes = 525, .seconds = any_time}));
}

TEST(RestoreLimitsOf, StepsOfATickAreCounted) {
  Simulation simulation(sharing()), other(sharing());
  const std::uint64_t before = other.state_hash();
  LegMuscles choice;
  choice.muscles.reset();
  choice.muscles.set(static_cast<std::size_t>(Muscle::hamstrings));
  choice.method = Method::explicit_central;
  choice.dt_s = simulation.tick_s() / 3000;
  const auto person = simulation.spawn({.height_m = 1.8F, .mass_kg = 80});
  ASSERT_TRUE(simulation.set_muscles(*person, choice));
  const Bytes bytes = saved(simulation);
  expect_refused(other.restore(bytes, {.seconds = any_time}), "3000 steps a tick");
  EXPECT_EQ(other.state_hash(), before);
  ASSERT_TRUE(other.restore(bytes, {.seconds = any_time, .steps = 3000}));
  // the stored choice of a compact person, by which muscles can be stepped later
  choice.method = Method::modal;
  choice.modal.control_points = false;
  ASSERT_TRUE(simulation.set_muscles(*person, choice));
  ASSERT_TRUE(simulation.set_state({&*person, 1}, PersonState::compact));
  EXPECT_TRUE(simulation.muscles(*person).empty());
  expect_refused(other.restore(saved(simulation), {.seconds = any_time}), "3000 steps a tick");
}

/// In a resealed snapshot any float of a row can be NaN or infinite.
TEST(RestoreLimitsOf, NonFiniteNumbersAreRefused) {
  Simulation simulation(sharing());
  people(simulation);
  const Bytes good = saved(simulation);
  std::uint64_t parts[3];
  std::memcpy(parts, &good[32], sizeof parts);
  const std::size_t blocks_at = SnapshotLayout{parts[0], parts[1], parts[2]}.blocks_at();
  std::mt19937_64 random(3);
  const float bad[] = {std::nanf(""), -std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity()};
  int refused = 0, tried = 0;
  for (int round = 0; round < 400; ++round) {
    Bytes bytes = good;
    std::byte* const word = &bytes[blocks_at + random() % (parts[2] / 4) * 4];
    float was;
    std::memcpy(&was, word, 4);
    if (was == 0 || !(std::fabs(was) > 1e-20F && std::fabs(was) < 1e6F)) continue;  // likely no float
    std::memcpy(word, &bad[round % 3], 4);
    ASSERT_TRUE(reseal_snapshot(bytes));
    ++tried;
    if (const auto done = simulation.restore(bytes); !done) {
      ++refused;
      EXPECT_EQ(done.error().message.find('\n'), std::string::npos);
      continue;
    }
    // Unchecked words are floats that no computation uses.
    for (int i = 0; i < 5; ++i) simulation.tick();
    for (const Entity person : simulation.people()) {
      EXPECT_TRUE(std::isfinite(simulation.get<Pose>(person)->position_m[0].x));
      for (const MuscleRef& own : simulation.muscles(person)) {
        const NodalView shown = nodal_displacement(simulation.world(), own.entity[Side::right]);
        for (std::size_t n = 0; shown.first != nullptr && n < shown.nodes; ++n) {
          EXPECT_TRUE(std::isfinite(shown.first[3 * n * lane_count])) << round;
        }
      }
    }
  }
  ASSERT_TRUE(simulation.restore(good));
  EXPECT_GT(tried, 100);
  EXPECT_GT(refused, tried * 8 / 10) << "of " << tried;
}

/// A job system that throws at its n-th call from now.
struct Throwing {
  int calls_left = -1;
  Jobs jobs() {
    return {this,
            [](void* user, std::size_t count, Jobs::Body body, void* context) {
              auto& self = *static_cast<Throwing*>(user);
              if (self.calls_left == 0) throw std::runtime_error("no thread");
              if (self.calls_left > 0) --self.calls_left;
              body(context, 0, count);
            },
            2};
  }
};

TEST(Jobs, AfterAnExceptionTheSimulationCanBeRestored) {
  Throwing host;
  Simulation simulation(sharing({.jobs = host.jobs()})), twin(sharing());
  people(simulation);
  people(twin);
  const Bytes bytes = saved(simulation);
  for (int i = 0; i < 10; ++i) twin.tick();
  bool whole = false;
  for (int calls = 0; calls < 100 && !whole; ++calls) {
    host.calls_left = calls;
    bool threw = false;
    try {
      const auto restored = simulation.restore(bytes);
      ASSERT_TRUE(restored) << restored.error().message;
      for (int i = 0; i < 10; ++i) simulation.tick();
    } catch (const std::runtime_error&) {
      threw = true;
    }
    host.calls_left = -1;
    whole = !threw;
    ASSERT_TRUE(simulation.restore(bytes));
    for (int i = 0; i < 10; ++i) simulation.tick();
    ASSERT_EQ(simulation.state_hash(), twin.state_hash()) << calls;
  }
  EXPECT_TRUE(whole);
}

/// For any pose of a posed person muscles stay finite, and other people are unaffected.
TEST(Posed, WildPosesAreRefusedOrFinite) {
  MOBIL_SLOW();
  Simulation simulation(sharing());
  const auto wild = *simulation.spawn_posed({.height_m = 1.8F, .mass_kg = 80});
  const auto calm = *simulation.spawn_posed({.height_m = 1.8F, .mass_kg = 80});
  Simulation alone(sharing());
  const auto twin = *alone.spawn_posed({.height_m = 1.8F, .mass_kg = 80});
  for (const Method method :
       {Method::modal, Method::explicit_central, Method::implicit_central, Method::newmark, Method::statics}) {
    LegMuscles choice;
    choice.method = method;
    choice.inertia = true;
    for (const auto& [where, who] : {std::pair{&simulation, wild}, {&simulation, calm}, {&alone, twin}}) {
      if (!where->muscles(who).empty()) {
        ASSERT_TRUE(where->set_muscles(who, std::nullopt));
      }
      ASSERT_TRUE(where->set_muscles(who, choice));
    }
    const Pose<float> usual = *simulation.get<Pose>(wild);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(-1, 1);
    int taken = 0;
    for (int tick = 0; tick < 60; ++tick) {
      Pose<float> pose = usual;
      const std::size_t segment = random() % segment_count;
      const float far = std::pow(10.0F, 6.5F * std::fabs(uniform(random)));
      switch (tick % 4) {
        case 0:
          pose.position_m[segment] = {far * uniform(random), far * uniform(random), far * uniform(random)};
          break;
        case 1:
          for (auto& p : pose.position_m) p = {far * uniform(random), far, far * uniform(random)};
          break;
        case 2:
          pose.rotation[segment] = {uniform(random) < 0 ? std::nanf("") : 1e30F, 0, 0, 1};
          break;
        default:
          break;
      }
      taken += simulation.set_pose(wild, pose) ? 1 : 0;
      simulation.tick();
      alone.tick();
    }
    EXPECT_GT(taken, 25);
    ASSERT_TRUE(simulation.set_pose(wild, usual));
    for (int tick = 0; tick < 480; ++tick) {  // vibrations fall by e^-4 a second
      simulation.tick();
      alone.tick();
    }
    const auto shown = [](const Simulation& of, Entity who) {
      std::vector<float> all;
      for (const MuscleRef& own : of.muscles(who)) {
        const NodalView view = nodal_displacement(of.world(), own.entity[Side::left]);
        for (std::size_t n = 0; view.first != nullptr && n < view.nodes; ++n) {
          all.push_back(view.first[(3 * n + 1) * lane_count]);
        }
      }
      return all;
    };
    for (const float y : shown(simulation, wild)) {
      EXPECT_TRUE(std::isfinite(y)) << static_cast<int>(method);
      // The trapezoidal rule hardly damps vibrations faster than the ticks.
      if (method == Method::newmark) continue;
      EXPECT_LT(std::fabs(y), 0.5F) << static_cast<int>(method);
    }
    EXPECT_EQ(shown(simulation, calm), shown(alone, twin)) << static_cast<int>(method);
    ASSERT_TRUE(simulation.set_pose(wild, usual));
  }
}

}  // namespace
}  // namespace mobil
