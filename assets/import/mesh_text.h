#pragma once
// Words and numbers of a mesh file written as text, whatever the locale; lines end with LF, CRLF or CR.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace mobil::inline v0_3 {

struct MeshText {
  std::string_view bytes;
  std::size_t at = 0;
  std::size_t line = 1;
  bool continued = false;  // a backslash before the line's end goes on with the next line
};

/// Past a mark of UTF-8 at the beginning, if there is one.
MeshText mesh_text(std::string_view bytes, bool continued = false);

/// The next word of the present line; empty at its end.
std::string_view next_word(MeshText& text);

/// The next word of any line; empty at the end of the text.
std::string_view next_word_of_any_line(MeshText& text);

/// Goes to the beginning of the next line. False at the end of the text.
bool next_line(MeshText& text);

/// The whole word as a coordinate: finite, decimal, at most a sign before it. A number too small for a float is 0.
std::optional<float> coordinate(std::string_view word);

/// The whole word as a number of any kind, also inf and nan: for values that are passed over.
bool is_number(std::string_view word);

/// The whole word as an integer.
std::optional<std::int64_t> whole_number(std::string_view word);

/// Equal but for the case of ASCII letters; `small` has none but small ones.
bool same_word(std::string_view word, std::string_view small);

/// What a message may show of a file's or user's text: printable ASCII, at most 40 characters, in quotes.
std::string shown(std::string_view word);

}  // namespace mobil::inline v0_3
