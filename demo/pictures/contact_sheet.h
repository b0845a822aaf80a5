#pragma once
// Many pictures on one sheet.

#include <span>
#include <vector>

#include <mobil/systems/render/image.h>

namespace mobil {

/// Rows of pictures from the top, each row from the left, on white: every row as high as its highest picture, every
/// column as wide as its widest, `gap_px` between them and round the whole. Pictures stand in the middle of their
/// cells; empty ones leave theirs white, and rows may be of different lengths. What they do not cover wholly shows the
/// white. Without any picture the sheet is empty.
Image contact_sheet(std::span<const std::vector<Image>> rows, int gap_px);

}  // namespace mobil
