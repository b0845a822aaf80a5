// Fitted steps: the least-squares method, the model of a step, and the committed table.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "assets/gait/step_lookup.h"
#include "demo/lab/gait_fit/step_grid.h"
#include "demo/lab/gait_fit/upper_body.h"

namespace mobil::gait_fit_test {
using namespace step_table;

const GaitReference& reference() {
  static const GaitReference read = *read_gait_reference(std::nullopt);
  return read;
}

/// Returns a node with the table's shape.
StepNode node(std::size_t s, std::size_t l, StepKind kind = StepKind::man) {
  StepNode made = step_node({&reference(), kind}, s, l);
  made.shape = fitted(step_shapes(kind)[s][l]);
  return made;
}

TEST(StepLookup, GivesTheTableAtItsNodes) {
  for (std::size_t s = 0; s < speed_count; ++s) {
    for (std::size_t l = 0; l < length_count; ++l) {
      const TabledStep step =
          tabled_step(static_cast<float>(speed[s]),
                      static_cast<float>(length[l] * usual_step(static_cast<float>(speed[s])).step_length));
      EXPECT_NEAR(step.usual.step_length, step_given[s].step_length, 1e-5);
      for (std::size_t i = 0; i < step_shape::size; ++i)
        EXPECT_NEAR(step.shape[i], step_shapes_man[s][l][i], 2e-5 * (1 + std::abs(step_shapes_man[s][l][i]))) << i;
    }
  }
}

TEST(StepLookup, IsZeroAtStandingAndContinuous) {
  for (const float number : tabled_step(0, 0.5F).shape) EXPECT_EQ(number, 0);
  const StepShape scale = shape_scales();
  TabledStep before = tabled_step(0, 0.2F);
  for (float at = 0.001F; at < 0.9F; at += 0.001F) {  // slower, faster, shorter and longer than the table
    const TabledStep now = tabled_step(at, 0.2F + at);
    for (std::size_t i = 0; i < step_shape::size; ++i)
      EXPECT_NEAR(now.shape[i], before.shape[i], 0.5 * scale[i]) << at << ' ' << i;
    EXPECT_NEAR(now.usual.double_support, before.usual.double_support, 0.001);
    before = now;
  }
}

TEST(StepTable, EveryStepKeepsItsFeetAndKnees) {
  for (std::size_t s = 0; s < speed_count; ++s) {
    for (std::size_t l = 0; l < length_count; ++l) {
      const StepNode n = node(s, l);
      const StepQuality q = step_quality(n.task, n.targets, n.shape);
      const std::string name = std::to_string(s) + ' ' + std::to_string(l);
      EXPECT_GT(q.slack_m, -1e-4) << name;
      EXPECT_GT(q.clearance_m, 0.0095) << name;
      EXPECT_LT(q.pad_m, 0.008) << name;
      EXPECT_LT(q.aside_m, 0.025 * fitted_height_m) << name;
    }
  }
}

TEST(StepTable, UsualStepsAreNearMeasurements) {
  for (std::size_t s = 0; s < speed_count; ++s) {
    const StepNode n = node(s, usual);
    const StepQuality q = step_quality(n.task, n.targets, n.shape);
    const double at_ends = s == 0 || s + 2 >= speed_count ? 4.7 : 3;
    using enum GaitQuantity;
    for (const GaitQuantity angle : {hip, knee, ankle}) EXPECT_LT(q.rms[index(angle)], at_ends) << speed[s];
    EXPECT_GT(q.correlation[index(vertical)], at_ends > 3 ? 0.96 : 0.98) << speed[s];
    EXPECT_GT(q.correlation[index(fore_aft)], at_ends > 3 ? 0.96 : 0.97) << speed[s];
    for (const GaitQuantity moment : {hip_moment, knee_moment, ankle_moment})
      EXPECT_GT(q.correlation[index(moment)], s == 0 ? 0.75 : 0.88) << speed[s];
  }
}

TEST(StepTable, StepIsReproducedFromItsNeighbours) {
  const StepNode written = node(4, usual);
  StepNode again = written;
  again.cost = INFINITY;
  for (const auto& [s, l] : {std::pair{std::size_t{5}, usual}, {std::size_t{4}, usual + 1}}) {
    const StepShape neighbour = node(s, l).shape;
    fit_node(again, neighbour, false);
  }
  const StepQuality a = step_quality(written.task, written.targets, written.shape),
                    b = step_quality(again.task, again.targets, again.shape);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a.rms[i], b.rms[i], 0.3);
  for (std::size_t i = 3; i < gait_quantity_count; ++i) EXPECT_NEAR(a.correlation[i], b.correlation[i], 0.01);
}

double max_lacking_m(const StepNode& node, const StepShape& shape) {
  StepCycle cycle;
  evaluate_step(node.task, shape, cycle);
  double most = 0;
  for (const double lacking : cycle.lacking) most = std::max(most, std::abs(lacking));
  return most;
}

/// One step of each posture, changed within the human range: the named quantity changes, balance does not.
TEST(StepStyles, ChangeTheirQuantityAndKeepBalance) {
  constexpr std::array<double, style_effects.size()> by = {3, 5, 5, -4, 0.01, 8, 4, 0.01, 0.008, 0.05, -0.3, 0.1, 4, 1};
  for (std::size_t s = 0; s < speed_count; ++s) {
    const StepNode n = node(s, usual);
    const auto before = style_values(n.task, n.shape, n.shape);
    for (std::size_t e = 0; e < style_effects.size(); ++e) {
      StepShape shape = n.shape;
      const StepShape unit = fitted(step_styles[s][e]);
      for (std::size_t i = 0; i < shape.size(); ++i) shape[i] += by[e] * unit[i];
      const double changed = style_values(n.task, n.shape, shape)[e] - before[e];
      EXPECT_NEAR(changed / by[e], 1, 0.35) << speed[s] << ' ' << style_effects[e].what;
      EXPECT_LT(max_lacking_m(n, shape), max_lacking_m(n, n.shape) + 0.04) << speed[s] << ' ' << style_effects[e].what;
    }
  }
}

/// The end of a fit depends on the processor's rounding in the mathematical library: by up to 7 % on those tried.
TEST(StepStyles, AreReproducible) {
  const StyleChanges again = style_changes(node(3, usual));
  static constexpr StepShape scale = shape_scales();
  for (std::size_t e = 0; e < style_effects.size(); ++e) {
    const StepShape written = fitted(step_styles[3][e]);
    double size = 0, off = 0;
    for (std::size_t i = 0; i < written.size(); ++i) {
      size += std::pow(written[i] / scale[i], 2);
      off += std::pow((written[i] - again[e][i]) / scale[i], 2);
    }
    EXPECT_LT(std::sqrt(off / size), 0.12) << style_effects[e].what;
  }
}

}  // namespace mobil::gait_fit_test
