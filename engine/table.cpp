#include <mobil/engine/table.h>

#include <algorithm>
#include <cstring>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace mobil::inline v0_3 {
namespace {
constexpr std::size_t word_bytes = sizeof(float);
constexpr std::size_t block_alignment = alignof(Lanes<float>);
constexpr std::size_t large_page = std::size_t{2} << 20;

// Words can be floats or integers, so they are moved only as bytes.
void copy_lane(float* to, const float* from, std::uint32_t words) {
  for (std::size_t w = 0; w < words; ++w) std::memcpy(to + w * lane_count, from + w * lane_count, word_bytes);
}
}  // namespace

Table::Table(const Archetype& key, std::pmr::memory_resource* memory)
    : key_(key, memory), first_word_(memory), chunks_(memory), blocks_(memory), entities_(memory), memory_(memory) {
  for (const ComponentId& part : key_) {
    const bool column = has_column(part.kind);
    first_word_.push_back(column ? words_ : no_column);
    if (column) words_ += static_cast<std::uint32_t>(part.value);
  }
  for (std::size_t i = 0; i < key_.size(); ++i) {
    if (key_[i].kind != PartKind::published) continue;
    first_word_[i] = words_ + published_words_;
    published_words_ += static_cast<std::uint32_t>(key_[i].value);
  }
}

Table::~Table() {
  rows_ = 0;
  while (!chunks_.empty()) drop_chunk();
}

std::size_t Table::chunk_bytes(std::size_t blocks) const {
  return std::max<std::size_t>(blocks * block_bytes(), block_alignment);
}

std::size_t Table::alignment_of(std::size_t bytes) {
  return bytes >= large_page ? large_page : block_alignment;
}

/// Adds a chunk of a quarter of the present blocks, which limits unused memory. In large tables a chunk grows to a
/// large page, which needs one TLB entry.
void Table::add_chunk(std::size_t least) {
  const std::size_t full = (large_page + chunk_bytes(1) - 1) / chunk_bytes(1);
  const std::size_t more = blocks_.size() < 2 * full ? blocks_.size() / 4 : full;
  const std::size_t count = std::min(full, std::max(least, more));
  if (chunks_.size() == chunks_.capacity()) chunks_.reserve(2 * chunks_.size() + 1);
  if (blocks_.size() + count > blocks_.capacity())
    blocks_.reserve(std::max(blocks_.size() + count, 2 * blocks_.size()));
  const std::size_t bytes = chunk_bytes(count);
  auto* const memory = static_cast<float*>(memory_->allocate(bytes, alignment_of(bytes)));
#if defined(__linux__)
  if (bytes >= large_page) madvise(memory, large_page, MADV_HUGEPAGE);  // only a hint
#endif
  chunks_.push_back({memory, count});
  for (std::size_t b = 0; b < count; ++b) blocks_.push_back(memory + b * block_bytes() / word_bytes);
}

void Table::drop_chunk() {
  const auto [memory, count] = chunks_.back();
  memory_->deallocate(memory, chunk_bytes(count), alignment_of(chunk_bytes(count)));
  blocks_.resize(blocks_.size() - count);
  chunks_.pop_back();
}

std::uint32_t Table::column(std::uint64_t id) const {
  const auto at = lower_bound(key_, id);
  return at != key_.end() && at->id == id ? first_word_[static_cast<std::size_t>(at - key_.begin())] : no_column;
}

std::uint32_t Table::live(std::size_t b) const {
  return static_cast<std::uint32_t>(std::min<std::size_t>(lane_count, rows_ - b * lane_count));
}

void Table::reserve(std::uint32_t rows) {
  const std::size_t blocks = (std::size_t{rows} + lane_count - 1) / lane_count;
  if (blocks * lane_count <= entities_.size()) return;
  try {
    while (blocks_.size() < blocks) add_chunk(blocks - blocks_.size());
    entities_.resize(blocks_.size() * lane_count);  // if this fails, the next call repeats it
  } catch (...) {
    trim();
    throw;
  }
}

/// Keeps room for an eighth more rows, so that rows that come and go do not allocate. An empty table keeps none.
void Table::trim() {
  while (!chunks_.empty() && (blocks_.size() - chunks_.back().blocks) * 8 >= block_count() * 9) drop_chunk();
  if (entities_.size() > blocks_.size() * lane_count) entities_.resize(blocks_.size() * lane_count);
}

void Table::write_new(std::size_t first_block, std::size_t end_block, std::uint32_t count,
                      std::span<const PartValue> parts) {
  for (std::size_t b = first_block; b < end_block; ++b) {
    // Lanes of this block, and the new rows in them; these usually span two of the source blocks.
    const std::size_t lane = b * lane_count < rows_ ? rows_ - b * lane_count : 0;
    const std::size_t lanes = std::min(lane_count, rows_ + count - b * lane_count) - lane;
    const std::size_t from = b * lane_count + lane - rows_, source = from / lane_count, offset = from % lane_count;
    const std::size_t head = std::min(lanes, lane_count - offset), tail = lanes - head;
    for (const auto& [part, values] : parts) {
      if (!has_column(part.kind)) continue;
      const std::size_t words = part.value;
      float* to = blocks_[b] + column(part.id) * lane_count + lane;
      if (values == nullptr) {
        for (std::size_t w = 0; w < words; ++w, to += lane_count) std::memset(to, 0, lanes * word_bytes);
        continue;
      }
      const float* of = static_cast<const float*>(values) + source * words * lane_count;
      for (std::size_t w = 0; w < words; ++w, to += lane_count, of += lane_count) {
        std::memcpy(to, of + offset, head * word_bytes);
        if (tail > 0) std::memcpy(to + head, of + words * lane_count, tail * word_bytes);
      }
    }
  }
}

void Table::append(std::span<const Entity> entities) {
  std::copy(entities.begin(), entities.end(), entities_.begin() + rows_);
  rows_ += static_cast<std::uint32_t>(entities.size());
  park(0, words_);
}

void Table::copy_rows(std::span<const RowMove> moves) {
  for (std::size_t i = 0; i < moves.size();) {
    // Rows between the same two blocks are copied together, because their words share cache lines.
    const std::size_t to_block = moves[i].to / lane_count, from_block = moves[i].from / lane_count;
    std::size_t end = i + 1;
    while (end < moves.size() && moves[end].to / lane_count == to_block && moves[end].from / lane_count == from_block) {
      ++end;
    }
    float* to = blocks_[to_block];
    const float* from = blocks_[from_block];
    for (std::size_t w = 0; w < words_; ++w, to += lane_count, from += lane_count) {
      for (std::size_t m = i; m < end; ++m) {
        std::memcpy(to + moves[m].to % lane_count, from + moves[m].from % lane_count, word_bytes);
      }
    }
    i = end;
  }
}

void Table::drop_last(std::uint32_t count) {
  rows_ -= count;
  trim();
  park(0, words_);
}

std::uint32_t Table::add_row(Entity entity) {
  const std::uint32_t row = rows_;
  float* block = blocks_[row / lane_count];
  const std::size_t lane = row % lane_count;
  if (lane == 0) {
    std::memset(block, 0, words_ * lane_count * word_bytes);
    std::fill_n(&entities_[row], lane_count, entity);
  } else {
    for (std::size_t w = 0; w < words_; ++w) std::memset(block + w * lane_count + lane, 0, word_bytes);
    entities_[row] = entity;
  }
  ++rows_;
  return row;
}

Entity Table::remove_row(std::uint32_t row) {
  const std::uint32_t last = --rows_;
  Entity moved;
  if (row != last) {
    moved = entities_[last];
    entities_[row] = moved;
    copy_lane(blocks_[row / lane_count] + row % lane_count, blocks_[last / lane_count] + last % lane_count, words_);
  }
  trim();
  if (row % lane_count == 0 && row / lane_count == last / lane_count) {
    park(0, words_);
  } else if (last % lane_count != 0) {  // the other lanes without a row are already copies
    float* const block = blocks_[last / lane_count];
    copy_lane(block + last % lane_count, block, words_);
    entities_[last] = entities_[last / lane_count * lane_count];
  }
  return moved;
}

void Table::read(std::uint32_t row, std::uint32_t first_word, std::uint32_t words, void* out) const {
  const float* from = blocks_[row / lane_count] + first_word * lane_count + row % lane_count;
  auto* to = static_cast<std::byte*>(out);
  for (std::size_t w = 0; w < words; ++w) std::memcpy(to + w * word_bytes, from + w * lane_count, word_bytes);
}

void Table::write(std::uint32_t row, std::uint32_t first_word, std::uint32_t words, const void* in) {
  float* to = blocks_[row / lane_count] + first_word * lane_count + row % lane_count;
  const auto* from = static_cast<const std::byte*>(in);
  for (std::size_t w = 0; w < words; ++w) std::memcpy(to + w * lane_count, from + w * word_bytes, word_bytes);
  if (is_parked_as(row)) park(first_word, words);
}

void Table::copy_from(std::uint32_t row, const Table& other, std::uint32_t other_row) {
  copy_new_from(row, other, other_row);
  if (is_parked_as(row)) park(0, words_);
}

void Table::copy_new_from(std::uint32_t row, const Table& other, std::uint32_t other_row) {
  for (std::size_t i = 0; i < key_.size(); ++i) {
    const ComponentId& part = key_[i];
    const ComponentId* theirs = has_column(part.kind) ? find_component(other.key_, part.id) : nullptr;
    if (theirs == nullptr || !(*theirs == part)) continue;
    copy_lane(blocks_[row / lane_count] + first_word_[i] * lane_count + row % lane_count,
              other.blocks_[other_row / lane_count] + other.column(part.id) * lane_count + other_row % lane_count,
              static_cast<std::uint32_t>(part.value));
  }
}

/// Fills the last block's lanes without a row with copies of its lane 0.
void Table::park(std::uint32_t first_word, std::uint32_t words) {
  const std::size_t used = rows_ % lane_count;
  if (used == 0) return;
  float* line = blocks_[rows_ / lane_count] + first_word * lane_count;
  for (std::size_t w = 0; w < words; ++w, line += lane_count) {
    for (std::size_t lane = used; lane < lane_count; ++lane) std::memcpy(line + lane, line, word_bytes);
  }
  Entity* entity = &entities_[rows_ / lane_count * lane_count];
  std::fill(entity + used, entity + lane_count, *entity);
}

}  // namespace mobil::inline v0_3
