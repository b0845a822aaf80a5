#pragma once
// Globals: state that does not belong to entities, one value of each type in a world. Modules declare them
// (Module::globals). Snapshots and state hashes contain those that differ from their first value.

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <string_view>
#include <vector>

#include <mobil/engine/module.h>

namespace mobil::inline v0_3 {

/// The values of a world's globals.
class Globals {
 public:
  explicit Globals(std::pmr::memory_resource* memory) : values_(memory) {}
  Globals(const Globals&) = delete;
  Globals& operator=(const Globals&) = delete;
  ~Globals();

  /// Adds a global with its first value; does nothing if the type exists.
  void add(const GlobalPart& part);
  /// Returns the value's bytes; an empty span if the type was never added.
  std::span<std::byte> find(std::uint64_t id) const;
  /// Returns the value's bytes; throws std::logic_error with the type's name if it was never added.
  std::byte* at(std::uint64_t id, std::string_view name) const;
  /// Returns true if the value differs from its first; false for a type that was never added.
  bool changed(std::uint64_t id) const;
  /// Returns a hash of all values that differ from their first; 0 if all are equal.
  std::uint64_t hash() const;

 private:
  struct Value {
    GlobalPart part;
    std::byte* bytes;
  };
  std::pmr::vector<Value> values_;
};

}  // namespace mobil::inline v0_3
