#include <mobil/png.h>

#include <fmt/format.h>
#include <png.h>

#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <cstring>

#include <mobil/assets/files/output_file.h>

namespace mobil::inline v0_3 {
namespace {

bool opaque(const Image& image) {
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
    if (image.rgba[i] != 255) return false;
  }
  return true;
}

/// Writes the picture to a file. libpng fails by longjmp, so no local object has a destructor.
bool encode(std::FILE* file, const Image& image, bool with_opacity, PngEffort effort) {
  // libpng's own functions print to stderr.
  png_structp png = png_create_write_struct(
      PNG_LIBPNG_VER_STRING, nullptr, [](png_structp of, png_const_charp) { png_longjmp(of, 1); },
      [](png_structp, png_const_charp) {});
  if (png == nullptr) return false;
  png_infop info = png_create_info_struct(png);
  if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_init_io(png, file);
  png_set_compression_level(png, effort == PngEffort::quick ? 2 : 9);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, effort == PngEffort::quick ? PNG_FILTER_UP : PNG_ALL_FILTERS);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height), 8,
               with_opacity ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(png, info);
  if (!with_opacity) png_set_filler(png, 0, PNG_FILLER_AFTER);
  for (int y = 0; y < image.height; ++y) png_write_row(png, image.pixel(0, y));
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return true;
}

}  // namespace

Result<void> write_png(const std::string& path, const Image& image, PngEffort effort) {
  if (image.width < 1 || image.height < 1 ||
      image.rgba.size() != 4 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height)) {
    return fail(fmt::format("{}: a picture of {} x {} pixels with {} bytes cannot be written; it needs 4 bytes a pixel",
                            path, image.width, image.height, image.rgba.size()));
  }
  auto place = OutputFile::at(path);
  if (!place) return tl::unexpected(place.error());
  const auto refused = [&](const char* what) {
    const int reason = errno;
    return fail(
        fmt::format("{}: cannot {} this picture ({}); name a file in a folder that exists, is writable and has room",
                    shown_path(path).string(), what, reason != 0 ? std::strerror(reason) : "unknown reason"));
  };
  errno = 0;
  std::FILE* file = std::fopen(place->temporary().c_str(), "wb");
  if (file == nullptr) return refused("create");
  bool written = encode(file, image, !opaque(image), effort);
  written = std::fflush(file) == 0 && written;
  const int reason = errno;
  if (std::fclose(file) == 0 && written) return place->put();
  if (!written) errno = reason;
  return refused("write");
}

}  // namespace mobil::inline v0_3
