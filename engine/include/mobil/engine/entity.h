#pragma once
// Handles of entities: an index and a generation. A handle that outlives its entity is stale, which every call reports.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory_resource>
#include <vector>

namespace mobil::inline v0_3 {

/// A handle: plain data that can be stored, copied and sent. The default one is null and never alive.
struct Entity {
  std::uint32_t index = 0;
  std::uint32_t generation = 0;

  friend bool operator==(const Entity&, const Entity&) = default;
};

/// Register of alive entities and their rows. Slots are reused last in, first out, each time with the next generation.
/// A slot whose generations are used up is retired.
class EntityRegister {
 public:
  /// A table's number in the world, and a row of it.
  struct Location {
    std::uint32_t table, row;
  };

  explicit EntityRegister(std::pmr::memory_resource* memory) : slots_(memory) {}

  /// Makes room for `more` entities, for which `create` does not allocate.
  void reserve(std::size_t more) {
    const std::size_t slots = slots_.size() + more;
    if (slots > slots_.capacity()) slots_.reserve((std::max)(slots, 2 * slots_.capacity()));
  }

  /// Returns the number of indices used so far, including those of destroyed entities.
  std::size_t size() const { return slots_.size(); }
  /// Returns the alive entity of an index, or a stale handle.
  Entity at(std::uint32_t index) const {
    return index < slots_.size() && slots_[index].location.table != nobody ? Entity{index, slots_[index].generation}
                                                                           : Entity{};
  }

  /// Creates an entity at table 0 and row 0; the caller sets its location.
  Entity create() {
    std::uint32_t index = first_free_;
    if (index == nobody) {
      index = static_cast<std::uint32_t>(slots_.size());
      slots_.push_back({1, {0, 0}});
    } else {
      first_free_ = slots_[index].location.row;
      slots_[index].location = {0, 0};
    }
    return {index, slots_[index].generation};
  }

  /// Undoes the last `create`; the next one returns the same handle.
  void undo_create(Entity entity) {
    slots_[entity.index].location = {nobody, first_free_};
    first_free_ = entity.index;
  }

  /// Returns null for a stale handle.
  Location* find(Entity entity) { return alive(entity) ? &slots_[entity.index].location : nullptr; }
  const Location* find(Entity entity) const { return alive(entity) ? &slots_[entity.index].location : nullptr; }

  /// Prefetches the memory that `find` reads.
  void fetch(Entity entity) const {
    if (entity.index < slots_.size()) __builtin_prefetch(&slots_[entity.index]);
  }

  /// Returns false for a stale or default handle.
  bool alive(Entity entity) const {
    return entity.index < slots_.size() && slots_[entity.index].generation == entity.generation &&
           slots_[entity.index].location.table != nobody;
  }

  /// Frees the slot of an alive entity.
  void destroy(Entity entity) {
    Slot& slot = slots_[entity.index];
    slot.location.table = nobody;
    if (++slot.generation == 0) return;
    slot.location.row = first_free_;
    first_free_ = entity.index;
  }

 private:
  friend class WorldSnapshot;  // engine/snapshot.h

  static constexpr std::uint32_t nobody = (std::numeric_limits<std::uint32_t>::max)();
  struct Slot {
    std::uint32_t generation;
    Location location;  // `{nobody, next free slot}` if the slot is free
  };
  std::pmr::vector<Slot> slots_;
  std::uint32_t first_free_ = nobody;
};

}  // namespace mobil::inline v0_3
