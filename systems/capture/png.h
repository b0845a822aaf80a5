#pragma once
// A picture as a PNG file.

#include <string>

#include "engine/error.h"
#include "systems/capture/image.h"

namespace mobil {

/// Writes `path` whole or not at all: a temporary file beside it is renamed at the end. Opaque pictures are stored
/// without their opacity. Errors: an empty picture, a folder that is missing or not writable, a full disk.
Result<void> write_png(const std::string& path, const Image& image);

}  // namespace mobil
