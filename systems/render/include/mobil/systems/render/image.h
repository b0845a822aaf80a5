#pragma once
// A picture in memory.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace mobil::inline v0_3 {

/// Rows from the top, pixels from the left, four sRGB bytes each (red, green, blue, opacity).
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;

  const std::uint8_t* pixel(int x, int y) const {
    return rgba.data() +
           4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  }
};

}  // namespace mobil::inline v0_3
