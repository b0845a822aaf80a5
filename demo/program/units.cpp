#include "demo/program/units.h"

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <span>

namespace mobil {
namespace {

struct Unit {
  std::string_view name;
  double base;  // its size in base units
};

constexpr Unit length_units[] = {{"m", 1}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}, {"ft", 0.3048}};
constexpr Unit masses[] = {{"kg", 1}, {"g", 0.001}, {"lb", 0.45359237}};
constexpr Unit speeds[] = {{"m/s", 1}, {"km/h", 1 / 3.6}, {"mph", 0.44704}};
constexpr Unit frequencies[] = {{"Hz", 1}, {"hz", 1}, {"steps/s", 1}, {"steps/min", 1.0 / 60}};
constexpr Unit times[] = {{"s", 1}, {"ms", 0.001}, {"min", 60}};
constexpr Unit angles[] = {{"deg", 1}, {"°", 1}, {"rad", 180 / std::numbers::pi}};
constexpr Unit pressures[] = {{"Pa", 1}, {"kPa", 1e3}, {"MPa", 1e6}};
constexpr Unit densities[] = {{"kg/m3", 1}, {"g/cm3", 1000}};
constexpr Unit rates[] = {{"1/s", 1}, {"/s", 1}};  // "5/s", because the 1 of "51/s" would belong to the number
constexpr Unit stiffnesses[] = {{"N/m", 1}, {"kN/m", 1e3}};

std::span<const Unit> units(Quantity quantity) {
  switch (quantity) {
    case Quantity::length:
      return length_units;
    case Quantity::mass:
      return masses;
    case Quantity::speed:
      return speeds;
    case Quantity::frequency:
      return frequencies;
    case Quantity::time:
      return times;
    case Quantity::angle:
      return angles;
    case Quantity::pressure:
      return pressures;
    case Quantity::density:
      return densities;
    case Quantity::rate:
      return rates;
    case Quantity::stiffness:
      return stiffnesses;
    case Quantity::ratio:
      break;
  }
  return {};
}

}  // namespace

std::string_view base_unit(Quantity quantity) {
  const auto known = units(quantity);
  return known.empty() ? std::string_view() : known.front().name;
}

Result<double> parse_quantity(const std::string& asked, Quantity quantity) {
  std::string known;
  for (const auto& unit : units(quantity)) known += fmt::format("{}{}", known.empty() ? "" : ", ", unit.name);
  const std::string text = asked.substr(0, asked.find_last_not_of(" \t\r") + 1);
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const auto used = static_cast<std::size_t>(end - text.c_str());
  if (used == 0 || !std::isfinite(value)) {
    return fail(fmt::format("'{}' is not a finite number; write one {}", text,
                            known.empty() ? "without a unit" : fmt::format("with an optional unit ({})", known)));
  }
  const auto first = text.find_first_not_of(' ', used);
  if (first == std::string::npos) return value;
  const std::string_view suffix = std::string_view(text).substr(first);
  for (const auto& unit : units(quantity)) {
    if (unit.name == suffix) return value * unit.base;
  }
  if (known.empty()) return fail(fmt::format("'{}' has a unit '{}'; write the number without one", text, suffix));
  return fail(fmt::format("'{}' has an unknown unit '{}'; known: {}", text, suffix, known));
}

Result<double> read_value(std::string_view name, const std::string& text, Quantity quantity) {
  auto value = parse_quantity(text, quantity);
  if (!value) return fail(fmt::format("{} {}", name, value.error().message));
  return value;
}

Result<double> read_value(std::string_view name, const std::string& text, Quantity quantity, double low, double high) {
  auto value = read_value(name, text, quantity);
  if (!value || (*value >= low && *value <= high)) return value;
  const std::string_view unit = base_unit(quantity);
  return fail(fmt::format("{} {}: outside the valid range {:g} to {:g}{}{}; choose a value inside it", name, text, low,
                          high, unit.empty() ? "" : " ", unit));
}

std::optional<std::uint64_t> parse_count(std::string_view text, std::uint64_t least, std::uint64_t most) {
  constexpr std::size_t max_digits = 18;  // fits 64 bits
  if (text.empty() || text.size() > max_digits) return std::nullopt;
  std::uint64_t count = 0;
  for (const char c : text) {
    if (c < '0' || c > '9') return std::nullopt;
    count = 10 * count + static_cast<std::uint64_t>(c - '0');
  }
  return count >= least && count <= most ? std::optional(count) : std::nullopt;
}

Result<std::uint64_t> read_count(std::string_view option, const std::string& text, std::uint64_t least,
                                 std::uint64_t most) {
  if (const auto count = parse_count(text, least, most)) return *count;
  return fail(fmt::format("{} {}: give a whole number from {} to {}", option, text, least, most));
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t end = std::min(text.find(separator, from), text.size());
    parts.emplace_back(text.substr(from, end - from));
    from = end + 1;
  }
  return parts;
}

}  // namespace mobil
