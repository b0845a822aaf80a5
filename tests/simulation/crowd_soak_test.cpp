// A crowd with constant spawns and despawns: an hour with MOBIL_LONG in the environment (tests/run --long), else a
// minute. Memory does not grow, positions do not drift, all values stay finite, and the same seed gives the same
// result.
#include <gtest/gtest.h>

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <vector>

#include <mobil/components/step_plan.h>
#include <mobil/engine/world.h>
#include <mobil/systems/surfaces/nodal_view.h>
#include "tests/engine/engine_counting_memory.h"
#include "tests/engine/wilful_pool.h"
#include "tests/labels.h"
#include "tests/simulation/crowd_play.h"

MOBIL_TEST_LABELS("slow");

namespace mobil::crowd_soak_test {
using play::mixed;

constexpr int a_minute = 3600;  // ticks
constexpr std::size_t crowd_size = 200, stayers = 8, kinds = 64;

/// Returns the bytes that the process has allocated on the heap.
std::size_t heap_bytes() {
#ifdef __GLIBC__
  const auto info = mallinfo2();
  return info.uordblks + info.hblkhd;
#else
  return 0;
#endif
}

/// Returns muscles; few use the costly methods.
LegMuscles muscles_of(std::uint64_t kind) {
  if (kind % 16 == 3) return play::choice_of(kind * 7);
  LegMuscles choice{.method = Method::modal, .modal = play::modal(12, true, kind % 4 == 0)};
  choice.muscles = 0;
  choice.muscles.set(static_cast<std::size_t>(Muscle::hamstrings));
  choice.muscles.set(static_cast<std::size_t>(Muscle::tibialis_anterior));
  return choice;
}

/// Eight people who always walk straight on, and many who are spawned, turn, change speed, and are despawned.
class Soak {
 public:
  explicit Soak(const Jobs& jobs) : simulation_({.jobs = jobs, .memory = &memory_}) {
    for (std::size_t i = 0; i < crowd_size; ++i) people_.push_back(come(i));
  }

  void tick(int now) {
    const std::uint64_t draw = mixed(1, 3, static_cast<std::uint64_t>(now));
    const std::size_t who = stayers + draw % (crowd_size - stayers);
    if (draw / 1000 % 8 == 0) {
      gone_ = people_[who];
      EXPECT_EQ(simulation_.despawn(gone_), Status::ok);
      people_[who] = come(crowd_size + static_cast<std::size_t>(now));
    }
    const std::size_t other = stayers + draw / 8000 % (crowd_size - stayers);
    const float part = static_cast<float>(draw / 8000000 % 1000) * 1e-3F;
    if (draw / 1000 % 4 == 1) {
      // back to the origin, so that no person leaves the range of single precision
      const auto state = *simulation_.get<GaitState>(people_[other]);
      const bool far = std::hypot(state.line_x_m, state.line_z_m) > 50;
      EXPECT_TRUE(
          simulation_.turn_to(people_[other], far ? std::atan2(-state.line_x_m, -state.line_z_m) : 6 * (part - 0.5F)));
    } else if (draw / 1000 % 4 == 2) {
      EXPECT_TRUE(simulation_.change_gait(people_[other], {.speed_m_s = part < 0.1F ? 0.0F : 0.7F + part}));
    } else if (draw / 1000 % 16 == 3) {
      EXPECT_TRUE(simulation_.set_method(
          people_[other], Muscle::hamstrings,
          play::every_method()[draw / 16000 % 90 < 9 ? draw / 16000 % 9 : 4 + draw / 16000 % 5]));
    }
    simulation_.tick();
  }

  std::uint64_t hash() const {
    std::uint64_t sum = 0;
    for (const Entity person : people_) sum = fnv(sum, 1) ^ hash_person(simulation_, person);
    return sum;
  }

  /// Checks that all people exist, despawned ones do not, and positions are plausible.
  void check() {
    EXPECT_EQ(simulation_.get<Pose>(gone_).error(), Status::stale_entity);
    std::size_t expected = 0;
    for (const Entity person : people_) {
      const auto pose = simulation_.get<Pose>(person);
      const auto state = simulation_.get<GaitState>(person);
      const auto feet = simulation_.get<Feet>(person);
      ASSERT_TRUE(pose && state && feet);
      ++expected;
      for (const auto& at : pose->position_m) ASSERT_TRUE(std::isfinite(at.x + at.y + at.z));
      for (const auto& q : pose->rotation)
        ASSERT_LT(std::abs(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w - 1), 1e-4F);
      const auto& heel = feet->heel_m[state->stance_side];
      worst_foot_m_ =
          std::max(worst_foot_m_, static_cast<double>(std::hypot(heel.x - state->line_x_m, heel.z - state->line_z_m)));
      lowest_m_ = std::min(lowest_m_, static_cast<double>(std::min(feet->heel_m[0].y, feet->heel_m[1].y)));
      for (std::size_t m = 0; m < usual_muscle_count; ++m) {
        for (const Side side : {Side::right, Side::left}) {
          const Entity muscle = simulation_.muscle(person, static_cast<Muscle>(m), side);
          if (!simulation_.world().alive(muscle)) continue;
          ++expected;
          EXPECT_EQ(simulation_.get<MuscleOwner>(muscle)->index, person.index);
          const auto line = *simulation_.get<LineOfAction>(muscle);
          ASSERT_TRUE(line.length_m > 0.05F && line.length_m < 1);
          const NodalView nodes = nodal_displacement(simulation_.world(), muscle);
          for (std::size_t i = 0; i < 3 * std::size_t{nodes.nodes}; ++i)
            ASSERT_LT(std::abs(nodes.first[i * lane_count]), 0.5F);
        }
      }
    }
    EXPECT_EQ(rows(simulation_.world()), expected);
    EXPECT_LT(worst_foot_m_, 0.7);  // a foothold and half a step's width
    EXPECT_GT(lowest_m_, -0.03);
  }

  /// Returns the deviation of straight walkers from their steady steps, relative to the distance.
  double drift() const {
    double most = 0;
    for (std::size_t i = 0; i < stayers; ++i) {
      const auto state = *simulation_.get<GaitState>(people_[i]);
      const auto plan = *simulation_.get<StepPlan>(people_[i]);
      EXPECT_EQ(plan.settled, 1U);
      const double steps = state.steps, way = static_cast<double>(state.line_z_m);
      const double step_m = static_cast<double>(plan.step_length_m), step_s = static_cast<double>(plan.duration_s);
      most = std::max({most, std::abs(way / (steps * step_m) - 1),
                       std::abs((steps * step_s + static_cast<double>(state.time_s)) / simulation_.time_s() - 1)});
    }
    return most;
  }

  std::size_t bytes() const { return memory_.lent_bytes(); }
  double worst_foot_m() const { return worst_foot_m_; }

 private:
  Entity come(std::size_t number) {
    const std::uint64_t kind = number % kinds;
    const SamplePerson p = sample_person(static_cast<int>(kind));
    const auto person = simulation_.spawn(p.body, p.gait);
    EXPECT_TRUE(person);
    EXPECT_TRUE(simulation_.set_muscles(*person, muscles_of(kind)));
    return *person;
  }

  CountingMemory memory_;
  Simulation simulation_;
  std::vector<Entity> people_;
  Entity gone_{};
  double worst_foot_m_ = 0, lowest_m_ = 0;
};

TEST(CrowdSoak, NoGrowthNoDriftAndReproducible) {
  const int minutes = std::getenv("MOBIL_LONG") != nullptr ? 60 : 1;
  const int parts = std::max(10, minutes), ticks = minutes * a_minute / parts;
  std::vector<std::uint64_t> hashes;
  std::vector<std::size_t> world, heap;
  {
    Soak soak({});
    for (int part = 0; part < parts; ++part) {
      for (int i = 0; i < ticks; ++i) soak.tick(part * ticks + i);
      soak.check();
      if (testing::Test::HasFatalFailure()) return;
      hashes.push_back(soak.hash());
      world.push_back(soak.bytes());
      heap.push_back(heap_bytes());
    }
    const double drift = soak.drift();
    EXPECT_LT(drift, minutes > 1 ? 1e-3 : 2e-2);  // in a minute the first steps still matter
    if (minutes > 1) {                            // no growth in the last third
      const auto most = [&](const std::vector<std::size_t>& of, int from, int to) {
        return static_cast<double>(*std::max_element(of.begin() + from, of.begin() + to));
      };
      EXPECT_LT(most(world, 2 * parts / 3, parts), 1.05 * most(world, parts / 3, 2 * parts / 3));
      EXPECT_LT(most(heap, 2 * parts / 3, parts), 1.05 * most(heap, parts / 3, 2 * parts / 3));
    }
    std::cout << minutes << " min: world " << world[static_cast<std::size_t>(parts / 3)] << " B after a third, "
              << world.back() << " at the end; heap " << heap[static_cast<std::size_t>(parts / 3)] << " and "
              << heap.back() << " B; drift " << drift << ", stance foot within " << soak.worst_foot_m() << " m\n";
  }
  Soak again(backwards());
  const int until = std::max(2, parts / 6);  // repeats the beginning
  for (int part = 0; part < until; ++part) {
    for (int i = 0; i < ticks; ++i) again.tick(part * ticks + i);
    EXPECT_EQ(again.hash(), hashes[static_cast<std::size_t>(part)]) << "part " << part;
  }
}

}  // namespace mobil::crowd_soak_test
