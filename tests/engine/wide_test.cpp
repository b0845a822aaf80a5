// The sixteen-lane functions against double precision, on every instruction set that this machine has. A ulp is the
// distance of neighbouring floats at the exact value; an ulp of one bounds results of that size absolutely.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/engine/wide_test.cpp"
#include <hwy/foreach_target.h>

#include "engine/wide_curve-inl.h"
#include "engine/wide_exp-inl.h"
#include "engine/wide_geometry-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {
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
/// One result a row of `out`.
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
/// 1 where a comparison holds, 0 elsewhere, one comparison a row of `out`.
void comparisons(const float* a, const float* b, const Lanes<std::uint32_t>& words, std::uint32_t value, float* out) {
  const Wide x = load(a), y = load(b);
  const WideMask all[] = {
      x<y, x <= y, x> y,  x >= y, x<1.0F, x <= 1.0F, x> 1.0F, x >= 1.0F, (x < y) & (x > 1.0F), (x < y) | (x > 1.0F),
      equal(words, value)};
  for (const WideMask& holds : all) {
    store(select(holds, wide(1.0F), wide(0.0F)), out);
    out += lane_count;
  }
}
void gathered(const float* column, const float* word, float* out) {
  store(gather(column, load(word)), out);
}
void between(const float* u, const float* a, const float* b, float* eased, float* mixed) {
  store(smooth(load(u)), eased);
  store(mix(load(a), load(b), load(u)), mixed);
}
void turned(const Quat<Lanes<float>>& q, const Quat<Lanes<float>>& p, const Vec3<Lanes<float>>& v,
            Vec3<Lanes<float>>& rotated, Quat<Lanes<float>>& product, float* long_as) {
  store(rotate(load(q), load(v)), rotated);
  store(load(q) * load(p), product);
  store(length(load(v)), long_as);
}
}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "engine/geometry.h"
#include "tests/engine/instruction_sets.h"

namespace mobil {
HWY_EXPORT(circular);
HWY_EXPORT(exponential);
HWY_EXPORT(arithmetic);
HWY_EXPORT(comparisons);
HWY_EXPORT(gathered);
HWY_EXPORT(between);
HWY_EXPORT(turned);

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
  /// Of either sign, from 2^-most to 2^most, one as likely as another.
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
/// The larger one; what is not a number stays.
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
    // Without fused multiply-add the reduction to a quadrant loses bits, the more the larger the angle.
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
    // Without fused multiply-add the reduction loses bits, the more the larger the argument.
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

TEST(Wide, ComparisonsAndSelectionGoLaneByLane) {
  for_each_instruction_set([](const char* set) {
    Dice dice;
    std::array<Lanes<float>, 11> out;
    for (int block = 0; block < blocks; ++block) {
      Lanes<float> x, y;
      Lanes<std::uint32_t> words;
      for (std::size_t l = 0; l < lane_count; ++l) {  // of few values: equal ones are frequent
        x[l] = static_cast<float>(dice.engine() % 4), y[l] = static_cast<float>(dice.engine() % 4);
        words[l] = 0xFFFFFFFDU + static_cast<std::uint32_t>(dice.engine() % 3);
      }
      const std::uint32_t value = 0xFFFFFFFDU + static_cast<std::uint32_t>(dice.engine() % 3);
      HWY_DYNAMIC_DISPATCH(comparisons)(x.lane, y.lane, words, value, out[0].lane);
      for (std::size_t l = 0; l < lane_count; ++l) {
        const float a = x[l], b = y[l];
        const std::array<bool, 11> wanted = {a<b, a <= b, a> b, a >= b,         a<1, a <= 1, a> 1, a >= 1,
                                             a < b && a > 1,    a < b || a > 1, words[l] == value};
        for (std::size_t i = 0; i < wanted.size(); ++i) {
          ASSERT_EQ(out[i][l], wanted[i] ? 1.0F : 0.0F) << set << ", comparison " << i << " of " << a << ", " << b;
        }
      }
    }
  });
}

TEST(Wide, GatherPicksEachLanesOwnWord) {
  for_each_instruction_set([](const char* set) {
    Dice dice;
    std::vector<Lanes<float>> column(50);
    for (std::size_t i = 0; i < column.size(); ++i) {
      for (std::size_t l = 0; l < lane_count; ++l) column[i][l] = static_cast<float>(16 * i + l);
    }
    for (int block = 0; block < 200; ++block) {
      Lanes<float> word, out;
      for (float& w : word.lane) w = static_cast<float>(dice.engine() % column.size());
      HWY_DYNAMIC_DISPATCH(gathered)(column[0].lane, word.lane, out.lane);
      for (std::size_t l = 0; l < lane_count; ++l) {
        ASSERT_EQ(out[l], 16 * word[l] + static_cast<float>(l)) << set;
      }
    }
  });
}

TEST(Wide, GoesFromOneValueToAnother) {
  for_each_instruction_set([](const char* set) {
    Dice dice;
    double worst_ease = 0, worst_mix = 0;
    Lanes<float> eased, mixed;
    for (int block = 0; block < blocks; ++block) {
      const Lanes<float> u = dice.lanes(-0.2, 1.2), a = dice.lanes(-1, 1), b = dice.lanes(-1, 1);
      HWY_DYNAMIC_DISPATCH(between)(u.lane, a.lane, b.lane, eased.lane, mixed.lane);
      for (std::size_t l = 0; l < lane_count; ++l) {
        const double v = std::fmin(std::fmax(of(u[l]), 0), 1);
        keep(worst_ease, std::fabs(of(eased[l]) - v * v * v * (10 + v * (6 * v - 15))));
        keep(worst_mix, std::fabs(of(mixed[l]) - of(a[l]) - of(u[l]) * (of(b[l]) - of(a[l]))));
      }
    }
    EXPECT_LT(worst_ease, 12 * ulp(1)) << set;
    EXPECT_LT(worst_mix, 2 * ulp(2)) << set;
  });
}

TEST(Wide, RotationsTurnAsInDoublePrecision) {
  for_each_instruction_set([](const char* set) {
    Dice dice;
    double worst = 0, worst_product = 0, worst_length = 0;
    for (int block = 0; block < blocks; ++block) {
      const auto unit = [&] {
        Quat<Lanes<float>> q = {dice.lanes(-1, 1), dice.lanes(-1, 1), dice.lanes(-1, 1), dice.lanes(-1, 1)};
        for (std::size_t l = 0; l < lane_count; ++l) {
          const float size = std::sqrt(q.x[l] * q.x[l] + q.y[l] * q.y[l] + q.z[l] * q.z[l] + q.w[l] * q.w[l]);
          q.x[l] /= size, q.y[l] /= size, q.z[l] /= size, q.w[l] /= size;
        }
        return q;
      };
      const Quat<Lanes<float>> q = unit(), p = unit();
      const Vec3<Lanes<float>> v = {dice.lanes(-1, 1), dice.lanes(-1, 1), dice.lanes(-1, 1)};
      Vec3<Lanes<float>> rotated;
      Quat<Lanes<float>> product;
      Lanes<float> length;
      HWY_DYNAMIC_DISPATCH(turned)(q, p, v, rotated, product, length.lane);
      for (std::size_t l = 0; l < lane_count; ++l) {
        const auto exact = [l](const Quat<Lanes<float>>& of_lanes) {
          return Quat<double>{of(of_lanes.x[l]), of(of_lanes.y[l]), of(of_lanes.z[l]), of(of_lanes.w[l])};
        };
        const Vec3<double> from = {of(v.x[l]), of(v.y[l]), of(v.z[l])};
        const Vec3<double> to = geometry::rotated(exact(q), from);
        const Quat<double> both = geometry::product(exact(q), exact(p));
        keep(worst, std::fabs(of(rotated.x[l]) - to.x));
        keep(worst, std::fabs(of(rotated.y[l]) - to.y));
        keep(worst, std::fabs(of(rotated.z[l]) - to.z));
        keep(worst_product, std::fabs(of(product.x[l]) - both.x));
        keep(worst_product, std::fabs(of(product.y[l]) - both.y));
        keep(worst_product, std::fabs(of(product.z[l]) - both.z));
        keep(worst_product, std::fabs(of(product.w[l]) - both.w));
        keep(worst_length, ulps(length[l], geometry::length(from)));
      }
    }
    EXPECT_LT(worst, 3.5 * ulp(1)) << set;
    EXPECT_LT(worst_product, 1.1 * ulp(1)) << set;
    EXPECT_LT(worst_length, 1.5) << set;
  });
}

}  // namespace
}  // namespace mobil
#endif
