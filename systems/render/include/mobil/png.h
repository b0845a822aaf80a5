#pragma once
// Writes pictures as PNG files.

#include <string>

#include <mobil/engine/error.h>
#include <mobil/systems/render/image.h>

namespace mobil::inline v0_3 {

/// Compression effort: quick, for frames of a video, or small, for files about 20 % smaller.
enum class PngEffort { quick, small };

/// Writes a picture to `path`, completely or not at all (OutputFile). Opaque pictures are stored without opacity.
/// Errors: an empty picture, a folder that is missing or not writable, a full disk.
Result<void> write_png(const std::string& path, const Image& image, PngEffort effort = PngEffort::quick);

}  // namespace mobil::inline v0_3
