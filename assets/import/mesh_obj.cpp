#include "assets/import/mesh_obj.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "assets/import/mesh_join.h"
#include "assets/import/mesh_text.h"

namespace mobil::inline v0_3 {
namespace {

constexpr std::size_t max_obj_vertices = 3 * max_mesh_triangles;

/// Statements of the format; those other than vertices and faces are passed over.
constexpr std::array<std::string_view, 47> statements = {
    "v",      "f",      "fo",     "vt",     "vn",         "vp",        "g",        "o",        "s",    "mg",
    "usemtl", "mtllib", "usemap", "maplib", "l",          "p",         "cstype",   "deg",      "bmat", "step",
    "curv",   "curv2",  "surf",   "parm",   "trim",       "hole",      "scrv",     "sp",       "end",  "con",
    "bevel",  "ctech",  "stech",  "lod",    "shadow_obj", "trace_obj", "c_interp", "d_interp", "call", "csh",
    "bsp",    "bzp",    "cdc",    "cdp",    "res",        "vt2",       "refine"};

struct ObjReader {
  MeshText text;
  std::string_view path;
  RawMesh raw;
  std::vector<std::uint32_t> corner;  // of the face that is read
  std::int64_t largest = 0;           // vertex that a face names, counted from 1
  std::size_t largest_line = 0;
};

/// Moves to the next statement. A backslash at the end of a line continues it, except before a statement or comment:
/// names and comments can end with a backslash.
bool pass_over(MeshText& text) {
  for (bool continues = true; continues;) {
    const std::size_t before = text.at;
    if (!next_line(text)) return false;
    auto line = text.bytes.substr(before, text.at - before);
    line = line.substr(0, line.find_last_not_of(" \t\r\n") + 1);
    MeshText ahead = text;
    const auto word = next_word(ahead);
    continues = line.ends_with('\\') && !word.empty() && word.front() != '#' &&
                std::ranges::find(statements, word) == statements.end();
  }
  return true;
}

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
  const std::size_t line = reader.text.line;
  reader.corner.clear();
  for (auto word = next_of_statement(reader.text); !word.empty(); word = next_of_statement(reader.text)) {
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
    reader.corner.push_back(static_cast<std::uint32_t>(*named - 1));
    if (reader.corner.size() >= 3 && !has_room(reader.raw, reader.corner.size() - 2)) {
      return too_many_triangles(reader.path);
    }
  }
  if (reader.corner.size() < 3) {
    return fault_in_line(reader.path, reader.text.line,
                         fmt::format("a face of {} corners, it needs three or more; the file may be cut short: copy or "
                                     "export it again",
                                     reader.corner.size()));
  }
  add_face(reader.raw, reader.corner, line);
  return {};
}

}  // namespace

Result<MeshFile> read_obj(std::string_view bytes, std::string_view path) {
  ObjReader reader{.text = mesh_text(without_filling(bytes), true), .path = path, .raw = {}, .corner = {}};
  for (bool more = true; more;) {
    const auto word = next_word(reader.text);
    Result<void> done;
    if (word == "v") {
      done = read_obj_vertex(reader);
    } else if (word == "f" || word == "fo") {
      done = read_obj_face(reader);
    } else if (!word.empty() && word.front() != '#' && std::ranges::find(statements, word) == statements.end()) {
      done = fault_in_line(path, reader.text.line,
                           fmt::format("{} is no statement of OBJ; the file may be damaged or of another format: copy "
                                       "or export it again",
                                       shown(word)));
    }
    if (!done) return tl::unexpected(done.error());
    const bool unread = !word.empty() && word != "v" && word != "f" && word != "fo" && word.front() != '#';
    more = unread ? pass_over(reader.text) : next_line(reader.text);
  }
  if (reader.largest > static_cast<std::int64_t>(reader.raw.position.size())) {
    return fault_in_line(path, reader.largest_line,
                         fmt::format("vertex {} is out of range, the file has {}; it may be cut short: copy or export "
                                     "it again",
                                     reader.largest, reader.raw.position.size()));
  }
  return join_mesh(std::move(reader.raw), path, "line");
}

}  // namespace mobil::inline v0_3
