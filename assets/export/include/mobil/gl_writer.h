#pragma once
// A recorded walk as vertices ready to draw, one block a time step: what the paper calls files with the GL coordinates.

#include <filesystem>

#include <mobil/assets/export/walk_recording.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Writes `path`, whole or not at all; little-endian, 4 bytes a number, no gaps:
///
///     char magic[8] = "MOBILGL1"
///     uint32 frames, parts, vertices, indices;  float32 frame_s
///     parts times:     char name[64] (UTF-8, zeros behind it); uint32 first_vertex, vertices, first_index, indices;
///                      float32 red, green, blue (linear)
///     indices times:   uint32, three a triangle, counted over all parts, wound outwards
///     frames times:    vertices times float32 x, y, z (m, world, +Y up), nx, ny, nz (unit)
///
/// So frame f is one glBufferData of 24 · vertices bytes at 28 + 92 · parts + 4 · indices + 24 · vertices · f. Parts
/// are the bones, then the muscles. Errors: those of check_recording, numbers that 32 bits do not hold, a file that
/// cannot be written.
Result<void> write_gl(const std::filesystem::path& path, const WalkRecording& recording);

}  // namespace mobil::inline v0_3
