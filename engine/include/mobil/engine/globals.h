#pragma once
// Values that are state, but no entity's: one of each type in a world. Modules name them (Module::globals). Snapshots
// and a simulation's state hash contain those that differ from their first value.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory_resource>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include <mobil/engine/archetype.h>

namespace mobil::inline v0_3 {

/// A type of global, as modules name it. `first`: its bytes when nothing has changed it. `is_sound`: whether a value
/// from a snapshot makes sense; null where every one does.
struct GlobalPart {
  std::uint64_t id = 0;
  std::string_view name;
  std::span<const std::byte> first;
  bool (*is_sound)(const void* value) = nullptr;
};

/// T is trivially copyable, without padding, at most 16-byte aligned; T{} is its first value.
template <class T, bool (*sound)(const T&) = nullptr>
GlobalPart global_part() {
  static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= 16);
  static const T first{};
  GlobalPart part{type_id<T>(), type_name<T>(), std::as_bytes(std::span(&first, 1))};
  if constexpr (sound != nullptr) {
    part.is_sound = [](const void* value) {
      T copy;
      std::memcpy(static_cast<void*>(&copy), value, sizeof(T));
      return sound(copy);
    };
  }
  return part;
}

class Globals {
 public:
  explicit Globals(std::pmr::memory_resource* memory) : values_(memory) {}
  Globals(const Globals&) = delete;
  Globals& operator=(const Globals&) = delete;
  ~Globals();

  /// Makes room for a global at its first value. A type that is there already stays as it is.
  void add(const GlobalPart& part);
  /// The value's bytes; none where the type was never added.
  std::span<std::byte> find(std::uint64_t id) const;
  /// The same of a type that must be there: throws std::logic_error, which names it, where it is not.
  std::byte* at(std::uint64_t id, std::string_view name) const;
  /// Whether the value differs from its first. False for a type that was never added.
  bool changed(std::uint64_t id) const;
  /// A hash of all that differ from their first values; 0 where none does.
  std::uint64_t hash() const;

 private:
  struct Value {
    GlobalPart part;
    std::byte* bytes;
  };
  std::pmr::vector<Value> values_;
};

}  // namespace mobil::inline v0_3
