#pragma once
// Changes of a snapshot, resealed as an adversary would: positions of four bytes, and their new values.

#include <cmath>
#include <vector>

#include <mobil/engine/world.h>
#include <mobil/simulation.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/systems/snapshot/restore_limits.h>
#include <mobil/systems/surfaces/nodal_view.h>
#include "tests/fuzz/fuzz_input.h"
#include "tests/simulation/reseal.h"

namespace mobil::fuzz {

/// Three people whose rows have most kinds of components, and their snapshot.
class SmallWorld {
 public:
  SmallWorld() {
    LegMuscles choice;
    choice.muscles.reset();
    choice.muscles.set(static_cast<std::size_t>(Muscle::hamstrings));
    choice.modal.modes = 4;
    const Entity walker = *simulation.spawn({});
    (void)simulation.set_muscles(walker, choice);
    (void)simulation.enable(walker, Feature::forces);
    choice.method = Method::explicit_central;
    choice.activation = ExcitationSource::host;
    (void)simulation.set_muscles(*simulation.spawn_posed({}), choice);
    const Entity sleeper = *simulation.spawn({.height_m = 1.6F, .mass_kg = 60});
    for (int i = 0; i < 3; ++i) simulation.tick();
    (void)simulation.set_state({&sleeper, 1}, PersonState::asleep);
    bytes.resize(simulation.snapshot_bytes());
    bytes.resize(*simulation.save(bytes));
    hash = simulation.state_hash();
  }

  Simulation simulation;
  std::vector<std::byte> bytes;
  std::uint64_t hash = 0;
};

inline void fuzz_snapshot(Input input) {
  static SmallWorld world;
  std::vector<std::byte> bytes = world.bytes;
  Numbers numbers(input);
  while (!numbers.empty()) {
    // Half of the changes are in the lists, which are short and describe the rows.
    const std::size_t reach = numbers.byte() % 2 == 0 ? std::min<std::size_t>(bytes.size(), 4096) : bytes.size();
    const std::size_t at = 32 + (numbers.word() % (reach - 36)) / 4 * 4;
    std::uint32_t value;
    std::memcpy(&value, &bytes[at], 4);
    switch (numbers.byte() % 8) {
      case 0:
        value = 0;
        break;
      case 1:
        value = 0xffffffff;
        break;
      case 2:
        value += 1;
        break;
      case 3:
        value -= 1;
        break;
      case 4:
        value ^= 1U << numbers.byte() % 32;
        break;
      case 5:
        value = 0x7fc00000;
        break;
      case 6:
        value = numbers.byte();
        break;
      default:
        value = numbers.word();
    }
    std::memcpy(&bytes[at], &value, 4);
  }
  (void)reseal_snapshot(bytes);
  Simulation& simulation = world.simulation;
  const RestoreLimits limits{.rows = 1000, .mesh_nodes = 0, .seconds = 1, .steps = 200};
  if (held(simulation.restore(bytes, limits))) {
    for (int i = 0; i < 3; ++i) simulation.tick();
    for (const Entity person : simulation.people()) {
      (void)simulation.person(person);
      (void)simulation.get<Pose>(person);
      (void)held(simulation.change_gait(person, {.speed_m_s = 1.1F}));
      for (const MuscleRef& own : simulation.muscles(person))
        (void)nodal_displacement(simulation.world(), own.entity[Side::left]);
    }
    (void)simulation.state_hash();
    promise(held(simulation.restore(world.bytes, RestoreLimits::none())),
            "a good snapshot is restored after any other");
  }
  promise(simulation.state_hash() == world.hash, "what is refused changes nothing");
}

}  // namespace mobil::fuzz
