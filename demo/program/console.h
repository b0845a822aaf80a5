#pragma once
// Standard output and standard error. Nothing here throws, and a stream that is full, closed or without a reader changes
// neither results nor the exit status, except for output that the user requested.

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include <mobil/engine/error.h>

namespace mobil {

/// Prepares the streams. Call it first in main. Closed standard descriptors are opened, so that results files do not get
/// their numbers, but writing to them still fails. Writing to a closed pipe fails with EPIPE, and beyond the maximum
/// file size with EFBIG, instead of killing the program.
void prepare_streams() noexcept;

/// Writes text on standard error as it is.
void write_error(std::string_view text) noexcept;

/// Writes text that accompanies results in files on standard output.
void write_note(std::string_view text) noexcept;

/// Writes text that the user requested on standard output. If that fails, `output_status` is 1.
void write_output(std::string_view text) noexcept;

/// Writes one line on standard error. Without memory it writes the format itself.
template <class... Values>
void print_error(fmt::format_string<Values...> format, Values&&... values) noexcept {
  try {
    write_error(one_line(fmt::format(format, std::forward<Values>(values)...)) + "\n");
  } catch (...) {
    const fmt::string_view text = format;
    write_error({text.data(), text.size()});
  }
}

template <class... Values>
void print_note(fmt::format_string<Values...> format, Values&&... values) {
  write_note(fmt::format(format, std::forward<Values>(values)...));
}

template <class... Values>
void print_output(fmt::format_string<Values...> format, Values&&... values) {
  write_output(fmt::format(format, std::forward<Values>(values)...));
}

/// Returns the exit status of a program whose work ended with `status`: 1, with a line on standard error, if that was 0
/// and requested output could not be written. A reader that closed the pipe is not an error.
int output_status(int status) noexcept;

}  // namespace mobil
