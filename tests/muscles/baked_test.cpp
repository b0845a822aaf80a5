// Shared data of muscles, baked into bytes and loaded again.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include <mobil/lod.h>
#include <mobil/muscle_library.h>
#include <mobil/muscle_table.h>
#include <mobil/simulation.h>
#include <mobil/systems/snapshot/restore_limits.h>
#include "engine/row_hash.h"
#include "tests/refused.h"

namespace mobil {
namespace {

/// Muscles of each method with small meshes, which are quickly baked and loaded.
std::vector<LegMuscles> choices() {
  LegMuscles one;
  one.muscles = MuscleSet(1);
  one.cells = {1, 1, 2};
  one.modal.cells = {2, 2, 4};
  one.modal.modes = 4;
  std::vector<LegMuscles> all;
  for (const Method method : {Method::explicit_central, Method::implicit_central, Method::newmark, Method::statics,
                              Method::modal, Method::finite}) {
    for (const bool inertia : {false, true}) {
      LegMuscles next = one;
      next.method = method;
      next.inertia = inertia;
      all.push_back(next);
    }
  }
  return all;
}

/// Spawns a person with that choice; each has another build.
void spawn(Simulation& simulation, std::size_t choice) {
  const auto person = simulation.spawn({.height_m = 1.65F + 0.03F * static_cast<float>(choice), .mass_kg = 72});
  ASSERT_TRUE(person);
  const auto done = simulation.set_muscles(*person, choices()[choice]);
  ASSERT_TRUE(done) << done.error().message;
}

/// Returns the hash after half a second with one person of each choice.
std::uint64_t walked(Simulation& simulation) {
  for (std::size_t choice = 0; choice < choices().size(); ++choice) spawn(simulation, choice);
  for (int i = 0; i < 30; ++i) simulation.tick();
  return simulation.state_hash();
}

std::vector<std::byte> baked_bytes() {
  Simulation simulation;
  walked(simulation);
  return simulation.muscle_library().bake();
}

/// Seals the bytes again, so that their content is checked.
void seal(std::vector<std::byte>& bytes) {
  constexpr std::size_t header = 32;
  const std::uint64_t seal = hash_bytes(bytes.data() + header, bytes.size() - header);
  std::memcpy(bytes.data() + 24, &seal, sizeof seal);
}

TEST(Baked, LoadedDataMatchesComputedData) {
  Simulation made, loaded;
  const std::uint64_t hash = walked(made);
  const std::vector<std::byte> bytes = made.muscle_library().bake();
  ASSERT_TRUE(loaded.muscle_library().load(bytes));
  EXPECT_EQ(loaded.muscle_library().bake(), bytes);
  EXPECT_EQ(walked(loaded), hash);
  EXPECT_EQ(loaded.muscle_library().bake(), bytes)
      << "something was made again, or something that was not there before";
}

TEST(Baked, LoadingAddsOnlyMissingData) {
  const std::vector<std::byte> bytes = baked_bytes();
  Simulation simulation;
  for (const std::size_t choice : {std::size_t{9}, std::size_t{5}}) spawn(simulation, choice);
  ASSERT_TRUE(simulation.muscle_library().load(bytes));
  const std::vector<std::byte> both = simulation.muscle_library().bake();
  ASSERT_TRUE(simulation.muscle_library().load(bytes));
  EXPECT_EQ(simulation.muscle_library().bake(), both);
  EXPECT_EQ(both.size(), bytes.size()) << "of what both have there is one";
}

/// Sets a scene of one muscle within 5 mm.
void set_scene_of(Simulation& simulation, Muscle muscle) {
  LodScene scene{.tolerance_m = 0.005F};
  scene.muscles = MuscleSet().set(static_cast<std::size_t>(muscle));
  ASSERT_TRUE(simulation.lod().set_scene(scene));
}

/// Loads the bytes, lets level of detail choose a method for a person's iliopsoas, and returns all baked data.
std::vector<std::byte> bytes_after_use(const std::vector<std::byte>& bytes) {
  Simulation simulation;
  EXPECT_TRUE(simulation.muscle_library().load(bytes));
  set_scene_of(simulation, Muscle::iliopsoas);
  const auto person = simulation.spawn({.height_m = 1.78F, .mass_kg = 76});
  EXPECT_TRUE(person);
  EXPECT_TRUE(simulation.lod().manage(*person));
  simulation.tick(10);
  EXPECT_NE(simulation.lod().why(*person, Muscle::iliopsoas)->method.method, Method::none);
  return simulation.muscle_library().bake();
}

TEST(Baked, PreparedMusclesOfASceneNeedNothingMore) {
  for (const Muscle muscle : {Muscle::iliopsoas, Muscle::peroneals}) {
    Simulation simulation;
    set_scene_of(simulation, muscle);
    ASSERT_TRUE(simulation.lod().prepare());
    const auto baked = simulation.muscle_library().bake();
    EXPECT_EQ(bytes_after_use(baked) == baked, muscle == Muscle::iliopsoas) << muscle_name(muscle);
  }
}

TEST(Baked, SnapshotUsesLoadedData) {
  Simulation made, loaded;
  walked(made);
  ASSERT_TRUE(loaded.muscle_library().load(made.muscle_library().bake()));
  std::vector<std::byte> snapshot(made.snapshot_bytes());
  ASSERT_TRUE(made.save(snapshot));
  const auto done = loaded.restore(snapshot, RestoreLimits::none());
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(loaded.state_hash(), made.state_hash());
}

void expect_refused(const std::vector<std::byte>& bytes, const char* what, const std::string& says) {
  Simulation simulation;
  const std::vector<std::byte> before = simulation.muscle_library().bake();
  EXPECT_TRUE(is_refused(simulation.muscle_library().load(bytes), says)) << what;
  EXPECT_EQ(simulation.muscle_library().bake(), before) << what;
}

TEST(Baked, DamagedBytesAreRefused) {
  const std::vector<std::byte> bytes = baked_bytes();
  expect_refused({}, "nothing", "no baked bellies");
  expect_refused(std::vector<std::byte>(1000, std::byte{7}), "something else", "no baked bellies");
  std::vector<std::byte> other = bytes;
  other[9] ^= std::byte{1};
  expect_refused(other, "another maker", "another version");
  for (const std::size_t kept : {std::size_t{31}, std::size_t{32}, bytes.size() / 2, bytes.size() - 1}) {
    expect_refused({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(kept)}, "cut", "bake");
  }
  std::vector<std::byte> longer = bytes;
  longer.push_back(std::byte{0});
  expect_refused(longer, "longer", "altered");
  std::mt19937 random(11);
  for (int i = 0; i < 50; ++i) {
    std::vector<std::byte> altered = bytes;
    altered[16 + random() % (bytes.size() - 16)] ^= std::byte{static_cast<unsigned char>(1U << random() % 8)};
    expect_refused(altered, "altered", "altered");
  }
}

/// With a valid seal the content can still be invalid: it is refused, or at least harmless.
TEST(Baked, InvalidContentUnderAValidSealIsHarmless) {
  const std::vector<std::byte> bytes = baked_bytes();
  std::mt19937 random(5);
  int taken = 0;
  for (int i = 0; i < 200; ++i) {
    std::vector<std::byte> altered = bytes;
    for (int word = 0; word < 3; ++word) {
      const std::size_t at = 32 + random() % (bytes.size() - 40);
      const std::uint32_t value = word == 0 ? 0xFFFFFFFFU : static_cast<std::uint32_t>(random());
      std::memcpy(altered.data() + (i % 2 == 0 ? 32 + at % 400 : at), &value, sizeof value);
    }
    seal(altered);
    Simulation simulation;
    if (!simulation.muscle_library().load(altered)) continue;
    ++taken;
    for (const LegMuscles& choice : choices()) {
      const auto person = simulation.spawn({});
      (void)simulation.set_muscles(*person, choice);
    }
    simulation.tick();
  }
  EXPECT_GT(taken, 0) << "nothing was tried";
  EXPECT_LT(taken, 200);
}

}  // namespace
}  // namespace mobil
