// The example for OGRE, with a virtual display: people in three levels of detail and their shadows are in its picture.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/hosts/picture.h"
#include "tests/labels.h"
#include "tests/program/program.h"

MOBIL_TEST_LABELS("long");

namespace mobil::ogre_test {

Ran run_host(int people, const std::filesystem::path& in) {
#ifdef MOBIL_OGRE_HOST
  return run_shell(
      fmt::format("xvfb-run -a -s '-screen 0 1280x1024x24' '{}' {} {}.png", MOBIL_OGRE_HOST, people, people), in);
#else
  (void)people, (void)in;
  return {.status = 127};
#endif
}

TEST(Ogre, DrawsPeopleWithShadows) {
  const TemporaryFolder folder;
#ifndef MOBIL_OGRE_HOST
  GTEST_SKIP() << "built without OGRE (apt-get install libogre-1.12-dev, then configure again)";
#endif
  if (run_shell("xvfb-run --help", folder.path).status != 0) GTEST_SKIP() << "xvfb-run is not installed";
  const Ran empty = run_host(0, folder.path), ran = run_host(24, folder.path);
  ASSERT_EQ(empty.status, 0) << empty.err;
  ASSERT_EQ(ran.status, 0) << ran.err;
  RecordProperty("output", ran.out);
  int people = 0, near = 0, far = 0, distant = 0;
  ASSERT_EQ(
      std::sscanf(ran.out.c_str(), "%d people; in view %d near, %d far, %d distant", &people, &near, &far, &distant), 4)
      << ran.out;
  EXPECT_EQ(people, 24);
  for (const int level : {near, far, distant}) EXPECT_GT(level, 0) << ran.out;
  EXPECT_LT(near + far + distant, 24) << "nobody is culled: " << ran.out;

  const auto without = read_pixels(folder.path / "0.png"), with = read_pixels(folder.path / "24.png");
  ASSERT_EQ(with.size(), 960U * 640U);
  ASSERT_EQ(without.size(), with.size());
  std::size_t drawn = 0, shadow = 0;
  for (std::size_t i = 0; i < with.size(); ++i) {
    const auto ratio = [&](std::size_t c) { return static_cast<double>(with[i][c]) / std::max<int>(1, without[i][c]); };
    if (with[i] == without[i]) continue;
    ++drawn;
    if (ratio(1) < 0.75 && std::abs(ratio(0) - ratio(1)) < 0.05 && std::abs(ratio(2) - ratio(1)) < 0.12) ++shadow;
  }
  const auto pixels = static_cast<double>(with.size());
  EXPECT_GT(static_cast<double>(drawn) / pixels, 0.15);
  EXPECT_LT(static_cast<double>(drawn) / pixels, 0.5);
  EXPECT_GT(static_cast<double>(shadow) / pixels, 0.01);
  const auto shirt = [&](std::size_t c) {  // red, green, blue
    return fraction(with, [c](const Pixel& p) { return p[c] > 1.5 * p[(c + 1) % 3] && p[c] > 1.5 * p[(c + 2) % 3]; });
  };
  for (const std::size_t c : {0U, 1U, 2U}) {
    EXPECT_GT(shirt(c), 0.005) << c;
    RecordProperty(fmt::format("shirt_{}", c), fmt::format("{:.4f}", shirt(c)));
  }
  const double lips = fraction(with, [](const Pixel& p) {
    return p[0] > 1.7 * p[1] && p[0] < 2.5 * p[1] && p[0] > 1.9 * p[2] && p[0] < 3 * p[2] && p[1] > p[2];
  });
  EXPECT_LT(lips, 0.0005) << "a distant skin has no lips";
  RecordProperty("lips", fmt::format("{:.5f}", lips));
  RecordProperty("drawn", fmt::format("{:.3f}", static_cast<double>(drawn) / pixels));
  RecordProperty("shadow", fmt::format("{:.3f}", static_cast<double>(shadow) / pixels));
}

}  // namespace mobil::ogre_test
