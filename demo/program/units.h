#pragma once
// Numbers as people write them: "180cm", "5km/h", "80", "110steps/min", "2x2x8", "0,-9.81,0"; and names in lists.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <mobil/engine/error.h>

namespace mobil {

enum class Quantity { length, mass, speed, frequency, time, angle, pressure, density, rate, stiffness, ratio };

/// The unit of values without one, as in messages: "m", "kg", …; empty for a ratio, which has none.
std::string_view base_unit(Quantity quantity);

/// Reads a number with an optional unit and returns it in the base unit: m, kg, m/s, Hz, s, deg (angles alone are not
/// in SI), Pa, kg/m3, 1/s, N/m, 1. Errors: not a finite number, or a unit that does not belong to the quantity (the
/// message lists those that do).
Result<double> parse_quantity(const std::string& text, Quantity quantity);

/// The value of an option, or of what else `name` says; messages begin with the name.
Result<double> read_value(std::string_view name, const std::string& text, Quantity quantity);

/// The same; also fails outside `low` to `high` (base unit).
Result<double> read_value(std::string_view name, const std::string& text, Quantity quantity, double low, double high);

/// One of an enumeration's names, which stand in its order. Errors name the option and all that there are.
template <class E, class Names>
Result<E> choose(std::string_view option, const std::string& text, const Names& names) {
  const auto found = std::find(std::begin(names), std::end(names), text);
  if (found != std::end(names)) return static_cast<E>(found - std::begin(names));
  return fail(fmt::format("{} '{}': choose one of {}", option, text, fmt::join(names, ", ")));
}

/// The first error of several options. What is read after it is worthless.
class OptionReader {
 public:
  /// The value; of a failure an empty one.
  template <class T>
  T operator()(Result<T> read) {
    if (read) return std::move(*read);
    refuse(std::move(read.error().message));
    return T{};
  }
  void operator()(Result<void> done) {
    if (!done) refuse(std::move(done.error().message));
  }
  void refuse(std::string message) {
    if (!error_) error_ = Error{std::move(message)};
  }

  /// `value` where nothing failed; the first error otherwise.
  template <class T>
  Result<T> result(T value) const {
    if (error_) return tl::unexpected(*error_);
    return value;
  }

 private:
  std::optional<Error> error_;
};

/// Digits alone, 18 at most, that make `least` to `most`; nothing otherwise.
std::optional<std::uint64_t> parse_count(std::string_view text, std::uint64_t least, std::uint64_t most);

/// The same of an option; fails where parse_count has nothing.
Result<std::uint64_t> read_count(std::string_view option, const std::string& text, std::uint64_t least,
                                 std::uint64_t most);

/// The parts between separators, empty ones too: always one more than there are separators.
std::vector<std::string> split(std::string_view text, char separator);

/// N plain numbers from `low` to `high` between separators; nothing where there are more, fewer or others.
template <std::size_t N>
std::optional<std::array<double, N>> parse_list(std::string_view text, char separator, double low, double high) {
  const auto parts = split(text, separator);
  if (parts.size() != N) return std::nullopt;
  std::array<double, N> list{};
  for (std::size_t i = 0; i < N; ++i) {
    const auto value = parse_quantity(parts[i], Quantity::ratio);
    if (!value || *value < low || *value > high) return std::nullopt;
    list[i] = *value;
  }
  return list;
}

}  // namespace mobil
