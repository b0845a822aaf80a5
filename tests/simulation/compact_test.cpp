// Compact people: walks are those of people who never were, to the bit; muscles go on within what is promised.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <mobil/components/compact.h>
#include <mobil/components/sleep.h>
#include <mobil/engine/world.h>
#include <mobil/forces.h>
#include <mobil/host_parts.h>
#include <mobil/pose_writer.h>
#include <mobil/simulation.h>
#include <mobil/systems/muscles/human.h>
#include <mobil/systems/surfaces/nodal_view.h>
#include "tests/labels.h"
#include "tests/simulation/simulation_hash.h"

MOBIL_TEST_LABELS("threads");

namespace mobil {
namespace {

LegMuscles unseen(std::uint32_t vectors) {
  LegMuscles choice;
  choice.method = Method::reduced;
  choice.reduced = {.vectors = vectors, .cells = {2, 2, 8}, .control_points = false, .reported = false};
  return choice;
}

/// The same people in two simulations: in one of them some are compact.
struct Pair {
  explicit Pair(int count, const std::optional<LegMuscles>& muscles = std::nullopt, int threads = 1)
      : compact(sharing({.threads = threads})), whole(sharing({.threads = threads})) {
    for (int i = 0; i < count; ++i) {
      const Person one = person(i);
      for (Simulation* const simulation : {&compact, &whole}) {
        const Entity human = *simulation->spawn(one.body, one.gait);
        if (muscles) {
          EXPECT_TRUE(simulation->set_muscles(human, *muscles));
        }
        (simulation == &compact ? small : large).push_back(human);
      }
    }
  }
  void tick(int count = 1) {
    for (int i = 0; i < count; ++i) compact.tick(), whole.tick();
  }
  void turn(std::size_t i, float heading_rad) {
    EXPECT_TRUE(compact.turn_to(small[i], heading_rad));
    EXPECT_TRUE(whole.turn_to(large[i], heading_rad));
  }
  void hasten(std::size_t i, float speed_m_s) {
    EXPECT_TRUE(compact.change_gait(small[i], {.speed_m_s = speed_m_s}));
    EXPECT_TRUE(whole.change_gait(large[i], {.speed_m_s = speed_m_s}));
  }
  bool all_same(std::size_t i) const { return walk_alike(compact, small[i], whole, large[i]); }
  std::size_t how_many() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(small, [&](Entity e) { return (compact.state(e) == PersonState::compact); }));
  }

  Simulation compact, whole;
  std::vector<Entity> small, large;
};

std::vector<float> state_of(const Simulation& simulation, Entity muscle) {
  std::vector<float> state(*simulation.world().get<ReducedState>(muscle));
  EXPECT_EQ(simulation.world().get_field<ReducedState>(muscle, state), Status::ok);
  return state;
}

TEST(Compact, WhoWasCompactIsWhereWhoNeverWasIs) {
  Pair pair(70);
  std::mt19937 random(3);
  std::size_t most = 0, read = 0;
  for (int second = 0; second < 40; ++second) {
    std::vector<Entity> shrink, grow;
    for (std::size_t i = 0; i < pair.small.size(); ++i) {
      const auto draw = random() % 100;
      if (draw < 10) pair.turn(i, 0.06F * static_cast<float>(draw) * static_cast<float>(second % 7 - 3));
      if (draw >= 10 && draw < 20) pair.hasten(i, draw == 10 ? 0.0F : 0.08F * static_cast<float>(draw));
      if (draw > 50) (draw > 80 ? grow : shrink).push_back(pair.small[i]);
    }
    const auto are = pair.compact.set_state(shrink, PersonState::compact);
    ASSERT_TRUE(are) << are.error().message;
    EXPECT_EQ(*are, shrink.size());
    ASSERT_TRUE(pair.compact.set_state(grow, PersonState::full));
    most = std::max(most, pair.how_many());
    pair.tick(15 + static_cast<int>(random() % 20));
    for (auto i = static_cast<std::size_t>(second % 5); i < pair.small.size(); i += 5) {
      ASSERT_TRUE(pair.all_same(i)) << "person " << i << " in second " << second;
      read += (pair.compact.state(pair.small[i]) == PersonState::compact) ? 1 : 0;
    }
  }
  ASSERT_TRUE(pair.compact.set_state(pair.small, PersonState::full));
  EXPECT_EQ(pair.how_many(), 0U);
  EXPECT_EQ(pair.compact.state_hash(), pair.whole.state_hash());
  EXPECT_GT(most, 40U);
  EXPECT_GT(read, 200U);
}

/// Near the origin: far from it whole people's places, and with them their lines, lose digits that compact ones keep.
TEST(Compact, MusclesGoOnWithinFourMicrometres) {
  MOBIL_SLOW();
  for (const std::uint32_t vectors : {4U, 12U}) {
    Pair pair(40, unseen(vectors));
    pair.tick(20);
    ASSERT_EQ(*pair.compact.set_state(pair.small, PersonState::compact), pair.small.size());
    for (std::size_t i = 0; i < pair.small.size(); i += 3) pair.turn(i, i % 2 == 0 ? 1.2F : -0.7F);
    for (std::size_t i = 1; i < pair.small.size(); i += 3) pair.hasten(i, i % 2 == 0 ? 0.0F : 1.5F);
    pair.tick(120);
    ASSERT_TRUE(pair.compact.set_state(pair.small, PersonState::full));
    MuscleMethod seen = {Method::reduced, unseen(vectors).reduced};
    seen.reduced.control_points = true;
    double worst_end = 0, worst_point = 0, largest = 0;
    for (std::size_t i = 0; i < pair.small.size(); ++i) {
      for (std::size_t m = 0; m < muscle_group_count; ++m) {
        const auto muscle = static_cast<Muscle>(m);
        ASSERT_TRUE(pair.compact.set_method(pair.small[i], muscle, seen));
        ASSERT_TRUE(pair.whole.set_method(pair.large[i], muscle, seen));
        for (const Side side : {Side::right, Side::left}) {
          const Entity a = pair.compact.muscle(pair.small[i], muscle, side);
          const Entity b = pair.whole.muscle(pair.large[i], muscle, side);
          const double end = double{pair.compact.get<EndDrive>(a)->to} - double{pair.whole.get<EndDrive>(b)->to};
          worst_end = std::max(worst_end, std::fabs(end));
          const NodalView one = nodal_displacement(pair.compact.world(), a),
                          other = nodal_displacement(pair.whole.world(), b);
          for (std::size_t k = 0; k < 3 * std::size_t{one.nodes}; ++k) {
            const double u = double{one.first[k * lane_count]}, v = double{other.first[k * lane_count]};
            worst_point = std::max(worst_point, std::fabs(u - v));
            largest = std::max(largest, std::fabs(v));
          }
        }
      }
    }
    EXPECT_LT(worst_end, 4e-6);
    EXPECT_LT(worst_point, 2e-5);
    EXPECT_GT(largest, 0.01);
  }
}

TEST(Compact, HandingOverAndBackChangesNothing) {
  Simulation simulation(sharing());
  std::vector<Entity> people;
  for (int i = 0; i < 19; ++i) {
    people.push_back(*simulation.spawn(person(i).body, person(i).gait));
    ASSERT_TRUE(simulation.set_muscles(people.back(), unseen(6)));
  }
  for (int i = 0; i < 30; ++i) simulation.tick();
  std::vector<std::vector<float>> before;
  const auto states = [&] {
    std::vector<std::vector<float>> all;
    for (const Entity human : people) {
      for (const OwnMuscle& own : simulation.muscles(human))
        for (const Entity muscle : own.entity) {
          all.push_back(state_of(simulation, muscle));
          all.back().push_back(simulation.get<EndDrive>(muscle)->to);
          all.back().push_back(simulation.get<LineOfAction>(muscle)->length_m);
        }
    }
    return all;
  };
  before = states();
  ASSERT_EQ(*simulation.set_state(people, PersonState::compact), people.size());
  EXPECT_TRUE(simulation.muscles(people[3]).empty());
  ASSERT_TRUE(simulation.set_state(people, PersonState::full));
  EXPECT_EQ(states(), before);
  ASSERT_EQ(*simulation.set_state(people, PersonState::compact), people.size());
  const std::uint64_t hash = simulation.state_hash();
  ASSERT_TRUE(simulation.set_state(people, PersonState::full));
  ASSERT_EQ(*simulation.set_state(people, PersonState::compact), people.size());
  EXPECT_EQ(simulation.state_hash(), hash);
}

TEST(Compact, EachMuscleHasTheMethodThatItHad) {
  Simulation simulation(sharing());
  const Entity human = *simulation.spawn({});
  ASSERT_TRUE(simulation.set_muscles(human, unseen(4)));
  const auto reduced = [](std::uint32_t vectors, bool moving) {
    ReducedChoice choice = unseen(vectors).reduced;
    choice.moving = moving;
    return MuscleMethod{Method::reduced, choice};
  };
  const std::vector<MuscleMethod> methods = {
      {Method::none, {}}, reduced(12, false), reduced(7, true), reduced(4, true)};
  for (std::size_t m = 0; m < methods.size(); ++m)
    ASSERT_TRUE(simulation.set_method(human, static_cast<Muscle>(m), methods[m]));
  ASSERT_EQ(*simulation.set_state({&human, 1}, PersonState::compact), 1U);
  const auto as_asked = [&] {
    for (std::size_t m = 0; m < methods.size(); ++m)
      EXPECT_TRUE(same_method(simulation.method(human, static_cast<Muscle>(m)), methods[m])) << m;
  };
  as_asked();
  simulation.tick();
  EXPECT_EQ(simulation.human(human)->leg_muscles.muscles, muscle_groups());
  ASSERT_TRUE(simulation.set_state({&human, 1}, PersonState::full));
  as_asked();
  EXPECT_EQ(simulation.muscles(human).size(), 4U);
}

template <class F>
struct Sticker {
  F value;
};

TEST(Compact, NotWhoHasWhatACompactRowCannotHold) {
  Simulation simulation({.modules = {{.name = "stickers", .parts = {component_part<Sticker>()}}}});
  const auto stays_whole = [&](Entity human, const char* what) {
    EXPECT_EQ(simulation.set_state({&human, 1}, PersonState::compact).value(), 0U) << what;
    EXPECT_NE(simulation.state(human), PersonState::compact) << what;
  };
  const auto with = [&](const LegMuscles& choice) {
    const Entity human = *simulation.spawn({});
    EXPECT_TRUE(simulation.set_muscles(human, choice));
    return human;
  };
  stays_whole(*simulation.spawn_posed({}), "posed");
  const Entity pressing = *simulation.spawn({});
  ASSERT_TRUE(simulation.enable(pressing, Feature::forces));
  stays_whole(pressing, "forces");
  LegMuscles choice = unseen(4);
  choice.reduced.control_points = true;
  stays_whole(with(choice), "control points");
  choice = unseen(4);
  choice.inertia = true;
  stays_whole(with(choice), "inertia");
  choice = unseen(4);
  choice.line_motion = true;
  stays_whole(with(choice), "line motion");
  choice = unseen(4);
  choice.drive = Drive::force;
  stays_whole(with(choice), "drawn by force");
  choice = unseen(4);
  choice.method = Method::ecd;
  stays_whole(with(choice), "explicit");
  choice = unseen(4);
  choice.activation = ExcitationSource::phase;
  stays_whole(with(choice), "activation");
  choice = unseen(31);
  choice.muscles = 1;
  choice.reduced.cells = {4, 4, 16};
  stays_whole(with(choice), "too many vectors");
  const Entity labelled = with(unseen(4));
  ASSERT_TRUE(simulation.parts().add(simulation.muscle(labelled, Muscle::quadriceps, Side::left), Sticker<float>{1}));
  stays_whole(labelled, "a host's part of a muscle");
  const Entity fine = with(unseen(4));
  ASSERT_TRUE(simulation.parts().add(fine, Sticker<float>{7}));
  EXPECT_EQ(simulation.set_state({&fine, 1}, PersonState::compact).value(), 1U);
  EXPECT_EQ(simulation.get<Sticker>(fine)->value, 7.0F);
  const std::vector twice = {fine, fine};
  EXPECT_FALSE(simulation.set_state(twice, PersonState::compact));
  EXPECT_FALSE(simulation.set_state(twice, PersonState::full));
  EXPECT_EQ(simulation.state(fine), PersonState::compact);
  ASSERT_TRUE(simulation.despawn(fine));
  EXPECT_EQ(simulation.set_state({&fine, 1}, PersonState::compact).error().status, Status::stale_entity);
  EXPECT_NE(simulation.state(fine), PersonState::compact);
}

TEST(Compact, OtherCallsMakeWholeFirst) {
  Simulation simulation(sharing());
  const Entity human = *simulation.spawn({});
  ASSERT_TRUE(simulation.set_muscles(human, unseen(4)));
  const auto small = [&] { EXPECT_EQ(simulation.set_state({&human, 1}, PersonState::compact).value(), 1U); };
  small();
  ASSERT_TRUE(simulation.change_gait(human, {.speed_m_s = 1.1F}));
  ASSERT_TRUE(simulation.turn_to(human, 0.5F));
  simulation.tick();
  EXPECT_EQ(simulation.state(human), PersonState::compact);
  ASSERT_TRUE(simulation.place(human, 3, 4, 0.2F));
  ASSERT_TRUE(simulation.enable({&human, 1}, Feature::step_events));
  EXPECT_EQ(simulation.state(human), PersonState::compact);
  EXPECT_NEAR(simulation.get<Pose>(human)->position_m[0].x, 3, 0.5);
  ASSERT_TRUE(simulation.set_method(human, Muscle::hamstrings, {Method::none, {}}));
  EXPECT_NE(simulation.state(human), PersonState::compact);
  small();
  ASSERT_TRUE(simulation.set_muscles(human, std::nullopt));
  EXPECT_TRUE(simulation.muscles(human).empty());
  small();
  ASSERT_TRUE(simulation.set_muscles(human, unseen(4)));
  EXPECT_EQ(simulation.muscles(human).size(), 4U);
  small();
  ASSERT_TRUE(simulation.enable(human, Feature::forces));
  simulation.tick();
  EXPECT_TRUE(simulation.get<GroundReaction>(human));
}

TEST(Compact, FallsAsleepAndWakes) {
  Pair pair(20, unseen(4));
  pair.tick(300);
  ASSERT_EQ(*pair.compact.set_state(pair.small, PersonState::compact), pair.small.size());
  const std::size_t slept = *pair.compact.set_state(pair.small, PersonState::asleep);
  EXPECT_GT(slept, 10U);
  pair.tick(50);
  ASSERT_TRUE(pair.compact.set_state(pair.small, PersonState::full));
  for (std::size_t i = 0; i < pair.small.size(); ++i) {
    EXPECT_TRUE(pair.all_same(i));
    EXPECT_EQ(pair.compact.method(pair.small[i], Muscle::quadriceps).reduced.vectors, 4U);
    EXPECT_EQ(pair.compact.muscles(pair.small[i]).size(), 4U);
  }
}

TEST(Compact, SnapshotsAndAnotherOriginKeepThem) {
  Simulation simulation(sharing({.threads = 2}));
  std::vector<Entity> people;
  for (int i = 0; i < 21; ++i) {
    people.push_back(*simulation.spawn(person(i).body, person(i).gait));
    if (i % 3 != 0) {
      ASSERT_TRUE(simulation.set_muscles(people.back(), unseen(i % 2 == 0 ? 4 : 9)));
    }
  }
  for (int i = 0; i < 10; ++i) simulation.tick();
  ASSERT_EQ(*simulation.set_state(people, PersonState::compact), people.size());
  std::vector<std::byte> bytes(simulation.snapshot_bytes());
  ASSERT_TRUE(simulation.save(bytes));
  Simulation other(sharing());
  const auto restored = other.restore(bytes, RestoreLimits::none());
  ASSERT_TRUE(restored) << restored.error().message;
  EXPECT_EQ(other.state_hash(), simulation.state_hash());
  for (int i = 0; i < 25; ++i) simulation.tick(), other.tick();
  EXPECT_EQ(other.state_hash(), simulation.state_hash());
  ASSERT_TRUE(other.set_state(people, PersonState::full));
  EXPECT_EQ(other.muscles(people[1]).size(), 4U);
  const Vec3<float> before = simulation.get<Pose>(people[5])->position_m[7];
  ASSERT_TRUE(simulation.shift_origin(64, -128));
  const Vec3<float> after = simulation.get<Pose>(people[5])->position_m[7];
  EXPECT_NEAR(after.x, before.x - 64, 1e-5);
  EXPECT_NEAR(after.z, before.z + 128, 2e-5);
}

TEST(Compact, PosesAreWrittenOfThem) {
  Pair pair(35);
  pair.tick(40);
  ASSERT_TRUE(pair.compact.set_state(std::span(pair.small).subspan(5, 20), PersonState::compact));
  for (const double ahead_s : {0.0, 0.011}) {
    std::vector<std::byte> a(pair.small.size() * segment_count * 28), b(a.size());
    PoseWriter writer;
    ASSERT_TRUE(writer.write(pair.compact.world(), pair.small, ahead_s, {}, {a}));
    ASSERT_TRUE(writer.write(pair.whole.world(), pair.large, ahead_s, {}, {b}));
    EXPECT_EQ(a, b);
  }
}

}  // namespace
}  // namespace mobil
