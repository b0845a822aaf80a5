#include "systems/bellies/leg_muscles_io.h"

#include <bit>
#include <limits>
#include <type_traits>

#include "engine/row_hash.h"

namespace mobil::inline v0_3 {
namespace {

/// Calls f with each field. A field missing here is a compile error.
template <class Choice, class F>
constexpr void each_field(Choice& choice, F&& f) {
  auto& [muscles, drive, method, modal, material, element, mass, damping, stiffness_damping, inertia, line_motion,
         activation, finite_shape, foundation, cells, dt] = choice;
  auto& [modes, moving, corrected, modal_cells, control_points, reported, tuned, linear_shape] = modal;
  auto& [density, young, poisson] = material;
  const auto all = [&f](auto&... field) { (f(field), ...); };
  all(muscles, drive, method, modes, moving, corrected, modal_cells, control_points, reported, density, young, poisson,
      element, mass, damping, stiffness_damping, inertia, line_motion, foundation, cells, dt, activation, finite_shape,
      tuned, linear_shape);
}

constexpr Drive last_of(Drive) {
  return Drive::force;
}
constexpr Method last_of(Method) {
  return last_method;
}
constexpr Element last_of(Element) {
  return Element::one_point;
}
constexpr Mass last_of(Mass) {
  return Mass::consistent;
}
constexpr ExcitationSource last_of(ExcitationSource) {
  return ExcitationSource::moments;
}

struct Writer {
  LegMusclesWords words{};
  std::size_t next = 0;

  constexpr void put(std::uint64_t word) { words[next++] = word; }
  void operator()(const MuscleSet& set) { put(set.to_ullong()); }
  constexpr void operator()(double value) { put(std::bit_cast<std::uint64_t>(value)); }
  constexpr void operator()(const std::optional<double>& value) {
    put(value.has_value());
    (*this)(value.value_or(0));
  }
  constexpr void operator()(const std::optional<bool>& value) { put(value ? 1U + *value : 0U); }
  constexpr void operator()(const Cells& cells) {
    for (const std::uint32_t count : cells) put(count);
  }
  template <class T>
  requires std::is_enum_v<T> || std::is_integral_v<T>
  constexpr void operator()(T value) { put(static_cast<std::uint64_t>(value)); }
};

struct Reader {
  const LegMusclesWords& words;
  std::size_t next = 0;
  bool sound = true;

  /// Reads the next word, whose maximum is `most`.
  std::uint64_t take(std::uint64_t most) {
    const std::uint64_t word = words[next++];
    sound = sound && word <= most;
    return word;
  }
  void operator()(MuscleSet& set) { set = MuscleSet(take((std::uint64_t{1} << muscle_count) - 1)); }
  void operator()(double& value) { value = std::bit_cast<double>(words[next++]); }
  void operator()(std::optional<double>& value) {
    const bool there = take(1) != 0;
    const double number = std::bit_cast<double>(words[next++]);
    if (there) value = number;
  }
  void operator()(std::optional<bool>& value) {
    const std::uint64_t word = take(2);
    if (word != 0) value = word == 2;
  }
  void operator()(Cells& cells) {
    for (std::uint32_t& count : cells) (*this)(count);
  }
  void operator()(bool& value) { value = take(1) != 0; }
  void operator()(std::uint32_t& value) {
    value = static_cast<std::uint32_t>(take(std::numeric_limits<std::uint32_t>::max()));
  }
  template <class T>
  requires std::is_enum_v<T>
  void operator()(T& value) { value = static_cast<T>(take(static_cast<std::uint64_t>(last_of(T{})))); }
};

}  // namespace

LegMusclesWords leg_muscles_words(const LegMuscles& choice) {
  Writer writer;
  each_field(choice, writer);
  return writer.words;
}

std::optional<LegMuscles> choice_of(const LegMusclesWords& words) {
  LegMuscles choice;
  Reader reader{words};
  each_field(choice, reader);
  if (!reader.sound) return std::nullopt;
  return choice;
}

std::uint64_t hash_of(const LegMuscles& choice) {
  // Words added later count only if nonzero, so choices without them keep their earlier hash.
  constexpr std::size_t first_words = 27;
  const LegMusclesWords words = leg_muscles_words(choice);
  std::uint64_t hash = 1;
  for (std::size_t w = 0; w < words.size(); ++w) {
    if (w < first_words || words[w] != 0)
      hash = mix64((hash + 0x9e3779b97f4a7c15) ^ (w < first_words ? 0 : std::uint64_t{w} << 32) ^ words[w]);
  }
  return hash;
}

}  // namespace mobil::inline v0_3
