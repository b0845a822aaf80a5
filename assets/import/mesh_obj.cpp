#include "assets/import/mesh_obj.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>

#include "assets/import/mesh_join.h"
#include "assets/import/mesh_text.h"

namespace mobil::inline v0_3 {
namespace {

constexpr std::size_t max_obj_vertices = 3 * max_mesh_triangles;

/// Statements of the format other than vertices and faces.
constexpr std::array<std::string_view, 44> passed_over = {
    "vt",       "vn",       "vp",     "g",   "o",    "s",     "mg",    "usemtl", "mtllib", "usemap",     "maplib",
    "l",        "p",        "cstype", "deg", "bmat", "step",  "curv",  "curv2",  "surf",   "parm",       "trim",
    "hole",     "scrv",     "sp",     "end", "con",  "bevel", "ctech", "stech",  "lod",    "shadow_obj", "trace_obj",
    "c_interp", "d_interp", "call",   "csh", "bsp",  "bzp",   "cdc",   "cdp",    "res",    "vt2",        "refine"};

struct ObjReader {
  MeshText text;
  std::string_view path;
  RawMesh raw;
  std::int64_t largest = 0;  // vertex that a face names, counted from 1
  std::size_t largest_line = 0;
};

/// Returns the next word; one that begins a comment ends the statement.
std::string_view next_of_statement(MeshText& text) {
  const auto word = next_word(text);
  return word.starts_with('#') ? std::string_view() : word;
}

Result<void> read_obj_vertex(ObjReader& reader) {
  std::array<float, 7> value{};
  std::size_t count = 0;
  for (auto word = next_of_statement(reader.text); !word.empty(); word = next_of_statement(reader.text), ++count) {
    const auto number = coordinate(word);
    if (!number) {
      return fault_in_line(
          reader.path, reader.text.line,
          fmt::format("{} is not a finite number; write decimals with a point: export the mesh again", shown(word)));
    }
    if (count < value.size()) value[count] = *number;
  }
  if (count != 3 && count != 4 && count != 6 && count != 7) {
    return fault_in_line(reader.path, reader.text.line,
                         fmt::format("a vertex of {} numbers; valid: 3, 4, 6 or 7: export the mesh again", count));
  }
  if (count == 4 && value[3] != 1) {
    return fault_in_line(reader.path, reader.text.line,
                         fmt::format("a vertex of weight {}; valid: 1: export triangles, not curves", value[3]));
  }
  if (reader.raw.position.size() == max_obj_vertices) {
    return fail(fmt::format("{}: more than {} vertices; make the mesh coarser in a mesh editor", reader.path,
                            max_obj_vertices));
  }
  reader.raw.position.push_back({value[0], value[1], value[2]});
  return {};
}

/// Returns the vertex of a corner "v", "v/vt", "v//vn" or "v/vt/vn", counted from 1; nothing for other words.
std::optional<std::int64_t> corner_vertex(std::string_view word) {
  std::optional<std::int64_t> vertex;
  for (int part = 0;; ++part) {
    const auto slash = word.find('/');
    const auto piece = word.substr(0, slash);
    const auto number = whole_number(piece);
    if (part > 2 || (part == 0 && piece.empty()) || (!piece.empty() && (!number || *number == 0))) return std::nullopt;
    if (part == 0) vertex = number;
    if (slash == std::string_view::npos) return vertex;
    word.remove_prefix(slash + 1);
  }
}

Result<void> read_obj_face(ObjReader& reader) {
  const auto vertices = static_cast<std::int64_t>(reader.raw.position.size());
  std::uint32_t first = 0, before = 0;
  std::size_t corners = 0;
  for (auto word = next_of_statement(reader.text); !word.empty(); word = next_of_statement(reader.text), ++corners) {
    auto named = corner_vertex(word);
    if (!named) {
      return fault_in_line(reader.path, reader.text.line,
                           fmt::format("{} is not a corner; valid: v, v/vt, v//vn or v/vt/vn, counted from 1, or from "
                                       "-1 backwards: export the mesh again",
                                       shown(word)));
    }
    if (*named < 0) *named += vertices + 1;
    if (*named < 1 || *named > static_cast<std::int64_t>(max_obj_vertices)) {
      return fault_in_line(reader.path, reader.text.line,
                           fmt::format("corner {} is out of range, {} vertices stand before it; export the mesh again",
                                       shown(word), vertices));
    }
    if (*named > reader.largest) {
      reader.largest = *named;
      reader.largest_line = reader.text.line;
    }
    const auto corner = static_cast<std::uint32_t>(*named - 1);
    if (corners == 0) first = corner;
    if (corners >= 2) {
      if (reader.raw.triangle.size() == 3 * max_mesh_triangles) return too_many_triangles(reader.path);
      reader.raw.triangle.insert(reader.raw.triangle.end(), {first, before, corner});
    }
    before = corner;
  }
  if (corners < 3) {
    return fault_in_line(reader.path, reader.text.line,
                         fmt::format("a face of {} corners, it needs three or more; the file may be cut short: copy or "
                                     "export it again",
                                     corners));
  }
  return {};
}

}  // namespace

Result<MeshFile> read_obj(std::string_view bytes, std::string_view path) {
  ObjReader reader{.text = mesh_text(bytes, true), .path = path, .raw = {}};
  do {
    const auto word = next_word(reader.text);
    Result<void> done;
    if (word == "v") {
      done = read_obj_vertex(reader);
    } else if (word == "f" || word == "fo") {
      done = read_obj_face(reader);
    } else if (!word.empty() && word.front() != '#' && std::ranges::find(passed_over, word) == passed_over.end()) {
      done = fault_in_line(path, reader.text.line,
                           fmt::format("{} is no statement of OBJ; the file may be damaged or of another format: copy "
                                       "or export it again",
                                       shown(word)));
    }
    if (!done) return tl::unexpected(done.error());
  } while (next_line(reader.text));
  if (reader.largest > static_cast<std::int64_t>(reader.raw.position.size())) {
    return fault_in_line(path, reader.largest_line,
                         fmt::format("vertex {} is out of range, the file has {}; it may be cut short: copy or export "
                                     "it again",
                                     reader.largest, reader.raw.position.size()));
  }
  return join_mesh(reader.raw, path);
}

}  // namespace mobil::inline v0_3
