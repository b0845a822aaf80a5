// The sixteen-lane functions compared with double precision, on every instruction set of this machine. A ulp is the
// distance of neighbouring floats at the exact value. "A ulp of one" is an absolute bound, 2⁻²³.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include "engine/wide_curve-inl.h"
#include "engine/wide_exp-inl.h"
#include "engine/wide_geometry-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
void circular(const float* x, const float* y, float* s, float* c, float* angle, float* arc) {
  Wide ws, wc;
  sin_cos(load(x), ws, wc);
  store(ws, s);
  store(wc, c);
  store(atan2(load(y), load(x)), angle);
  store(acos(load(y)), arc);
}
void exponential(const float* x, const float* y, float* e, float* l) {
  store(exp(load(x)), e);
  store(log(load(y)), l);
}
/// Writes one row of `out` for each function.
void arithmetic(const float* a, const float* b, const float* c, float* out) {
  const Wide x = load(a), y = load(b), z = load(c);
  const Wide all[] = {
      x + y,     x - y,     x * y,    x / y,    sqrt(abs(x)),          floor(x),        abs(x),       -x,
      min(x, y), max(x, y), x * 3.0F, 3.0F / y, clamp(x, -2.0F, 7.0F), copy_sign(x, y), fma(x, y, z), fnma(x, y, z)};
  for (const Wide& w : all) {
    store(w, out);
    out += lane_count;
  }
}
}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include <mobil/engine/geometry.h>
#include "tests/engine/instruction_sets.h"

namespace mobil {
HWY_EXPORT(circular);
HWY_EXPORT(exponential);
HWY_EXPORT(arithmetic);

namespace {

constexpr int blocks = 5000;

struct Dice {
  std::mt19937 engine{1};
  double operator()(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine()) / 4294967296.0);
  }
  Lanes<float> lanes(double low, double high) {
    Lanes<float> x;
    for (float& lane : x.lane) lane = static_cast<float>((*this)(low, high));
    return x;
  }
  /// Returns random numbers of either sign, from 2^-most to 2^most, log-uniform.
  Lanes<float> of_any_size(int most) {
    Lanes<float> x;
    for (float& lane : x.lane) {
      const auto size = static_cast<float>(std::exp2((*this)(-most, most)));
      lane = engine() % 2 == 0 ? size : -size;
    }
    return x;
  }
};

double ulp(double exact) {
  const float near = std::fabs(static_cast<float>(exact));
  return static_cast<double>(std::nextafter(near, INFINITY)) - static_cast<double>(near);
}
double ulps(float got, double exact) {
  return std::fabs(static_cast<double>(got) - exact) / ulp(exact);
}
double of(float x) {
  return x;
}
/// Keeps the larger error. NaN stays.
void keep(double& worst, double off) {
  if (!(off <= worst) && !std::isnan(worst)) worst = off;
}

TEST(Wide, SineAndCosineAreWithinTwoThirdsOfAnUlpOfOne) {
  for_each_instruction_set([](const char* set) {
    Dice dice;
    double near = 0, far = 0;
    Lanes<float> s, c, a, arc;
    for (int block = 0; block < blocks; ++block) {
      const bool large = block % 2 == 1;
      const Lanes<float> x = large ? dice.lanes(-1000, 1000) : dice.lanes(-10, 10);
      HWY_DYNAMIC_DISPATCH(circular)(x.lane, x.lane, s.lane, c.lane, a.lane, arc.lane);
      for (std::size_t l = 0; l < lane_count; ++l) {
        double& worst = large ? far : near;
        keep(worst, std::fabs(of(s[l]) - std::sin(of(x[l]))));
        keep(worst, std::fabs(of(c[l]) - std::cos(of(x[l]))));
      }
    }
    // Without fused multiply-add the reduction to a quadrant loses bits, more at larger angles.
    EXPECT_LT(near, ulp(1) * (has_fused_multiply_add() ? 2.0 / 3 : 2.5)) << set;
    EXPECT_LT(far, ulp(1) * (has_fused_multiply_add() ? 2.0 / 3 : 300)) << set;
  });
}

TEST(Wide, ArcTangentIsWithinThreeUlpsAndArcCosineWithinThreeOfOne) {
  for_each_instruction_set([](const char* set) {
    Dice dice;
    double worst = 0, worst_arc = 0;
    Lanes<float> s, c, a, arc;
    for (int block = 0; block < blocks; ++block) {
      const Lanes<float> x = dice.of_any_size(20), y = block % 2 == 0 ? dice.of_any_size(20) : dice.lanes(-1, 1);
      HWY_DYNAMIC_DISPATCH(circular)(x.lane, y.lane, s.lane, c.lane, a.lane, arc.lane);
      for (std::size_t l = 0; l < lane_count; ++l) {
        keep(worst, ulps(a[l], std::atan2(of(y[l]), of(x[l]))));
        const double clamped = std::fmin(std::fmax(of(y[l]), -1), 1);
        keep(worst_arc, std::fabs(of(arc[l]) - std::acos(clamped)));
      }
    }
    EXPECT_LT(worst, 3) << set;
    EXPECT_LT(worst_arc, 3 * ulp(1)) << set;
  });
}

TEST(Wide, ExponentialAndLogarithmAreWithinFourUlps) {
  for_each_instruction_set([](const char* set) {
    Dice dice;
    double near = 0, far = 0, logarithm = 0;
    Lanes<float> e, l;
    for (int block = 0; block < blocks; ++block) {
      const Lanes<float> x = block % 2 == 0 ? dice.lanes(-2, 2) : dice.lanes(-87, 87);
      Lanes<float> y = dice.of_any_size(100);
      for (float& lane : y.lane) lane = std::fabs(lane);
      HWY_DYNAMIC_DISPATCH(exponential)(x.lane, y.lane, e.lane, l.lane);
      for (std::size_t i = 0; i < lane_count; ++i) {
        keep(block % 2 == 0 ? near : far, ulps(e[i], std::exp(of(x[i]))));
        const double exact = std::log(of(y[i]));
        keep(logarithm, std::fabs(of(l[i]) - exact) / (ulp(1) + 1e-7 * std::fabs(exact)));
      }
    }
    EXPECT_LT(near, 4) << set;
    // Without fused multiply-add the reduction loses bits, more at larger arguments.
    EXPECT_LT(far, has_fused_multiply_add() ? 4 : 300) << set;
    EXPECT_LT(logarithm, 2) << set;
    const Lanes<float> beyond{{200, -200, 88, -88, 0}}, y1{{1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}};
    HWY_DYNAMIC_DISPATCH(exponential)(beyond.lane, y1.lane, l.lane, e.lane);
    EXPECT_TRUE(std::isfinite(l[0]) && l[1] > 0) << set;
    EXPECT_EQ(l[4], 1) << set;
  });
}

TEST(Wide, ArithmeticIsCorrectlyRounded) {
  for_each_instruction_set([](const char* set) {
    Dice dice;
    std::array<Lanes<float>, 16> out;
    for (int block = 0; block < blocks; ++block) {
      const Lanes<float> x = dice.of_any_size(20), y = dice.of_any_size(20), z = dice.of_any_size(20);
      HWY_DYNAMIC_DISPATCH(arithmetic)(x.lane, y.lane, z.lane, out[0].lane);
      for (std::size_t l = 0; l < lane_count; ++l) {
        const float a = x[l], b = y[l], c = z[l];
        const std::array<float, 14> wanted = {a + b,
                                              a - b,
                                              a * b,
                                              a / b,
                                              std::sqrt(std::fabs(a)),
                                              std::floor(a),
                                              std::fabs(a),
                                              -a,
                                              std::fmin(a, b),
                                              std::fmax(a, b),
                                              a * 3,
                                              3 / b,
                                              std::fmin(std::fmax(a, -2.0F), 7.0F),
                                              std::copysign(a, b)};
        for (std::size_t i = 0; i < wanted.size(); ++i) {
          ASSERT_EQ(out[i][l], wanted[i]) << set << ", operation " << i << " of " << a << ", " << b;
        }
        if (has_fused_multiply_add()) {
          ASSERT_EQ(out[14][l], std::fma(a, b, c)) << set;
          ASSERT_EQ(out[15][l], std::fma(-a, b, c)) << set;
        } else {
          ASSERT_EQ(out[14][l], a * b + c) << set;
          ASSERT_EQ(out[15][l], c - a * b) << set;
        }
      }
    }
  });
}

}  // namespace
}  // namespace mobil
#endif
