#pragma once
// A host of the C interface that makes arbitrary calls with arbitrary arguments. Only pointers are valid, or null.

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <vector>

#include <mobil/mobil.h>
#include "tests/fuzz/fuzz_input.h"

namespace mobil::fuzz {

/// Some people, and the properties that calls must preserve.
class WildHost {
 public:
  explicit WildHost(Numbers numbers) : numbers_(numbers) {
    mobil_options options;
    mobil_defaults(MOBIL_OPTIONS, &options, sizeof options);
    char line[512];
    promise(mobil_create(&options, &sim_, line, sizeof line) == MOBIL_OK, "a simulation is made");
    static const std::vector<unsigned char> baked = kept_or_baked();
    if (!baked.empty()) mobil_load_baked(sim_, baked.data(), baked.size());
  }
  ~WildHost() { mobil_destroy(sim_); }
  WildHost(const WildHost&) = delete;
  WildHost& operator=(const WildHost&) = delete;

  void play() {
    for (int calls = 0; calls < 40 && !numbers_.empty(); ++calls) {
      const int code = call();
      if (code >= MOBIL_OK) continue;
      promise(code != MOBIL_INTERNAL, "no fault is the library's own");
      promise_line(mobil_message(sim_));
    }
    look();
  }

 private:
  /// Meshes and bases, made once for all inputs. With sanitizers they take minutes, so a file named in MOBIL_FUZZ_BAKED
  /// stores them.
  std::vector<unsigned char> kept_or_baked() const {
    const char* const file = std::getenv("MOBIL_FUZZ_BAKED");
    if (file == nullptr) return bake();
    if (std::ifstream kept(file, std::ios::binary); kept)
      return {std::istreambuf_iterator<char>(kept), std::istreambuf_iterator<char>()};
    const std::vector<unsigned char> baked = bake();
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(baked.data()), static_cast<std::streamsize>(baked.size()));
    return baked;
  }
  std::vector<unsigned char> bake() const {
    mobil_muscles choice;
    mobil_defaults(MOBIL_MUSCLES, &choice, sizeof choice);
    for (const int method : {MOBIL_MODAL, MOBIL_EXPLICIT_CENTRAL}) {
      choice.method = method;
      promise(mobil_prepare(sim_, &choice) == MOBIL_OK, "usual muscles are prepared");
    }
    size_t bytes = 0;
    mobil_bake(sim_, nullptr, 0, &bytes);
    std::vector<unsigned char> baked(bytes);
    promise(mobil_bake(sim_, baked.data(), baked.size(), &bytes) == MOBIL_OK, "what was prepared is baked");
    return baked;
  }

  /// Returns a person's handle, mostly of an existing person.
  mobil_id id() {
    const std::uint8_t which = numbers_.byte();
    if (which >= 250 || people_.empty()) {
      mobil_id any;
      for (std::size_t i = 0; i < sizeof any; ++i) reinterpret_cast<std::uint8_t*>(&any)[i] = numbers_.byte();
      return any;
    }
    return people_[which % people_.size()];
  }

  mobil_muscles muscles() {
    mobil_muscles choice;
    mobil_defaults(MOBIL_MUSCLES, &choice, sizeof choice);
    choice.muscles = 1U << numbers_.byte() % 8;
    choice.method = numbers_.wild(6);
    choice.modes = numbers_.wild(20);
    choice.control_points = numbers_.wild(2);
    choice.reported = numbers_.wild(2);
    choice.activation = numbers_.wild(4);
    choice.inertia = numbers_.wild(2);
    choice.drive = numbers_.wild(2);
    if (numbers_.byte() < 32) choice.poisson = static_cast<double>(numbers_.number());
    if (numbers_.byte() < 32) choice.young_pa = 1e5 * static_cast<double>(numbers_.number());
    if (numbers_.byte() < 32) choice.dt_s = static_cast<double>(numbers_.number()) / 100;
    return choice;
  }

  mobil_walk walk() {
    mobil_walk walk;
    mobil_defaults(MOBIL_WALK, &walk, sizeof walk);
    walk.given = numbers_.byte();
    walk.speed_m_s = numbers_.number();
    walk.step_length_m = numbers_.number();
    walk.heading_rad = numbers_.number();
    for (float& number : style_) number = numbers_.byte() < 250 ? 0 : numbers_.number();
    walk.style = style_.data();
    walk.style_count = numbers_.byte() % style_.size();
    return walk;
  }

  int call() {
    const mobil_id who = id();
    switch (numbers_.byte() % 20) {
      case 0: {
        mobil_person person;
        mobil_defaults(MOBIL_PERSON, &person, sizeof person);
        if (numbers_.byte() % 4 == 0) person.height_m = numbers_.number();
        if (numbers_.byte() % 4 == 0) person.mass_kg = 80 * numbers_.number();
        person.constitution = numbers_.wild(4);
        person.posed = numbers_.wild(2);
        person.given = numbers_.byte() & 7;
        person.speed_m_s = numbers_.number();
        person.step_length_m = numbers_.number();
        person.step_frequency_hz = numbers_.number();
        mobil_id made;
        if (people_.size() >= 6) return MOBIL_OK;
        const int code = mobil_spawn(sim_, &person, 0, 1, nullptr, &made);
        if (code == MOBIL_OK) people_.push_back(made);
        return code;
      }
      case 1: {
        const int code = mobil_despawn(sim_, &who, 1);
        if (code == MOBIL_OK)
          std::erase_if(people_, [&](const mobil_id& p) { return !std::memcmp(&p, &who, sizeof p); });
        return code;
      }
      case 2: {
        const mobil_walk asked = walk();
        return mobil_change_walk(sim_, &who, 1, &asked);
      }
      case 3:
        return mobil_step_aside(sim_, who, numbers_.number(), numbers_.number());
      case 4: {
        const float place[3] = {100 * numbers_.number(), numbers_.number(), numbers_.number()};
        return mobil_place(sim_, who, place, numbers_.number());
      }
      case 5: {
        std::vector<float> pose(std::size_t{7} * MOBIL_SEGMENTS);
        mobil_poses(sim_, &who, 1, nullptr, pose.data(), 0);
        for (int changes = numbers_.byte() % 4; changes > 0; --changes) {
          pose[(numbers_.byte() + 256U * numbers_.byte()) % pose.size()] = numbers_.number();
        }
        return mobil_set_poses(sim_, &who, 1, pose.data(), 0, numbers_.wild(2));
      }
      case 6:
      case 7:
      case 8:
      case 9:
        return mobil_set_state(sim_, &who, 1, numbers_.wild(5), numbers_.number() / 100, nullptr);
      case 10:
        return mobil_enable(sim_, &who, 1, numbers_.wild(3), numbers_.wild(2));
      case 11: {
        const mobil_muscles choice = muscles();
        return mobil_set_muscles(sim_, &who, 1, numbers_.byte() % 4 == 0 ? nullptr : &choice);
      }
      case 12: {
        mobil_method method;
        mobil_defaults(MOBIL_METHOD, &method, sizeof method);
        method.method = numbers_.wild(6);
        method.modes = numbers_.wild(20);
        method.control_points = numbers_.wild(2);
        return mobil_set_method(sim_, &who, 1, numbers_.wild(17), &method);
      }
      case 13: {
        const float excitation = numbers_.number();
        return mobil_set_excitation(sim_, &who, 1, numbers_.wild(17), numbers_.wild(2), &excitation, 0);
      }
      case 14:
        answer_ground();
        return mobil_tick(sim_, numbers_.byte() % 8);
      case 15:
        return mobil_advance(sim_, static_cast<double>(numbers_.number()) / 16, nullptr);
      case 16: {
        std::vector<unsigned char> state(mobil_snapshot_bytes(sim_));
        size_t bytes = 0;
        promise(mobil_save(sim_, state.data(), state.size(), &bytes) == MOBIL_OK, "a state is saved");
        const int restored = mobil_restore(sim_, state.data(), bytes);
        promise(restored == MOBIL_OK, restored == MOBIL_OK ? "" : mobil_message(sim_));
        return MOBIL_OK;
      }
      case 17: {
        const float to[3] = {64 * numbers_.number(), 0, numbers_.number()};
        return mobil_shift_origin(sim_, to);
      }
      case 18: {
        float row[512];
        const int what = numbers_.wild(MOBIL_ROWS);
        return mobil_read(sim_, what, &who, 1, row, 0);
      }
      default: {
        if (numbers_.byte() % 4 != 0) return call_surroundings(who);
        mobil_pose_layout layout;
        mobil_defaults(MOBIL_POSE_LAYOUT, &layout, sizeof layout);
        layout.form = numbers_.wild(3);
        layout.to_parent = numbers_.wild(2);
        layout.ahead_s = static_cast<double>(numbers_.number()) / 10;
        std::array<float, std::size_t{12} * MOBIL_SEGMENTS> out;
        return mobil_poses(sim_, &who, 1, &layout, out.data(), 0);
      }
    }
  }

  int call_surroundings(const mobil_id& who) {
    float row[7];
    for (float& number : row) number = numbers_.number();
    const size_t count = numbers_.byte() % 2;
    switch (numbers_.byte() % 6) {
      case 0:
        return mobil_avoidance_manage(sim_, &who, 1, numbers_.wild(2));
      case 1:
        return mobil_avoidance_set_desired_velocity(sim_, &who, 1, row, 0);
      case 2:
        return mobil_avoidance_set_walls(sim_, row, 0, count);
      case 3:
        return mobil_avoidance_set_discs(sim_, row, 0, count);
      case 4: {
        mobil_avoidance_options options;
        mobil_defaults(MOBIL_AVOIDANCE_OPTIONS, &options, sizeof options);
        options.radius_h = row[0];
        options.overlap_m = row[1];
        options.shoulders_h = row[2];
        return mobil_avoidance_set_options(sim_, &options);
      }
      default:
        mobil_terrain_set_speed_scaling(sim_, static_cast<int>(count));
        return mobil_terrain_manage(sim_, &who, 1, numbers_.wild(2));
    }
  }

  /// Sometimes returns a different number of heights than requested.
  void answer_ground() {
    size_t places = 0;
    promise(mobil_terrain_query(sim_, nullptr, 0, nullptr, 0, &places) == MOBIL_OK, "the ground is asked for");
    if (places == 0) return;
    std::vector<float> ground(4 * places);
    for (float& number : ground) number = numbers_.byte() < 32 ? numbers_.number() : 0.25F * numbers_.number();
    mobil_terrain_resolve(sim_, ground.data(), 0, numbers_.byte() < 250 ? places : places - 1, nullptr);
  }

  /// Checks that every existing person has a state, a finite pose and finite control points.
  void look() {
    for (const mobil_id& who : people_) {
      std::array<float, std::size_t{7} * MOBIL_SEGMENTS> pose;
      int bits = 0, state = 0;
      promise(mobil_has(sim_, who, &bits) == MOBIL_OK, "who was made is there");
      promise(mobil_get_state(sim_, who, &state) == MOBIL_OK, "who was made has a state");
      if (state == MOBIL_ASLEEP) continue;  // has no pose
      const int code = mobil_poses(sim_, &who, 1, nullptr, pose.data(), 0);
      promise(code == MOBIL_OK, code == MOBIL_OK ? "" : mobil_message(sim_));
      for (const float number : pose) promise(std::isfinite(number), "poses are finite");
      if ((bits & MOBIL_HAS_MUSCLES) == 0 || state == MOBIL_COMPACT) continue;
      for (int muscle = 0; muscle < 17; ++muscle) {
        const int floats = mobil_muscle_row_floats(sim_, MOBIL_NODES, who, muscle, 0);
        if (floats <= 0) continue;
        std::vector<float> nodes(static_cast<std::size_t>(floats));
        if (mobil_read_muscles(sim_, MOBIL_NODES, &who, 1, muscle, 0, nodes.data(), 0) != MOBIL_OK) continue;
        for (const float number : nodes) promise(std::isfinite(number), "control points are finite");
      }
    }
  }

  Numbers numbers_;
  mobil_sim* sim_ = nullptr;
  std::vector<mobil_id> people_;
  std::array<float, 40> style_{};
};

inline void fuzz_calls(Input input) {
  WildHost host{Numbers(input)};
  host.play();
}

}  // namespace mobil::fuzz
