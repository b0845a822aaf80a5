// Linear equations in sixteen lanes, against what they ask.
#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cmath>

#include "systems/gait/elimination-inl.h"
#include "tests/gait/walkers.h"

namespace mobil::elimination_test {
namespace wide_step = HWY_NAMESPACE;  // the compiler's own instruction set
using wide_step::Wide;

double lane_of(const Wide& w, std::size_t l) {
  Lanes<float> lanes;
  wide_step::store(w, lanes);
  return static_cast<double>(lanes[l]);
}

TEST(Elimination, SolvesEachLanesOwnEquations) {
  Dice dice{std::mt19937(6)};
  for (int block = 0; block < 100; ++block) {
    Lanes<float> a[3][3], b[3];
    wide_step::Elimination<3> elimination;
    Wide x[3];
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t l = 0; l < lane_count; ++l) {
        // Pivots that vanish now and then, so that rows must change places, in some lanes and not in others.
        for (std::size_t j = 0; j < 3; ++j) a[i][j][l] = i == j && dice(0, 1) < 0.3 ? 0.0F : dice.single(-1, 1);
        b[i][l] = dice.single(-1, 1);
      }
      for (std::size_t j = 0; j < 3; ++j) elimination.a[i][j] = wide_step::load(a[i][j]);
      x[i] = wide_step::load(b[i]);
    }
    elimination.factor();
    elimination.solve(x);
    for (std::size_t l = 0; l < lane_count; ++l) {
      double size = 1;
      for (const Wide& value : x) size = std::fmax(size, std::fabs(lane_of(value, l)));
      for (std::size_t i = 0; i < 3; ++i) {
        double sum = 0;
        for (std::size_t j = 0; j < 3; ++j) sum += double{a[i][j][l]} * lane_of(x[j], l);
        EXPECT_NEAR(sum, b[i][l], 1e-5 * size) << "lane " << l;
      }
    }
  }
}

}  // namespace mobil::elimination_test
