#include "assets/import/mesh_ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>

#include "assets/import/mesh_join.h"
#include "assets/import/mesh_text.h"
#include "assets/import/ply_header.h"

namespace mobil::inline v0_3 {
namespace {

constexpr std::size_t max_ply_vertices = 3 * max_mesh_triangles;

struct PlyReader {
  MeshText text;
  std::string_view path;
  PlyFormat format = PlyFormat::ascii;
  std::size_t vertices = 0;  // as the header promises
  RawMesh raw;
  std::vector<double> value;  // of one property
  std::vector<std::uint32_t> corner;
};

/// Returns a fault with its place in the file: a line of a text, an item of a binary file.
tl::unexpected<Error> ply_fault(const PlyReader& reader, const PlyElement& element, std::size_t item,
                                std::string_view what) {
  if (reader.format == PlyFormat::ascii) return fault_in_line(reader.path, reader.text.line, what);
  return fail(fmt::format("{}: {} {}: {}", reader.path, element.name, item + 1, what));
}

tl::unexpected<Error> ends_early(const PlyReader& reader, const PlyElement& element, std::size_t item) {
  return fail(fmt::format("{}: {} {} where its header promises {}; the file is cut short: copy or export it again",
                          reader.path, item, shown(element.name), element.count));
}

template <class T>
double native(std::uint64_t bits) {
  return static_cast<double>(std::bit_cast<T>(static_cast<std::make_unsigned_t<T>>(bits)));
}

double binary_value(const unsigned char* bytes, PlyType type, bool big) {
  const std::size_t size = size_of(type);
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < size; ++i) bits |= static_cast<std::uint64_t>(bytes[i]) << (8 * (big ? size - 1 - i : i));
  switch (type) {
    case PlyType::int8:
      return native<std::int8_t>(bits);
    case PlyType::uint8:
      return native<std::uint8_t>(bits);
    case PlyType::int16:
      return native<std::int16_t>(bits);
    case PlyType::uint16:
      return native<std::uint16_t>(bits);
    case PlyType::int32:
      return native<std::int32_t>(bits);
    case PlyType::uint32:
      return native<std::uint32_t>(bits);
    case PlyType::float32:
      return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    default:
      return std::bit_cast<double>(bits);
  }
}

/// Reads one value as text: a coordinate or index must be a finite number, any other a number.
std::optional<double> text_value(PlyReader& reader, PlyType type, bool wanted) {
  const auto word = next_word(reader.text);
  if (type != PlyType::float32 && type != PlyType::float64) {
    const auto whole = whole_number(word);
    return whole ? std::optional(static_cast<double>(*whole)) : std::nullopt;
  }
  if (!wanted) return is_number(word) ? std::optional(0.0) : std::nullopt;
  const auto number = coordinate(word);
  return number ? std::optional(static_cast<double>(*number)) : std::nullopt;
}

/// Reads `count` values into reader.value; unwanted binary ones are skipped.
Result<void> read_values(PlyReader& reader, const PlyElement& element, std::size_t item, PlyType type,
                         std::size_t count, bool wanted) {
  reader.value.clear();
  if (reader.format == PlyFormat::ascii) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto value = text_value(reader, type, wanted);
      if (!value) {
        return ply_fault(
            reader, element, item,
            fmt::format("value {} of {} is missing or not a finite number of its type; write decimals with "
                        "a point: export the mesh again",
                        i + 1, shown(element.name)));
      }
      reader.value.push_back(*value);
    }
    return {};
  }
  const std::size_t size = size_of(type);
  if (count > (reader.text.bytes.size() - reader.text.at) / size) return ends_early(reader, element, item);
  const auto* bytes = reinterpret_cast<const unsigned char*>(reader.text.bytes.data()) + reader.text.at;
  for (std::size_t i = 0; wanted && i < count; ++i) {
    reader.value.push_back(binary_value(bytes + i * size, type, reader.format == PlyFormat::big_endian));
  }
  reader.text.at += count * size;
  return {};
}

/// Reads one property of one item. The rest of the file must be long enough for a list's count.
Result<void> read_property(PlyReader& reader, const PlyElement& element, std::size_t item, const PlyProperty& property,
                           bool wanted) {
  if (!property.count) return read_values(reader, element, item, property.type, 1, wanted);
  if (auto done = read_values(reader, element, item, *property.count, 1, true); !done) return done;
  const double count = reader.value.front();
  const auto left = static_cast<double>(reader.text.bytes.size() - reader.text.at);
  const double each = reader.format == PlyFormat::ascii ? 2 : static_cast<double>(size_of(property.type));
  if (count < 0 || count * each > left) {
    return ply_fault(reader, element, item,
                     fmt::format("a list of {} values, for which the file is too short; it is cut short or damaged: "
                                 "copy or export it again",
                                 count));
  }
  return read_values(reader, element, item, property.type, static_cast<std::size_t>(count), wanted);
}

Result<void> add_vertex(PlyReader& reader, const PlyElement& element, std::size_t item,
                        const std::array<double, 3>& place) {
  const Vec3<float> p{static_cast<float>(place[0]), static_cast<float>(place[1]), static_cast<float>(place[2])};
  if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
    return ply_fault(reader, element, item,
                     fmt::format("({}, {}, {}); every coordinate must be a finite number: export the mesh again",
                                 place[0], place[1], place[2]));
  }
  reader.raw.position.push_back(p);
  return {};
}

/// Adds the list of a face, or of strips, which -1 separates.
Result<void> add_corners(PlyReader& reader, const PlyElement& element, std::size_t item, bool strips) {
  const auto& named = reader.value;
  if (!strips && named.size() < 3) {
    return ply_fault(reader, element, item,
                     fmt::format("a face of {} corners, it needs three or more; export the mesh again", named.size()));
  }
  if (named.size() > 2 && !has_room(reader.raw, named.size() - 2)) return too_many_triangles(reader.path);
  reader.corner.clear();
  for (const double c : named) {
    if (c >= 0 && c < static_cast<double>(reader.vertices)) {
      reader.corner.push_back(static_cast<std::uint32_t>(c));
    } else if (strips && c == -1) {
      add_strip(reader.raw, reader.corner);
      reader.corner.clear();
    } else {
      return ply_fault(reader, element, item,
                       fmt::format("vertex {} is out of range; valid: 0 to {}: export the mesh again", c,
                                   static_cast<std::int64_t>(reader.vertices) - 1));
    }
  }
  if (strips) {
    add_strip(reader.raw, reader.corner);
  } else {
    add_face(reader.raw, reader.corner, reader.format == PlyFormat::ascii ? reader.text.line : item + 1);
  }
  return {};
}

bool names_corners(const PlyProperty& property) {
  return (property.name == "vertex_indices" || property.name == "vertex_index") && property.count &&
         property.type != PlyType::float32 && property.type != PlyType::float64;
}

/// Moves to the line of a text's item, past empty ones. Returns false at the end of the text.
bool find_item(PlyReader& reader, bool first) {
  if (!first && !next_line(reader.text)) return false;
  for (;;) {
    MeshText ahead = reader.text;
    if (!next_word(ahead).empty()) return true;
    if (!next_line(reader.text)) return false;
  }
}

Result<void> read_items(PlyReader& reader, const PlyElement& element, bool first_of_all) {
  const bool vertex = element.name == "vertex", strips = element.name == "tristrips";
  std::array<double, 3> place{};
  for (std::size_t item = 0; item < element.count; ++item) {
    if (reader.format == PlyFormat::ascii && !find_item(reader, first_of_all && item == 0)) {
      return ends_early(reader, element, item);
    }
    for (const auto& property : element.property) {
      const bool axis = vertex && property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z';
      const bool corners = (strips || element.name == "face") && names_corners(property);
      if (auto done = read_property(reader, element, item, property, axis || corners); !done) return done;
      if (axis) place[static_cast<std::size_t>(property.name[0] - 'x')] = reader.value.front();
      if (!corners) continue;
      if (auto done = add_corners(reader, element, item, strips); !done) return done;
    }
    if (vertex) {
      if (auto done = add_vertex(reader, element, item, place); !done) return done;
    }
    if (reader.format != PlyFormat::ascii) continue;
    if (const auto extra = next_word(reader.text); !extra.empty()) {
      return ply_fault(
          reader, element, item,
          fmt::format("{} after the last value that the header names; export the mesh again", shown(extra)));
    }
  }
  return {};
}

/// Fails unless the elements are those of a surface.
Result<void> check_elements(const PlyHeader& header, PlyReader& reader) {
  const auto find = [&](std::string_view name) { return std::ranges::find(header.element, name, &PlyElement::name); };
  const auto vertex = find("vertex");
  bool axes = vertex != header.element.end();
  for (const auto* axis : {"x", "y", "z"}) {
    axes = axes && std::ranges::any_of(vertex->property, [&](const auto& p) { return p.name == axis && !p.count; });
  }
  std::size_t faces = 0;
  bool corners = false;
  for (const auto* name : {"face", "tristrips"}) {
    const auto element = find(name);
    if (element == header.element.end() || element->count == 0) continue;
    corners = 1 == std::ranges::count_if(element->property, names_corners);
    if (!corners) break;
    faces += element->count;
  }
  if (faces == 0 && find("face") != header.element.end() && find("face")->count == 0)
    return fail(fmt::format("{}: its header promises no face; export it as triangles", reader.path));
  if (!axes || !corners) {
    return fail(
        fmt::format("{}: its header lacks vertices with x, y, z or faces with a list of vertex_indices; export "
                    "it as triangles",
                    reader.path));
  }
  if (faces > max_mesh_triangles) return too_many_triangles(reader.path);
  if (vertex->count > max_ply_vertices) {
    return fail(fmt::format("{}: more than {} vertices; make the mesh coarser in a mesh editor", reader.path,
                            max_ply_vertices));
  }
  reader.vertices = vertex->count;
  reader.raw.position.reserve(vertex->count);
  reader.raw.triangle.reserve(3 * faces);
  return {};
}

}  // namespace

Result<MeshFile> read_ply(std::string_view bytes, std::string_view path) {
  PlyReader reader{.text = mesh_text(bytes), .path = path, .raw = {}, .value = {}, .corner = {}};
  const auto header = read_ply_header(reader.text, path);
  if (!header) return tl::unexpected(header.error());
  reader.format = header->format;
  if (reader.format == PlyFormat::ascii) reader.text.bytes = without_filling(bytes);
  if (auto done = check_elements(*header, reader); !done) return tl::unexpected(done.error());
  bool first = true;
  for (const auto& element : header->element) {
    if (auto done = read_items(reader, element, first); !done) return tl::unexpected(done.error());
    first = first && element.count == 0;
  }
  const bool text = reader.format == PlyFormat::ascii;
  // Some programs append a line end or fill a block.
  constexpr std::string_view filling("\0\r\n", 3);
  if (text ? !next_word_of_any_line(reader.text).empty()
           : bytes.find_first_not_of(filling, reader.text.at) != std::string_view::npos) {
    return fail(
        fmt::format("{}: data after the last element that its header promises; the file may be damaged: copy or "
                    "export it again",
                    path));
  }
  return join_mesh(std::move(reader.raw), path, text ? "line" : "face");
}

}  // namespace mobil::inline v0_3
