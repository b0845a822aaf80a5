#include "assets/import/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "assets/import/mesh_join.h"

namespace mobil::inline v0_3 {
namespace {

constexpr std::size_t max_ply_elements = 64, max_ply_properties = 256;

constexpr std::array<std::pair<std::string_view, PlyType>, 16> ply_types = {{{"char", PlyType::int8},
                                                                             {"int8", PlyType::int8},
                                                                             {"uchar", PlyType::uint8},
                                                                             {"uint8", PlyType::uint8},
                                                                             {"short", PlyType::int16},
                                                                             {"int16", PlyType::int16},
                                                                             {"ushort", PlyType::uint16},
                                                                             {"uint16", PlyType::uint16},
                                                                             {"int", PlyType::int32},
                                                                             {"int32", PlyType::int32},
                                                                             {"uint", PlyType::uint32},
                                                                             {"uint32", PlyType::uint32},
                                                                             {"float", PlyType::float32},
                                                                             {"float32", PlyType::float32},
                                                                             {"double", PlyType::float64},
                                                                             {"float64", PlyType::float64}}};

std::optional<PlyType> ply_type(std::string_view word) {
  const auto* found = std::ranges::find(ply_types, word, &std::pair<std::string_view, PlyType>::first);
  return found == ply_types.end() ? std::nullopt : std::optional(found->second);
}

bool has_fraction(PlyType type) {
  return type == PlyType::float32 || type == PlyType::float64;
}

/// Returns the words of one line; headers have few.
std::vector<std::string_view> header_words(MeshText& text) {
  std::vector<std::string_view> words;
  for (auto word = next_word(text); !word.empty() && words.size() < 8; word = next_word(text)) words.push_back(word);
  return words;
}

/// Returns the fault of a header line, with valid ones.
tl::unexpected<Error> bad_header(std::string_view path, const MeshText& text, std::string_view valid) {
  return fault_in_line(path, text.line,
                       fmt::format("not a line of a PLY header; valid: {}: export the mesh again", valid));
}

Result<void> add_property(const std::vector<std::string_view>& word, const MeshText& text, std::string_view path,
                          PlyHeader& header) {
  const bool list = word.size() == 5 && word[1] == "list";
  const auto type = list ? ply_type(word[3]) : word.size() == 3 ? ply_type(word[1]) : std::nullopt;
  const auto count = list ? ply_type(word[2]) : std::nullopt;
  if (!type || (list && (!count || has_fraction(*count)))) {
    return bad_header(path, text,
                      "'property TYPE NAME' or 'property list INTEGER_TYPE TYPE NAME', types char to double");
  }
  if (header.element.empty()) return bad_header(path, text, "'element NAME COUNT' before the first property");
  auto& property = header.element.back().property;
  const std::string name(word.back());
  if (property.size() == max_ply_properties || std::ranges::find(property, name, &PlyProperty::name) != property.end())
    return bad_header(path, text, fmt::format("each property once, at most {}", max_ply_properties));
  property.push_back({name, *type, count});
  return {};
}

Result<void> add_element(const std::vector<std::string_view>& word, const MeshText& text, std::string_view path,
                         PlyHeader& header) {
  const auto count = word.size() == 3 ? whole_number(word[2]) : std::nullopt;
  if (!count || *count < 0 || *count > (std::int64_t{1} << 32)) {
    return bad_header(path, text, "'element NAME COUNT', the count from 0 to 4294967296");
  }
  const std::string name(word[1]);
  if (header.element.size() == max_ply_elements ||
      std::ranges::find(header.element, name, &PlyElement::name) != header.element.end())
    return bad_header(path, text, fmt::format("each element once, at most {}", max_ply_elements));
  header.element.push_back({name, static_cast<std::size_t>(*count), {}});
  return {};
}

/// Returns the minimum bytes of one item; a value as text takes a digit and a separator.
std::size_t min_size(const PlyElement& element, PlyFormat format) {
  std::size_t bytes = 0;
  for (const auto& property : element.property) {
    bytes += format == PlyFormat::ascii ? 2 : size_of(property.count.value_or(property.type));
  }
  return bytes;
}

Result<void> check_counts(const PlyHeader& header, std::size_t left, std::string_view path) {
  left += header.format == PlyFormat::ascii ? 1 : 0;  // the last separator can be missing
  for (const auto& element : header.element) {
    const std::size_t each = min_size(element, header.format);
    if (element.count == 0) continue;
    if (each == 0 || element.count > left / each) {
      return fail(
          fmt::format("{}: its header promises {} times {}, for which the file is too short; it is cut short: "
                      "copy or export it again",
                      path, element.count, shown(element.name)));
    }
    left -= element.count * each;
  }
  return {};
}

/// Moves to the data, past the line's end, which is as the first line's.
void skip_last_line_end(MeshText& text, bool two_bytes) {
  const auto rest = text.bytes.substr(text.at);
  if (two_bytes && rest.starts_with("\r\n")) {
    text.at += 2;
  } else if (rest.starts_with('\n') || rest.starts_with('\r')) {
    text.at += 1;
  }
  ++text.line;
}

}  // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::float64:
      return 8;
    default:
      return 4;
  }
}

Result<PlyHeader> read_ply_header(MeshText& text, std::string_view path) {
  if (next_word(text) != "ply" || !next_word(text).empty()) {
    return bad_header(path, text, "'ply' alone in small letters");
  }
  const bool two_bytes = text.bytes.substr(text.at).starts_with("\r\n");
  PlyHeader header;
  bool format_known = false;
  for (;;) {
    if (!next_line(text)) {
      return fail(fmt::format("{}: no 'end_header' in it; the file is cut short: copy or export it again", path));
    }
    const MeshText line = text;
    const auto word = header_words(text);
    if (word.empty() || word[0] == "comment" || word[0] == "obj_info") continue;
    Result<void> done;
    if (word[0] == "end_header" && word.size() == 1) break;
    if (word[0] == "format") {
      constexpr std::array<std::string_view, 3> names = {"ascii", "binary_little_endian", "binary_big_endian"};
      const auto* known = word.size() == 3 ? std::ranges::find(names, word[1]) : names.end();
      if (known == names.end() || word[2] != "1.0" || format_known) {
        return bad_header(path, line, "'format ascii 1.0', or binary_little_endian or binary_big_endian, once");
      }
      header.format = static_cast<PlyFormat>(known - names.begin());
      format_known = true;
    } else if (word[0] == "element") {
      done = add_element(word, line, path, header);
    } else if (word[0] == "property") {
      done = add_property(word, line, path, header);
    } else {
      done = bad_header(path, line, "format, element, property, comment, obj_info, end_header");
    }
    if (!done) return tl::unexpected(done.error());
  }
  if (!format_known) return bad_header(path, text, "'format ascii 1.0' before 'end_header'");
  skip_last_line_end(text, two_bytes);
  if (auto done = check_counts(header, text.bytes.size() - text.at, path); !done) return tl::unexpected(done.error());
  return header;
}

}  // namespace mobil::inline v0_3
