#include "systems/surfaces/vertex_stream.h"

#include <fmt/format.h>

namespace mobil {

Result<void> check_stream(const char* what, const VertexStream& stream, std::size_t vertices, std::size_t bytes) {
  if (stream.stride < bytes)
    return fail(fmt::format("a stride of {} bytes for {}; at least {}", stream.stride, what, bytes));
  const std::size_t needed = vertices == 0 ? 0 : (vertices - 1) * stream.stride + bytes;
  if (stream.bytes.size() < needed) {
    return fail(fmt::format("{} bytes for {} of {} vertices, {} bytes apart; {} are needed", stream.bytes.size(), what,
                            vertices, stream.stride, needed));
  }
  return {};
}

}  // namespace mobil
