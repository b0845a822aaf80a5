#pragma once
// Arranges pictures on one sheet.

#include <span>
#include <vector>

#include <mobil/systems/render/image.h>

namespace mobil {

/// Returns a white sheet with rows of pictures from the top left, and gaps of `gap_px` between and around them. Each
/// row is as high as its highest picture, each column as wide as its widest. Pictures are centred in their cells; an
/// empty picture leaves its cell white. Rows can differ in length. Transparent pixels show the white. Without pictures
/// the sheet is empty.
Image contact_sheet(std::span<const std::vector<Image>> rows, int gap_px);

}  // namespace mobil
