#pragma once
// Pictures that other programs wrote, as pixels.

#include <png.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace mobil {

using Pixel = std::array<std::uint8_t, 3>;

/// Pixels of a PNG file, row by row; empty if it cannot be read.
inline std::vector<Pixel> read_pixels(const std::filesystem::path& file) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&image, file.c_str()) == 0) return {};
  image.format = PNG_FORMAT_RGB;
  std::vector<Pixel> pixels(std::size_t{image.width} * image.height);
  if (png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr) == 0) return {};
  return pixels;
}

/// Returns the fraction of pixels for which `is` returns true.
template <class Is>
double fraction(const std::vector<Pixel>& pixels, const Is& is) {
  return static_cast<double>(std::ranges::count_if(pixels, is)) /
         static_cast<double>(std::max<std::size_t>(1, pixels.size()));
}

}  // namespace mobil
