#include "assets/files/csv_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

namespace mobil::inline v0_3 {
namespace {

void add_utf8(std::string& text, std::uint32_t code) {
  const auto tail = [&](unsigned shift) { text += static_cast<char>(0x80U | (code >> shift & 0x3FU)); };
  if (code < 0x80) {
    text += static_cast<char>(code);
  } else if (code < 0x800) {
    text += static_cast<char>(0xC0U | code >> 6U);
    tail(0);
  } else if (code < 0x10000) {
    text += static_cast<char>(0xE0U | code >> 12U);
    tail(6);
    tail(0);
  } else {
    text += static_cast<char>(0xF0U | code >> 18U);
    tail(12);
    tail(6);
    tail(0);
  }
}

/// Returns UTF-16 as UTF-8; halves of pairs that stand alone become U+FFFD.
std::string from_utf16(std::string_view bytes, bool big) {
  std::string text;
  std::uint32_t high = 0;
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    const std::uint32_t first = static_cast<unsigned char>(bytes[i]), second = static_cast<unsigned char>(bytes[i + 1]);
    const std::uint32_t unit = big ? first << 8U | second : second << 8U | first;
    const bool low = unit >= 0xDC00 && unit < 0xE000;
    if (high != 0) add_utf8(text, low ? 0x10000 + ((high - 0xD800) << 10U) + (unit - 0xDC00) : 0xFFFD);
    if (low && high == 0) add_utf8(text, 0xFFFD);
    high = unit >= 0xD800 && unit < 0xDC00 ? unit : 0;
    if (high == 0 && !low) add_utf8(text, unit);
  }
  if (high != 0) add_utf8(text, 0xFFFD);
  return text;
}

/// Returns the length of a text's part that is UTF-8.
std::size_t utf8_length(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const auto first = static_cast<unsigned char>(text[at]);
    const std::size_t length = first < 0x80   ? 1
                               : first < 0xC2 ? 0
                               : first < 0xE0 ? 2
                               : first < 0xF0 ? 3
                               : first < 0xF5 ? 4
                                              : 0;
    const auto tail = text.substr(at, length).substr(std::min<std::size_t>(length, 1));
    const auto is_tail = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80; };
    if (length == 0 || tail.size() + 1 != length || !std::ranges::all_of(tail, is_tail)) return at;
    at += length;
  }
  return text.size();
}

std::string with_line_feeds(std::string_view text) {
  std::string lines;
  lines.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\r') {
      lines += text[i];
    } else if (i + 1 == text.size() || text[i + 1] != '\n') {
      lines += '\n';
    }
  }
  return lines;
}

}  // namespace

Result<std::string> csv_text(std::string_view bytes, std::string_view name) {
  std::string text;
  if (bytes.starts_with("\xEF\xBB\xBF")) {
    text = bytes.substr(3);
  } else if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF")) {
    text = from_utf16(bytes.substr(2), bytes.front() == '\xFE');
  } else {
    text = bytes;
  }
  text.resize(text.find_last_not_of(std::string_view("\0\x1A", 2)) + 1);
  const bool workbook = bytes.starts_with("PK\x03\x04") || bytes.starts_with("\xD0\xCF\x11\xE0");
  if (workbook || text.find('\0') != std::string::npos) {
    return fail(fmt::format(
        "{}: {}; save it as CSV in UTF-8", name,
        workbook ? "a spreadsheet's own format" : "zero bytes in it: no text, or UTF-16 or UTF-32 without its mark"));
  }
  text = with_line_feeds(text);
  if (const std::size_t good = utf8_length(text); good < text.size()) {
    return fail(fmt::format("{} line {}: not UTF-8 but another encoding, such as Windows-1252; save it as CSV UTF-8",
                            name,
                            1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(good), '\n')));
  }
  return text;
}

}  // namespace mobil::inline v0_3
