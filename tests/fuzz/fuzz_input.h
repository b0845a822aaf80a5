#pragma once
// Definition of a fuzz target, and a reader of numbers from the bytes that it is given.
//
// A target is one header, NAME_target.h, with `void fuzz_NAME(std::span<const std::uint8_t>)`, a name in
// CMakeLists.txt's list, and a folder of seed inputs, corpus/NAME. It ends the program (`promise`) if a property fails
// that must hold for any bytes. tests/fuzz/run builds the targets with libFuzzer and searches for failing inputs.
// fuzz_test runs the seed inputs, inputs that once failed, and random mutations of them, in every run of the tests.

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

#include <mobil/engine/error.h>

namespace mobil::fuzz {

using Input = std::span<const std::uint8_t>;

inline void promise(bool held, const char* what) {
  if (held) return;
  std::fprintf(stderr, "broken promise: %s\n", what);
  std::abort();
}

/// Checks that a refusal is one non-empty line.
inline void promise_line(const std::string& message) {
  promise(!message.empty(), "an error has a message");
  promise(message.find('\n') == std::string::npos, "an error's message is one line");
  promise(message.size() < 2100, "an error's message is short");
}
template <class T>
bool held(const Result<T>& result) {
  if (!result) promise_line(result.error().message);
  return result.has_value();
}

inline std::string_view text_of(Input input) {
  return {reinterpret_cast<const char*>(input.data()), input.size()};
}

/// Takes small numbers from the front of the input, and zeros at its end.
class Numbers {
 public:
  explicit Numbers(Input input) : left_(input) {}
  bool empty() const { return left_.empty(); }
  std::uint8_t byte() {
    if (left_.empty()) return 0;
    const std::uint8_t first = left_.front();
    left_ = left_.subspan(1);
    return first;
  }
  std::uint32_t word() {
    std::uint32_t made = 0;
    for (unsigned i = 0; i < 4; ++i) made |= static_cast<std::uint32_t>(byte()) << 8 * i;
    return made;
  }
  /// Returns any float; mostly a small one.
  float number() {
    const std::uint8_t kind = byte();
    if (kind >= 200) {
      const std::uint32_t bits = word();
      float any;
      std::memcpy(&any, &bits, sizeof any);
      return any;
    }
    return (static_cast<float>(kind) - 100) / 32;
  }
  int choice(int count) { return byte() % count; }
  /// Returns mostly a value of an enumeration, sometimes an invalid one.
  int wild(int count) {
    const int value = byte();
    return value < 240 ? value % count : value - 250;
  }

 private:
  Input left_;
};

}  // namespace mobil::fuzz
