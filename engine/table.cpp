#include "engine/table.h"

#include <algorithm>
#include <cstring>

namespace mobil {
namespace {
constexpr std::size_t word_bytes = sizeof(float);
constexpr std::size_t block_alignment = alignof(Lanes<float>);

// Words may be floats or whole numbers: they are only ever moved as bytes.
void copy_lane(float* to, const float* from, std::uint32_t words) {
  for (std::size_t w = 0; w < words; ++w) std::memcpy(to + w * lane_count, from + w * lane_count, word_bytes);
}
}  // namespace

Table::Table(const TableKey& key, std::pmr::memory_resource* memory)
    : key_(key, memory), first_word_(memory), blocks_(memory), entities_(memory), memory_(memory) {
  for (const KeyPart& part : key_) {
    const bool column = has_column(part.kind);
    first_word_.push_back(column ? words_ : no_column);
    if (column) words_ += static_cast<std::uint32_t>(part.value);
  }
}

Table::~Table() {
  for (float* block : blocks_) memory_->deallocate(block, words_ * lane_count * word_bytes, block_alignment);
}

std::uint32_t Table::column(std::uint64_t id) const {
  const auto at = lower_bound(key_, id);
  return at != key_.end() && at->id == id ? first_word_[static_cast<std::size_t>(at - key_.begin())] : no_column;
}

std::uint32_t Table::live(std::size_t b) const {
  return static_cast<std::uint32_t>(std::min<std::size_t>(lane_count, rows_ - b * lane_count));
}

void Table::reserve_row() {
  if (rows_ < blocks_.size() * lane_count) return;
  if (blocks_.size() == blocks_.capacity()) blocks_.reserve(2 * blocks_.size() + 1);
  entities_.resize((blocks_.size() + 1) * lane_count);
  blocks_.push_back(static_cast<float*>(memory_->allocate(words_ * lane_count * word_bytes, block_alignment)));
}

void Table::reserve(std::uint32_t rows) {
  const std::size_t blocks = (std::size_t{rows} + lane_count - 1) / lane_count;
  if (blocks <= blocks_.size()) return;
  blocks_.reserve(blocks);
  entities_.resize(blocks * lane_count);
  while (blocks_.size() < blocks) {
    blocks_.push_back(static_cast<float*>(memory_->allocate(words_ * lane_count * word_bytes, block_alignment)));
  }
}

void Table::trim() {
  while (blocks_.size() > block_count() + 1) {
    memory_->deallocate(blocks_.back(), words_ * lane_count * word_bytes, block_alignment);
    blocks_.pop_back();
  }
  entities_.resize(blocks_.size() * lane_count);
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
  park(0, words_);
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
  if (row % lane_count == 0) park(first_word, words);
}

void Table::copy_from(std::uint32_t row, const Table& other, std::uint32_t other_row) {
  for (std::size_t i = 0; i < key_.size(); ++i) {
    const KeyPart& part = key_[i];
    const KeyPart* theirs = has_column(part.kind) ? find_part(other.key_, part.id) : nullptr;
    if (theirs == nullptr || !(*theirs == part)) continue;
    copy_lane(blocks_[row / lane_count] + first_word_[i] * lane_count + row % lane_count,
              other.blocks_[other_row / lane_count] + other.column(part.id) * lane_count + other_row % lane_count,
              static_cast<std::uint32_t>(part.value));
  }
  if (row % lane_count == 0) park(0, words_);
}

/// Fills the lanes without a row of the last block with copies of its lane 0.
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

}  // namespace mobil
