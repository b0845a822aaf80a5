// Pictures on a contact sheet are at their places, complete and unchanged.
#include "demo/pictures/contact_sheet.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>

namespace mobil::contact_sheet_test {
Image plain(int width, int height, std::array<std::uint8_t, 4> colour) {
  Image image{width, height, {}};
  for (int i = 0; i < width * height; ++i) image.rgba.insert(image.rgba.end(), colour.begin(), colour.end());
  return image;
}

TEST(ContactSheet, CellsFitTheLargestPictureAndTheRestIsWhite) {
  const std::vector<std::vector<Image>> rows = {{plain(4, 3, {9, 8, 7, 255}), plain(2, 5, {1, 2, 3, 255})},
                                                {plain(6, 2, {200, 100, 50, 0})}};
  const Image sheet = contact_sheet(rows, 2);
  ASSERT_EQ(sheet.width, 2 + 6 + 2 + 2 + 2);
  ASSERT_EQ(sheet.height, 2 + 5 + 2 + 2 + 2);
  int first = 0, second = 0;
  for (int y = 0; y < sheet.height; ++y) {
    for (int x = 0; x < sheet.width; ++x) {
      const std::uint8_t* p = sheet.pixel(x, y);
      ASSERT_EQ(p[3], 255);
      if (p[0] == 9 && p[1] == 8 && p[2] == 7) {
        ++first;
        EXPECT_TRUE(x >= 3 && x < 7 && y >= 3 && y < 6) << x << ' ' << y;  // centred in its cell
      } else if (p[0] == 1 && p[1] == 2 && p[2] == 3) {
        ++second;
      } else {
        EXPECT_TRUE(p[0] == 255 && p[1] == 255 && p[2] == 255) << x << ' ' << y;  // the transparent one shows white
      }
    }
  }
  EXPECT_EQ(first, 12);
  EXPECT_EQ(second, 10);
}

TEST(ContactSheet, WithoutPicturesIsEmpty) {
  EXPECT_TRUE(contact_sheet({}, 3).rgba.empty());
  const std::vector<std::vector<Image>> rows(2);
  EXPECT_TRUE(contact_sheet(rows, 3).rgba.empty());
}

}  // namespace mobil::contact_sheet_test
