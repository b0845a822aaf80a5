#pragma once
// Plain data in and out of bytes of any alignment; layout and seals of a snapshot:
//
//   header | front: the caller's own | world: keys, register, rows' entities | blocks | seals, one a chunk
//
// Each chunk has a seal (a hash). The header has a seal of itself and of all seals, so that every altered bit and every
// missing byte is detected.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

#include <mobil/engine/error.h>
#include <mobil/engine/jobs.h>

namespace mobil::inline v0_3 {

/// Plain values in sequence.
template <class T>
class Records {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  Records() = default;
  Records(const std::byte* at, std::size_t count) : at_(at), count_(count) {}
  std::size_t size() const { return count_; }
  T operator[](std::size_t i) const {
    T value;
    std::memcpy(&value, at_ + i * sizeof(T), sizeof(T));
    return value;
  }

 private:
  const std::byte* at_ = nullptr;
  std::size_t count_ = 0;
};

/// Writes values into memory that is large enough.
class ByteWriter {
 public:
  explicit ByteWriter(std::byte* out) : at_(out) {}
  template <class T>
  void put(const T& value) {
    put(&value, 1);
  }
  template <class T>
  void put(const T* values, std::size_t count) {
    static_assert(std::has_unique_object_representations_v<T>, "no padding: what is written is always the same");
    if (count != 0) std::memcpy(at_, values, count * sizeof(T));
    at_ += count * sizeof(T);
  }
  std::byte* at() const { return at_; }

 private:
  std::byte* at_;
};

/// Reads values from bytes; if there are too few, that read and `whole` fail.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> in) : left_(in) {}
  template <class T>
  bool take(T& value) {
    const auto one = take_many<T>(1);
    if (one.size() == 1) value = one[0];
    return one.size() == 1;
  }
  /// Returns an empty list if there are fewer than `count`.
  template <class T>
  Records<T> take_many(std::uint64_t count) {
    if (count > left_.size() / sizeof(T)) {
      short_ = true;
      return {};
    }
    const Records<T> records(left_.data(), static_cast<std::size_t>(count));
    left_ = left_.subspan(static_cast<std::size_t>(count) * sizeof(T));
    return records;
  }
  std::span<const std::byte> take_bytes(std::uint64_t count) {
    const Records<std::byte> bytes = take_many<std::byte>(count);
    return bytes.size() == 0 ? std::span<const std::byte>{} : std::span(left_.data() - bytes.size(), bytes.size());
  }
  /// Returns true if all reads succeeded and no bytes are left.
  bool whole() const { return !short_ && left_.empty(); }

 private:
  std::span<const std::byte> left_;
  bool short_ = false;
};

/// Sizes of a snapshot's parts, and their offsets.
struct SnapshotLayout {
  std::uint64_t front = 0, world = 0, blocks = 0;

  static constexpr std::size_t header_bytes = 64, chunk_bytes = std::size_t{1} << 16;
  std::size_t front_at() const { return header_bytes; }
  std::size_t world_at() const { return front_at() + front; }
  std::size_t blocks_at() const { return aligned(world_at() + world); }
  std::size_t seals_at() const { return aligned(blocks_at() + blocks); }
  std::size_t chunks() const { return (seals_at() - header_bytes + chunk_bytes - 1) / chunk_bytes; }
  std::size_t bytes() const { return seals_at() + 8 * chunks(); }

 private:
  static std::size_t aligned(std::size_t bytes) { return (bytes + 63) / 64 * 64; }
};

struct OpenSnapshot {
  std::span<const std::byte> front, world, blocks;
};

/// Writes chunks of `out` (of layout.bytes()) by `fill(context, begin, end)`, ranges of bytes within the blocks, and
/// seals the snapshot. Front and world must be written before. A null `fill` means that blocks are written as well.
void seal_snapshot(const SnapshotLayout& layout, std::span<std::byte> out, const Jobs& jobs,
                   void (*fill)(void* context, std::size_t begin, std::size_t end), void* context);

/// Checks a snapshot. Errors, one line each: other bytes, another version or byte order, too short or long, altered.
Result<OpenSnapshot> open_snapshot(std::span<const std::byte> in, const Jobs& jobs);

}  // namespace mobil::inline v0_3
