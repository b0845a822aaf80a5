#include <mobil/engine/error.h>

#include <algorithm>
#include <array>
#include <clocale>
#include <cstddef>
#include <cstdio>
#include <new>
#include <string_view>

namespace mobil::inline v0_3 {

const char MOBIL_CONTAINERS = 0;

namespace {

constexpr std::size_t longest_word = 255, start_of_word = 60, longest_line = 2000;

bool is_control(char c) {
  const auto u = static_cast<unsigned char>(c);
  return u < 0x20 || u == 0x7F;
}

/// Returns the first `count` bytes, or up to three fewer, so that no UTF-8 character is cut.
std::string_view start_of(std::string_view text, std::size_t count) {
  while (count > 0 && count < text.size() && (static_cast<unsigned char>(text[count]) & 0xC0U) == 0x80U) --count;
  return text.substr(0, count);
}

void add_escaped(char c, std::string& to) {
  constexpr std::string_view digits = "0123456789abcdef";
  if (c == '\n') {
    to += "\\n";
  } else if (c == '\t') {
    to += "\\t";
  } else {
    const auto u = static_cast<unsigned char>(c);
    to += "\\x";
    to += digits[u >> 4U];
    to += digits[u & 15U];
  }
}

Error error_of(const char* call, Status status) noexcept {
  Error error{{}, status};
  try {
    if (call != nullptr) error.message = std::string(call) + ": ";
    error.message += status_text(status);
  } catch (const std::bad_alloc&) {
    error.message.clear();
  }
  return error;
}

}  // namespace

std::string one_line(std::string text) {
  const bool clean = std::ranges::none_of(text, is_control);
  if (clean && text.size() <= longest_word) return text;
  std::string line;
  for (std::size_t from = 0; from < text.size() && line.size() < longest_line;) {
    const std::size_t end = std::min(text.find(' ', from), text.size());
    const std::string_view word = std::string_view(text).substr(from, end - from);
    const bool whole = word.size() <= longest_word;
    for (const char c : whole ? word : start_of(word, start_of_word)) {
      if (is_control(c)) {
        add_escaped(c, line);
      } else {
        line += c;
      }
    }
    if (!whole) line += "... (" + std::to_string(word.size()) + " characters)";
    if (end < text.size()) line += ' ';
    from = end + 1;
  }
  if (line.size() > longest_line) line = std::string(start_of(line, longest_line)) + "...";
  return line;
}

std::string decimal(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.7g", value);
  std::string number = text.data();
  const std::string_view point = std::localeconv()->decimal_point;
  if (const auto at = number.find(point); at != std::string::npos) number.replace(at, point.size(), ".");
  return number;
}

tl::unexpected<Error> fail(Status status) noexcept {
  return tl::unexpected<Error>(error_of(nullptr, status));
}

Result<void> result_of(const char* call, Status status) noexcept {
  if (status == Status::ok) return {};
  return tl::unexpected<Error>(error_of(call, status));
}

}  // namespace mobil::inline v0_3
