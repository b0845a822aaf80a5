#pragma once
// Where vertices go in a caller's buffer.

#include <cstddef>
#include <span>

#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Three floats a vertex, of tangents four: vertex v begins at byte v · stride. Nothing else in it is written, and
/// nothing read.
struct VertexStream {
  std::span<std::byte> bytes;
  std::size_t stride = 3 * sizeof(float);  // at least 12, of tangents 16
};

/// Whether so many vertices of `bytes` each have room in it. Errors, in one line with `what`: a stride or a buffer that
/// is too small.
Result<void> check_stream(const char* what, const VertexStream& stream, std::size_t vertices, std::size_t bytes);

/// Whether any of a stream's vertices lies over any of another's. Streams in the same memory share a stride.
bool lie_over(const VertexStream& a, std::size_t a_bytes, const VertexStream& b, std::size_t b_bytes,
              std::size_t vertices);

}  // namespace mobil::inline v0_3
