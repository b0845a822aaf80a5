// Effect of each call on people of each state: checks the table of systems/states/README.md.
#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <mobil/avoidance.h>
#include <mobil/lod.h>
#include <mobil/systems/poses/roots.h>
#include <mobil/terrain.h>
#include "tests/simulation/people.h"

namespace mobil::person_states_test {
namespace {

const std::vector<std::string> states = {"full", "compact", "asleep", "posed"};

std::string trimmed(const std::string& cell) {
  const auto first = cell.find_first_not_of(" `"), last = cell.find_last_not_of(" `");
  return first == std::string::npos ? std::string() : cell.substr(first, last - first + 1);
}

/// Returns the table: by call, the resulting state for each initial state.
std::map<std::string, std::vector<std::string>> table() {
  std::ifstream file(std::string(MOBIL_SOURCE_DIR) + "/systems/states/README.md");
  std::map<std::string, std::vector<std::string>> rows;
  bool inside = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("| call | full |")) inside = true;
    if (!inside || !line.starts_with("| `")) continue;
    std::vector<std::string> cells;
    std::istringstream in(line.substr(1));
    for (std::string cell; std::getline(in, cell, '|');) cells.push_back(trimmed(cell));
    if (cells.size() < 5) continue;
    rows[cells[0]] = {cells.begin() + 1, cells.begin() + 5};
  }
  return rows;
}

std::string word(const std::optional<PersonState>& state) {
  return state ? states[static_cast<std::size_t>(*state)] : "gone";
}

/// A simulation with a person who has walked for four seconds (or stood, for a step aside) and has the given state now.
/// Muscles of a compact person have no activation, and terrain manages no compact person.
struct Stage {
  Simulation simulation{sharing()};
  Entity person;
  bool managed, avoids, grounded;

  Stage(PersonState state, const std::string& call)
      : managed(call == "lod_release"), avoids(call == "avoidance_release"), grounded(call == "terrain_release") {
    const bool muscles = call == "set_method" || call == "set_excitation" || call == "set_no_muscles";
    if (state == PersonState::posed) {
      person = *simulation.spawn_posed({});
    } else {
      const bool stands = call == "step_aside";
      person = *simulation.spawn({}, {.speed_m_s = stands ? 0.0F : 1.2F});
    }
    if (avoids && state != PersonState::posed) {
      EXPECT_TRUE(simulation.avoidance().manage(person));
    }
    if (grounded && state != PersonState::posed && state != PersonState::compact) {
      EXPECT_TRUE(simulation.terrain().manage({&person, 1}));
    }
    if (muscles) {
      LegMuscles choice;
      choice.muscles = MuscleSet(1);
      choice.method = Method::modal;
      choice.modal.control_points = false;
      if (call == "set_excitation" && state != PersonState::compact) choice.activation = ExcitationSource::host;
      EXPECT_TRUE(simulation.set_muscles(person, choice));
    }
    if (managed) {
      EXPECT_TRUE(simulation.lod().set_scene({.muscles = 0}));
      if (state != PersonState::asleep) {
        EXPECT_TRUE(simulation.lod().manage(person));
      }
    }
    simulation.tick(240);
    if (managed && state == PersonState::asleep) {
      EXPECT_TRUE(simulation.lod().manage_asleep({&person, 1}));
    }
    if (state < PersonState::posed && simulation.state(person) != state) (void)simulation.set_state(person, state);
  }
};

using Call = std::function<bool(Simulation&, Entity)>;

const std::map<std::string, Call>& calls() {
  static const LegMuscles one = [] {
    LegMuscles choice;
    choice.muscles = MuscleSet(1);
    return choice;
  }();
  static const auto span = [](const Entity& person) { return std::span(&person, 1); };
  static const std::map<std::string, Call> all = {
      {"change_gait", [](Simulation& s, Entity p) { return s.change_gait(p, {.speed_m_s = 1.0F}).has_value(); }},
      {"set_gait", [](Simulation& s, Entity p) { return s.set_gait(p, {.speed_m_s = 1.0F}).has_value(); }},
      {"turn_to", [](Simulation& s, Entity p) { return s.turn_to(p, 0.5F).has_value(); }},
      {"change_gait_many",
       [](Simulation& s, Entity p) {
         const WalkChange change{.person = p, .heading_rad = 0.5F};
         return s.change_gait(std::span(&change, 1)).has_value();  // it counts people who cannot
       }},
      {"step_aside", [](Simulation& s, Entity p) { return s.step_aside(p, 0.1F, 0).has_value(); }},
      {"place", [](Simulation& s, Entity p) { return s.place(p, 3, 4, 0.5F).has_value(); }},
      {"roots",
       [](Simulation& s, Entity p) {
         Root root;
         return s.roots(span(p), {&root, 1}).has_value();
       }},
      {"get_pose", [](Simulation& s, Entity p) { return s.get<Pose>(p).has_value(); }},
      {"set_pose", [](Simulation& s, Entity p) { return s.set_pose(p, *s.get<Pose>(p)).has_value(); }},
      {"set_muscles", [](Simulation& s, Entity p) { return s.set_muscles(p, one).has_value(); }},
      {"set_no_muscles", [](Simulation& s, Entity p) { return s.set_muscles(p, std::nullopt).has_value(); }},
      {"set_method",
       [](Simulation& s, Entity p) {
         return s.set_method(p, Muscle::hamstrings, {Method::none, {}}).has_value();
       }},
      {"set_excitation",
       [](Simulation& s, Entity p) { return s.set_excitation(p, Muscle::hamstrings, Side::right, 0.5F).has_value(); }},
      {"enable_step_events", [](Simulation& s, Entity p) { return s.enable(p, Feature::step_events).has_value(); }},
      {"enable_fat", [](Simulation& s, Entity p) { return s.enable(p, Feature::fat).has_value(); }},
      {"enable_forces", [](Simulation& s, Entity p) { return s.enable(p, Feature::forces).has_value(); }},
      {"set_state_full", [](Simulation& s, Entity p) { return s.set_state(p, PersonState::full).has_value(); }},
      {"set_state_compact", [](Simulation& s, Entity p) { return s.set_state(p, PersonState::compact).has_value(); }},
      {"set_state_asleep", [](Simulation& s, Entity p) { return s.set_state(p, PersonState::asleep).has_value(); }},
      {"avoidance_manage", [](Simulation& s, Entity p) { return s.avoidance().manage(p).has_value(); }},
      {"avoidance_release", [](Simulation& s, Entity p) { return s.avoidance().release(p).has_value(); }},
      {"terrain_manage", [](Simulation& s, Entity p) { return s.terrain().manage(span(p)).has_value(); }},
      {"terrain_release", [](Simulation& s, Entity p) { return s.terrain().release(span(p)).has_value(); }},
      {"lod_manage",
       [](Simulation& s, Entity p) {
         return s.lod().set_scene({.muscles = 0}).has_value() && s.lod().manage(p).has_value();
       }},
      {"lod_release", [](Simulation& s, Entity p) { return s.lod().release(p).has_value(); }},
      {"despawn", [](Simulation& s, Entity p) { return s.despawn(p).has_value(); }},
      {"shift_origin", [](Simulation& s, Entity) { return s.shift_origin(64, 0).has_value(); }},
      {"tick",
       [](Simulation& s, Entity) {
         s.tick();
         return true;
       }},
  };
  return all;
}

TEST(PersonStates, MatchTheTableAfterEachCall) {
  const auto rows = table();
  ASSERT_EQ(rows.size(), calls().size());
  for (const auto& [name, call] : calls()) {
    ASSERT_TRUE(rows.contains(name)) << name << " is not in the table";
    for (std::size_t s = 0; s < states.size(); ++s) {
      const auto state = static_cast<PersonState>(s);
      Stage stage(state, name);
      ASSERT_EQ(word(stage.simulation.state(stage.person)), states[s]) << name;
      const std::uint64_t before = stage.simulation.state_hash();
      const bool done = call(stage.simulation, stage.person);
      const std::string after = word(stage.simulation.state(stage.person));
      const std::string& expected = rows.at(name)[s];
      EXPECT_EQ(done ? after : "refused", expected) << name << " of somebody " << states[s];
      if (done) continue;
      EXPECT_EQ(after, states[s]) << name;
      EXPECT_EQ(stage.simulation.state_hash(), before) << name << " of somebody " << states[s];
    }
  }
}

TEST(PersonStates, HandlesOfMusclesAreRefused) {
  Simulation simulation;
  const Entity person = *simulation.spawn({});
  ASSERT_TRUE(simulation.set_muscles(person));
  const std::vector<Entity> both = {person, simulation.muscles(person).front().entity[0]};
  const std::uint64_t before = simulation.state_hash();
  for (const PersonState state : {PersonState::full, PersonState::compact, PersonState::asleep})
    EXPECT_TRUE(simulation.set_state(both, state) == Status::stale_entity);
  EXPECT_EQ(simulation.state_hash(), before);
}

/// The ticks after each call run correctly for all people.
TEST(PersonStates, ContinueAfterEachCall) {
  for (const auto& [name, call] : calls()) {
    for (std::size_t s = 0; s < states.size(); ++s) {
      Stage stage(static_cast<PersonState>(s), name);
      const bool done = call(stage.simulation, stage.person);
      stage.simulation.tick(90);
      EXPECT_EQ(stage.simulation.state(stage.person).has_value(), !(done && name == "despawn")) << name;
      if (const auto pose = stage.simulation.get<Pose>(stage.person)) {
        EXPECT_TRUE(std::isfinite(pose->position_m[0].x + pose->position_m[0].y)) << name;
      }
    }
  }
}

}  // namespace
}  // namespace mobil::person_states_test
