#pragma once
// The finaliser of SplitMix64 (Steele, Lea and Flood 2014), a bijection that scatters bits, the same on every machine.

#include <cstdint>

namespace mobil {

constexpr std::uint64_t scatter(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

}  // namespace mobil
