#pragma once
// A picture as a PNG file.

#include <string>

#include <mobil/engine/error.h>
#include <mobil/systems/render/image.h>

namespace mobil::inline v0_3 {

/// How hard the file is squeezed: quickly, for frames of a video; or until it is about a fifth smaller.
enum class PngEffort { quick, small };

/// Writes `path` whole or not at all, by an OutputFile. Opaque pictures are stored without their opacity. Errors: an
/// empty picture, a folder that is missing or not writable, a full disk.
Result<void> write_png(const std::string& path, const Image& image, PngEffort effort = PngEffort::quick);

}  // namespace mobil::inline v0_3
