// Loads as tables: interpolation, and refusals of tables with their line.
#include "demo/lab/muscle/force_history.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <string>

namespace mobil::force_history_test {
const std::string header = "time_s,force_x_n,force_y_n,force_z_n\n";

RC_GTEST_PROP(ForceHistory, LinearBetweenRowsZeroBeforeHeldAfter, (int first_n, int second_n)) {
  const double a = first_n % 1000 * 0.1, b = second_n % 1000 * 0.1;
  const ForceHistory history{{{1, {a, 0, -a}}, {3, {b, 1, -b}}}};
  const double t = *rc::gen::inRange(0, 101) * 0.01;
  const auto between = force_at(history, 1 + 2 * t);
  RC_ASSERT(std::abs(between.x - (a + t * (b - a))) < 1e-9);
  RC_ASSERT(std::abs(between.y - t) < 1e-12);
  RC_ASSERT(std::abs(between.z + between.x) < 1e-9);
  RC_ASSERT(force_at(history, 0.999).x == 0.0);
  RC_ASSERT(force_at(history, 3 + t).x == b);
}

TEST(ForceHistory, TwoRowsOfOneTimeAreAJump) {
  const auto history = parse_force_history(header + "0,0,0,1\n1,0,0,1\n1,0,0,5\n2,0,0,5\n", "load.csv");
  ASSERT_TRUE(history) << history.error().message;
  EXPECT_DOUBLE_EQ(force_at(*history, 0.999999).z, 1);
  EXPECT_DOUBLE_EQ(force_at(*history, 1).z, 5);
}

TEST(ForceHistory, SpacesSignsAndForeignLineEndsAreRead) {
  const auto history =
      parse_force_history("time_s,force_x_n,force_y_n,force_z_n\r\n 0 , +1,2e-1 ,-3\r\n\r\n", "load.csv");
  ASSERT_TRUE(history) << history.error().message;
  ASSERT_EQ(history->row.size(), 1U);
  EXPECT_EQ(history->row[0].force_n.x, 1);
  EXPECT_EQ(history->row[0].force_n.y, 0.2);
  EXPECT_EQ(history->row[0].force_n.z, -3);
}

TEST(ForceHistory, BadTablesAreRefusedWithTheirLine) {
  const auto message = [](const std::string& text) {
    const auto parsed = parse_force_history(text, "load.csv");
    return parsed ? std::string("accepted") : parsed.error().message;
  };
  EXPECT_TRUE(message("").starts_with("load.csv: no rows"));
  EXPECT_TRUE(message(header).starts_with("load.csv: no rows"));
  EXPECT_TRUE(message("t,x,y,z\n0,0,0,0\n").starts_with("load.csv line 1:"));
  for (const auto* row :
       {"1,2,3", "1,2,3,4,5", "1,2,three,4", "1,2,nan,4", "1,inf,3,4", "1,2,3,", "1,2,3,4x", "1;2;3;4"}) {
    EXPECT_TRUE(message(header + "0,0,0,0\n" + row + "\n").starts_with("load.csv line 3:")) << row;
  }
  EXPECT_TRUE(message(header + "0,0,0,0\n2,0,0,0\n1,0,0,0\n").starts_with("load.csv line 4:"));
  EXPECT_FALSE(read_force_history("/nowhere/load.csv"));
  EXPECT_FALSE(read_force_history("/"));
}

}  // namespace mobil::force_history_test
