#pragma once
// Records of a snapshot in addition to its world, without padding.

#include <cstdint>
#include <cstring>

#include "systems/bellies/leg_muscles_io.h"

namespace mobil::inline v0_3 {

struct FrontHeader {
  std::int64_t tick_units, remainder_units;
  std::uint32_t tick, resources, modules, parts, globals, global_bytes;
};

/// A component on saved rows that no module names; for messages.
struct SavedPartName {
  std::uint64_t id;
  char name[56];  // truncated, padded with zeros
};

/// A module with components on saved rows, or with changed globals.
struct SavedModule {
  char name[60];  // truncated, padded with zeros
  std::uint32_t version;
};

/// A global that differs from its first value; the values are stored after the list, in its order.
struct SavedGlobal {
  std::uint64_t id, bytes;
};

/// `named`: a module's resource, found by names.
enum class ResourceKind : std::uint32_t { unknown, choice, shape, lines, solver, basis, finite, named };

/// Recipe of a shared resource in canonical form: options that do not affect it are those of LegMuscles{}. The recipe
/// of a choice of muscles has the choice itself, and max_muscles (any) as `muscle`.
struct Recipe {
  ResourceKind kind;
  std::uint32_t muscle;
  LegMusclesWords choice;
  std::uint64_t dt, across, along;             // of a solver: doubles; of a basis: across / along and their product;
                                               // of a named one: hashes of the module's and its own name, component
  std::uint32_t method, mass, modes, spare;    // of a solver; of a basis

  friend bool operator==(const Recipe& a, const Recipe& b) { return std::memcmp(&a, &b, sizeof(a)) == 0; }
};

/// A resource of a table with rows, by its number in the saved world. Numbers ascend.
struct SavedResource {
  Recipe recipe;
  std::uint64_t fingerprint;  // of its numbers
  std::uint32_t number, spare;
};

}  // namespace mobil::inline v0_3
