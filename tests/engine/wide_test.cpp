// The sixteen-lane functions against the C library in double precision.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/engine/wide_test.cpp"
#include <hwy/foreach_target.h>

#include "engine/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {
void transcendental(const float* x, const float* y, float* s, float* c, float* angle) {
  Wide ws, wc;
  sin_cos(load(x), ws, wc);
  store(ws, s);
  store(wc, c);
  store(atan2(load(y), load(x)), angle);
}
void gathered(const float* column, const float* word, float* out) { store(gather(column, load(word)), out); }
}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace mobil {
HWY_EXPORT(transcendental);
HWY_EXPORT(gathered);

TEST(Wide, SineCosineAndArcTangentAreCloseToDouble) {
  double worst_sine = 0, worst_angle = 0;
  for (int block = 0; block < 20000; ++block) {
    Lanes<float> x, y, s, c, a;
    for (std::size_t l = 0; l < lane_count; ++l) {
      const double t = block * 16.0 + static_cast<double>(l);
      x[l] = static_cast<float>(std::sin(t * 0.37) * 40.0);
      y[l] = static_cast<float>(std::cos(t * 0.11) * 3.0);
    }
    HWY_DYNAMIC_DISPATCH(transcendental)(x.lane, y.lane, s.lane, c.lane, a.lane);
    for (std::size_t l = 0; l < lane_count; ++l) {
      worst_sine = std::fmax(worst_sine, std::fabs(s[l] - std::sin(static_cast<double>(x[l]))));
      worst_sine = std::fmax(worst_sine, std::fabs(c[l] - std::cos(static_cast<double>(x[l]))));
      worst_angle = std::fmax(worst_angle, std::fabs(a[l] - std::atan2(static_cast<double>(y[l]), static_cast<double>(x[l]))));
    }
  }
  EXPECT_LT(worst_sine, 2e-7);
  EXPECT_LT(worst_angle, 4e-7);
}

TEST(Wide, GatherPicksEachLanesOwnWord) {
  std::vector<float> column(8 * lane_count);
  for (std::size_t i = 0; i < column.size(); ++i) column[i] = static_cast<float>(i);
  Lanes<float> word, out;
  for (std::size_t l = 0; l < lane_count; ++l) word[l] = static_cast<float>((3 * l) % 8);
  HWY_DYNAMIC_DISPATCH(gathered)(column.data(), word.lane, out.lane);
  for (std::size_t l = 0; l < lane_count; ++l) EXPECT_EQ(out[l], static_cast<float>(((3 * l) % 8) * 16 + l));
}
}  // namespace mobil
#endif
