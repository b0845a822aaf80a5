// Memory of a crowd: no allocation in steady ticks, all memory of a world from its caller, no change if an allocation
// fails, and a bounded size a person.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <memory_resource>
#include <new>
#include <span>
#include <vector>

#include <mobil/engine/world.h>
#include <mobil/muscle_library.h>
#include "tests/engine/counting_heap.h"
#include "tests/engine/counting_malloc.h"
#include "tests/engine/engine_counting_memory.h"
#include "tests/engine/wilful_pool.h"
#include "tests/labels.h"
#include "tests/simulation/crowd_play.h"

MOBIL_TEST_LABELS("threads;long");

namespace mobil::crowd_memory_test {
using play::coarse;

/// One of the effects, and all together.
struct Effects {
  bool forces = false;
  LegMuscles muscles;
};

std::vector<Effects> every_effect() {
  std::vector<Effects> all;
  for (const MuscleMethod& method : play::every_method()) {
    for (const bool more : {false, true}) {
      Effects e{more, {.method = method.method, .modal = method.modal, .inertia = more, .line_motion = more}};
      if (more && method.method == Method::explicit_central) e.muscles.drive = Drive::force;
      e.muscles.muscles = 0;
      e.muscles.muscles.set(static_cast<std::size_t>(Muscle::hamstrings));
      all.push_back(e);
    }
  }
  return all;
}

TEST(CrowdMemory, SteadyTicksAllocateNothingOnAnyThreads) {
  CountingMemory memory;
  const auto effects = every_effect();
  WilfulPool wilful(3);
  const std::vector<SimulationOptions> options = {
      {.memory = &memory}, {.threads = 2, .memory = &memory}, {.jobs = wilful.jobs(), .memory = &memory}};
  for (const SimulationOptions& o : options) {
    Simulation simulation(sharing(o));
    for (std::size_t i = 0; i < 2 * effects.size(); ++i) {
      const Effects& e = effects[i % effects.size()];
      const Entity person = join(simulation, sample_person(static_cast<int>(i)), false);
      if (e.forces) {
        EXPECT_EQ(simulation.enable(person, Feature::forces), Status::ok);
      }
      const auto added = simulation.set_muscles(person, e.muscles);
      ASSERT_TRUE(added) << added.error().message;
      if (i % 2 == 0) {
        EXPECT_TRUE(simulation.enable({&person, 1}, Feature::step_events));
      }
      // a change of method has faded before counting starts
      if (i % 3 == 0) {
        EXPECT_TRUE(simulation.set_method(person, Muscle::hamstrings, {Method::statics}));
      }
    }
    for (int i = 0; i < 80; ++i) simulation.tick();
    const std::size_t heap = heap_requests, all = malloc_requests, lent = memory.requests;
    ASSERT_GT(heap, 0U);  // the counters count
    ASSERT_TRUE(all > 0 || !counts_malloc);
    for (int i = 0; i < 60; ++i) simulation.advance(1.0 / 60);
    EXPECT_EQ(heap_requests - heap, 0U);
    EXPECT_EQ(memory.requests - lent, 0U);
    EXPECT_EQ(malloc_requests - all, 0U) << "libraries included";
  }
}

TEST(CrowdMemory, AllMemoryIsTheCallersAndReturned) {
  CountingMemory memory;
  std::size_t people = 0;
  {
    play::Crowd crowd(sharing({.memory = &memory}), {.at_first = 20, .comers = 20});
    // no memory of a world is elsewhere: the default resource lends none
    std::pmr::memory_resource* before = std::pmr::set_default_resource(std::pmr::null_memory_resource());
    for (int i = 0; i < 90; ++i) crowd.tick();
    std::pmr::set_default_resource(before);
    people = crowd.people().size();
    EXPECT_GT(memory.lent(), people);
  }
  EXPECT_EQ(memory.lent(), 0U);
}

/// Returns a hash of all people: handles and state, and the facade's view of them.
std::uint64_t all_of(const Simulation& simulation, const std::vector<Entity>& people) {
  std::uint64_t hash = hash_world(simulation);
  for (const Entity person : people) hash = fnv(hash_person(simulation, person), static_cast<std::uint32_t>(hash));
  return hash;
}

using Change = std::function<void(Simulation&, std::vector<Entity>&)>;
enum class Refuses { resource, heap };

/// Runs `change` with one more allowed request each time until it succeeds. A refusal must not change anything, and the
/// final result must equal that with sufficient memory.
void refuse_at_every_request(const Change& change, Refuses who) {
  const auto make = [&](CountingMemory& memory, std::vector<Entity>& people) {
    SimulationOptions options;
    if (who == Refuses::resource) options.memory = &memory;
    auto simulation = std::make_unique<Simulation>(options);
    static const std::vector<std::byte> usual = [] {
      Simulation first;
      join(first, sample_person(0));
      return first.muscle_library().bake();
    }();
    EXPECT_TRUE(simulation->muscle_library().load(usual));  // and makes other data itself
    people.reserve(32);
    for (int i = 0; i < 16; ++i) people.push_back(join(*simulation, sample_person(i), i % 4 == 0));
    for (int i = 0; i < 5; ++i) simulation->tick();
    return simulation;
  };
  CountingMemory memory, enough;
  std::vector<Entity> people, others;
  const auto simulation = make(memory, people), other = make(enough, others);
  const auto asked = [&] { return who == Refuses::resource ? enough.requests : heap_requests.load(); };
  const std::size_t before_requests = asked();
  change(*other, others);
  const std::size_t requests = asked() - before_requests;
  // Making templates needs many allocations; MOBIL_LONG tests more of them.
  const std::size_t stride = requests / (std::getenv("MOBIL_LONG") != nullptr ? 60 : 20) + 1;
  other->tick();
  for (std::size_t granted = 0;; granted += stride) {
    const std::uint64_t before = all_of(*simulation, people);
    const std::size_t rows_before = rows(simulation->world()), count = people.size();
    if (who == Refuses::resource) memory.refuse_after = granted;
    if (who == Refuses::heap) heap_refuse_at = heap_requests + granted;
    bool refused = false;
    try {
      change(*simulation, people);
    } catch (const std::bad_alloc&) {
      refused = true;
    }
    memory.refuse_after = heap_refuse_at = SIZE_MAX;
    if (!refused) break;
    ASSERT_LT(granted, requests);
    ASSERT_EQ(people.size(), count);
    EXPECT_EQ(rows(simulation->world()), rows_before) << "at request " << granted << " of " << requests;
    ASSERT_EQ(all_of(*simulation, people), before) << "at request " << granted << " of " << requests;
  }
  simulation->tick();
  ASSERT_EQ(people.size(), others.size());
  for (std::size_t i = 0; i < people.size(); ++i) {
    EXPECT_EQ(people[i], others[i]) << "person " << i;  // no handle is lost by a refusal
    EXPECT_EQ(hash_person(*simulation, people[i]), hash_person(*other, others[i])) << "person " << i;
  }
}

void refuse_at_every_request(const Change& change) {
  refuse_at_every_request(change, Refuses::resource);
  refuse_at_every_request(change, Refuses::heap);
}

void add(Simulation& simulation, Entity person, const LegMuscles& choice) {
  const auto added = simulation.set_muscles(person, choice);
  ASSERT_TRUE(added) << added.error().message;
}

TEST(CrowdMemory, SpawnWithoutMemoryChangesNothing) {
  refuse_at_every_request([](Simulation& simulation, std::vector<Entity>& people) {
    people.push_back(*simulation.spawn(sample_person(20).body, sample_person(20).gait));
  });
  refuse_at_every_request([](Simulation& simulation, std::vector<Entity>& people) {
    people.push_back(*simulation.spawn_posed(sample_person(20).body));
  });
}

TEST(CrowdMemory, AddingMusclesWithoutMemoryChangesNothing) {
  refuse_at_every_request([](Simulation& simulation, std::vector<Entity>& people) {
    add(simulation, people[1], {.method = Method::newmark});
  });
}

TEST(CrowdMemory, AChangeOfMethodWithoutMemoryChangesNothing) {
  refuse_at_every_request([](Simulation& simulation, std::vector<Entity>& people) {
    EXPECT_TRUE(simulation.set_method(people[0], Muscle::hamstrings, {Method::statics}));
  });
  refuse_at_every_request([](Simulation& simulation, std::vector<Entity>& people) {
    EXPECT_TRUE(simulation.set_muscles(people[0], {.drive = Drive::force, .inertia = true}));
  });
}

TEST(CrowdMemory, AddingEffectsWithoutMemoryChangesNothing) {
  refuse_at_every_request([](Simulation& simulation, std::vector<Entity>& people) {
    EXPECT_EQ(simulation.enable(people[0], Feature::forces), Status::ok);
  });
}

TEST(CrowdMemory, EventsAndPlacementWithoutMemoryChangeNothing) {
  refuse_at_every_request([](Simulation& simulation, std::vector<Entity>& people) {
    ASSERT_TRUE(simulation.enable(people, Feature::step_events));
  });
  refuse_at_every_request([](Simulation& simulation, std::vector<Entity>& people) {
    ASSERT_TRUE(simulation.enable(people, Feature::fat));
  });
  refuse_at_every_request([](Simulation& simulation, std::vector<Entity>& people) {
    std::vector<PlaceRequest> places;
    for (const Entity person : people) places.push_back({person, static_cast<float>(person.index), 5, 1});
    ASSERT_TRUE(simulation.place(places));
  });
}

TEST(CrowdMemory, BatchSpawnWithMusclesIsAllOrNone) {
  LegMuscles far{.method = Method::modal, .modal = play::modal(12, true, false)}, near = far;
  near.modal.control_points = true;
  const std::array<LegMuscles, 4> choices = {near,
                                             {.method = Method::implicit_central, .inertia = true},
                                             far,
                                             {.drive = Drive::force, .method = Method::none}};
  refuse_at_every_request([&](Simulation& simulation, std::vector<Entity>& people) {
    std::vector<SpawnRequest> requests;
    for (int i = 0; i < 8; ++i) {
      requests.push_back({.body = sample_person(20 + i).body, .gait = sample_person(20 + i).gait});
      if (i % 5 != 0) requests.back().muscles = choices[static_cast<std::size_t>(i % 4)];
    }
    std::vector<Entity> come(requests.size());
    const auto done = simulation.spawn(requests, come);
    ASSERT_TRUE(done) << done.error().message;
    people.insert(people.end(), come.begin(), come.end());
  });
}

TEST(CrowdMemory, DespawnAllocatesNothing) {
  CountingMemory memory;
  Simulation simulation(sharing({.memory = &memory}));
  std::vector<Entity> people;
  for (int i = 0; i < 40; ++i) people.push_back(join(simulation, sample_person(i), i % 2 == 0));
  const std::span<const Entity> all = people;
  const std::array<Entity, 2> twice = {people[20], people[20]};
  memory.refuse_after = 0;
  heap_refuse_at = 0;
  const auto refused = simulation.despawn(twice);
  bool gone = true;
  for (const Entity person : all.first(20)) gone = simulation.despawn(person) == Status::ok && gone;
  for (const Entity person : all.subspan(20, 4))
    gone = simulation.set_muscles(person, std::nullopt) != Status::stale_entity && gone;
  gone = simulation.despawn(all.subspan(20)) == Status::ok && gone;
  memory.refuse_after = heap_refuse_at = SIZE_MAX;
  EXPECT_EQ(refused, Status::stale_entity);
  EXPECT_TRUE(gone);
  EXPECT_EQ(rows(simulation.world()), 0U);
}

/// Data shared by bodies is on the heap, made once. A person's own data is in the caller's memory.
TEST(CrowdMemory, PeopleKeepNothingOnTheHeap) {
  CountingMemory memory;
  Simulation simulation(sharing({.memory = &memory}));
  const auto effects = every_effect();
  std::vector<Entity> people;
  const auto grow_to = [&](std::size_t count) {
    while (people.size() < count) {
      const Effects& e = effects[people.size() % effects.size()];
      people.push_back(join(simulation, sample_person(static_cast<int>(people.size() % (4 * effects.size()))), false));
      if (e.forces) {
        EXPECT_EQ(simulation.enable(people.back(), Feature::forces), Status::ok);
      }
      add(simulation, people.back(), e.muscles);
    }
    simulation.tick();
    return heap_lent - memory.lent_bytes();  // which the heap lends as well
  };
  const std::size_t some = grow_to(4 * effects.size()), many = grow_to(40 * effects.size());
  std::printf("%zu bytes for %zu people more\n", many - some, 36 * effects.size());
  EXPECT_LT(many, some + 36 * effects.size() * 100);  // the counting itself uses some memory
}

TEST(CrowdMemory, GrowsWithPeopleAndShrinksWithThem) {
  MOBIL_SLOW();
  CountingMemory memory;
  Simulation simulation(sharing({.memory = &memory}));
  LegMuscles choice{.method = Method::modal, .modal = play::modal(12, true, false)};
  std::vector<Entity> people;
  const auto grow_to = [&](std::size_t count) {
    std::vector<SpawnRequest> more(64);
    for (std::size_t i = 0; i < more.size(); ++i) {
      const SamplePerson p = sample_person(static_cast<int>(i));
      more[i].body = p.body, more[i].gait = p.gait, more[i].muscles = choice;
    }
    while (people.size() < count) {
      people.resize(people.size() + more.size());
      const auto came = simulation.spawn(more, std::span(people).last(more.size()));
      EXPECT_TRUE(came) << came.error().message;
    }
    simulation.tick();
    return static_cast<double>(memory.lent_bytes());
  };
  // A table's memory grows by up to 2 MB at once, which is little for this many people.
  const double few = grow_to(1280), some = grow_to(2560), many = grow_to(5120);
  const double each = (some - few) / 1280, each_later = (many - some) / 2560;
  EXPECT_LT(each, 8192);                       // at the far tier
  EXPECT_NEAR(each_later, each, 0.25 * each);  // tables have spare capacity
  EXPECT_LT(many, 1.25 * each * 5120);         // memory independent of people is small
  while (people.size() > 1280) {
    EXPECT_EQ(simulation.despawn(people.back()), Status::ok);
    people.pop_back();
  }
  simulation.tick();
  EXPECT_LT(static_cast<double>(memory.lent_bytes()), few + 0.5 * (some - few));
}

}  // namespace mobil::crowd_memory_test
