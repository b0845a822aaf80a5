// The host's rounding mode changes no bit of a simulation.

#include <gtest/gtest.h>

#include <cfenv>
#include <vector>

#include <mobil/avoidance.h>
#include <mobil/lod.h>
#include <mobil/muscle_library.h>
#include <mobil/pose_writer.h>
#include <mobil/simulation.h>
#include <mobil/terrain.h>
#include "tests/labels.h"
#include "tests/simulation/crowd_play.h"

MOBIL_TEST_LABELS("long");

namespace mobil::float_mode_test {

/// Requests of eight people. Their numbers are computed once, in the default mode.
const std::vector<SpawnRequest>& people() {
  static const std::vector<SpawnRequest> all = [] {
    std::vector<SpawnRequest> made(8);
    for (std::size_t i = 0; i < made.size(); ++i) {
      const auto n = static_cast<float>(i);
      made[i].body = {.height_m = 1.55F + 0.04F * n, .mass_kg = 55 + 5 * n};
      made[i].gait = {.speed_m_s = 0.7 + 0.13 * static_cast<double>(i)};
      made[i].x_m = 1.7F * n;
      made[i].heading_rad = 0.3F * n;
    }
    return made;
  }();
  return all;
}

/// Plays a scene with all kinds of calls that change state, and returns its hashes.
std::vector<std::uint64_t> play() {
  std::vector<std::uint64_t> hashes;
  Simulation simulation;
  const auto note = [&] { hashes.push_back(simulation.state_hash()); };
  std::vector<Entity> all(people().size());
  EXPECT_TRUE(simulation.spawn(people(), all));
  note();
  std::size_t i = 0;
  for (const Entity person : all) {
    LegMuscles choice;
    choice.method = play::every_method()[i].method;
    choice.modal = play::every_method()[i].modal;
    choice.muscles = MuscleSet{3};
    choice.inertia = i % 3 == 0;
    if (i % 2 == 0) choice.activation = ExcitationSource::phase;
    EXPECT_TRUE(simulation.set_muscles(person, choice));
    ++i;
  }
  for (const Feature feature : {Feature::forces, Feature::fat, Feature::step_events})
    EXPECT_TRUE(simulation.enable(all, feature));
  note();
  simulation.terrain().set_heights([](std::span<const TerrainQuery> at, std::span<TerrainHeight> out) {
    for (std::size_t p = 0; p < at.size(); ++p) out[p].height_m = at[p].x_m > 1.5F ? 0.125F : 0.0F;
  });
  EXPECT_TRUE(simulation.terrain().manage(std::span(all).first(4)));
  EXPECT_TRUE(simulation.avoidance().manage(std::span(all).last(4)));
  simulation.tick(10);
  note();
  EXPECT_TRUE(simulation.change_gait(all[1], {.speed_m_s = 1.35}));
  EXPECT_TRUE(simulation.turn_to(all[2], 1.1F));
  EXPECT_TRUE(simulation.place(all[3], 7.3F, -2.1F, 0.7F));
  EXPECT_TRUE(simulation.shift_origin(0.3F, 0.7F));
  note();
  simulation.tick(10);
  note();
  EXPECT_TRUE(simulation.set_muscles(std::span(all).first(1), std::nullopt));
  EXPECT_TRUE(simulation.set_state(all[0], PersonState::asleep));
  simulation.tick(30);
  std::vector<std::byte> bytes(simulation.snapshot_bytes());
  EXPECT_TRUE(simulation.save(bytes));
  Simulation other;
  EXPECT_TRUE(other.restore(bytes));
  EXPECT_TRUE(other.set_state(all[0], PersonState::full));
  other.tick(5);
  hashes.push_back(other.state_hash());
  for (const PoseForm form : {PoseForm::place_and_quaternion, PoseForm::matrix, PoseForm::dual_quaternion}) {
    std::vector<std::byte> poses(sizeof(float) * 16 * segment_count);
    PoseWriter writer;
    EXPECT_TRUE(writer.write(other.world(), {&all[1], 1}, 0.01,
                             {.form = form, .axes = PoseAxes::z_up, .units_per_m = 39.37F, .to_parent = true}, {poses}));
    for (const std::byte byte : poses)
      hashes.back() = play::mixed(2, hashes.back() & 0xffffff, static_cast<std::uint64_t>(byte));
  }
  LegMuscles choice;
  choice.muscles = MuscleSet{3};
  choice.method = Method::modal;
  choice.modal = play::modal(6, true, true);
  Simulation baker;
  EXPECT_TRUE(baker.muscle_library().prepare(choice));
  for (const std::byte byte : baker.muscle_library().bake()) {
    hashes.back() = play::mixed(1, hashes.back() & 0xffffff, static_cast<std::uint64_t>(byte));
  }
  return hashes;
}

TEST(FloatMode, RoundingOfTheHostChangesNoBit) {
  const auto expected = play();
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    (void)people();
    ASSERT_EQ(std::fesetround(mode), 0);
    const auto hashes = play();
    std::fesetround(FE_TONEAREST);
    EXPECT_EQ(hashes, expected);
  }
}

}  // namespace mobil::float_mode_test
