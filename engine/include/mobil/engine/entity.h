#pragma once
// Handles: an index and a generation. A handle that outlives its entity is stale, and every call says so.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory_resource>
#include <vector>

#include <mobil/engine/status.h>

namespace mobil::inline v0_3 {

/// A handle: plain data, may be stored, copied and sent. The default one is null: never alive.
struct Entity {
  std::uint32_t index = 0;
  std::uint32_t generation = 0;

  friend bool operator==(const Entity&, const Entity&) = default;
};

/// Who is alive, and where: the table (its number in the world) and the row. Slots are reused last in, first out, each
/// time with the next generation; a slot whose generations are used up is retired.
class EntityRegister {
 public:
  /// A table's number in the world, and a row of it.
  struct Location {
    std::uint32_t table, row;
  };

  explicit EntityRegister(std::pmr::memory_resource* memory) : slots_(memory) {}

  /// Room for so many more: then `create` takes no memory.
  void reserve(std::size_t more) {
    const std::size_t slots = slots_.size() + more;
    if (slots > slots_.capacity()) slots_.reserve(std::max(slots, 2 * slots_.capacity()));
  }

  /// Indices given out so far, also those of entities that are gone.
  std::size_t size() const { return slots_.size(); }
  /// The alive entity of an index; a stale handle where there is none.
  Entity at(std::uint32_t index) const {
    return index < slots_.size() && slots_[index].location.table != nobody ? Entity{index, slots_[index].generation}
                                                                           : Entity{};
  }

  /// A new alive entity, at table 0 and row 0 until its place is set.
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

  /// The entity created last is as if it had never been: the next one gets its handle.
  void undo_create(Entity entity) {
    slots_[entity.index].location = {nobody, first_free_};
    first_free_ = entity.index;
  }

  /// Null when the handle is stale.
  Location* find(Entity entity) { return alive(entity) ? &slots_[entity.index].location : nullptr; }
  const Location* find(Entity entity) const { return alive(entity) ? &slots_[entity.index].location : nullptr; }

  /// Fetches the memory that `find` reads.
  void fetch(Entity entity) const {
    if (entity.index < slots_.size()) __builtin_prefetch(&slots_[entity.index]);
  }

  /// False for a stale handle and for the default one.
  bool alive(Entity entity) const {
    return entity.index < slots_.size() && slots_[entity.index].generation == entity.generation &&
           slots_[entity.index].location.table != nobody;
  }

  /// Frees the slot of a alive entity.
  void destroy(Entity entity) {
    Slot& slot = slots_[entity.index];
    slot.location.table = nobody;
    if (++slot.generation == 0) return;
    slot.location.row = first_free_;
    first_free_ = entity.index;
  }

 private:
  friend class WorldSnapshot;  // engine/snapshot.h

  static constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max();
  struct Slot {
    std::uint32_t generation;
    Location location;  // of a free slot: {nobody, the next free one}
  };
  std::pmr::vector<Slot> slots_;
  std::uint32_t first_free_ = nobody;
};

}  // namespace mobil::inline v0_3
