#pragma once
// What a world's shared resources are made from, and the same made again from that.

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

/// The part's id of a shared resource; 0 of unknown ones.
std::uint64_t resource_type(const Recipe& recipe);

/// Of each resource of a world, by number: what it is made from, and a hash of its numbers. Others than those of the
/// library and of modules are unknown.
class ResourceList {
 public:
  struct Known {
    Recipe recipe{};
    std::uint64_t fingerprint = 0;
  };

  /// Learns of resources that came since; takes memory for those alone.
  void learn(const World& world, const BellyLibrary& library, std::span<const Module> modules);
  const std::vector<Known>& known() const { return known_; }

  /// The number of that resource in this world, found or made again and shared. Errors: a
  /// recipe that the library refuses, or of a mesh with more nodes than that; numbers that come out otherwise.
  Result<std::uint64_t> number_of(const SavedResource& saved, std::size_t max_nodes, World& world,
                                  BellyLibrary& library, std::span<const Module> modules);

 private:
  /// Whether the library has it, so that making it takes no time.
  static bool is_there(const Recipe& recipe, BellyLibrary& library);
  Result<void> make(const Recipe& recipe, World& world, BellyLibrary& library);

  std::vector<Known> known_;
};

}  // namespace mobil::inline v0_3
