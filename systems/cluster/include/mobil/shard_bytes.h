#pragma once
// Converts a shard to bytes and back: its simulation and the data of its host.

#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include <mobil/engine/error.h>
#include <mobil/simulation.h>

namespace mobil::inline v0_3 {

/// Writes trivially copyable values to a byte array.
class PlainBytes {
 public:
  /// Appends the bytes of a value.
  template <class T>
  void put(const T& value) {
    put_all(std::span(&value, 1));
  }
  /// Appends the bytes of a list, without its length.
  template <class T>
  void put_all(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::size_t at = bytes_.size();
    bytes_.resize(at + values.size_bytes());
    if (!values.empty()) std::memcpy(&bytes_[at], values.data(), values.size_bytes());
  }
  /// Returns all bytes written so far.
  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

/// Reads the values of a PlainBytes. `whole` returns true if no read failed and no bytes are left.
class PlainReader {
 public:
  explicit PlainReader(std::span<const std::byte> bytes) : left_(bytes) {}
  /// Reads the next value. It is unchanged if too few bytes are left.
  template <class T>
  void take(T& value) {
    take_all(std::span(&value, 1));
  }
  /// Reads a list of the given length. It is unchanged if too few bytes are left.
  template <class T>
  void take_all(std::span<T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    good_ = good_ && values.size_bytes() <= left_.size();
    if (!good_ || values.empty()) return;
    std::memcpy(values.data(), left_.data(), values.size_bytes());
    left_ = left_.subspan(values.size_bytes());
  }
  /// Returns a list of that length, or an empty one if fewer values are left.
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

/// Returns a simulation and the host's data as bytes. Errors: those of Simulation::save.
Result<std::vector<std::byte>> pack_shard(const Simulation& simulation, std::span<const std::byte> host);
/// Restores the simulation and returns the host's data. The bytes are trusted, because messages and files have
/// checksums, and no RestoreLimits apply. Errors: bytes that do not match, those of Simulation::restore.
Result<std::vector<std::byte>> unpack_shard(std::span<const std::byte> bytes, Simulation& simulation);

}  // namespace mobil::inline v0_3
