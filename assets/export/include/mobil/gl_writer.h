#pragma once
// Writes a recorded walk as vertices ready to draw, one block a time step: the paper's files with the GL coordinates.

#include <filesystem>

#include <mobil/assets/export/walk_recording.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Writes `path`, completely or not at all; little-endian, 4 bytes a number, no gaps.
///
///     char magic[8] = "MOBILGL1"
///     uint32 frames, parts, vertices, indices;  float32 frame_s;
///     parts times:     char name[64] (UTF-8, padded with zeros); uint32 first_vertex, vertices, first_index, indices;
///                      float32 red, green, blue (linear);
///     indices times:   uint32, three a triangle, counted over all parts, wound outwards;
///     frames times:    vertices times float32 x, y, z (m, world, +Y up), nx, ny, nz (unit);
///
/// Frame f is thus one glBufferData of 24 · vertices bytes at 28 + 92 · parts + 4 · indices + 24 · vertices · f. Parts
/// are the bones, then the muscles. Fails as check_recording, on numbers beyond 32 bits, or on a file that cannot be
/// written.
Result<void> write_gl(const std::filesystem::path& path, const WalkRecording& recording);

}  // namespace mobil::inline v0_3
