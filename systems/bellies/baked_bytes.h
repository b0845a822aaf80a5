#pragma once
// Writes numbers and arrays to bytes and reads them back. Baked bytes begin with a header: magic, maker, length, seal.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include <mobil/engine/error.h>
#include <mobil/engine/interrupt.h>
#include "engine/snapshot_bytes.h"

namespace mobil::inline v0_3 {

/// Appends numbers to `bytes`.
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
    check_interrupt();
    const auto* const first = static_cast<const std::byte*>(from);
    bytes.insert(bytes.end(), first, first + count);
  }
};

/// Reads numbers. After too few bytes or a number that is not finite, the reader stays unsound.
class BakeReader {
 public:
  explicit BakeReader(std::span<const std::byte> in) : in_(in) {}

  template <class T>
  T take() {
    T number{};
    sound_ = in_.take(number) && finite(number) && sound_;
    return sound_ ? number : T{};
  }
  /// Reads a number of at most `most`.
  std::uint32_t take_up_to(std::uint32_t most) {
    const auto number = take<std::uint32_t>();
    sound_ = sound_ && number <= most;
    return sound_ ? number : 0;
  }
  template <class T>
  void operator()(std::vector<T>& numbers, std::size_t length) {
    check_interrupt();
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
  /// Returns true if the reader is sound and no bytes are left.
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

/// Returns the contents behind a header. The maker is a hash of everything that determines their bits.
std::vector<std::byte> sealed(const BakeWriter& contents, std::uint64_t magic, std::uint64_t maker);
/// Returns the contents of sealed bytes. `what`, for messages, is "bellies" or "skins". Errors: bytes of another kind,
/// cut or altered bytes, those of another maker.
Result<std::span<const std::byte>> opened(std::span<const std::byte> baked, std::uint64_t magic,
                                          std::uint64_t (*maker)(), std::string_view what);

}  // namespace mobil::inline v0_3
