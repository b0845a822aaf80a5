#include "demo/pictures/contact_sheet.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>

namespace mobil {
namespace {

constexpr int white = 255;

/// Blends a picture over a sheet, which must contain all of it.
void lay(const Image& picture, Image& sheet, int left, int top) {
  for (int y = 0; y < picture.height; ++y) {
    const std::uint8_t* from = picture.pixel(0, y);
    std::uint8_t* to = sheet.rgba.data() + (sheet.pixel(left, top + y) - sheet.rgba.data());
    for (int x = 0; x < picture.width; ++x, from += 4, to += 4) {
      const int cover = from[3];
      for (int c = 0; c < 3; ++c) {
        to[c] = static_cast<std::uint8_t>((from[c] * cover + to[c] * (255 - cover) + 127) / 255);
      }
    }
  }
}

}  // namespace

Image contact_sheet(std::span<const std::vector<Image>> rows, int gap_px) {
  std::vector<int> width, height;
  for (const auto& row : rows) {
    width.resize(std::max(width.size(), row.size()), 0);
    height.push_back(0);
    for (std::size_t column = 0; column < row.size(); ++column) {
      width[column] = std::max(width[column], row[column].width);
      height.back() = std::max(height.back(), row[column].height);
    }
  }
  const auto across = [gap_px](const std::vector<int>& sizes) {
    return std::accumulate(sizes.begin(), sizes.end(), gap_px * (static_cast<int>(sizes.size()) + 1));
  };
  Image sheet;
  if (width.empty()) return sheet;
  sheet.width = across(width);
  sheet.height = across(height);
  sheet.rgba.assign(std::size_t{4} * static_cast<std::size_t>(sheet.width) * static_cast<std::size_t>(sheet.height),
                    white);
  int top = gap_px;
  for (std::size_t r = 0; r < rows.size(); top += height[r++] + gap_px) {
    int left = gap_px;
    for (std::size_t c = 0; c < rows[r].size(); left += width[c++] + gap_px) {
      const Image& picture = rows[r][c];
      lay(picture, sheet, left + (width[c] - picture.width) / 2, top + (height[r] - picture.height) / 2);
    }
  }
  return sheet;
}

}  // namespace mobil
