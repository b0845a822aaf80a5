// Long calls ended by the host, through the C interface and in C++, compared with uninterrupted ones.

#include <atomic>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include <mobil/engine/interrupt.h>
#include <mobil/engine/world.h>
#include <mobil/lod.h>
#include <mobil/muscle_library.h>
#include "tests/c/c_fixture.h"

namespace mobil::c_interrupt_test {
namespace {
using namespace c_test;

/// Stops a call at the check after `left` others, in C++ at every check.
struct Countdown {
  std::size_t left = 0, asked = 0;

  static int stop(void* user) {
    auto& self = *static_cast<Countdown*>(user);
    ++self.asked;
    return self.left == 0 ? 1 : (--self.left, 0);
  }
  Interrupt each_check() { return {this, stop, 0}; }
};

TEST(CInterrupt, TicksBeforeTheInterruptionStayAndLaterOnesContinueThem) {
  const Sim interrupted, plain;
  const auto ids = spawn(interrupted, 20), others = spawn(plain, 20);
  Countdown countdown{.left = 1};
  ASSERT_EQ(mobil_set_interrupt(interrupted, Countdown::stop, &countdown), MOBIL_OK);
  ASSERT_EQ(mobil_tick(interrupted, 100'000'000), MOBIL_INTERRUPTED);
  EXPECT_NE(interrupted.message().find("mobil_set_interrupt"), std::string::npos) << interrupted.message();
  EXPECT_EQ(countdown.asked, 2U);
  const auto ticks = static_cast<unsigned int>(std::lround(mobil_time_s(interrupted) / mobil_tick_s(interrupted)));
  ASSERT_GT(ticks, 0U);
  ASSERT_EQ(mobil_tick(plain, ticks), MOBIL_OK);
  EXPECT_EQ(interrupted.hash(), plain.hash());
  ASSERT_EQ(mobil_set_interrupt(interrupted, nullptr, nullptr), MOBIL_OK);
  for (const Sim* sim : {&interrupted, &plain}) ASSERT_EQ(mobil_tick(*sim, 90), MOBIL_OK);
  EXPECT_EQ(interrupted.hash(), plain.hash());
}

TEST(CInterrupt, ShortCallsDoNotAsk) {
  const Sim sim;
  const auto ids = spawn(sim, 3);
  Countdown countdown;
  ASSERT_EQ(mobil_set_interrupt(sim, Countdown::stop, &countdown), MOBIL_OK);
  for (int i = 0; i < 100; ++i) ASSERT_EQ(mobil_tick(sim, 1), MOBIL_OK);
  EXPECT_EQ(countdown.asked, 0U);
  EXPECT_EQ(mobil_set_interrupt(nullptr, Countdown::stop, &countdown), MOBIL_REFUSED);
}

TEST(CInterrupt, ARepeatedPreparationContinuesWithWhatIsFinished) {
  LegMuscles choice;
  choice.method = Method::modal;
  choice.muscles = MuscleSet(1);
  const auto checks_of = [&](Simulation& simulation, std::size_t most) {
    Countdown countdown{.left = most};
    const InterruptScope scope(countdown.each_check());
    try {
      EXPECT_TRUE(simulation.muscle_library().prepare(choice));
    } catch (const Interrupted&) {
    }
    return countdown.asked;
  };
  Simulation whole, ended;
  const std::size_t all = checks_of(whole, ~std::size_t{0});
  ASSERT_EQ(checks_of(ended, all / 2), all / 2 + 1);
  const std::size_t rest = checks_of(ended, ~std::size_t{0});
  EXPECT_LT(rest, 2 * all / 3);
  EXPECT_LT(checks_of(ended, ~std::size_t{0}), all / 10);
  for (Simulation* const simulation : {&whole, &ended}) {
    const auto walker = simulation->spawn(BodyRequest{}, GaitRequest{});
    ASSERT_TRUE(walker && simulation->set_muscles(*walker, choice));
    simulation->tick(5);
  }
  EXPECT_EQ(whole.state_hash(), ended.state_hash());
}

/// Uses the simulation within a call.
struct Reentry {
  mobil_sim* sim;
  int tick = MOBIL_OK, hash = MOBIL_OK;

  void use() {
    unsigned int half[2];
    tick = mobil_tick(sim, 1);
    hash = mobil_hash(sim, half);
  }
};

TEST(CInterrupt, ACallWithinACallIsBusyAndChangesNothing) {
  const Sim sim, plain;
  const auto ids = spawn(sim, 3), others = spawn(plain, 3);
  Reentry reentry{sim};
  const auto ask = [](void* user) {
    static_cast<Reentry*>(user)->use();
    return 1;
  };
  ASSERT_EQ(mobil_set_interrupt(sim, ask, &reentry), MOBIL_OK);
  ASSERT_EQ(mobil_tick(sim, 100'000'000), MOBIL_INTERRUPTED);
  EXPECT_EQ(reentry.tick, MOBIL_BUSY);
  EXPECT_EQ(reentry.hash, MOBIL_BUSY);
  const auto ticks = static_cast<unsigned int>(std::lround(mobil_time_s(sim) / mobil_tick_s(sim)));
  ASSERT_EQ(mobil_tick(plain, ticks), MOBIL_OK);
  EXPECT_EQ(sim.hash(), plain.hash());
  const auto heights = [](void* user, const float*, const mobil_id*, std::size_t, float*) {
    static_cast<Reentry*>(user)->use();
    return 0;
  };
  reentry.tick = MOBIL_OK;
  ASSERT_EQ(mobil_set_interrupt(sim, nullptr, nullptr), MOBIL_OK);
  ASSERT_EQ(mobil_terrain_set_heights(sim, heights, &reentry), MOBIL_OK);
  ASSERT_EQ(mobil_terrain_manage(sim, ids.data(), ids.size(), 1), MOBIL_OK);
  ASSERT_EQ(mobil_tick(sim, 1), MOBIL_OK);
  EXPECT_EQ(reentry.tick, MOBIL_BUSY);
}

/// A world, and a call of it that can be ended.
struct Scene {
  Simulation simulation;
  std::vector<Entity> people;
};
struct EndedCall {
  const char* name;
  std::function<void(Scene&)> before, call;
};

std::vector<EndedCall> ended_calls() {
  LegMuscles modal, statics;
  modal.method = Method::modal;
  modal.muscles = statics.muscles = MuscleSet(1);
  statics.method = Method::statics;
  const auto requests = [](std::size_t count, const std::optional<LegMuscles>& muscles) {
    std::vector<SpawnRequest> people(count);
    for (std::size_t i = 0; i < count; ++i) {
      people[i].body.height_m = 1.6F + 0.01F * static_cast<float>(i % 30);
      people[i].x_m = static_cast<float>(i);
      people[i].gait.style.pelvis_tilt_deg = static_cast<float>(i % 12);
      people[i].muscles = muscles;
    }
    return people;
  };
  const auto spawn = [requests](Scene& s, std::size_t count, const std::optional<LegMuscles>& muscles) {
    std::vector<Entity> made(count);
    ASSERT_TRUE(s.simulation.spawn(requests(count, muscles), made));
    s.people.insert(s.people.end(), made.begin(), made.end());
  };
  const auto plain = [spawn](Scene& s) { spawn(s, 20, std::nullopt); };
  const auto asleep = [spawn, modal](Scene& s) {
    spawn(s, 20, modal);
    s.simulation.tick(60);
    ASSERT_TRUE(s.simulation.set_state(s.people, PersonState::asleep));
    s.simulation.tick(30);
  };
  const auto saved = std::make_shared<std::vector<std::byte>>();
  return {
      {"spawn", plain, [spawn, modal](Scene& s) { spawn(s, 20, modal); }},
      {"set_muscles", plain, [statics](Scene& s) { ASSERT_TRUE(s.simulation.set_muscles(s.people, statics)); }},
      {"set_state", asleep, [](Scene& s) { ASSERT_TRUE(s.simulation.set_state(s.people, PersonState::full, 0.001F)); }},
      {"enable", asleep, [](Scene& s) { ASSERT_TRUE(s.simulation.enable(s.people, Feature::forces)); }},
      {"prepare", plain, [modal](Scene& s) { ASSERT_TRUE(s.simulation.muscle_library().prepare(modal)); }},
      {"manage", plain, [](Scene& s) { ASSERT_TRUE(s.simulation.lod().manage(s.people)); }},
      {"change_gait", plain,
       [](Scene& s) {
         GaitStyle style;
         style.double_support_scale = 0.6F;
         std::vector<WalkChange> changes(s.people.size());
         for (std::size_t i = 0; i < changes.size(); ++i) {
           changes[i].person = s.people[i];
           changes[i].gait.emplace().style = style;
         }
         ASSERT_TRUE(s.simulation.change_gait(changes));
       }},
      {"restore",
       [spawn, modal, saved](Scene& s) {
         Scene other;
         spawn(other, 20, modal);
         saved->resize(other.simulation.snapshot_bytes());
         ASSERT_TRUE(other.simulation.save(*saved));
         spawn(s, 3, std::nullopt);
       },
       [saved](Scene& s) { ASSERT_TRUE(s.simulation.restore(*saved)); }},
  };
}

TEST(CInterrupt, ACallEndedAtAnyCheckChangesNobodyAndCanBeRepeated) {
  for (const EndedCall& one : ended_calls()) {
    Scene uninterrupted;
    one.before(uninterrupted);
    one.call(uninterrupted);
    const std::uint64_t wanted = uninterrupted.simulation.state_hash();
    std::size_t ended = 0;
    Scene scene;
    one.before(scene);
    const std::uint64_t before = scene.simulation.state_hash();
    for (std::size_t at = 0, done = 0; done == 0; at = 2 * at + 1) {
      Countdown countdown{.left = at};
      try {
        const InterruptScope scope(countdown.each_check());
        one.call(scene);
        done = 1;
      } catch (const Interrupted&) {
        ++ended;
        ASSERT_EQ(scene.simulation.state_hash(), before) << one.name << " ended at check " << at;
      }
    }
    EXPECT_GT(ended, 1U) << one.name;
    EXPECT_EQ(scene.simulation.state_hash(), wanted) << one.name;
    scene.simulation.tick(5);
    uninterrupted.simulation.tick(5);
    EXPECT_EQ(scene.simulation.state_hash(), uninterrupted.simulation.state_hash()) << one.name;
  }
}

TEST(CInterrupt, MusclesChangeAndGoPersonByPerson) {
  LegMuscles statics, finer;
  statics.muscles = finer.muscles = MuscleSet(1);
  statics.method = Method::statics;
  finer.method = Method::newmark;
  for (const bool gone : {false, true}) {
    Simulation simulation;
    std::vector<Entity> people;
    for (int i = 0; i < 20; ++i) people.push_back(*simulation.spawn(BodyRequest{}, GaitRequest{}));
    ASSERT_TRUE(simulation.set_muscles(people, finer));  // makes the shared data
    ASSERT_TRUE(simulation.set_muscles(people, statics));
    const std::optional<LegMuscles> to = gone ? std::nullopt : std::optional(finer);
    std::size_t ended = 0, partly = 0;
    for (std::size_t at = 0, done = 0; done == 0; ++at) {
      Countdown countdown{.left = at};
      try {
        const InterruptScope scope(countdown.each_check());
        ASSERT_TRUE(simulation.set_muscles(people, to));
        done = 1;
      } catch (const Interrupted&) {
        ++ended;
        std::size_t changed = 0;
        for (const Entity person : people)
          changed +=
              gone ? simulation.muscles(person).empty() : simulation.method(person, Muscle{}).method == Method::newmark;
        partly += changed > 0 && changed < people.size() ? 1 : 0;
        simulation.tick(1);
      }
    }
    EXPECT_GT(ended, 5U);
    EXPECT_GT(partly, 0U);
    for (const Entity person : people) EXPECT_EQ(simulation.muscles(person).empty(), gone);
  }
}

TEST(CInterrupt, ATickThatMakesBasesIsNotCut) {
  Scene scene, plain;
  for (Scene* const s : {&scene, &plain}) {
    for (int i = 0; i < 5; ++i)
      s->people.push_back(*s->simulation.spawn({.height_m = 1.6F + 0.05F * static_cast<float>(i)}, GaitRequest{}));
    LodScene needs;
    needs.tolerance_m = 0.0005F;
    ASSERT_TRUE(s->simulation.lod().set_scene(needs));
    ASSERT_TRUE(s->simulation.lod().manage(s->people));
  }
  for (std::uint32_t ticks = 1; ticks <= 8; ++ticks) {
    Countdown countdown{.left = 1};
    {
      const InterruptScope scope(countdown.each_check());
      EXPECT_THROW(scene.simulation.tick(1000), Interrupted);
    }
    EXPECT_EQ(scene.simulation.ticks(), ticks);
    plain.simulation.tick();
    EXPECT_EQ(scene.simulation.state_hash(), plain.simulation.state_hash());
  }
}

TEST(CInterrupt, AFrameKeepsItsTimeForTheNextOne) {
  Scene scene, plain;
  for (Scene* s : {&scene, &plain}) ASSERT_TRUE(s->simulation.spawn(BodyRequest{}, GaitRequest{}));
  Countdown countdown{.left = 5};
  {
    const InterruptScope scope(countdown.each_check());
    EXPECT_THROW(scene.simulation.advance(0.25), Interrupted);
  }
  EXPECT_EQ(scene.simulation.ticks(), 5U);
  EXPECT_EQ(scene.simulation.advance(0).count, 10U);
  EXPECT_EQ(plain.simulation.advance(0.25).count, 15U);
  EXPECT_EQ(scene.simulation.state_hash(), plain.simulation.state_hash());
}

TEST(CInterrupt, JobsOfOtherThreadsEndAndOnlyTheCallingThreadAsks) {
  const Threads threads(2);
  const Jobs jobs = threads.jobs();
  struct Asked {
    std::thread::id thread = std::this_thread::get_id();
    bool elsewhere = false;
  } asked;
  std::atomic<std::size_t> ran = 0;
  const InterruptScope scope({&asked,
                              [](void* user) {
                                auto& self = *static_cast<Asked*>(user);
                                self.elsewhere = self.elsewhere || std::this_thread::get_id() != self.thread;
                                return 1;
                              },
                              0});
  EXPECT_THROW(in_parallel(jobs, 100'000,
                           [&](std::size_t begin, std::size_t end) {
                             for (std::size_t i = begin; i < end; ++i) {
                               check_interrupt();
                               ++ran;
                               std::this_thread::yield();
                             }
                           }),
               Interrupted);
  EXPECT_FALSE(asked.elsewhere);
  EXPECT_LT(ran, 100'000U);
  const WholeScope whole;
  EXPECT_NO_THROW(check_interrupt());
}

}  // namespace
}  // namespace mobil::c_interrupt_test
