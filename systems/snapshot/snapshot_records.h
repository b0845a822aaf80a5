#pragma once
// What a snapshot has beside a world, as plain records without padding; numbers that a compiler may lay out as it likes
// are words of their own.

#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>

#include "components/leg_muscles.h"
#include "engine/entity.h"

namespace mobil {

inline double number(std::uint64_t bits) {
  return std::bit_cast<double>(bits);
}

struct FrontHeader {
  std::int64_t tick_units, remainder_units;
  std::uint32_t tick, resources, modules, spare;
};

struct SavedMethod {
  std::uint32_t method, vectors, moving, corrected, cells[3], control_points, reported;
};

struct SavedChoice {
  std::uint64_t density, young, poisson, damping, stiffness_damping, foundation, dt;  // doubles, bit by bit
  std::uint32_t muscles, drive, element, mass, inertia, line_motion, cells[3], has_foundation, has_dt;
  SavedMethod method;

  friend bool operator==(const SavedChoice& a, const SavedChoice& b) { return std::memcmp(&a, &b, sizeof(a)) == 0; }
};

/// A module that rows have parts of.
struct SavedModule {
  char name[60];  // its beginning, zeros behind
  std::uint32_t version;
};

/// `named`: a module's, by names.
enum class ResourceKind : std::uint32_t { unknown, choice, shape, lines, solver, basis, named };

/// What a shared resource is made from, in one form: what it does not depend on is as in a LegMuscles{}.
struct Recipe {
  ResourceKind kind;
  std::uint32_t muscle;
  SavedChoice choice;
  std::uint64_t dt, across, along;             // of a solver: doubles; of a basis across / along and their product;
                                               // of a named one: hashes of the module's name and its own, its part
  std::uint32_t method, mass, vectors, spare;  // of a solver; of a basis

  friend bool operator==(const Recipe& a, const Recipe& b) { return std::memcmp(&a, &b, sizeof(a)) == 0; }
};

/// Of a choice of muscles the recipe's `choice` is the resource itself; its `muscle` is most_muscles: any.
/// A resource that a table with rows has, by its number in the world that was saved; these ascend.
struct SavedResource {
  Recipe recipe;
  std::uint64_t fingerprint;  // of its numbers
  std::uint32_t number, spare;
};

SavedChoice pack(const LegMuscles& choice);
/// Nothing where an enumeration or a truth value is none.
std::optional<LegMuscles> unpack(const SavedChoice& saved);

}  // namespace mobil
