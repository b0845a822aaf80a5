#pragma once
// All rows of one key, in blocks of sixteen lanes. One block is one piece of memory: every word of every column as
// sixteen neighbouring 4-byte numbers, column after column in the order of the key. Blocks never move; neighbours
// mostly lie one after the other.

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

/// A row that takes another's place, both of one table.
struct RowMove {
  std::uint32_t to, from;
};

/// Rows 0 … row_count − 1 are dense: row r is lane r % 16 of block r / 16. The lanes of the last block that have no row
/// hold copies of its lane 0, so that a kernel may always run all sixteen. What a kernel computes there, nobody reads.
class Table {
 public:
  /// What `column` answers where the table has no such part.
  static constexpr std::uint32_t no_column = std::numeric_limits<std::uint32_t>::max();

  Table(const Archetype& key, std::pmr::memory_resource* memory);
  ~Table();
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;

  /// Parts, rows, and blocks of sixteen rows (the last may be partly filled).
  const Archetype& key() const { return key_; }
  std::uint32_t row_count() const { return rows_; }
  std::size_t block_count() const { return (rows_ + lane_count - 1) / lane_count; }
  /// Words of one row's state, all columns together.
  std::uint32_t words() const { return words_; }
  /// What a block takes: state, and what rows publish.
  std::size_t block_bytes() const { return (std::size_t{words_} + published_words_) * sizeof(Lanes<float>); }

  /// First word of a component's or field's column inside a block, or of what rows publish (sixteen structs one after
  /// the other); `no_column` where there is none.
  std::uint32_t column(std::uint64_t id) const;

  /// A block's words, 64-byte aligned; word w of lane l at [16·w + l]. What rows publish follows.
  float* block(std::size_t b) { return blocks_[b]; }
  const float* block(std::size_t b) const { return blocks_[b]; }
  /// Whose rows those are, sixteen; past `live(b)` the first one's again.
  const Entity* entities(std::size_t b) const { return &entities_[b * lane_count]; }
  /// Lanes of the block that are rows.
  std::uint32_t live(std::size_t b) const;

  // What follows is for World, which keeps the entities' register in step.

  /// Makes room for one more row. Throws what the memory resource throws; nothing else here takes memory.
  void reserve_row() { reserve(rows_ + 1); }
  /// Makes room for so many rows in all; where memory runs out, nothing has changed.
  void reserve(std::uint32_t rows);
  /// Gives back memory that no row needs, but for a next block.
  void trim();
  /// Appends a row of zeros, for which there must be room, and says which.
  std::uint32_t add_row(Entity entity);
  /// Many rows behind those that there are, for which there must be room, from values in blocks of sixteen lanes as
  /// World::create_many has them; several threads may write, each its own target blocks. They are rows once they are
  /// `appended`; `park` makes a table whole again whose new rows are not to be.
  void write_new(std::size_t first_block, std::size_t end_block, std::uint32_t count, std::span<const PartValue> parts);
  void append(std::span<const Entity> entities);
  void park() { park(0, words_); }
  /// Moves rows onto others, which may be in any order; several threads may, each others.
  void copy_rows(std::span<const RowMove> moves);
  /// The entity of one row becomes that of another; then the last `count` rows are gone.
  void rename(const RowMove& move) { entities_[move.to] = entities_[move.from]; }
  void drop_last(std::uint32_t count);
  /// Removes a row by moving the last one into its place; returns the entity that moved, nobody if none had to.
  Entity remove_row(std::uint32_t row);
  void read(std::uint32_t row, std::uint32_t first_word, std::uint32_t words, void* out) const;
  void write(std::uint32_t row, std::uint32_t first_word, std::uint32_t words, const void* in);
  /// Copies into `row` all columns that `other` has too. `copy_new_from`: into one that is not appended yet; several
  /// threads may, each its own blocks.
  void copy_from(std::uint32_t row, const Table& other, std::uint32_t other_row);
  void copy_new_from(std::uint32_t row, const Table& other, std::uint32_t other_row);

 private:
  friend class WorldSnapshot;  // engine/snapshot.h

  struct Chunk {
    float* memory;
    std::size_t blocks;
  };
  void park(std::uint32_t first_word, std::uint32_t words);
  /// Whether the row is what the lanes past the last row are copies of. No other row's writer touches those.
  bool is_parked_as(std::uint32_t row) const { return row % lane_count == 0 && row / lane_count == rows_ / lane_count; }
  std::size_t chunk_bytes(std::size_t blocks) const;
  static std::size_t alignment_of(std::size_t bytes);
  void add_chunk(std::size_t min_blocks);
  void drop_chunk();

  Archetype key_;
  std::pmr::vector<std::uint32_t> first_word_;  // by part of the key
  std::pmr::vector<Chunk> chunks_;              // of memory, each several blocks
  std::pmr::vector<float*> blocks_;             // more than there are rows for: those of chunks begun, one at least
  std::pmr::vector<Entity> entities_;           // sixteen a block
  std::pmr::memory_resource* memory_;
  std::uint32_t words_ = 0, published_words_ = 0;
  std::uint32_t rows_ = 0;
};

}  // namespace mobil::inline v0_3
