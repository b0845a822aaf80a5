#pragma once
// State of a World as bytes and back, bit-exact: rows, entities and handles. Shared resources are numbers here, which
// the caller translates; the caller also adds all other contents of a snapshot (systems/snapshot/snapshot.h). Layout:
// engine/snapshot_bytes.h.

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

/// One table with rows. Its parts and entities are in the lists of all tables, its blocks in the bytes of all.
struct SavedTable {
  std::uint64_t first_block_byte, first_entity;
  std::uint32_t first_part, parts, rows, words;
};
/// `left_out`: 1 for a column that is omitted because it follows from the others; else 0.
struct SavedPart {
  std::uint64_t id, value;
  std::uint32_t kind, left_out;
};
struct SavedSlot {
  std::uint32_t generation, table, row;
};

/// A checked world in a snapshot. All numbers are consistent, so that readers stay within its bytes.
struct SavedWorld {
  Records<SavedTable> tables;
  Records<SavedPart> parts;
  Records<SavedSlot> slots;  // a free slot has `table` = `nobody` and the next free slot in `row`
  Records<Entity> entities;
  std::span<const std::byte> blocks;
  std::uint32_t first_free = 0;

  static constexpr std::uint32_t nobody = 0xffffffff;
  /// Returns an entity's slot, or nothing for a stale handle.
  std::optional<SavedSlot> find(Entity entity) const;
  std::optional<SavedPart> part(std::uint32_t table, std::uint64_t id) const;
  /// Returns the first word of a column in a table's blocks; Table::no_column if it is missing or left out.
  std::uint32_t column(std::uint32_t table, std::uint64_t id) const;
  std::uint32_t word(std::uint32_t table, std::uint32_t row, std::uint32_t column_word) const;
};

/// Returns the error of a snapshot that contradicts itself in `what`.
tl::unexpected<Error> damaged(std::string_view what);

/// Returns true if `is_sound` accepts component C of every row of a table, or if the table has none.
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

/// Number of a resource in the snapshot and in the restored world.
struct SharedNumber {
  std::uint64_t id, saved, present;
};

/// Snapshots leave out a column that can be computed from a row's other columns. This function takes a table's key and
/// returns that column's id, or 0 if the table has none. The caller computes the column again after `commit`.
using LeftOut = std::function<std::uint64_t(const Archetype& key)>;

/// Words of a table's rows that are not in a snapshot.
struct WordGap {
  std::uint32_t first = 0, words = 0;
};

class WorldSnapshot {
 public:
  /// Returns the sizes of `world` and `blocks`. Tables without rows are left out.
  static SnapshotLayout layout(const World& world, const LeftOut& left_out);
  /// Writes those parts, and seals the snapshot; the front must be written before. Does not allocate.
  static void save(const World& world, const SnapshotLayout& layout, std::span<std::byte> out, const Jobs& jobs,
                   const LeftOut& left_out);

  /// Checks the consistency of sizes, keys, and the register with the rows and its list of free slots.
  static Result<SavedWorld> read(const OpenSnapshot& snapshot);

  /// Finds or creates a table for each saved one, and makes room. Until `commit` the world is unchanged, except for
  /// tables and blocks without rows. Keeps no pointers into the snapshot. `known`: parts that tables can have in
  /// addition to those in the world. `shared`: all resources named. `check` validates keys for which the world has no
  /// table. `left_out` must agree with the snapshot. Allocates only if it needs more than the last time. Throws what
  /// the memory resource throws; then call `give_up`.
  Result<void> prepare(World& world, const SavedWorld& saved, std::span<const ComponentId> known,
                       std::span<const SharedNumber> shared, const LeftOut& left_out,
                       const std::function<Result<void>(const Archetype&)>& check);
  /// Replaces the world's state by the saved one; columns that were left out have undefined words. Requires a
  /// successful `prepare` with the same arguments.
  void commit(World& world, const SavedWorld& saved, const Jobs& jobs) const noexcept;
  /// Frees the room made by `prepare`.
  static void give_up(World& world) noexcept;

 private:
  Result<ComponentId> known_part(const World& world, const SavedPart& part, std::span<const ComponentId> known,
                                 std::span<const SharedNumber> shared) const;
  static void relate_all(World& world) noexcept;

  std::vector<std::uint32_t> table_;  // index in the world, by saved table
  std::vector<std::uint32_t> saved_;  // the inverse
  std::vector<WordGap> gap_;          // by saved table
  std::pmr::vector<ComponentId> key_;
};

}  // namespace mobil::inline v0_3
