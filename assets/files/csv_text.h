#pragma once
// The text of a table, whatever a spreadsheet wrote it as.

#include <string>
#include <string_view>

#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Returns UTF-8 without a mark, whose lines end with LF: from UTF-8 or, with a mark, UTF-16; from LF, CRLF or CR. Fails
/// with a line that begins with the name on bytes that are no text.
Result<std::string> csv_text(std::string_view bytes, std::string_view name);

}  // namespace mobil::inline v0_3
