#include "demo/units.h"

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <string_view>

namespace mobil {
namespace {

struct Unit {
  std::string_view name;
  double si;
};

constexpr Unit lengths[] = {{"m", 1}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}, {"ft", 0.3048}};
constexpr Unit masses[] = {{"kg", 1}, {"g", 0.001}, {"lb", 0.45359237}};
constexpr Unit speeds[] = {{"m/s", 1}, {"km/h", 1 / 3.6}, {"mph", 0.44704}};
constexpr Unit frequencies[] = {{"Hz", 1}, {"hz", 1}, {"steps/s", 1}, {"steps/min", 1.0 / 60}};
constexpr Unit times[] = {{"s", 1}, {"ms", 0.001}, {"min", 60}};

std::span<const Unit> units(Quantity quantity) {
  switch (quantity) {
    case Quantity::length:
      return lengths;
    case Quantity::mass:
      return masses;
    case Quantity::speed:
      return speeds;
    case Quantity::frequency:
      return frequencies;
    case Quantity::time:
      return times;
  }
  return {};
}

}  // namespace

std::string_view si_unit(Quantity quantity) {
  return units(quantity).front().name;
}

Result<double> parse_quantity(const std::string& text, Quantity quantity) {
  std::string known;
  for (const auto& unit : units(quantity)) known += fmt::format("{}{}", known.empty() ? "" : ", ", unit.name);
  std::size_t used = 0;
  double value = NAN;
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used == 0 || !std::isfinite(value)) {
    return fail(fmt::format("'{}' is not a finite number; write one with an optional unit ({})", text, known));
  }
  const auto first = text.find_first_not_of(' ', used);
  if (first == std::string::npos) return value;
  const std::string_view suffix = std::string_view(text).substr(first);
  for (const auto& unit : units(quantity)) {
    if (unit.name == suffix) return value * unit.si;
  }
  return fail(fmt::format("'{}' has an unknown unit '{}'; known: {}", text, suffix, known));
}

}  // namespace mobil
