// The state as bytes, and back.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cstring>
#include <vector>

#include <mobil/components/gait.h>
#include <mobil/engine/world.h>
#include <mobil/simulation.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/systems/snapshot/restore_limits.h>
#include <mobil/systems/surfaces/nodal_view.h>
#include "engine/snapshot.h"
#include "engine/snapshot_bytes.h"
#include "systems/snapshot/snapshot_records.h"
#include "tests/engine/engine_counting_memory.h"
#include "tests/labels.h"
#include "tests/refused.h"
#include "tests/simulation/crowd_play.h"
#include "tests/simulation/people.h"
#include "tests/simulation/reseal.h"
#include "tests/simulation/simulation_hash.h"

MOBIL_TEST_LABELS("threads;long");

namespace mobil::snapshot_test {
using Bytes = std::vector<std::byte>;

Bytes saved(const Simulation& simulation) {
  Bytes bytes(simulation.snapshot_bytes());
  const auto done = simulation.save(bytes);
  EXPECT_TRUE(done) << done.error().message;
  EXPECT_EQ(done.value_or(0), bytes.size());
  return bytes;
}

void restore(Simulation& simulation, const Bytes& bytes) {
  const auto done = simulation.restore(bytes, RestoreLimits::none());
  ASSERT_TRUE(done) << done.error().message;
}

/// Makes the changes of a tick, determined by the tick, the seed and handles.
void disturb(Simulation& simulation, std::vector<Entity>& people, std::uint64_t seed) {
  const std::uint64_t what = play::mixed(seed, simulation.ticks(), 1), how = play::mixed(seed, simulation.ticks(), 2);
  if (what % 3 == 0) {
    const auto who = static_cast<int>(how % 1000);
    const auto person = what % 4 == 0 ? simulation.spawn_posed(sample_person(who).body)
                                      : simulation.spawn(sample_person(who).body, sample_person(who).gait);
    ASSERT_TRUE(person);
    people.push_back(*person);
    if (what % 5 != 0) {
      ASSERT_TRUE(simulation.set_muscles(*person, play::choice_of(how / 7)));
    }
  }
  if (people.size() < 5) return;
  const Entity one = people[how % people.size()], other = people[how / 1000 % people.size()];
  if (what % 7 == 1) {
    ASSERT_EQ(simulation.despawn(one), Status::ok);
    std::erase(people, one);
  }
  if (!simulation.world().alive(other)) return;
  const bool walks = !simulation.person(other)->posed;
  if (what % 6 == 1) (void)simulation.set_method(other, Muscle::hamstrings, play::every_method()[how % 9]);
  if (what % 6 == 2 && walks) {
    ASSERT_TRUE(simulation.change_gait(other, {.speed_m_s = how % 3 == 0 ? 0.0F : 1.2F}));
  }
  if (what % 6 == 3 && walks) {
    ASSERT_TRUE(simulation.turn_to(other, static_cast<float>(how % 6) - 3));
  }
  if (what % 6 == 4) simulation.enable(other, Feature::forces);
  if (what % 6 == 5) simulation.set_muscles(other, std::nullopt);
}

struct Told {
  std::vector<std::uint64_t> hashes;
  std::vector<Entity> people;
};

Told run(Simulation& simulation, std::vector<Entity> people, int ticks, std::uint64_t seed) {
  Told told;
  for (int t = 0; t < ticks; ++t) {
    disturb(simulation, people, seed);
    simulation.tick();
    told.hashes.push_back(simulation.state_hash());
  }
  told.people = people;
  return told;
}

TEST(Snapshot, ContinuesWithTheSameBitsAndHandlesAnywhere) {
  Simulation simulation(sharing({.threads = 2}));
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    std::vector<Entity> people = simulation.people();
    people = run(simulation, people, 25, seed).people;
    const std::uint64_t before = simulation.state_hash(), world = hash_world(simulation);
    const Bytes bytes = saved(simulation);
    const Told first = run(simulation, people, 20, seed + 10);

    restore(simulation, bytes);
    EXPECT_EQ(simulation.state_hash(), before);
    EXPECT_EQ(hash_world(simulation), world);
    EXPECT_EQ(saved(simulation), bytes);
    for (const Entity one : people) EXPECT_TRUE(simulation.is_person(one));
    const Told again = run(simulation, people, 20, seed + 10);
    EXPECT_EQ(again.hashes, first.hashes);
    EXPECT_EQ(again.people, first.people);

    Simulation fresh;  // makes shared data itself
    restore(fresh, bytes);
    EXPECT_EQ(fresh.state_hash(), before);
    const Told elsewhere = run(fresh, people, 20, seed + 10);
    EXPECT_EQ(elsewhere.hashes, first.hashes);
    EXPECT_EQ(elsewhere.people, first.people);
  }
}

/// Spawns a few people with muscles of every method. One muscle fades.
std::vector<Entity> few(Simulation& simulation) {
  std::vector<Entity> people;
  for (int i = 0; i < 9; ++i) {
    people.push_back(join(simulation, sample_person(i), false));
    EXPECT_TRUE(simulation.set_muscles(people.back(), play::choice_of(static_cast<std::uint64_t>(i))));
  }
  simulation.tick();
  EXPECT_TRUE(simulation.set_method(people[0], Muscle::hamstrings, {Method::statics}));
  simulation.tick();
  return people;
}

TEST(Snapshot, IncludesUnspentTime) {
  Simulation simulation(sharing());
  few(simulation);
  simulation.advance(0.03);
  const Bytes bytes = saved(simulation);
  const auto first = simulation.advance(0.005);
  restore(simulation, bytes);
  const auto again = simulation.advance(0.005);
  EXPECT_EQ(first.count, again.count);
  EXPECT_EQ(first.alpha, again.alpha);
}

TEST(Snapshot, LaterHandlesAreStaleAfterRestoring) {
  Simulation simulation(sharing());
  const auto people = few(simulation);
  const Bytes bytes = saved(simulation);
  ASSERT_EQ(simulation.despawn(people[3]), Status::ok);
  const Entity late = *simulation.spawn({});
  const Entity later = *simulation.spawn({});
  restore(simulation, bytes);
  EXPECT_FALSE(simulation.is_person(late));
  EXPECT_FALSE(simulation.world().alive(later));
  EXPECT_TRUE(simulation.is_person(people[3]));
  EXPECT_TRUE(simulation.world().alive(simulation.muscle(people[3], Muscle::hamstrings, Side::left)));
}

/// Expects a refusal in one line that changes nothing.
void expect_refused(Simulation& simulation, std::span<const std::byte> bytes, const std::string& about = "") {
  const std::uint64_t world = hash_world(simulation), state = simulation.state_hash();
  EXPECT_TRUE(is_refused(simulation.restore(bytes, RestoreLimits::none()), "restore: ", about));
  EXPECT_EQ(hash_world(simulation), world);
  EXPECT_EQ(simulation.state_hash(), state);
}

TEST(Snapshot, AlteredBitIsRefused) {
  Simulation simulation(sharing());
  few(simulation);
  Bytes bytes = saved(simulation);
  rc::check([&] {
    const auto at = *rc::gen::inRange<std::size_t>(0, bytes.size());
    const auto bit = static_cast<std::byte>(1U << *rc::gen::inRange(0, 8));
    bytes[at] ^= bit;
    expect_refused(simulation, bytes);
    bytes[at] ^= bit;
  });
  for (std::size_t at = 0; at < 64; ++at) {
    bytes[at] ^= std::byte{16};
    expect_refused(simulation, bytes);
    bytes[at] ^= std::byte{16};
  }
  restore(simulation, bytes);
}

TEST(Snapshot, CutOrPaddedBytesAreRefused) {
  Simulation simulation(sharing());
  few(simulation);
  Bytes bytes = saved(simulation);
  rc::check([&] {
    const auto length = *rc::gen::inRange<std::size_t>(0, bytes.size());
    expect_refused(simulation, std::span(bytes).first(length));
  });
  bytes.resize(bytes.size() + 8);
  expect_refused(simulation, bytes, "cut or padded");
}

TEST(Snapshot, OtherVersionsAndByteOrdersAreRefusedByName) {
  Simulation simulation(sharing());
  few(simulation);
  Bytes bytes = saved(simulation);
  const std::byte own = bytes[8];
  for (const int version : {std::to_integer<int>(own) - 1, std::to_integer<int>(own) + 1}) {
    bytes[8] = static_cast<std::byte>(version);
    expect_refused(simulation, bytes, fmt::format("version {}", version));
  }
  bytes[8] = own;
  std::swap(bytes[12], bytes[15]);
  std::swap(bytes[13], bytes[14]);
  expect_refused(simulation, bytes, "byte order");
}

TEST(Snapshot, SmallBuffersAndOtherTicksAreRefused) {
  Simulation simulation(sharing());
  few(simulation);
  Bytes bytes = saved(simulation);
  EXPECT_FALSE(simulation.save(std::span(bytes).first(bytes.size() - 1)));
  Simulation faster(sharing({.tick_s = 1.0 / 120}));
  expect_refused(faster, bytes, "tick_s");
}

TEST(Snapshot, DifferingResourcesAreRefused) {
  Simulation simulation(sharing()), fresh;
  few(simulation);
  Bytes bytes = saved(simulation);
  FrontHeader header;
  std::memcpy(&header, &bytes[SnapshotLayout::header_bytes], sizeof(header));
  const std::size_t resources = SnapshotLayout::header_bytes + sizeof(header) + header.modules * sizeof(SavedModule);
  bytes[resources + offsetof(SavedResource, fingerprint)] ^= std::byte{1};
  ASSERT_TRUE(reseal_snapshot(bytes));
  EXPECT_TRUE(is_refused(fresh.restore(bytes, RestoreLimits::none()), "otherwise"));
  EXPECT_EQ(fresh.people().size(), 0U);
}

/// Control points of modal muscles are left out and reproduced bit-exactly, also for muscles that have just been added
/// or changed, before any tick.
TEST(Snapshot, ControlPointsAreOmittedAndReproduced) {
  Simulation simulation(sharing());
  std::vector<Entity> people;
  for (int i = 0; i < 20; ++i) {
    people.push_back(*simulation.spawn(sample_person(1).body, sample_person(i).gait));
    LegMuscles choice;
    choice.method = Method::modal;
    choice.modal.moving = i % 3 != 0;
    choice.inertia = i % 2 == 0;
    ASSERT_TRUE(simulation.set_muscles(people.back(), choice));
  }
  const auto expect_same = [&](const char* when) {
    Simulation other(sharing());
    restore(other, saved(simulation));
    EXPECT_EQ(other.state_hash(), simulation.state_hash()) << when;
    const Entity one = simulation.muscle(people[1], Muscle::quadriceps, Side::left);
    const NodalView ours = nodal_displacement(simulation.world(), one), theirs = nodal_displacement(other.world(), one);
    ASSERT_GT(ours.nodes, 0U);
    for (std::size_t w = 0; w < 3 * std::size_t{ours.nodes}; ++w)
      ASSERT_EQ(ours.first[w * lane_count], theirs.first[w * lane_count]) << when;
  };
  expect_same("just begun");
  simulation.tick(7);
  expect_same("after ticks");
  for (std::size_t i = 0; i < people.size(); i += 2) {
    MuscleMethod method{Method::modal, {}};
    method.modal.modes = 8;
    ASSERT_TRUE(simulation.set_method(people[i], Muscle::quadriceps, method));
  }
  expect_same("just changed");
  std::size_t rows = 0, points = 0;
  for (const Table& table : simulation.world().tables()) {
    rows += table.block_count() * table.words() * sizeof(Lanes<float>);
    const ComponentId* const part = find_component(table.key(), type_id<NodalDisplacement>());
    if (part != nullptr) points += table.block_count() * part->value * sizeof(Lanes<float>);
  }
  EXPECT_GT(points, 100'000U);
  EXPECT_LT(simulation.snapshot_bytes(), rows - points + 100'000);
}

/// A snapshot is refused if it marks a stored column as left out, or the left-out column as stored.
TEST(Snapshot, OnlyReproducibleColumnsCanBeOmitted) {
  Simulation simulation(sharing());
  const Entity one = *simulation.spawn(sample_person(1).body, sample_person(1).gait);
  LegMuscles choice;
  choice.method = Method::modal;
  ASSERT_TRUE(simulation.set_muscles(one, choice));
  simulation.tick(3);
  const Bytes bytes = saved(simulation);
  std::uint64_t world_at = 0;
  std::memcpy(&world_at, &bytes[32], sizeof world_at);
  world_at += SnapshotLayout::header_bytes;
  std::uint64_t world_bytes = 0;
  std::memcpy(&world_bytes, &bytes[40], sizeof world_bytes);
  const auto refused = [&](Bytes altered) {
    EXPECT_TRUE(reseal_snapshot(altered));
    Simulation other(sharing());
    const auto done = other.restore(altered);
    EXPECT_FALSE(done);
    EXPECT_EQ(other.ticks(), 0U);
  };
  std::size_t flags = 0;
  for (std::size_t at = world_at; at + 24 <= world_at + world_bytes; at += 4) {
    SavedPart part;
    std::memcpy(&part, &bytes[at], sizeof part);
    if (part.id != type_id<NodalDisplacement>() && part.id != type_id<Pose<float>>()) continue;
    ++flags;
    Bytes altered = bytes;
    part.left_out = 1 - part.left_out;
    std::memcpy(&altered[at], &part, sizeof part);
    refused(altered);
  }
  EXPECT_GT(flags, 4U);
}

}  // namespace mobil::snapshot_test
