#pragma once
// Disjoint sets that can be joined.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace mobil::inline v0_3 {

/// Members 0 to count - 1, each at first a separate set, identified by its smallest member.
struct UnionFind {
  std::vector<std::uint32_t> root;

  explicit UnionFind(std::size_t count) : root(count) { std::iota(root.begin(), root.end(), 0U); }
  std::uint32_t find(std::uint32_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    root[std::max(a, b)] = std::min(a, b);
  }
};

}  // namespace mobil::inline v0_3
