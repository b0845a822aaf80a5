#pragma once
// The text of a table in the encodings of spreadsheets.

#include <string>
#include <string_view>

#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Returns UTF-8 without a mark, with lines that end with LF. The bytes are UTF-8, or UTF-16 with a mark; their lines
/// end with LF, CRLF or CR. Zeros and Ctrl-Z at its end are left out. Fails with a line that begins
/// with the name on a workbook, zero bytes and other encodings.
Result<std::string> csv_text(std::string_view bytes, std::string_view name);

}  // namespace mobil::inline v0_3
