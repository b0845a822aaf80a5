#pragma once
// All rows of one archetype, in blocks of sixteen lanes. A block is contiguous: each word of each column as sixteen
// adjacent 4-byte numbers, columns in the order of the key. Blocks never move; most are adjacent to the next one.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory_resource>
#include <span>
#include <vector>

#include <mobil/components/lanes.h>
#include <mobil/engine/archetype.h>
#include <mobil/engine/entity.h>

namespace mobil::inline v0_3 {

/// A move of a row onto another row of the same table.
struct RowMove {
  std::uint32_t to, from;
};

/// Rows 0 … row_count − 1 are dense: row r is lane r % 16 of block r / 16. Lanes of the last block without a row hold
/// copies of its lane 0, so that kernels can always run all sixteen. Results in these lanes are never read.
class Table {
 public:
  /// Result of `column` if the table has no such part.
  static constexpr std::uint32_t no_column = (std::numeric_limits<std::uint32_t>::max)();

  Table(const Archetype& key, std::pmr::memory_resource* memory);
  ~Table();
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;

  /// Key, number of rows, and number of blocks of sixteen rows (the last can be partly filled).
  const Archetype& key() const { return key_; }
  std::uint32_t row_count() const { return rows_; }
  std::size_t block_count() const { return (rows_ + lane_count - 1) / lane_count; }
  /// Returns the words of one row's state in all columns.
  std::uint32_t words() const { return words_; }
  /// Returns the bytes of a block: state and published structs.
  std::size_t block_bytes() const { return (std::size_t{words_} + published_words_) * sizeof(Lanes<float>); }

  /// Returns the first word of a component's or field's column in a block, or of published structs (sixteen in
  /// sequence); `no_column` if the table has none.
  std::uint32_t column(std::uint64_t id) const;

  /// Returns a block's words, 64-byte aligned; word w of lane l at [16·w + l]. Published structs follow.
  float* block(std::size_t b) { return blocks_[b]; }
  const float* block(std::size_t b) const { return blocks_[b]; }
  /// Returns the entities of a block's sixteen rows; from `live(b)` on, the first one again.
  const Entity* entities(std::size_t b) const { return &entities_[b * lane_count]; }
  /// Returns the number of lanes with rows.
  std::uint32_t live(std::size_t b) const;

  // The following functions are for World, which keeps the register of entities consistent.

  /// Makes room for one more row. Throws what the memory resource throws; no other function here allocates.
  void reserve_row() { reserve(rows_ + 1); }
  /// Makes room for `rows` rows in total. Changes nothing if memory runs out.
  void reserve(std::uint32_t rows);
  /// Frees blocks without rows, except room for an eighth more rows.
  void trim();
  /// Appends a row of zeros and returns its number; there must be room.
  std::uint32_t add_row(Entity entity);
  /// Writes new rows after the last one, from values in blocks of sixteen lanes as in World::create_many; there must be
  /// room. Several threads can write different target blocks. The rows exist after `append`. To abandon them, call
  /// `park`, which restores the copies in the last block.
  void write_new(std::size_t first_block, std::size_t end_block, std::uint32_t count, std::span<const PartValue> parts);
  void append(std::span<const Entity> entities);
  void park() { park(0, words_); }
  /// Copies rows onto others, in any order. Several threads can copy different rows.
  void copy_rows(std::span<const RowMove> moves);
  /// `rename` moves the entity with its row. `drop_last` removes the last `count` rows.
  void rename(const RowMove& move) { entities_[move.to] = entities_[move.from]; }
  void drop_last(std::uint32_t count);
  /// Removes a row by moving the last one into its place; returns the entity that moved, or a null handle.
  Entity remove_row(std::uint32_t row);
  void read(std::uint32_t row, std::uint32_t first_word, std::uint32_t words, void* out) const;
  void write(std::uint32_t row, std::uint32_t first_word, std::uint32_t words, const void* in);
  /// Copies all columns that `other` also has into `row`. `copy_new_from` is for rows before `append`; several threads
  /// can copy into different blocks.
  void copy_from(std::uint32_t row, const Table& other, std::uint32_t other_row);
  void copy_new_from(std::uint32_t row, const Table& other, std::uint32_t other_row);

 private:
  friend class WorldSnapshot;  // engine/snapshot.h

  struct Chunk {
    float* memory;
    std::size_t blocks;
  };
  void park(std::uint32_t first_word, std::uint32_t words);
  /// True if the lanes without a row are copies of this row. Writers of other rows do not touch those lanes.
  bool is_parked_as(std::uint32_t row) const { return row % lane_count == 0 && row / lane_count == rows_ / lane_count; }
  std::size_t chunk_bytes(std::size_t blocks) const;
  static std::size_t alignment_of(std::size_t bytes);
  void add_chunk(std::size_t min_blocks);
  void drop_chunk();

  Archetype key_;
  std::pmr::vector<std::uint32_t> first_word_;  // by part of the key
  std::pmr::vector<Chunk> chunks_;              // memory of several blocks each
  std::pmr::vector<float*> blocks_;             // all blocks of all chunks, used or not
  std::pmr::vector<Entity> entities_;           // sixteen a block
  std::pmr::memory_resource* memory_;
  std::uint32_t words_ = 0, published_words_ = 0;
  std::uint32_t rows_ = 0;
};

}  // namespace mobil::inline v0_3
