#pragma once
// Layout of vertices in a caller's buffer.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <mobil/engine/error.h>
#include <mobil/pose_writer.h>

namespace mobil::inline v0_3 {

/// Three floats a vertex, or four for tangents. Vertex v begins at byte v · stride. No other byte is written, and none
/// is read.
struct VertexStream {
  std::span<std::byte> bytes;
  std::size_t stride = 3 * sizeof(float);  // at least 12, or 16 for tangents
};

/// Axes and unit of length of written vertices, as those of poses (PoseLayout). In axes of the other handedness,
/// triangles must be wound the other way round.
struct VertexAxes {
  PoseAxes axes = PoseAxes::y_up;
  float units_per_m = 1;
};
/// Fails on a unit outside 0.001 to 1e6 a metre.
Result<void> check_axes(const VertexAxes& axes);
enum class VertexField : std::uint8_t { position, normal, tangent };
/// Converts `count` written vertices of a stream from the first on to other axes; of an empty stream, none.
void convert_axes(const VertexStream& stream, std::size_t first, std::size_t count, VertexField field,
                  const VertexAxes& axes);

/// Returns the minimum and the maximum coordinates of the first `count` positions, at least one.
std::array<Vec3<float>, 2> bounds_of(const VertexStream& positions, std::size_t count);

/// Checks that the stream has room for so many vertices of `bytes` bytes each. Errors, with `what` in the message: a
/// stride or a buffer that is too small.
Result<void> check_stream(const char* what, const VertexStream& stream, std::size_t vertices, std::size_t bytes);

/// Returns true if vertices of two streams overlap. Streams in the same memory must have the same stride.
bool lie_over(const VertexStream& a, std::size_t a_bytes, const VertexStream& b, std::size_t b_bytes,
              std::size_t vertices);

}  // namespace mobil::inline v0_3
