#pragma once
// Recipes of a world's shared resources, and their reconstruction from recipes.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <mobil/engine/error.h>
#include <mobil/engine/module.h>
#include <mobil/engine/world.h>
#include "systems/bellies/belly_library.h"
#include "systems/snapshot/snapshot_records.h"

namespace mobil::inline v0_3 {

/// Returns the component id of a shared resource; 0 for unknown ones.
std::uint64_t resource_type(const Recipe& recipe);

/// Recipe of each resource of a world, by number, and a hash of its numbers. Resources that are neither the library's
/// nor a module's are unknown.
class ResourceList {
 public:
  struct Known {
    Recipe recipe{};
    std::uint64_t fingerprint = 0;
  };

  /// Adds resources that are new since the last call; allocates memory only for those.
  void learn(const World& world, const BellyLibrary& library, std::span<const Module> modules);
  const std::vector<Known>& known() const { return known_; }

  /// Returns the number of a resource in this world; makes and shares it if missing. Errors: a recipe that the library
  /// refuses, or that needs a mesh of more than `max_nodes` nodes; a result that differs from the saved one.
  Result<std::uint64_t> number_of(const SavedResource& saved, std::size_t max_nodes, World& world,
                                  BellyLibrary& library, std::span<const Module> modules);

 private:
  /// Returns true if the library has the resource, so that making it takes no time.
  static bool is_there(const Recipe& recipe, BellyLibrary& library);
  Result<void> make(const Recipe& recipe, World& world, BellyLibrary& library);

  std::vector<Known> known_;
};

}  // namespace mobil::inline v0_3
