// Predicted errors of level of detail for active muscles, compared with nonlinear tissue on bodies that the accuracy
// table was not measured on.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include <mobil/lod.h>
#include "demo/lab/effects/accuracy_active.h"

namespace mobil::active_accuracy_test {
namespace {

AccuracyPlan other_bodies() {
  AccuracyPlan plan = active_plans(usual_muscles()).front();
  plan.bodies.clear();
  BodyRequest body;
  body.height_m = 1.70F;
  body.mass_kg = 62;
  body.constitution = Constitution::thin;
  plan.bodies.push_back(body);
  body.height_m = 1.76F;
  body.mass_kg = 92;
  body.constitution = Constitution::athletic;
  plan.bodies.push_back(body);
  plan.seconds = 1.2;
  return plan;
}

TEST(ActiveAccuracy, OtherBodiesMatchTheTable) {
  if (std::getenv("MOBIL_LONG") == nullptr) GTEST_SKIP() << "takes minutes: tests/run --long, or MOBIL_LONG=1";
  const auto rows = measure_active_errors(other_bodies());
  std::vector<float> over;
  for (const AccuracyRow& row : rows) {
    const AccuracyRow* const table = accuracy_table().find(row.muscle, row.speed, row.inertia, true);
    ASSERT_NE(table, nullptr);
    for (std::size_t r = 0; r < level_count; ++r) over.push_back(row.error_m[r] / table->error_m[r]);
  }
  std::ranges::sort(over);
  const float most = over.back(), usual = over[over.size() * 9 / 10];
  fmt::print("errors over the table's: nine in ten at most {:.2f}, the largest {:.2f}\n", usual, most);
  EXPECT_LT(usual, LodOptions{}.margin);
  EXPECT_LT(most, 2 * LodOptions{}.margin);
}

}  // namespace
}  // namespace mobil::active_accuracy_test
