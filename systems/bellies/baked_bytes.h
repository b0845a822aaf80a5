#pragma once
// Numbers and arrays of them in bytes and out again.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "engine/snapshot_bytes.h"

namespace mobil::inline v0_3 {

/// Appends.
class BakeWriter {
 public:
  template <class T>
  void put(const T& number) {
    static_assert(std::is_arithmetic_v<T>);
    append(&number, sizeof(T));
  }
  template <class T>
  void operator()(const std::vector<T>& numbers, std::size_t) {
    static_assert(std::is_arithmetic_v<T>);
    append(numbers.data(), numbers.size() * sizeof(T));
  }
  std::vector<std::byte> bytes;

 private:
  void append(const void* from, std::size_t count) {
    const auto* const first = static_cast<const std::byte*>(from);
    bytes.insert(bytes.end(), first, first + count);
  }
};

/// Takes; once there are too few bytes, or a number is not finite, nothing is sound any more.
class BakeReader {
 public:
  explicit BakeReader(std::span<const std::byte> in) : in_(in) {}

  template <class T>
  T take() {
    T number{};
    sound_ = in_.take(number) && finite(number) && sound_;
    return sound_ ? number : T{};
  }
  /// At most `most`.
  std::uint32_t take_up_to(std::uint32_t most) {
    const auto number = take<std::uint32_t>();
    sound_ = sound_ && number <= most;
    return sound_ ? number : 0;
  }
  template <class T>
  void operator()(std::vector<T>& numbers, std::size_t length) {
    const Records<T> all = in_.take_many<T>(length);
    sound_ = sound_ && all.size() == length;
    if (!sound_) return;
    numbers.resize(length);
    for (std::size_t i = 0; i < length; ++i) {
      numbers[i] = all[i];
      sound_ = sound_ && finite(numbers[i]);
    }
  }
  bool sound() const { return sound_; }
  void refuse() { sound_ = false; }
  /// Sound, and nothing is left.
  bool whole() const { return sound_ && in_.whole(); }

 private:
  template <class T>
  static bool finite(T number) {
    if constexpr (std::is_floating_point_v<T>) return std::isfinite(number);
    return true;
  }

  ByteReader in_;
  bool sound_ = true;
};

}  // namespace mobil::inline v0_3
