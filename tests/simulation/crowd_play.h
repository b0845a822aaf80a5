#pragma once
// A scripted crowd under constant change: people of all kinds are spawned, turn, change speed, effects and methods, and
// are despawned. The script depends only on each person's number.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <span>
#include <vector>

#include <mobil/avoidance.h>
#include <mobil/components/avoidance.h>
#include <mobil/components/sleep.h>
#include <mobil/engine/world.h>
#include <mobil/forces.h>
#include <mobil/simulation.h>
#include <mobil/terrain.h>
#include "engine/row_hash.h"
#include "tests/interfaces.h"
#include "tests/simulation/people.h"
#include "tests/simulation/simulation_hash.h"

namespace mobil::play {

// Coarse meshes, whose bases are quickly made.
inline constexpr Cells coarse = {2, 2, 8};

inline ModalOptions modal(std::uint32_t modes, bool moving, bool seen) {
  return {.modes = modes, .moving = moving, .cells = coarse, .control_points = seen};
}

inline const std::array<MuscleMethod, 10>& every_method() {
  static const std::array<MuscleMethod, 10> all = {{{Method::explicit_central},
                                                    {Method::implicit_central},
                                                    {Method::newmark},
                                                    {Method::statics},
                                                    {Method::modal, modal(12, true, true)},
                                                    {Method::modal, modal(12, true, false)},
                                                    {Method::modal, modal(5, true, true)},
                                                    {Method::modal, modal(8, false, true)},
                                                    {Method::finite},
                                                    {Method::none}}};
  return all;
}

/// Returns a number that depends only on its arguments.
inline std::uint64_t mixed(std::uint64_t seed, std::uint64_t who, std::uint64_t when) {
  return mix64(mix64((seed << 48 ^ who << 24 ^ when) + 0x9e3779b97f4a7c15));
}

/// Returns muscles of up to three groups, by any method, with each effect in some. Few templates suffice for all.
inline LegMuscles choice_of(std::uint64_t draw) {
  LegMuscles choice;
  choice.method = every_method()[draw % every_method().size()].method;
  choice.modal = every_method()[draw % every_method().size()].modal;
  choice.modal.cells = coarse;
  draw /= every_method().size();
  choice.line_motion = draw % 2 == 0;
  choice.muscles = 0;
  choice.muscles.set(static_cast<std::size_t>(Muscle::hamstrings));
  if (draw / 2 % 3 == 0) {
    choice.inertia = true;
  } else if (draw / 2 % 3 == 1) {
    choice.drive = Drive::force;
  } else {
    choice.muscles.set(static_cast<std::size_t>(Muscle::tibialis_anterior));
    choice.activation = static_cast<ExcitationSource>(draw / 6 % 3);
    if (draw / 18 % 3 != 0) choice.finite_shape = draw / 18 % 3 == 1;
    choice.modal.tuned = has_activation(choice) && draw / 54 % 2 == 0;
    choice.inertia = choice.modal.tuned && draw / 108 % 2 == 0;
    if (choice.method == Method::explicit_central) choice.muscles.set(static_cast<std::size_t>(Muscle::quadriceps));
  }
  return choice;
}

struct Script {
  int at_first = 40;  // people at the start
  int comers = 24;    // people who are spawned later, one every `apart` ticks
  int apart = 3;      // ticks
  std::uint64_t seed = 1;
  bool avoidance = true;  // some avoid others: their motion depends on handles and other people

  int everybody() const { return at_first + comers; }
  int comes(int who) const { return who < at_first ? 0 : 1 + (who - at_first) * apart; }
  int goes(int who) const {
    return who % 5 == 4 ? comes(who) + 20 + static_cast<int>(mixed(seed, 7, static_cast<std::uint64_t>(who)) % 60) : -1;
  }
};

class Crowd {
 public:
  /// `order`: the order of simultaneous spawns and of requests; it contains each number once.
  Crowd(const SimulationOptions& options, const Script& script, std::vector<int> order)
      : simulation_(options), terrain_(terrain_of(simulation_, &hills)), script_(script), order_(std::move(order)) {}
  Crowd(const Crowd&) = delete;
  Crowd& operator=(const Crowd&) = delete;
  Crowd(const SimulationOptions& options, const Script& script) : Crowd(options, script, in_turn(script)) {}

  static std::vector<int> in_turn(const Script& script) {
    std::vector<int> order(static_cast<std::size_t>(script.everybody()));
    std::iota(order.begin(), order.end(), 0);
    return order;
  }

  Simulation& simulation() { return simulation_; }
  const Simulation& simulation() const { return simulation_; }
  const std::map<int, Entity>& people() const { return people_; }

  void tick() {
    for (const int who : order_) {
      if (script_.comes(who) == now_) come(who);
      if (script_.goes(who) == now_) go(who);
      const auto person = people_.find(who);
      if (person != people_.end()) ask(who, person->second);
    }
    simulation_.tick();
    ++now_;
  }

  /// Hashes by number. Number -1 is the hash of all people.
  std::map<int, std::uint64_t> hashes() const {
    std::map<int, std::uint64_t> all;
    all[-1] = simulation_.state_hash();
    for (const auto& [who, person] : people_) all[who] = hash_person(simulation_, person);
    return all;
  }

 private:
  static bool is_posed(int who) { return who % 16 == 11; }
  bool avoids_others(int who) const { return script_.avoidance && who % 16 == 9; }
  static bool is_on_hills(int who) { return who % 16 == 6; }
  static void hills(std::span<const TerrainQuery> at, std::span<TerrainHeight> out) {
    for (std::size_t i = 0; i < at.size(); ++i)
      out[i] = {0.3F * std::sin(at[i].x_m) + 0.1F * at[i].z_m, 0.3F * std::cos(at[i].x_m), 0.1F};
  }
  std::uint64_t draw(int who, int what) const {
    return mixed(script_.seed, static_cast<std::uint64_t>(who), static_cast<std::uint64_t>(what));
  }

  void come(int who) {
    SamplePerson p = sample_person(who);
    if (who % 2 == 0) p.gait.style = snapped(p.gait.style);
    if (is_posed(who)) p.body.limbs = {0.27F * p.body.height_m, 0, 0, 0.16F * p.body.height_m};
    const auto person = is_posed(who) ? simulation_.spawn_posed(p.body) : simulation_.spawn(p.body, p.gait);
    ASSERT_TRUE(person) << person.error().message;
    people_[who] = *person;
    if (is_posed(who)) {
      EXPECT_EQ(simulation_.enable(*person, Feature::forces), Status::ok);
    }
    if (who % 3 == 0 && !is_posed(who)) {
      EXPECT_TRUE(simulation_.enable({&*person, 1}, Feature::step_events));
    }
    if (who % 4 == 1) {
      EXPECT_TRUE(simulation_.enable({&*person, 1}, Feature::fat));
    }
    if (is_on_hills(who)) {
      EXPECT_TRUE(terrain_.manage({&*person, 1}));
    }
    if (avoids_others(who)) {
      EXPECT_TRUE(simulation_.avoidance().manage(*person));
    }
    if (who % 8 == 5) return;  // walks without muscles
    const auto added = simulation_.set_muscles(*person, choice_for(*person, draw(who, -1)));
    ASSERT_TRUE(added) << added.error().message;
  }

  /// People with forces follow moments if others follow the phase.
  LegMuscles choice_for(Entity person, std::uint64_t how) const {
    LegMuscles choice = choice_of(how);
    if (choice.activation == ExcitationSource::phase && simulation_.get<JointMoments>(person))
      choice.activation = ExcitationSource::moments;
    return choice;
  }

  void go(int who) {
    EXPECT_EQ(simulation_.despawn(people_.at(who)), Status::ok);
    people_.erase(who);
  }

  void ask(int who, Entity person) {
    const std::uint64_t what = draw(who, now_);
    if (is_posed(who)) {
      Pose<float> pose = *simulation_.get<Pose>(person);
      for (auto& at : pose.position_m) at.z += 0.01F * static_cast<float>(what % 3);
      EXPECT_EQ(simulation_.set_pose(person, pose), Status::ok);
    }
    if (what % 24 == 1) {
      EXPECT_TRUE(simulation_.set_state({&person, 1}, PersonState::asleep));
    } else if (what % 24 == 2 || (what % 24 == 0 && what / 24 % 2 == 0)) {
      EXPECT_TRUE(simulation_.set_state({&person, 1}, PersonState::full));  // for muscles as well
    }
    if (what % 24 == 3 || what % 24 == 4) shrink(person, what / 24);
    if (what % 24 == 5) {
      EXPECT_TRUE(simulation_.set_state({&person, 1}, PersonState::full));
    }
    if (what % 24 != 0) return;
    const std::uint64_t how = what / 24 / 8;
    if (what / 24 % 2 == 0) {
      ask_for_muscles(person, what / 48 % 4, how);
    } else if (!is_posed(who)) {
      ask_to_walk(person, what / 48 % 4, how);
    }
  }

  /// Compacts a person with muscles that allow it, or without muscles.
  void shrink(Entity person, std::uint64_t how) {
    LegMuscles choice;
    choice.muscles = how % 2 == 0 ? 1 : 9;
    choice.method = how % 5 == 0 ? Method::none : Method::modal;
    choice.modal = modal(how % 3 == 0 ? 5 : 12, true, false);
    if (!simulation_.muscles(person).empty()) {
      EXPECT_TRUE(simulation_.set_muscles(person, choice));
    }
    EXPECT_TRUE(simulation_.set_state({&person, 1}, PersonState::compact));
  }

  void ask_to_walk(Entity person, std::uint64_t what, std::uint64_t how) {
    const auto part = static_cast<float>(how % 1000) * 1e-3F;
    if (what == 0) {
      EXPECT_TRUE(simulation_.change_gait(person, {.speed_m_s = how % 5 == 0 ? 0.0F : 0.7F + part}));
    } else if (what == 1) {
      EXPECT_TRUE(simulation_.turn_to(person, 6 * (part - 0.5F)));
    } else if (what == 2) {
      EXPECT_EQ(simulation_.enable(person, Feature::forces), Status::ok);
    } else {
      EXPECT_NE(simulation_.enable(person, Feature::forces, false), Status::stale_entity);
    }
  }

  void ask_for_muscles(Entity person, std::uint64_t what, std::uint64_t how) {
    EXPECT_TRUE(simulation_.set_state({&person, 1}, PersonState::full));
    const auto hamstrings = simulation_.muscle(person, Muscle::hamstrings, Side::right);
    if (!simulation_.world().alive(hamstrings)) {
      EXPECT_TRUE(simulation_.set_muscles(person, choice_for(person, how)));
    } else if (what == 0) {
      EXPECT_EQ(simulation_.set_muscles(person, std::nullopt), Status::ok);
    } else if (what == 1) {
      EXPECT_TRUE(simulation_.set_muscles(person, choice_for(person, how)));
    } else {
      EXPECT_TRUE(simulation_.set_method(person, Muscle::hamstrings, every_method()[how % every_method().size()]));
      if (simulation_.get<ExcitationSource>(hamstrings) == static_cast<std::uint64_t>(ExcitationSource::host)) {
        const float level = static_cast<float>(how % 100) * 0.01F;
        EXPECT_TRUE(simulation_.set_excitation(person, Muscle::hamstrings, Side::right, level));
      }
    }
  }

  Simulation simulation_;
  Terrain terrain_;
  Script script_;
  std::vector<int> order_;
  std::map<int, Entity> people_;
  int now_ = 0;
};

}  // namespace mobil::play
