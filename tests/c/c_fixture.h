#pragma once
// A simulation through the C interface, and its twin in C++.

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include <mobil/mobil.h>
#include <mobil/simulation.h>

namespace mobil::c_test {

template <class S>
S filled(int which) {
  S s;
  EXPECT_EQ(mobil_defaults(which, &s, sizeof s), MOBIL_OK);
  return s;
}

class Sim {
 public:
  Sim() : Sim(filled<mobil_options>(MOBIL_OPTIONS)) {}
  explicit Sim(const mobil_options& options) {
    char line[256] = "";
    EXPECT_EQ(mobil_create(&options, &sim_, line, sizeof line), MOBIL_OK) << line;
  }
  ~Sim() { mobil_destroy(sim_); }
  Sim(const Sim&) = delete;
  Sim& operator=(const Sim&) = delete;

  operator mobil_sim*() const { return sim_; }
  std::uint64_t hash() const {
    unsigned int half[2] = {};
    EXPECT_EQ(mobil_hash(sim_, half), MOBIL_OK);
    return half[0] | std::uint64_t{half[1]} << 32;
  }
  std::string message() const { return mobil_message(sim_); }

 private:
  mobil_sim* sim_ = nullptr;
};

/// Returns people in a row, with different bodies and gaits.
inline std::vector<mobil_person> some_people(std::size_t count) {
  std::vector<mobil_person> people(count, filled<mobil_person>(MOBIL_PERSON));
  for (std::size_t i = 0; i < count; ++i) {
    people[i].height_m = 1.6F + 0.01F * static_cast<float>(i % 30);
    people[i].mass_kg = 60 + static_cast<float>(i % 7);
    people[i].given = MOBIL_SPEED;
    people[i].speed_m_s = 0.9F + 0.05F * static_cast<float>(i % 9);
    people[i].place[0] = static_cast<float>(i);
    people[i].heading_rad = 0.3F * static_cast<float>(i % 5);
  }
  return people;
}

inline std::vector<mobil_id> spawn(const Sim& sim, std::size_t count, const mobil_muscles* muscles = nullptr) {
  const auto people = some_people(count);
  std::vector<mobil_id> ids(count);
  EXPECT_EQ(mobil_spawn(sim, people.data(), 0, count, muscles, ids.data()), MOBIL_OK) << sim.message();
  return ids;
}

/// Returns a person's state and features as bits.
inline int bits_of(const Sim& sim, mobil_id id) {
  int state = -1, has = -1;
  EXPECT_EQ(mobil_get_state(sim, id, &state), MOBIL_OK);
  EXPECT_EQ(mobil_has(sim, id, &has), MOBIL_OK);
  return state | has;
}

/// Returns the equivalent C++ requests.
inline std::vector<SpawnRequest> as_requests(const std::vector<mobil_person>& people) {
  std::vector<SpawnRequest> requests(people.size());
  for (std::size_t i = 0; i < people.size(); ++i) {
    requests[i].body.height_m = people[i].height_m;
    requests[i].body.mass_kg = people[i].mass_kg;
    requests[i].gait.speed_m_s = people[i].speed_m_s;
    requests[i].x_m = people[i].place[0];
    requests[i].heading_rad = people[i].heading_rad;
  }
  return requests;
}

inline mobil_options unreal() {
  auto options = filled<mobil_options>(MOBIL_OPTIONS);
  options.axes = MOBIL_AXES_UNREAL;
  options.units_per_m = 100;
  return options;
}

/// Five equal people in Unreal's axes (C) and in the library's axes (C++).
struct Twins {
  Twins() : sim(unreal()) {
    std::vector<mobil_person> people = some_people(5);
    const std::vector<SpawnRequest> requests = as_requests(people);
    for (std::size_t i = 0; i < 5; ++i) {
      people[i].place[0] = 0;
      people[i].place[1] = -100 * static_cast<float>(i);  // there y is to the right
    }
    ids.resize(5);
    EXPECT_EQ(mobil_spawn(sim, people.data(), 0, 5, nullptr, ids.data()), MOBIL_OK) << sim.message();
    entities.resize(5);
    EXPECT_TRUE(simulation.spawn(requests, entities));
  }

  Sim sim;
  Simulation simulation;
  std::vector<mobil_id> ids;
  std::vector<Entity> entities;
};

/// Sets `out` as the target: three floats for each position, or six with normals.
template <class Target>
void aim(Target& target, std::vector<float>& out, bool normals) {
  target.positions = out.data();
  target.position_bytes = out.size() * sizeof(float);
  if (!normals) return;
  target.normals = out.data() + 3;
  target.position_stride = target.normal_stride = 24;
  target.normal_bytes = target.position_bytes - 12;
}

inline mobil_muscles modal_muscles() {
  auto muscles = filled<mobil_muscles>(MOBIL_MUSCLES);
  muscles.method = MOBIL_MODAL;
  muscles.muscles = 1U << MOBIL_HAMSTRINGS | 1U << MOBIL_TRICEPS_SURAE;
  muscles.modes = 4;
  return muscles;
}

}  // namespace mobil::c_test
