#include <mobil/systems/surfaces/vertex_stream.h>

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "systems/poses/pose_axes.h"

namespace mobil::inline v0_3 {

Result<void> check_axes(const VertexAxes& axes) {
  if (axes.units_per_m >= 0.001F && axes.units_per_m <= 1e6F) return {};
  return fail(fmt::format("{} units a metre; 0.001 to 1e6", axes.units_per_m));
}

void convert_axes(const VertexStream& stream, std::size_t first, std::size_t count, VertexField field,
                  const VertexAxes& axes) {
  if (stream.bytes.empty() || (axes.axes == PoseAxes::y_up && axes.units_per_m == 1)) return;
  const AxisMap& map = axes_of[static_cast<std::size_t>(axes.axes)];
  const float units = field == VertexField::position ? axes.units_per_m : 1;
  const std::size_t floats = field == VertexField::tangent ? 4 : 3;
  for (std::size_t v = first; v < first + count; ++v) {
    float ours[4], theirs[4];
    std::byte* const at = stream.bytes.data() + v * stream.stride;
    std::memcpy(ours, at, floats * sizeof(float));
    for (std::size_t i = 0; i < 3; ++i) theirs[i] = map.sign[i] * units * ours[map.ours[i]];
    theirs[3] = map.mirrored() * ours[3];
    std::memcpy(at, theirs, floats * sizeof(float));
  }
}

std::array<Vec3<float>, 2> bounds_of(const VertexStream& positions, std::size_t count) {
  const auto at = [&](std::size_t v) {
    Vec3<float> place;
    std::memcpy(&place, positions.bytes.data() + v * positions.stride, sizeof place);
    return place;
  };
  Vec3<float> least = at(0), greatest = least;
  for (std::size_t v = 1; v < count; ++v) {
    const Vec3<float> p = at(v);
    least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
    greatest = {std::max(greatest.x, p.x), std::max(greatest.y, p.y), std::max(greatest.z, p.z)};
  }
  return {least, greatest};
}

Result<void> check_stream(const char* what, const VertexStream& stream, std::size_t vertices, std::size_t bytes) {
  if (stream.stride < bytes)
    return fail(fmt::format("a stride of {} bytes for {}; at least {}", stream.stride, what, bytes));
  if (vertices == 0) return {};
  const std::size_t room = stream.bytes.size();
  if (room < bytes || vertices - 1 > (room - bytes) / stream.stride) {
    return fail(fmt::format("{} bytes for {} of {} vertices, {} bytes apart; {} are needed", room, what, vertices,
                            stream.stride, (vertices - 1) * stream.stride + bytes));
  }
  return {};
}

bool lie_over(const VertexStream& a, std::size_t a_bytes, const VertexStream& b, std::size_t b_bytes,
              std::size_t vertices) {
  if (vertices == 0) return false;
  const auto begin_a = reinterpret_cast<std::uintptr_t>(a.bytes.data());
  const auto begin_b = reinterpret_cast<std::uintptr_t>(b.bytes.data());
  const auto end_a = begin_a + (vertices - 1) * a.stride + a_bytes,
             end_b = begin_b + (vertices - 1) * b.stride + b_bytes;
  if (end_a <= begin_b || end_b <= begin_a) return false;
  if (a.stride != b.stride) return true;
  // Bytes by which the later one's slots begin behind the other's.
  const bool a_first = begin_a <= begin_b;
  const std::size_t behind = (a_first ? begin_b - begin_a : begin_a - begin_b) % a.stride;
  return behind < (a_first ? a_bytes : b_bytes) || a.stride - behind < (a_first ? b_bytes : a_bytes);
}

}  // namespace mobil::inline v0_3
