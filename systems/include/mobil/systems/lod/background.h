#pragma once
// What is made while ticks go on: where the work goes, and what was called for.

#include <array>
#include <cstdint>

namespace mobil::inline v0_3 {

/// A host's way to do work that no tick waits for: `run` has `work(argument)` called once, at any time, on any thread.
struct Background {
  void* user = nullptr;
  void (*run)(void* user, void (*work)(void* argument), void* argument) = nullptr;  // null: there is none
};

/// A basis that was called for, and from which tick on it may be taken. `choice`: a hash of the tissue and effects.
struct OrderedBasis {
  std::uint64_t choice;
  float ratio, product;  // the centre of the range of bodies that it serves
  std::uint16_t muscle, cells;
  std::uint32_t ready_tick;

  friend bool operator==(const OrderedBasis&, const OrderedBasis&) = default;
};

/// All that were called for. Where there is no room for more, they are made at once.
struct OrderedBases {
  std::array<OrderedBasis, 128> one{};
  std::uint32_t count = 0;
};

}  // namespace mobil::inline v0_3
