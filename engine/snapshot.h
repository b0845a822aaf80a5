#pragma once
// The state of a World as bytes, and back: rows, entities and who is alive, down to the last bit. It knows nothing of
// what tables mean: shared resources are numbers here, which the caller translates, and what else goes into a snapshot
// is the caller's (systems/snapshot/snapshot.h). Layout: engine/snapshot_bytes.h.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <mobil/engine/error.h>
#include <mobil/engine/jobs.h>
#include <mobil/engine/world.h>
#include "engine/snapshot_bytes.h"

namespace mobil::inline v0_3 {

/// One table with rows: its parts and entities are among those of all tables, its blocks within the bytes of all.
struct SavedTable {
  std::uint64_t first_block_byte, first_entity;
  std::uint32_t first_part, parts, rows, words;
};
/// `left_out`: 1 for a column that is not among the blocks' words, for it follows from the others; else 0.
struct SavedPart {
  std::uint64_t id, value;
  std::uint32_t kind, left_out;
};
struct SavedSlot {
  std::uint32_t generation, table, row;
};

/// A world in a snapshot, every number of which fits every other: who reads it stays within its bytes.
struct SavedWorld {
  Records<SavedTable> tables;
  Records<SavedPart> parts;
  Records<SavedSlot> slots;  // `table` is nobody for a free one, whose `row` is the next free one
  Records<Entity> entities;
  std::span<const std::byte> blocks;
  std::uint32_t first_free = 0;

  static constexpr std::uint32_t nobody = 0xffffffff;
  /// Its slot; nothing for a stale handle.
  std::optional<SavedSlot> find(Entity entity) const;
  std::optional<SavedPart> part(std::uint32_t table, std::uint64_t id) const;
  /// First word of a column in a table's blocks; Table::no_column where it has none, or it is left out.
  std::uint32_t column(std::uint32_t table, std::uint64_t id) const;
  std::uint32_t word(std::uint32_t table, std::uint32_t row, std::uint32_t column_word) const;
};

/// The error of a snapshot that contradicts itself in `what`.
tl::unexpected<Error> damaged(std::string_view what);

/// Whether `is_sound` says so of component C in every row of a table; true where the table has none.
template <template <class> class C, class Sound>
bool every_row(const SavedWorld& saved, std::uint32_t table, Sound is_sound) {
  const std::uint32_t column = saved.column(table, type_id<C<float>>());
  if (column == Table::no_column) return true;
  for (std::uint32_t row = 0; row < saved.tables[table].rows; ++row) {
    std::array<std::uint32_t, ComponentLayout<C>::words> word;
    for (std::uint32_t w = 0; w < word.size(); ++w) word[w] = saved.word(table, row, column + w);
    if (!is_sound(std::bit_cast<C<float>>(word))) return false;
  }
  return true;
}

/// A resource's number in the snapshot and in the world that is restored.
struct SharedNumber {
  std::uint64_t id, saved, present;
};

/// Snapshots leave out a column that can be computed from a row's other columns. This function says which: it takes a
/// table's key and returns the part's id, or 0 if the table has no such column. The caller computes the column again
/// after `commit`.
using LeftOut = std::function<std::uint64_t(const Archetype& key)>;

/// Words of a table's rows that a snapshot has not.
struct WordGap {
  std::uint32_t first = 0, words = 0;
};

class WorldSnapshot {
 public:
  /// Bytes of the parts `world` and `blocks`. Tables without rows are left out.
  static SnapshotLayout layout(const World& world, const LeftOut& left_out);
  /// Writes those parts, and seals the whole: the front must be there. No heap.
  static void save(const World& world, const SnapshotLayout& layout, std::span<std::byte> out, const Jobs& jobs,
                   const LeftOut& left_out);

  /// Checks that everything agrees: sizes, keys, the register with the rows and its list of free slots.
  static Result<SavedWorld> read(const OpenSnapshot& snapshot);

  /// Finds or makes a table for each one saved, and makes room. Until `commit` the world is unchanged, but for tables
  /// and blocks without rows; nothing here keeps pointers into the snapshot. `known`: parts that tables may have beside
  /// those that the world's have. `shared`: of every resource named. `check` says whether a key that the world has no
  /// table of yet makes sense. `left_out`: as the snapshot must have it. Takes memory only where more is needed than
  /// the last time. Throws what the memory resource throws; then call `give_up`.
  Result<void> prepare(World& world, const SavedWorld& saved, std::span<const ComponentId> known,
                       std::span<const SharedNumber> shared, const LeftOut& left_out,
                       const std::function<Result<void>(const Archetype&)>& check);
  /// Makes the world what was saved, but for columns that were left out, whose words are any. Only after a `prepare` of
  /// the same two that succeeded.
  void commit(World& world, const SavedWorld& saved, const Jobs& jobs) const noexcept;
  /// Gives back the room made.
  static void give_up(World& world) noexcept;

 private:
  Result<ComponentId> known_part(const World& world, const SavedPart& part, std::span<const ComponentId> known,
                                 std::span<const SharedNumber> shared) const;
  static void relate_all(World& world) noexcept;

  std::vector<std::uint32_t> table_;  // of the world, by table saved
  std::vector<std::uint32_t> saved_;  // the other way round
  std::vector<WordGap> gap_;          // by table saved
  std::pmr::vector<ComponentId> key_;
};

}  // namespace mobil::inline v0_3
