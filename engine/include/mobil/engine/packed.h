#pragma once
// Systems that work on few rows. A first function chooses lanes of each block. The chosen rows are gathered into full
// blocks of sixteen, a second function works on these, and its results are scattered back.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <tuple>
#include <type_traits>

#include <mobil/engine/access.h>

namespace mobil::inline v0_3 {

/// A chosen row: a lane of a block, with the kernel's parameters bound to its table.
struct ChosenRow {
  float* block;
  const Bound* bound;
  std::uint32_t lane;
};

/// A parameter of the kernel of a packed system: a component, read or written, or the tick.
template <class P>
struct PackedParameter;

/// Parameters that rows do not contain.
template <class P>
struct TickParameter {
  struct Block {};
  static void gather(Block&, std::span<const ChosenRow>, std::size_t) {}
  static void scatter(const Block&, std::span<const ChosenRow>, std::size_t) {}
};
template <>
struct PackedParameter<float> : TickParameter<float> {
  static float make(Block&, Tick tick) { return tick.dt_s; }
};
template <>
struct PackedParameter<Tick> : TickParameter<Tick> {
  static Tick make(Block&, Tick tick) { return tick; }
};

template <template <class> class C>
struct PackedParameter<C<Lanes<float>>&> {
  using Block = C<Lanes<float>>;
  static constexpr std::size_t words = ComponentLayout<C>::words;

  static Block& make(Block& block, Tick) { return block; }
  /// Gathers the rows; lanes without a row repeat the first one.
  static void gather(Block& block, std::span<const ChosenRow> rows, std::size_t parameter) {
    auto* out = reinterpret_cast<std::byte*>(&block);
    for (std::size_t l = 0; l < lane_count; ++l) {
      const ChosenRow& row = rows[l < rows.size() ? l : 0];
      const float* in = row.block + row.bound[parameter].first_word * lane_count + row.lane;
      for (std::size_t w = 0; w < words; ++w) std::memcpy(out + 4 * (w * lane_count + l), in + w * lane_count, 4);
    }
  }
  static void scatter(const Block& block, std::span<const ChosenRow> rows, std::size_t parameter) {
    const auto* in = reinterpret_cast<const std::byte*>(&block);
    for (std::size_t l = 0; l < rows.size(); ++l) {
      const ChosenRow& row = rows[l];
      float* out = row.block + row.bound[parameter].first_word * lane_count + row.lane;
      for (std::size_t w = 0; w < words; ++w) std::memcpy(out + w * lane_count, in + 4 * (w * lane_count + l), 4);
    }
  }
};

template <template <class> class C>
struct PackedParameter<const C<Lanes<float>>&> : PackedParameter<C<Lanes<float>>&> {
  using Block = C<Lanes<float>>;
  static const Block& make(Block& block, Tick) { return block; }
  static void scatter(const Block&, std::span<const ChosenRow>, std::size_t) {}
};

/// Runs `function` on at most sixteen rows.
template <class... P, class F>
void run_packed(const F& function, std::span<const ChosenRow> rows, Tick tick) {
  std::tuple<typename PackedParameter<P>::Block...> blocks;
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    (PackedParameter<P>::gather(std::get<i>(blocks), rows, i), ...);
    function(PackedParameter<P>::make(std::get<i>(blocks), tick)...);
    (PackedParameter<P>::scatter(std::get<i>(blocks), rows, i), ...);
  }
  (std::index_sequence_for<P...>{});
}

}  // namespace mobil::inline v0_3
