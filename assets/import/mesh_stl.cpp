#include "assets/import/mesh_stl.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include "assets/import/mesh_join.h"
#include "assets/import/mesh_text.h"

namespace mobil::inline v0_3 {
namespace {

constexpr std::size_t stl_head = 84, stl_facet = 50;

std::uint32_t little_endian(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    word |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  }
  return word;
}

void add_facet(RawMesh& raw, const std::array<Vec3<float>, 3>& corner) {
  for (const auto& p : corner) {
    raw.triangle.push_back(static_cast<std::uint32_t>(raw.position.size()));
    raw.position.push_back(p);
  }
}

/// Returns the facets that a binary file's head counts; 0 without a head.
std::size_t counted_facets(std::string_view bytes) {
  return bytes.size() < stl_head ? 0 : little_endian(bytes, stl_head - 4);
}

/// Returns the next word of any line; `#` begins a comment, which some programs write.
std::string_view next_stl_word(MeshText& text) {
  for (;;) {
    const auto word = next_word_of_any_line(text);
    if (!word.starts_with('#')) return word;
    if (!next_line(text)) return {};
  }
}

/// Binary files can begin with "solid", too. Their count of facets fits their size, while four characters of a text
/// count more facets than a file can have. A damaged count does not fit; bytes that no text has then decide.
bool is_text_stl(std::string_view bytes) {
  const std::size_t facets = counted_facets(bytes);
  if (facets > 0 && stl_head + stl_facet * facets <= bytes.size()) return false;
  MeshText text = mesh_text(without_filling(bytes));
  const bool solid = same_word(next_stl_word(text), "solid");
  return solid && text.bytes.substr(0, 1024).find('\0') == std::string_view::npos;
}

Result<MeshFile> read_binary_stl(std::string_view bytes, std::string_view path) {
  const std::size_t facets = counted_facets(bytes), whole = stl_head + stl_facet * facets;
  if (bytes.size() < stl_head) {
    return fail(
        fmt::format("{}: {} bytes, and no 'solid' at the beginning; a binary STL has more than {}: copy or "
                    "export it again",
                    path, bytes.size(), stl_head));
  }
  if (facets == 0) {
    return fail(
        fmt::format("{}: neither a text that begins with 'solid' nor a binary STL, its count of facets is 0; "
                    "export the mesh again",
                    path));
  }
  // Some programs append a line end or fill a block.
  if (bytes.size() < whole ||
      (bytes.size() - whole >= stl_facet && bytes.find_first_not_of('\0', whole) != std::string_view::npos)) {
    return fail(fmt::format(
        "{}: {} bytes where its count of {} facets makes {}; the file is {}: copy or export it again", path,
        bytes.size(), facets, whole, bytes.size() < whole ? "cut short or damaged" : "damaged, or several in one"));
  }
  if (facets > max_mesh_triangles) return too_many_triangles(path);
  RawMesh raw;
  raw.position.reserve(3 * facets);
  raw.triangle.reserve(3 * facets);
  for (std::size_t f = 0; f < facets; ++f) {
    std::array<Vec3<float>, 3> corner{};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t at = stl_head + f * stl_facet + 12 * (c + 1);
      const auto read = [&](std::size_t i) { return std::bit_cast<float>(little_endian(bytes, at + 4 * i)); };
      corner[c] = {read(0), read(1), read(2)};
      if (!std::isfinite(corner[c].x) || !std::isfinite(corner[c].y) || !std::isfinite(corner[c].z)) {
        return fail(
            fmt::format("{}: facet {} has a corner at ({}, {}, {}); every coordinate must be a finite number: export "
                        "the mesh again",
                        path, f + 1, corner[c].x, corner[c].y, corner[c].z));
      }
    }
    add_facet(raw, corner);
  }
  return join_mesh(std::move(raw), path);
}

struct StlReader {
  MeshText text;
  std::string_view path;
  RawMesh raw;
};

/// Reads a word of the grammar; line ends do not matter.
Result<void> expect(StlReader& reader, std::string_view wanted) {
  const auto word = next_stl_word(reader.text);
  if (same_word(word, wanted)) return {};
  return fault_in_line(reader.path, reader.text.line,
                       word.empty()
                           ? fmt::format("the file ends where '{}' should stand; it is cut short: copy or "
                                         "export it again",
                                         wanted)
                           : fmt::format("{} where '{}' should stand; export the mesh again", shown(word), wanted));
}

Result<void> read_facet(StlReader& reader) {
  if (auto done = expect(reader, "normal"); !done) return done;
  for (int i = 0; i < 3; ++i) {
    const auto word = next_stl_word(reader.text);
    if (!is_number(word)) {
      return fault_in_line(reader.path, reader.text.line,
                           fmt::format("{} in a normal is not a number; export the mesh again", shown(word)));
    }
  }
  if (auto done = expect(reader, "outer"); !done) return done;
  if (auto done = expect(reader, "loop"); !done) return done;
  std::array<Vec3<float>, 3> corner{};
  for (auto& p : corner) {
    if (auto done = expect(reader, "vertex"); !done) return done;
    for (float* value : {&p.x, &p.y, &p.z}) {
      const auto word = next_stl_word(reader.text);
      const auto number = coordinate(word);
      if (!number) {
        return fault_in_line(
            reader.path, reader.text.line,
            fmt::format("{} is not a finite number; write three decimals with a point: export the mesh again",
                        shown(word)));
      }
      *value = *number;
    }
  }
  if (auto done = expect(reader, "endloop"); !done) return done;
  if (auto done = expect(reader, "endfacet"); !done) return done;
  if (reader.raw.triangle.size() == 3 * max_mesh_triangles) return too_many_triangles(reader.path);
  add_facet(reader.raw, corner);
  return {};
}

/// Moves past a solid's name: to the next line, or to a facet on the same one. Returns whether there is one.
bool pass_name(MeshText& text) {
  for (MeshText ahead = text;;) {
    const MeshText before = ahead;
    MeshText facet = ahead;
    if (next_word(ahead).empty()) break;
    bool begins = true;
    for (const std::string_view wanted : {"facet", "normal", "", "", "", "outer"}) {
      const auto own = begins ? next_word(facet) : std::string_view();
      begins = wanted.empty() ? is_number(own) : same_word(own, wanted);
    }
    if (!begins) continue;
    text = before;
    return true;
  }
  next_line(text);
  return false;
}

/// Reads from after "solid" to the end of the line of "endsolid", or of several solids on one line.
Result<void> read_solid(StlReader& reader) {
  pass_name(reader.text);
  for (;;) {
    const auto word = next_stl_word(reader.text);
    MeshText ahead = reader.text;
    if (same_word(word, "endsolid") || (same_word(word, "end") && same_word(next_word(ahead), "solid"))) {
      if (pass_name(reader.text)) continue;
      return {};
    }
    if (!same_word(word, "facet")) {
      return fault_in_line(reader.path, reader.text.line,
                           word.empty() ? std::string("no 'endsolid' in it; the file is cut short: copy or export it "
                                                      "again")
                                        : fmt::format("{} where 'facet' or 'endsolid' should stand; export the mesh "
                                                      "again",
                                                      shown(word)));
    }
    if (auto done = read_facet(reader); !done) return done;
  }
}

}  // namespace

Result<MeshFile> read_stl(std::string_view bytes, std::string_view path) {
  if (!is_text_stl(bytes)) return read_binary_stl(bytes, path);
  StlReader reader{.text = mesh_text(without_filling(bytes)), .path = path, .raw = {}};
  for (auto word = next_stl_word(reader.text); !word.empty(); word = next_stl_word(reader.text)) {
    if (!same_word(word, "solid")) {
      return fault_in_line(path, reader.text.line,
                           fmt::format("{} after 'endsolid'; take it away, or export the mesh again", shown(word)));
    }
    if (auto done = read_solid(reader); !done) return tl::unexpected(done.error());
  }
  return join_mesh(std::move(reader.raw), path);
}

}  // namespace mobil::inline v0_3
