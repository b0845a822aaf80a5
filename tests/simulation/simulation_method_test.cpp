// Changes of single muscles' methods while walking: the display is continuous, errors change nothing, and unused
// features have no cost.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include <mobil/components/fade.h>
#include <mobil/engine/world.h>
#include <mobil/muscle_table.h>
#include <mobil/step_report.h>
#include <mobil/systems/surfaces/nodal_view.h>
#include "tests/labels.h"
#include "tests/simulation/crowd_play.h"
#include "tests/simulation/leg_muscles.h"

MOBIL_TEST_LABELS("threads");

namespace mobil::simulation_method_test {
using play::coarse, play::every_method;

MuscleMethod modal(std::uint32_t modes, bool moving, bool control_points) {
  return {Method::modal, play::modal(modes, moving, control_points)};
}

std::string text(const MuscleMethod& method) {
  std::string all = name(method.method);
  if (method.method != Method::modal) return all;
  const ModalOptions& r = method.modal;
  return all + " " + std::to_string(r.modes) + (r.moving ? "" : " static") + (r.control_points ? "" : " unseen");
}

double apart(const std::vector<float>& a, const std::vector<float>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, static_cast<double>(std::abs(a[i] - b[i])));
  return most;
}

// ------------------------------------------------------------------------------------------------- continuity

/// A crowd in short ticks with changes of methods, and an unchanged twin.
struct Twins {
  static constexpr double tick_s = 1.0 / 960;
  static constexpr int people = 4;
  Simulation switched{sharing({.tick_s = tick_s})}, steady{sharing({.tick_s = tick_s})};
  std::vector<Entity> who, twin;

  explicit Twins(bool inertia) {
    LegMuscles choice;
    choice.inertia = inertia;
    choice.muscles = 0;
    choice.muscles.set(static_cast<std::size_t>(Muscle::hamstrings));
    choice.muscles.set(static_cast<std::size_t>(Muscle::tibialis_anterior));
    for (int i = 0; i < people; ++i) {
      who.push_back(join_with(switched, sample_person(i), choice));
      twin.push_back(join_with(steady, sample_person(i), choice));
    }
    tick(100);
  }
  void tick(int count = 1) {
    for (int i = 0; i < count; ++i) switched.tick(), steady.tick();
  }
};

Twins& twins(bool inertia) {
  static std::array<Twins, 2> both = {Twins(false), Twins(true)};
  return both[inertia ? 1 : 0];
}

/// The static solution of the modes is another method than their motion, with the same modes. Methods can change twice
/// between two ticks.
TEST(Switching, MotionToStaticAndBackInOneTickHasNoJump) {
  Twins& t = twins(false);
  const auto at = [&] {
    return displacement(t.switched, t.switched.muscle(t.who[0], Muscle::hamstrings, Side::right));
  };
  const auto change = [&](const MuscleMethod& to) {
    ASSERT_TRUE(t.switched.set_method(t.who[0], Muscle::hamstrings, to));
  };
  change(modal(12, true, true));
  double step = 0;  // of a tick, without a change
  for (int i = 0; i < 400; ++i) {
    const auto before = at();
    t.tick();
    step = std::max(step, apart(before, at()));
  }
  for (const MuscleMethod& next :
       {MuscleMethod{Method::explicit_central}, modal(5, true, true), modal(12, true, true)}) {
    const auto before = at();
    change(modal(12, false, true));
    EXPECT_LT(apart(before, at()), 1.1e-5);
    t.tick();
    EXPECT_LT(apart(before, at()), 2 * step);
    const auto still = at();
    change(modal(12, true, true));
    change(modal(12, false, true));
    change(next);
    EXPECT_LT(apart(still, at()), 1.1e-5) << text(next);
    change(modal(12, true, true));
    t.tick(400);
  }
}

RC_GTEST_PROP(Switching, HasNoJumpOfDisplacementOrVelocity, ()) {
  const bool inertia = *rc::gen::arbitrary<bool>();
  Twins& t = twins(inertia);
  const auto person = *rc::gen::inRange<std::size_t>(0, Twins::people);
  const Muscle muscle = *rc::gen::element(Muscle::hamstrings, Muscle::tibialis_anterior);
  const MuscleMethod to = *rc::gen::elementOf(every_method());
  t.tick(*rc::gen::inRange(0, 300));  // sometimes while the last change still fades

  // Ticks 0 to 3, the change, ticks 4 to 6.
  constexpr std::size_t last = 3;
  using Frames = std::array<std::vector<float>, 7>;
  std::array<Frames, 2> shown, unswitched;
  const auto record = [&](std::size_t frame) {
    for (const Side side : {Side::right, Side::left}) {
      shown[side][frame] = displacement(t.switched, t.switched.muscle(t.who[person], muscle, side));
      unswitched[side][frame] = displacement(t.steady, t.steady.muscle(t.twin[person], muscle, side));
    }
  };
  record(0);
  for (std::size_t frame = 1; frame <= last; ++frame) {
    t.tick();
    record(frame);
  }
  const auto done = t.switched.set_method(t.who[person], muscle, to);
  RC_ASSERT(done.has_value());
  RC_ASSERT(t.switched.method(t.who[person], muscle).method == to.method);
  const bool seen = to.method != Method::none && (to.method != Method::modal || to.modal.control_points);
  for (const Side side : {Side::right, Side::left}) {
    const auto now = displacement(t.switched, t.switched.muscle(t.who[person], muscle, side));
    RC_ASSERT(now.empty() != seen);
    if (seen && !shown[side][last].empty()) RC_ASSERT(apart(now, shown[side][last]) < 1.1e-5);
  }
  for (std::size_t frame = last + 1; frame < std::tuple_size<Frames>(); ++frame) {
    t.tick();
    record(frame);
  }
  for (const Side side : {Side::right, Side::left}) {
    // A static solution has the velocity of its load, which can be arbitrary.
    const bool still = to.method == Method::statics || (to.method == Method::modal && !to.modal.moving);
    if (!seen || still || shown[side][last].empty()) continue;
    // Change of velocity at the change, and the part explained by the methods' own motion before, then and later.
    // (Remains of earlier changes can ring in an implicit method at a few ticks a period.)
    double jump = 0, explained = 0;
    for (std::size_t i = 0; i < shown[side][last].size(); ++i) {
      const auto kink = [i](const Frames& u, std::size_t k) {
        return std::abs(static_cast<double>(u[k + 1][i] - u[k][i]) - static_cast<double>(u[k][i] - u[k - 1][i])) /
               Twins::tick_s;
      };
      RC_ASSERT(std::isfinite(shown[side].back()[i]));
      jump = std::max(jump, kink(shown[side], last));
      explained = std::max(explained, kink(unswitched[side], last));
      for (const std::size_t k : {last - 2, last - 1, last + 1, last + 2}) {
        explained = std::max(explained, kink(shown[side], k));
      }
    }
    RC_ASSERT(jump < 3 * explained + 0.01);
  }
}

TEST(Switching, LeavesNoStateAfterTheFade) {
  Simulation simulation(sharing()), whole(sharing());
  const Entity person = join_with(simulation, sample_person(5), {}),
               same = join_with(whole, sample_person(5), {.method = Method::statics});
  for (int i = 0; i < 40; ++i) simulation.tick(), whole.tick();
  for (std::size_t m = 0; m < usual_muscle_count; ++m) {
    ASSERT_TRUE(simulation.set_method(person, static_cast<Muscle>(m), {Method::statics}));
  }
  EXPECT_GT(rows_with<Fade>(simulation.world()), 0U);
  for (int i = 0; i < 15; ++i) {
    EXPECT_GT(rows_with(simulation.world(), type_id<ShownDisplacement>()), 0U) << i;
    simulation.tick();
    whole.tick();
  }
  EXPECT_EQ(rows_with<Fade>(simulation.world()), 0U);
  EXPECT_EQ(rows_with(simulation.world(), type_id<FadeStart>()), 0U);
  EXPECT_EQ(rows_with(simulation.world(), type_id<ShownDisplacement>()), 0U);
  Difference d;
  compare(simulation, person, whole, same, d);
  EXPECT_LT(d.apart, 2e-5);  // the solver's error
  EXPECT_GT(d.most, 1e-3);
}

TEST(Switching, PlacingControlPointsChangesNoState) {
  for (const bool inertia : {false, true}) {
    Simulation looked(sharing()), unseen(sharing());
    const LegMuscles choice{.method = Method::modal, .modal = {.cells = coarse}, .inertia = inertia};
    const Entity a = join_with(looked, sample_person(7), choice), b = join_with(unseen, sample_person(7), choice);
    for (int i = 0; i < 60; ++i) {
      if (i % 5 == 0) {
        ASSERT_TRUE(unseen.set_method(b, Muscle::hamstrings, modal(12, true, i % 2 == 0)));
      }
      looked.tick();
      unseen.tick();
    }
    ASSERT_TRUE(unseen.set_method(b, Muscle::hamstrings, modal(12, true, true)));
    looked.tick();
    unseen.tick();
    for (const Side side : {Side::right, Side::left}) {
      const Entity x = looked.muscle(a, Muscle::hamstrings, side), y = unseen.muscle(b, Muscle::hamstrings, side);
      EXPECT_EQ(displacement(looked, x), displacement(unseen, y));
      EXPECT_FALSE(displacement(unseen, y).empty());
    }
    EXPECT_EQ(rows_with<Fade>(unseen.world()), 0U);
    EXPECT_EQ(hash_person(looked, a), hash_person(unseen, b));
  }
}

TEST(Switching, FromNoneStartsOnTheLine) {
  for (const bool inertia : {false, true}) {
    Simulation simulation(sharing());
    const Entity person = join_with(simulation, sample_person(2), {.inertia = inertia});
    for (int i = 0; i < 30; ++i) simulation.tick();
    for (const MuscleMethod& to : every_method()) {
      ASSERT_TRUE(simulation.set_method(person, Muscle::hamstrings, {Method::none}));
      for (int i = 0; i < 3; ++i) simulation.tick();
      ASSERT_TRUE(simulation.set_method(person, Muscle::hamstrings, to)) << text(to);
      const Entity muscle = simulation.muscle(person, Muscle::hamstrings, Side::left);
      EXPECT_FALSE(simulation.world().has<Fade>(muscle));
      for (int i = 0; i < 20; ++i) simulation.tick();
      const auto u = displacement(simulation, muscle);
      for (const float x : u) ASSERT_LT(std::abs(x), 0.12F) << text(to);
    }
  }
}

// ----------------------------------------------------------------------------------------------------- refusals

TEST(SetMethod, RefusedChangeChangesNothing) {
  Simulation simulation(sharing());
  const Entity person = join_with(simulation, sample_person(9),
                                  {.method = Method::newmark, .inertia = true, .dt_s = 1.0 / 60}),
               damped = join_with(simulation, sample_person(4), {.stiffness_damping_s = 0.001}),
               bare = join(simulation, sample_person(1), false);
  for (int i = 0; i < 10; ++i) simulation.tick();
  const auto before = hash_world(simulation);
  const std::size_t tables = simulation.world().tables().size();
  const auto refused = [&](Entity whose, Muscle muscle, const MuscleMethod& method, const std::string& says) {
    const auto done = simulation.set_method(whose, muscle, method);
    ASSERT_FALSE(done) << says;
    EXPECT_TRUE(done.error().message.starts_with("set_method: ")) << done.error().message;
    EXPECT_NE(done.error().message.find(says), std::string::npos) << done.error().message;
    EXPECT_EQ(done.error().message.find('\n'), std::string::npos) << done.error().message;
    EXPECT_EQ(hash_world(simulation), before) << says;
    EXPECT_EQ(simulation.world().tables().size(), tables) << says;
  };
  const Muscle soleus = find_muscle("soleus").value();
  refused(Entity{}, Muscle::hamstrings, {Method::none}, "spawn one first");
  refused(bare, Muscle::hamstrings, {Method::none}, "no such muscle");
  refused(person, soleus, {Method::none}, "no such muscle");
  refused(person, Muscle::hamstrings, {static_cast<Method>(9)}, "hamstrings");
  refused(person, Muscle::hamstrings, {Method::explicit_central}, "critical step");
  refused(person, Muscle::hamstrings, modal(0, true, true), "1 to 32");
  refused(person, Muscle::hamstrings, modal(33, false, true), "1 to 32");
  refused(person, Muscle::hamstrings, {Method::modal, {.cells = {3, 3, 12}}}, "cells");
  refused(person, Muscle::hamstrings, {Method::modal, {.cells = {0, 4, 16}}}, "cells");
  refused(damped, Muscle::quadriceps, modal(12, true, true), "stiffness damping");
  EXPECT_EQ(simulation.method(person, Muscle::hamstrings).method, Method::newmark);
  EXPECT_EQ(simulation.method(person, soleus).method, Method::none);
  EXPECT_EQ(simulation.method(bare, Muscle::hamstrings).method, Method::none);
}

TEST(SetMethod, IsResetByAChangeOfLegMuscles) {
  Simulation simulation(sharing());
  const Entity person = join_with(simulation, sample_person(8), {});
  for (int i = 0; i < 10; ++i) simulation.tick();
  ASSERT_TRUE(simulation.set_method(person, Muscle::hamstrings, {Method::none}));
  ASSERT_TRUE(simulation.set_method(person, Muscle::quadriceps, modal(9, true, true)));
  ASSERT_TRUE(simulation.set_method(person, Muscle::triceps_surae, {Method::statics}));
  EXPECT_EQ(simulation.method(person, Muscle::tibialis_anterior).method, Method::explicit_central);
  simulation.tick();
  const auto muscles = muscles_of(simulation, person);
  ASSERT_TRUE(simulation.set_muscles(person, {.method = Method::newmark}));
  EXPECT_EQ(muscles_of(simulation, person), muscles);
  for (std::size_t m = 0; m < usual_muscle_count; ++m) {
    EXPECT_EQ(simulation.method(person, static_cast<Muscle>(m)).method, Method::newmark);
  }
  for (const Entity muscle : muscles) EXPECT_TRUE(simulation.world().has<SolvedSteps>(muscle));
  for (int i = 0; i < 30; ++i) simulation.tick();
  EXPECT_EQ(rows_with<Fade>(simulation.world()), 0U);
}

// --------------------------------------------------------------------------------------------------------- costs

/// Returns the entities that systems with that prefix processed in the last tick; without such entities their time is
/// 0.
std::uint64_t worked(const Simulation& simulation, std::string_view begins) {
  std::uint64_t sum = 0;
  for (const SystemReport& system : simulation.report().systems) {
    if (!system.name.starts_with(begins)) continue;
    sum += system.entities;
    if (system.entities == 0) {
      EXPECT_EQ(system.seconds, 0.0) << system.name;
    }
  }
  return sum;
}

TEST(Cost, DisabledFeaturesCostNothing) {
  Simulation simulation(sharing());
  std::vector<Entity> crowd;
  for (int i = 0; i < 5; ++i) crowd.push_back(join(simulation, sample_person(i), false));
  simulation.tick();
  EXPECT_EQ(worked(simulation, "gait"), 5U);
  EXPECT_EQ(worked(simulation, "kinematics"), 5U);
  for (const char* system : {"forces", "line", "frame motion", "deformation", "control points", "fade"}) {
    EXPECT_EQ(worked(simulation, system), 0U) << system;
  }
  for (const SystemReport& system : simulation.report().systems) {
    if (system.total_entities > 0) {
      EXPECT_GT(system.total_seconds, 0) << system.name;
    }
  }

  LegMuscles choice{.method = Method::none, .inertia = true};
  ASSERT_TRUE(simulation.set_muscles(crowd[0], choice));
  simulation.tick();
  EXPECT_EQ(worked(simulation, "lines of action"), 8U);
  for (const char* system : {"forces", "line motion", "frame motion", "deformation", "control points", "fade"}) {
    EXPECT_EQ(worked(simulation, system), 0U) << system;
  }
  EXPECT_EQ(nodal_displacement(simulation.world(), simulation.muscle(crowd[0], Muscle::hamstrings, Side::left)).first,
            nullptr);

  ASSERT_TRUE(simulation.set_method(crowd[0], Muscle::hamstrings, modal(8, false, false)));
  simulation.tick();
  for (const char* system : {"frame motion", "deformation", "control points", "fade"}) {
    EXPECT_EQ(worked(simulation, system), 0U) << system;
  }
  ASSERT_TRUE(simulation.set_method(crowd[0], Muscle::hamstrings, modal(8, true, false)));
  simulation.tick();
  EXPECT_EQ(worked(simulation, "frame motion"), 2U);
  EXPECT_EQ(worked(simulation, "deformation, modal"), 2U);
  EXPECT_EQ(worked(simulation, "deformation"), 2U);
  EXPECT_EQ(worked(simulation, "control points"), 0U);
  ASSERT_TRUE(simulation.set_method(crowd[0], Muscle::hamstrings, modal(8, false, true)));
  simulation.tick();
  EXPECT_EQ(worked(simulation, "deformation"), 0U);
  EXPECT_EQ(worked(simulation, "control points, static"), 2U);
  EXPECT_EQ(worked(simulation, "control points"), 2U);
  EXPECT_EQ(simulation.report().ticks, 5U);
}

TEST(Cost, LinesAreIndependentOfBellies) {
  Simulation all(sharing()), none(sharing());
  const Entity a = join_with(all, sample_person(3), {.line_motion = true}),
               b = join_with(none, sample_person(3), {.method = Method::none, .line_motion = true});
  for (int i = 0; i < 20; ++i) all.tick(), none.tick();
  for (std::size_t m = 0; m < usual_muscle_count; ++m) {
    const Entity x = all.muscle(a, static_cast<Muscle>(m), Side::left),
                 y = none.muscle(b, static_cast<Muscle>(m), Side::left);
    const auto p = *all.get<LineOfAction>(x), q = *none.get<LineOfAction>(y);
    EXPECT_EQ(std::memcmp(&p, &q, sizeof p), 0);
    const auto r = *all.get<LineMotion>(x), s = *none.get<LineMotion>(y);
    EXPECT_EQ(std::memcmp(&r, &s, sizeof r), 0);
  }
}

TEST(Cost, UnseenMuscleNeedsFewBytes) {
  std::map<std::string, std::uint32_t> bytes;
  for (const bool inertia : {false, true}) {
    Simulation simulation(sharing());
    const Entity person = join_with(simulation, sample_person(3), {.inertia = inertia});
    for (const MuscleMethod& method : every_method()) {
      ASSERT_TRUE(simulation.set_method(person, Muscle::hamstrings, method));
      for (int i = 0; i < 20; ++i) simulation.tick();  // the fade is over
      const auto place = simulation.world().find(simulation.muscle(person, Muscle::hamstrings, Side::left));
      bytes[text(method) + (inertia ? ", inertia" : "")] = 4 * place.table->words();
    }
  }
  for (const auto& [what, size] : bytes) std::cout << what << ": " << size << " bytes a muscle\n";
  EXPECT_LE(bytes["modal 12 unseen"], 448U);
  EXPECT_LE(bytes["none"], 200U);
  EXPECT_LT(4 * bytes["modal 12 unseen"], bytes["explicit-central"]);
}

/// A fade is not a motion: passed from change to change, it once grew to NaN within a quarter of a second.
TEST(Switching, InEveryTickStaysStable) {
  Simulation simulation(sharing());
  const Entity person = join_with(simulation, sample_person(2), {.modal = {.cells = {2, 2, 8}}});
  constexpr std::array order = {Method::explicit_central,
                                Method::implicit_central,
                                Method::newmark,
                                Method::statics,
                                Method::modal,
                                Method::finite};
  for (int tick = 0; tick < 240; ++tick) {
    for (std::size_t g = 0; g < usual_muscle_count; ++g) {
      const Method to = order[(static_cast<std::size_t>(tick) + g) % order.size()];
      ASSERT_TRUE(simulation.set_method(person, static_cast<Muscle>(g), {to, {.cells = {2, 2, 8}}}));
    }
    simulation.tick();
    for (const Entity muscle : muscles_of(simulation, person)) {
      for (const float u : displacement(simulation, muscle)) ASSERT_LT(std::abs(u), 0.15F) << tick;
    }
  }
}

}  // namespace mobil::simulation_method_test
