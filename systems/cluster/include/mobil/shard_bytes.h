#pragma once
// A shard as bytes: its simulation, and what its host keeps.

#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include <mobil/engine/error.h>
#include <mobil/simulation.h>

namespace mobil::inline v0_3 {

/// Plain values one after the other.
class PlainBytes {
 public:
  /// Appends a value, or all of a list, as they lie in memory.
  template <class T>
  void put(const T& value) {
    put_all(std::span(&value, 1));
  }
  /// The same of a list; its length is not written.
  template <class T>
  void put_all(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::size_t at = bytes_.size();
    bytes_.resize(at + values.size_bytes());
    if (!values.empty()) std::memcpy(&bytes_[at], values.data(), values.size_bytes());
  }
  /// All that was put so far.
  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

/// The same taken out again; `whole` says whether all of it was there, and nothing is left.
class PlainReader {
 public:
  explicit PlainReader(std::span<const std::byte> bytes) : left_(bytes) {}
  /// The next value; it stays as it is where the bytes do not suffice.
  template <class T>
  void take(T& value) {
    take_all(std::span(&value, 1));
  }
  /// The same of a list, whose length the caller knows.
  template <class T>
  void take_all(std::span<T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    good_ = good_ && values.size_bytes() <= left_.size();
    if (!good_ || values.empty()) return;
    std::memcpy(values.data(), left_.data(), values.size_bytes());
    left_ = left_.subspan(values.size_bytes());
  }
  /// A list of that length; an empty one where fewer values are left.
  template <class T>
  std::vector<T> take_many(std::size_t count) {
    good_ = good_ && count <= left_.size() / sizeof(T);
    std::vector<T> values(good_ ? count : 0);
    take_all(std::span(values));
    return values;
  }
  bool whole() const { return good_ && left_.empty(); }

 private:
  std::span<const std::byte> left_;
  bool good_ = true;
};

/// Errors: what Simulation::save refuses.
Result<std::vector<std::byte>> pack_shard(const Simulation& simulation, std::span<const std::byte> host);
/// The host's part. Errors: bytes that do not fit; what Simulation::restore refuses. The bytes are taken for one's own:
/// messages and files are sealed, and limits (RestoreLimits) are none.
Result<std::vector<std::byte>> unpack_shard(std::span<const std::byte> bytes, Simulation& simulation);

}  // namespace mobil::inline v0_3
