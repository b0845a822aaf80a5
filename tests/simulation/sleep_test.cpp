// Sleepers: who has slept is, to the bit, where those are who never did; muscles are within what is promised.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <random>
#include <vector>

#include "assets/body/anthropometry.h"
#include "demo/crowd/crowd_people.h"
#include "engine/rows.h"
#include "systems/gait/asleep.h"
#include "systems/gait/gait.h"
#include "systems/simulation.h"

namespace mobil {
namespace {

/// The same people in two simulations: in one of them some sleep.
struct Twins {
  explicit Twins(std::size_t count, int threads = 1, bool muscles = false)
      : dozing({.threads = threads}), waking({.threads = threads}) {
    std::vector<SpawnRequest> requests;
    for (std::uint64_t number = 0; requests.size() < count; ++number) {
      const CrowdPerson person = crowd_person(7, number, 0);
      const CrowdPlace place = crowd_place(7, number);
      SpawnRequest request{.body = person.body, .gait = person.gait};
      if (number % 3 != 0) request.gait.style = snapped(person.gait.style);
      request.x_m = 400 * place.across;
      request.z_m = 400 * place.along;
      request.heading_rad = place.heading_rad;
      const auto body = make_body(request.body);
      if (!body || !resolve_gait(*body, request.gait)) continue;
      if (muscles) {
        request.muscles = LegMuscles{};
        request.muscles->method = Method::reduced;
        request.muscles->reduced.control_points = false;
      }
      requests.push_back(request);
    }
    for (Simulation* const one : {&dozing, &waking}) {
      auto& people = one == &dozing ? dozers : wakers;
      people.resize(count);
      EXPECT_TRUE(one->spawn(requests, people));
    }
    changes.resize(count);
  }
  void tick() {
    dozing.tick();
    waking.tick();
  }
  void tick(int count) {
    for (int i = 0; i < count; ++i) tick();
  }
  /// What the crowd's people do next.
  void change(std::size_t i) {
    const CrowdChange change = crowd_change(7, i, changes[i]++, changes[i] % 5 == 4);
    if (change.speed_m_s >= 0) {
      for (Simulation* const one : {&dozing, &waking})
        one->change_gait(one == &dozing ? dozers[i] : wakers[i], {.speed_m_s = change.speed_m_s});
    }
    if (change.turn_rad != 0) {
      const float heading = waking.get<Gait>(wakers[i])->heading_rad + change.turn_rad;
      EXPECT_TRUE(dozing.turn_to(dozers[i], heading));
      EXPECT_TRUE(waking.turn_to(wakers[i], heading));
    }
  }
  template <template <class> class C>
  bool same(std::size_t i) const {
    const auto a = dozing.get<C>(dozers[i]);
    const auto b = waking.get<C>(wakers[i]);
    return a && b && std::memcmp(&*a, &*b, sizeof(*a)) == 0;
  }
  bool all_same(std::size_t i) const {
    return same<Gait>(i) && same<GaitState>(i) && same<StepPlan>(i) && same<Pose>(i) && same<JointAngles>(i) &&
           same<Feet>(i) && same<CentreOfMass>(i) && same<BodySize>(i) && same<Physique>(i);
  }
  std::size_t asleep() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(dozers, [&](Entity one) { return dozing.is_asleep(one); }));
  }

  Simulation dozing, waking;
  std::vector<Entity> dozers, wakers;
  std::vector<std::uint32_t> changes;
};

TEST(Sleep, WhoHasSleptIsWhereWhoNeverDidIs) {
  Twins twins(160);
  std::mt19937 random(5);
  twins.tick(50);
  std::size_t slept = 0, woken = 0, most = 0, read = 0;
  for (int second = 0; second < 100; ++second) {
    std::vector<Entity> tired, rested;
    for (std::size_t i = 0; i < twins.dozers.size(); ++i) {
      const auto draw = random() % 100;
      if (draw < 7) twins.change(i);
      if (twins.dozing.is_asleep(twins.dozers[i])) {
        if (draw >= 90) rested.push_back(twins.dozers[i]);
      } else if (draw >= 30) {
        tired.push_back(twins.dozers[i]);
      }
    }
    const auto sleeping = twins.dozing.sleep(tired);
    ASSERT_TRUE(sleeping) << sleeping.error().message;
    slept += *sleeping;
    ASSERT_TRUE(twins.dozing.wake(rested));
    woken += rested.size();
    most = std::max(most, twins.asleep());
    twins.tick(20 + static_cast<int>(random() % 30));
    for (std::size_t i = second % 7; i < twins.dozers.size(); i += 7) {
      ASSERT_TRUE(twins.all_same(i)) << "person " << i << " in second " << second << ", "
                                     << (twins.dozing.is_asleep(twins.dozers[i]) ? "asleep" : "awake");
      read += twins.dozing.is_asleep(twins.dozers[i]) ? 1 : 0;
    }
  }
  ASSERT_TRUE(twins.dozing.wake(twins.dozers));
  EXPECT_EQ(twins.asleep(), 0U);
  EXPECT_EQ(twins.dozing.state_hash(), twins.waking.state_hash());
  EXPECT_GT(slept, 1000U);
  EXPECT_GT(woken, 500U);
  EXPECT_GT(most, 120U);
  EXPECT_GT(read, 1000U);
}

}  // namespace
}  // namespace mobil
