#include "assets/import/mesh_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

namespace mobil::inline v0_3 {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}
bool ends_line(char c) {
  return c == '\n' || c == '\r';
}

/// Returns the bytes of the line end at `at`, or 0.
std::size_t end_length(std::string_view bytes, std::size_t at) {
  if (at >= bytes.size() || !ends_line(bytes[at])) return 0;
  return bytes[at] == '\r' && at + 1 < bytes.size() && bytes[at + 1] == '\n' ? 2 : 1;
}

/// Returns the bytes of a backslash at the end of its line, with that end, or 0.
std::size_t continuation_length(const MeshText& text) {
  if (!text.continued || text.bytes[text.at] != '\\') return 0;
  std::size_t end = text.at + 1;
  while (end < text.bytes.size() && is_blank(text.bytes[end])) ++end;
  const std::size_t length = end_length(text.bytes, end);
  return length == 0 ? 0 : end + length - text.at;
}

/// from_chars takes no plus sign.
std::string_view without_plus(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  return word;
}

}  // namespace

MeshText mesh_text(std::string_view bytes, bool continued) {
  constexpr std::string_view mark = "\xEF\xBB\xBF";
  return {bytes, bytes.starts_with(mark) ? mark.size() : 0, 1, continued};
}

std::string_view without_filling(std::string_view bytes) {
  return bytes.substr(0, bytes.find_last_not_of(std::string_view("\0\x1A", 2)) + 1);
}

std::string_view next_word(MeshText& text) {
  const auto& bytes = text.bytes;
  while (text.at < bytes.size()) {
    const std::size_t continuation = continuation_length(text);
    if (continuation == 0 && !is_blank(bytes[text.at])) break;
    text.at += std::max<std::size_t>(continuation, 1);
    text.line += continuation > 0 ? 1 : 0;
  }
  const std::size_t first = text.at;
  while (text.at < bytes.size() && !is_blank(bytes[text.at]) && !ends_line(bytes[text.at])) {
    if (continuation_length(text) > 0) break;
    ++text.at;
  }
  return bytes.substr(first, text.at - first);
}

std::string_view next_word_of_any_line(MeshText& text) {
  for (;;) {
    const auto word = next_word(text);
    if (!word.empty() || !next_line(text)) return word;
  }
}

bool next_line(MeshText& text) {
  const auto& bytes = text.bytes;
  while (text.at < bytes.size()) {
    const std::size_t end = end_length(bytes, text.at);
    text.at += end == 0 ? 1 : end;
    if (end == 0) continue;
    ++text.line;
    return text.at < bytes.size();
  }
  return false;
}

std::optional<float> coordinate(std::string_view word) {
  word = without_plus(word);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (word.empty() || end != word.data() + word.size()) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    const bool tiny = word.find("e-") != std::string_view::npos || word.find("E-") != std::string_view::npos;
    return tiny ? std::optional(0.0F) : std::nullopt;
  }
  if (error != std::errc()) return std::nullopt;
  const auto single = static_cast<float>(value);
  return std::isfinite(single) ? std::optional(single) : std::nullopt;
}

bool is_number(std::string_view word) {
  word = without_plus(word);
  if (const auto mark = word.find(".#"); mark != std::string_view::npos) {  // as Microsoft's printf wrote them
    const auto one = word.substr(0, mark), kind = word.substr(mark + 2);
    return (one == "1" || one == "-1") && kind.find_first_not_of("0123456789IJNDOFQSAR") == std::string_view::npos;
  }
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return !word.empty() && error != std::errc::invalid_argument && end == word.data() + word.size();
}

std::optional<std::int64_t> whole_number(std::string_view word) {
  word = without_plus(word);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (word.empty() || error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

bool same_word(std::string_view word, std::string_view small) {
  if (word.size() != small.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i) {
    const char c = word[i];
    if ((c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c) != small[i]) return false;
  }
  return true;
}

bool begins_with(std::string_view word, std::string_view small) {
  return same_word(word.substr(0, small.size()), small);
}

std::string shown(std::string_view word, std::size_t most) {
  std::string text = "'";
  for (const char c : word.substr(0, most)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (word.size() > most ? "…'" : "'");
}

}  // namespace mobil::inline v0_3
