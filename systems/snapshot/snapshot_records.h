#pragma once
// What a snapshot has beside a world, as plain records without padding.

#include <cstdint>
#include <cstring>

#include "systems/bellies/leg_muscles_io.h"

namespace mobil::inline v0_3 {

struct FrontHeader {
  std::int64_t tick_units, remainder_units;
  std::uint32_t tick, resources, modules, parts, globals, global_bytes;
};

/// A part that rows have and no module names: for messages.
struct SavedPartName {
  std::uint64_t id;
  char name[56];  // its beginning, zeros behind
};

/// A module that rows have parts of.
struct SavedModule {
  char name[60];  // its beginning, zeros behind
  std::uint32_t version;
};

/// A global that is not at its first value; its bytes lie behind the list, one after the other.
struct SavedGlobal {
  std::uint64_t id, bytes;
};

/// `named`: a module's, by names.
enum class ResourceKind : std::uint32_t { unknown, choice, shape, lines, solver, basis, finite, named };

/// What a shared resource is made from, in one form: what it does not depend on is as in a LegMuscles{}. Of a choice of
/// muscles `choice` is the resource itself; its `muscle` is max_muscles: any.
struct Recipe {
  ResourceKind kind;
  std::uint32_t muscle;
  LegMusclesWords choice;
  std::uint64_t dt, across, along;             // of a solver: doubles; of a basis across / along and their product;
                                               // of a named one: hashes of the module's name and its own, its part
  std::uint32_t method, mass, modes, spare;    // of a solver; of a basis

  friend bool operator==(const Recipe& a, const Recipe& b) { return std::memcmp(&a, &b, sizeof(a)) == 0; }
};

/// A resource that a table with rows has, by its number in the world that was saved; these ascend.
struct SavedResource {
  Recipe recipe;
  std::uint64_t fingerprint;  // of its numbers
  std::uint32_t number, spare;
};

}  // namespace mobil::inline v0_3
