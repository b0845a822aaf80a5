#pragma once
// The header of a PLY file: its elements, and their encoding.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <mobil/engine/error.h>
#include "assets/import/mesh_text.h"

namespace mobil::inline v0_3 {

enum class PlyFormat : std::uint8_t { ascii, little_endian, big_endian };
enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Returns the bytes of one value in a binary file.
std::size_t size_of(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  std::optional<PlyType> count;  // of a list: how many values follow
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> property;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> element;
};

/// Reads the header and leaves `text` at the first byte of the data. Fails on anything that the format does not have,
/// and on more elements than the remaining bytes can hold.
Result<PlyHeader> read_ply_header(MeshText& text, std::string_view path);

}  // namespace mobil::inline v0_3
