// Bases made in the background: choices depend on ticks, not on when the work is done.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <thread>
#include <utility>
#include <vector>

#include <mobil/lod.h>
#include <mobil/systems/snapshot/restore_limits.h>
#include "tests/interfaces.h"
#include "tests/labels.h"
#include "tests/simulation/leg_muscles.h"

MOBIL_TEST_LABELS("threads");

namespace mobil::basis_orders_test {

constexpr std::uint32_t making_ticks = 12;

/// A job queue that waits until a test runs it.
struct Queue {
  std::vector<std::pair<void (*)(void*), void*>> waiting;
  std::size_t asked = 0;
  std::vector<std::jthread> threads;
  bool at_once_on_threads = false;

  Background background() {
    return {this, [](void* user, void (*work)(void*), void* argument) {
              auto& queue = *static_cast<Queue*>(user);
              ++queue.asked;
              if (queue.at_once_on_threads) {
                queue.threads.emplace_back([=] { work(argument); });
              } else {
                queue.waiting.emplace_back(work, argument);
              }
            }};
  }
  void run() {
    for (const auto& [work, argument] : std::exchange(waiting, {})) work(argument);
  }
};

/// Two people with one muscle, at different tolerances; the coarse levels use small meshes.
struct Scene {
  Simulation simulation;
  Lod lod;
  std::vector<Entity> people;

  explicit Scene(const Background& background)
      : lod(lod_of(simulation,
                   {.stagger = 1, .machine_factor = 1, .background = background, .making_ticks = making_ticks})) {
    LodScene needs{.tolerance_m = 0.006F};
    needs.muscles = MuscleSet(1);
    EXPECT_TRUE(lod.set_scene(needs));
    for (int i = 0; i < 2; ++i) {
      people.push_back(*simulation.spawn(sample_person(i).body));
      EXPECT_TRUE(lod.manage(people.back()));
    }
  }
  std::size_t level(std::size_t i) const { return lod.why(people[i], Muscle::hamstrings)->level; }
};

/// Returns the state hash after each tick. The queue is run in ticks for which `when` is true.
std::vector<std::uint64_t> hashes(Queue& queue, const std::function<bool(int tick)>& when) {
  Scene scene(queue.background());
  std::vector<std::uint64_t> all;
  for (int tick = 0; tick < 30; ++tick) {
    scene.simulation.tick();
    if (when(tick)) queue.run();
    all.push_back(scene.simulation.state_hash());
  }
  queue.run();
  EXPECT_GT(scene.level(0), 0U) << "nothing was taken up in the end";
  return all;
}

TEST(BasisOrders, ChoicesFollowFromTicks) {
  Queue soon, late, never, threads;
  threads.at_once_on_threads = true;
  const auto first = hashes(soon, [](int) { return true; });
  EXPECT_EQ(hashes(late, [](int tick) { return tick == 11; }), first);
  EXPECT_EQ(hashes(never, [](int) { return false; }), first);
  EXPECT_EQ(hashes(threads, [](int) { return false; }), first);
  EXPECT_GT(soon.asked, 0U);
  EXPECT_EQ(soon.asked, never.asked);
}

TEST(BasisOrders, CoarserBasisServesUntilTheOrderIsDue) {
  Queue queue;
  Scene scene(queue.background());
  for (std::uint32_t tick = 0; tick < making_ticks; ++tick) {
    scene.simulation.tick();
    EXPECT_EQ(scene.level(0), 0U);
    EXPECT_EQ(scene.lod.why(scene.people[0], Muscle::hamstrings)->reason, Reason::switch_pending);
  }
  scene.simulation.tick();
  EXPECT_GT(scene.level(0), 0U);
  queue.run();
}

TEST(BasisOrders, PreparedBasesDoNotWait) {
  Queue queue;
  Scene scene(queue.background());
  ASSERT_TRUE(scene.lod.prepare());
  scene.simulation.tick();
  EXPECT_GT(scene.level(0), 0U);
  EXPECT_EQ(queue.asked, 0U);
}

/// Another program that restores both continues with the same bits. Missing bases are made there.
TEST(BasisOrders, ContinueInAnotherProgram) {
  Queue queue, others;
  Scene scene(queue.background()), other(others.background());
  for (int tick = 0; tick < 6; ++tick) scene.simulation.tick();
  std::vector<std::byte> bytes(scene.simulation.snapshot_bytes());
  ASSERT_TRUE(scene.simulation.save(bytes));
  ASSERT_TRUE(other.simulation.restore(bytes, RestoreLimits::none()));
  for (int tick = 0; tick < 12; ++tick) {
    for (Scene* const one : {&scene, &other}) one->simulation.tick();
    EXPECT_EQ(other.simulation.state_hash(), scene.simulation.state_hash()) << tick;
  }
  EXPECT_GT(scene.level(0), 0U);
  queue.run();
}

}  // namespace mobil::basis_orders_test
