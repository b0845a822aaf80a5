// Compact people: gaits match those of people who were never compact to the bit; muscles match within the promised
// error.

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
#include <mobil/systems/muscles/person.h>
#include <mobil/systems/snapshot/restore_limits.h>
#include <mobil/systems/surfaces/nodal_view.h>
#include "tests/labels.h"
#include "tests/simulation/simulation_hash.h"

MOBIL_TEST_LABELS("threads");

namespace mobil {
namespace {

LegMuscles unseen(std::uint32_t modes) {
  LegMuscles choice;
  choice.method = Method::modal;
  choice.modal = {.modes = modes, .cells = {2, 2, 8}, .control_points = false, .reported = false};
  return choice;
}

/// Equal people in two simulations. In one of them some are compact.
struct Pair {
  explicit Pair(int count, const std::optional<LegMuscles>& muscles = std::nullopt, int threads = 1)
      : compact(sharing({.threads = threads})), whole(sharing({.threads = threads})) {
    for (int i = 0; i < count; ++i) {
      const SamplePerson one = sample_person(i);
      for (Simulation* const simulation : {&compact, &whole}) {
        const Entity person = *simulation->spawn(one.body, one.gait);
        if (muscles) {
          const auto gave = simulation->set_muscles(person, *muscles);
          EXPECT_TRUE(gave) << gave.error().message;
        }
        (simulation == &compact ? small : large).push_back(person);
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
  std::vector<float> state(*simulation.world().get<ModalState>(muscle));
  EXPECT_EQ(simulation.world().get_field<ModalState>(muscle, state), Status::ok);
  return state;
}

TEST(Compact, CompactedPeopleMatchFullOnes) {
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

/// Near the origin: far from it, full people's positions and lines lose digits that compact ones keep.
TEST(Compact, MusclesMatchWithinFourMicrometres) {
  MOBIL_SLOW();
  for (const std::uint32_t modes : {4U, 12U}) {
    Pair pair(40, unseen(modes));
    pair.tick(20);
    ASSERT_EQ(*pair.compact.set_state(pair.small, PersonState::compact), pair.small.size());
    for (std::size_t i = 0; i < pair.small.size(); i += 3) pair.turn(i, i % 2 == 0 ? 1.2F : -0.7F);
    for (std::size_t i = 1; i < pair.small.size(); i += 3) pair.hasten(i, i % 2 == 0 ? 0.0F : 1.5F);
    pair.tick(120);
    ASSERT_TRUE(pair.compact.set_state(pair.small, PersonState::full));
    MuscleMethod seen = {Method::modal, unseen(modes).modal};
    seen.modal.control_points = true;
    double worst_end = 0, worst_point = 0, largest = 0;
    for (std::size_t i = 0; i < pair.small.size(); ++i) {
      for (std::size_t m = 0; m < usual_muscle_count; ++m) {
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

TEST(Compact, CompactingAndExpandingChangesNothing) {
  Simulation simulation(sharing());
  std::vector<Entity> people;
  for (int i = 0; i < 19; ++i) {
    people.push_back(*simulation.spawn(sample_person(i).body, sample_person(i).gait));
    ASSERT_TRUE(simulation.set_muscles(people.back(), unseen(6)));
  }
  for (int i = 0; i < 30; ++i) simulation.tick();
  std::vector<std::vector<float>> before;
  const auto states = [&] {
    std::vector<std::vector<float>> all;
    for (const Entity person : people) {
      for (const MuscleRef& own : simulation.muscles(person))
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

TEST(Compact, MusclesKeepTheirMethods) {
  Simulation simulation(sharing());
  const Entity person = *simulation.spawn({});
  ASSERT_TRUE(simulation.set_muscles(person, unseen(4)));
  const auto modal = [](std::uint32_t modes, bool moving) {
    ModalOptions choice = unseen(modes).modal;
    choice.moving = moving;
    return MuscleMethod{Method::modal, choice};
  };
  const std::vector<MuscleMethod> methods = {{Method::none, {}}, modal(12, false), modal(7, true), modal(4, true)};
  for (std::size_t m = 0; m < methods.size(); ++m)
    ASSERT_TRUE(simulation.set_method(person, static_cast<Muscle>(m), methods[m]));
  ASSERT_EQ(*simulation.set_state({&person, 1}, PersonState::compact), 1U);
  const auto as_asked = [&] {
    for (std::size_t m = 0; m < methods.size(); ++m)
      EXPECT_TRUE(same_method(simulation.method(person, static_cast<Muscle>(m)), methods[m])) << m;
  };
  as_asked();
  simulation.tick();
  EXPECT_EQ(simulation.person(person)->leg_muscles.muscles, usual_muscles());
  ASSERT_TRUE(simulation.set_state({&person, 1}, PersonState::full));
  as_asked();
  EXPECT_EQ(simulation.muscles(person).size(), 4U);
}

template <class F>
struct Sticker {
  F value;
};

TEST(Compact, PeopleWithUnstorableStateStayFull) {
  Simulation simulation({.modules = {{.name = "stickers", .parts = {component_id<Sticker>()}}}});
  const auto stays_full = [&](Entity person, const char* what) {
    EXPECT_EQ(simulation.set_state({&person, 1}, PersonState::compact).value(), 0U) << what;
    EXPECT_NE(simulation.state(person), PersonState::compact) << what;
  };
  const auto with = [&](const LegMuscles& choice) {
    const Entity person = *simulation.spawn({});
    EXPECT_TRUE(simulation.set_muscles(person, choice));
    return person;
  };
  stays_full(*simulation.spawn_posed({}), "posed");
  const Entity pressing = *simulation.spawn({});
  ASSERT_TRUE(simulation.enable(pressing, Feature::forces));
  stays_full(pressing, "forces");
  LegMuscles choice = unseen(4);
  choice.modal.control_points = true;
  stays_full(with(choice), "control points");
  choice = unseen(4);
  choice.inertia = true;
  stays_full(with(choice), "inertia");
  choice = unseen(4);
  choice.line_motion = true;
  stays_full(with(choice), "line motion");
  choice = unseen(4);
  choice.drive = Drive::force;
  stays_full(with(choice), "drawn by force");
  choice = unseen(4);
  choice.method = Method::explicit_central;
  stays_full(with(choice), "explicit");
  choice = unseen(4);
  choice.activation = ExcitationSource::phase;
  stays_full(with(choice), "activation");
  choice = unseen(31);
  choice.muscles = 1;
  choice.modal.cells = {4, 4, 16};
  stays_full(with(choice), "too many modes");
  const Entity labelled = with(unseen(4));
  ASSERT_TRUE(simulation.parts().add(simulation.muscle(labelled, Muscle::quadriceps, Side::left), Sticker<float>{1}));
  stays_full(labelled, "a host's part of a muscle");
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

TEST(Compact, OtherCallsExpandFirst) {
  Simulation simulation(sharing());
  const Entity person = *simulation.spawn({});
  ASSERT_TRUE(simulation.set_muscles(person, unseen(4)));
  const auto small = [&] { EXPECT_EQ(simulation.set_state({&person, 1}, PersonState::compact).value(), 1U); };
  small();
  ASSERT_TRUE(simulation.change_gait(person, {.speed_m_s = 1.1F}));
  ASSERT_TRUE(simulation.turn_to(person, 0.5F));
  simulation.tick();
  EXPECT_EQ(simulation.state(person), PersonState::compact);
  ASSERT_TRUE(simulation.place(person, 3, 4, 0.2F));
  ASSERT_TRUE(simulation.enable({&person, 1}, Feature::step_events));
  EXPECT_EQ(simulation.state(person), PersonState::compact);
  EXPECT_NEAR(simulation.get<Pose>(person)->position_m[0].x, 3, 0.5);
  ASSERT_TRUE(simulation.set_method(person, Muscle::hamstrings, {Method::none, {}}));
  EXPECT_NE(simulation.state(person), PersonState::compact);
  small();
  ASSERT_TRUE(simulation.set_muscles(person, std::nullopt));
  EXPECT_TRUE(simulation.muscles(person).empty());
  small();
  ASSERT_TRUE(simulation.set_muscles(person, unseen(4)));
  EXPECT_EQ(simulation.muscles(person).size(), 4U);
  small();
  ASSERT_TRUE(simulation.enable(person, Feature::forces));
  simulation.tick();
  EXPECT_TRUE(simulation.get<GroundReaction>(person));
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
    EXPECT_EQ(pair.compact.method(pair.small[i], Muscle::quadriceps).modal.modes, 4U);
    EXPECT_EQ(pair.compact.muscles(pair.small[i]).size(), 4U);
  }
}

TEST(Compact, KeptBySnapshotsAndOriginShifts) {
  Simulation simulation(sharing({.threads = 2}));
  std::vector<Entity> people;
  for (int i = 0; i < 21; ++i) {
    people.push_back(*simulation.spawn(sample_person(i).body, sample_person(i).gait));
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
  EXPECT_NEAR(after.z, before.z + 128, 4e-5);
}

TEST(Compact, PosesCanBeWritten) {
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
