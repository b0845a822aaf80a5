#pragma once
// Reads numbers with units ("180cm", "5km/h", "80", "110steps/min"), lists ("2x2x8", "0,-9.81,0") and names.

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

/// Returns the unit of values without one, such as "m" or "kg"; empty for a ratio.
std::string_view base_unit(Quantity quantity);

/// Reads a number with an optional unit and returns it in the base unit m, kg, m/s, Hz, s, deg (the only one that is
/// not SI), Pa, kg/m3, 1/s, N/m or 1. Errors: not a finite number, or a unit of another quantity (the message lists the
/// valid ones).
Result<double> parse_quantity(const std::string& text, Quantity quantity);

/// Reads the value of an option, or of another input called `name`. Messages begin with the name.
Result<double> read_value(std::string_view name, const std::string& text, Quantity quantity);

/// Reads a value and fails outside `low` to `high` (base unit).
Result<double> read_value(std::string_view name, const std::string& text, Quantity quantity, double low, double high);

/// Returns the enumerator with this name. `names` are in the enumeration's order. Errors list the option and all names.
template <class E, class Names>
Result<E> choose(std::string_view option, const std::string& text, const Names& names) {
  const auto found = std::find(std::begin(names), std::end(names), text);
  if (found != std::end(names)) return static_cast<E>(found - std::begin(names));
  return fail(fmt::format("{} '{}': choose one of {}", option, text, fmt::join(names, ", ")));
}

/// Keeps the first error of several options. Values read after an error are invalid.
class OptionReader {
 public:
  /// Returns the value, or an empty one on failure.
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

  /// Returns `value`, or the first error.
  template <class T>
  Result<T> result(T value) const {
    if (error_) return tl::unexpected(*error_);
    return value;
  }

 private:
  std::optional<Error> error_;
};

/// Reads a number of up to 18 digits, and nothing else, from `least` to `most`. Returns nullopt for other texts.
std::optional<std::uint64_t> parse_count(std::string_view text, std::uint64_t least, std::uint64_t most);

/// Reads the count of an option; fails if parse_count returns nullopt.
Result<std::uint64_t> read_count(std::string_view option, const std::string& text, std::uint64_t least,
                                 std::uint64_t most);

/// Returns the parts between separators, including empty ones. There is always one more part than separators.
std::vector<std::string> split(std::string_view text, char separator);

/// Reads N plain numbers from `low` to `high` between separators. Returns nullopt for other texts.
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
