#pragma once
// Bases made while ticks run: the host's executor, and the list of ordered bases.

#include <array>
#include <cstdint>

namespace mobil::inline v0_3 {

/// The host's executor for background work. `run` must call `work(argument)` once, at any time, on any thread.
struct Background {
  void* user = nullptr;
  void (*run)(void* user, void (*work)(void* argument), void* argument) = nullptr;  // null: no executor
};

/// An ordered basis, usable from `ready_tick` on. `choice` is a hash of the tissue and effects.
struct OrderedBasis {
  std::uint64_t choice;
  float ratio, product;  // the centre of the range of bodies that it covers
  std::uint16_t muscle, cells;
  std::uint32_t ready_tick;

  friend bool operator==(const OrderedBasis&, const OrderedBasis&) = default;
};

/// All ordered bases. If the list is full, a further basis is made at once.
struct OrderedBases {
  std::array<OrderedBasis, 128> one{};
  std::uint32_t count = 0;
};

}  // namespace mobil::inline v0_3
