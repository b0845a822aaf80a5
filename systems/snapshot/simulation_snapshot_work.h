#pragma once
// What saving and restoring keep from one time to the next, and what a snapshot's front holds. Part of the front door.

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "engine/module.h"
#include "engine/snapshot.h"
#include "systems/muscles/change_muscles.h"
#include "systems/people/simulation_people.h"
#include "systems/snapshot/simulation_resources.h"
#include "systems/snapshot/simulation_snapshot_records.h"

namespace mobil {

/// What rows of a saved table can be.
struct TableFacts {
  bool walker, posed;          // a person
  std::uint32_t owner_column;  // a muscle's, Table::no_column else
  std::uint32_t muscle;        // its lines', most_muscles where it has none
};

struct SnapshotWork {
  ResourceList resources;
  WorldSnapshot world;
  std::vector<std::uint8_t> used;  // resources, by number
  std::vector<SharedNumber> shared;
  std::vector<KeyPart> parts;  // of all modules
  std::vector<TableFacts> facts;
  // People and fades to be, where they are not as many as those that are there.
  People people;
  std::deque<MuscleWork::Fading> fading;
};

/// Lists of the front, each as long as its header says.
struct SavedFront {
  FrontHeader header{};
  Records<SavedModule> modules;
  Records<SavedResource> resources;
  Records<SavedChoice> choices;
  Records<SavedPerson> people;
  Records<SavedMuscle> muscles;  // one person's after the other's
  Records<SavedFading> fading;
};
/// Nothing where it is not described.
std::optional<SavedResource> find_resource(const SavedFront& front, std::uint64_t number);
Result<SavedFront> read_front(std::span<const std::byte> front);

/// The front and the rows are fit for each other and for this program: people have what walking takes, muscles are
/// their owners', numbers that lists are read by are in range. `present`: bodies that are there need no other look.
Result<void> check_people(const SavedFront& front, const SavedWorld& world, const People& present,
                          std::vector<TableFacts>& facts);
/// Parts are laid out as their modules have them, of the version that these have here, and their rows are sound.
Result<void> check_modules(const SavedFront& front, const SavedWorld& world, std::span<const Module> modules);
/// A table's shared resources are those of one muscle; and what its modules make sure of.
Result<void> check_key(const TableKey& key, const World& world, const ResourceList& resources,
                       std::span<const Module> modules);

}  // namespace mobil
