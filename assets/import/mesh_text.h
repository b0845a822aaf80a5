#pragma once
// Words and numbers of a mesh file written as text, independent of the locale; lines end with LF, CRLF or CR.

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
  bool continued = false;  // a backslash at a line's end continues the words that are read
};

/// Returns the text after a UTF-8 mark at the beginning, if there is one.
MeshText mesh_text(std::string_view bytes, bool continued = false);

/// Returns the text without the zeros and Ctrl-Z with which some programs end or fill a file.
std::string_view without_filling(std::string_view bytes);

/// Returns the next word of the current line; empty at its end.
std::string_view next_word(MeshText& text);

/// Returns the next word of any line; empty at the end of the text.
std::string_view next_word_of_any_line(MeshText& text);

/// Moves to the beginning of the next line, whatever the rest of this one is. Returns false at the end of the text.
bool next_line(MeshText& text);

/// Returns the word as a coordinate: finite, decimal, with an optional sign. A number too small for a float is 0.
std::optional<float> coordinate(std::string_view word);

/// True if the word is a number of any kind, including inf, nan and `-1.#IND`, for values that are skipped.
bool is_number(std::string_view word);

/// Returns the word as an integer.
std::optional<std::int64_t> whole_number(std::string_view word);

/// True if the words are equal except for the case of ASCII letters; `small` must be lower case.
bool same_word(std::string_view word, std::string_view small);

/// True if the word begins with `small` in that sense.
bool begins_with(std::string_view word, std::string_view small);

/// Returns a file's or user's text as messages show it: printable ASCII, at most `most` characters, in quotes.
std::string shown(std::string_view word, std::size_t most = 40);

/// Length of names that identify a file or an extension, for `shown`.
inline constexpr std::size_t name_length = 250;

}  // namespace mobil::inline v0_3
