#pragma once
// All rows of one key, in blocks of sixteen lanes. One block is one piece of memory: every word of every column as
// sixteen neighbouring 4-byte numbers, column after column in the order of the key. Blocks never move.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory_resource>
#include <vector>

#include "components/lanes.h"
#include "engine/entity.h"
#include "engine/key.h"

namespace mobil {

/// Rows 0 … row_count − 1 are dense: row r is lane r % 16 of block r / 16. The lanes of the last block that have no row
/// hold copies of its lane 0, so that a kernel may always run all sixteen. What a kernel computes there, nobody reads.
class Table {
 public:
  static constexpr std::uint32_t no_column = std::numeric_limits<std::uint32_t>::max();

  Table(const TableKey& key, std::pmr::memory_resource* memory);
  ~Table();
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;

  const TableKey& key() const { return key_; }
  std::uint32_t row_count() const { return rows_; }
  std::size_t block_count() const { return (rows_ + lane_count - 1) / lane_count; }
  /// Words of one row, all columns together; a block is words() · 64 bytes.
  std::uint32_t words() const { return words_; }

  /// First word of a component's or field's column inside a block; `no_column` where there is none.
  std::uint32_t column(std::uint64_t id) const;

  /// A block's words, 64-byte aligned; word w of lane l at [16·w + l].
  float* block(std::size_t b) { return blocks_[b]; }
  const float* block(std::size_t b) const { return blocks_[b]; }
  /// Whose rows those are, sixteen; past `live(b)` the first one's again.
  const Entity* entities(std::size_t b) const { return &entities_[b * lane_count]; }
  /// Lanes of the block that are rows.
  std::uint32_t live(std::size_t b) const;

  // What follows is for World, which keeps the entities' register in step.

  /// Makes room for one more row. Throws what the memory resource throws; nothing else here takes memory.
  void reserve_row();
  /// Appends a row of zeros, for which there must be room, and says which.
  std::uint32_t add_row(Entity entity);
  /// Removes a row by moving the last one into its place; returns the entity that moved, nobody if none had to.
  Entity remove_row(std::uint32_t row);
  void read(std::uint32_t row, std::uint32_t first_word, std::uint32_t words, void* out) const;
  void write(std::uint32_t row, std::uint32_t first_word, std::uint32_t words, const void* in);
  /// Copies into `row` all columns that `other` has too.
  void copy_from(std::uint32_t row, const Table& other, std::uint32_t other_row);

 private:
  friend class WorldSnapshot;  // engine/snapshot.h

  void park(std::uint32_t first_word, std::uint32_t words);

  TableKey key_;
  std::pmr::vector<std::uint32_t> first_word_;  // by part of the key
  std::pmr::vector<float*> blocks_;             // one empty block at most is kept for the next row
  std::pmr::vector<Entity> entities_;           // sixteen a block
  std::pmr::memory_resource* memory_;
  std::uint32_t words_ = 0;
  std::uint32_t rows_ = 0;
};

}  // namespace mobil
