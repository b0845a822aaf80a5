// The cheapest sufficient level, and the best level within a budget: properties of any table.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <mobil/muscle_table.h>
#include <mobil/systems/accuracy/lod_table.h>

namespace mobil::lod_table_test {
struct RandomTable {
  std::vector<AccuracyRow> rows;
  AccuracyTable table;

  explicit RandomTable(unsigned seed) {
    std::mt19937 dice(seed);
    const auto between = [&](float low, float high) {
      return low * std::pow(high / low, static_cast<float>(dice()) * 0x1p-32F);
    };
    for (std::size_t g = 0; g < usual_muscle_count; ++g) {
      for (const SpeedClass speed : {SpeedClass::slow, SpeedClass::free, SpeedClass::fast}) {
        for (const unsigned effects : {0U, 1U, 2U, 3U}) {
          AccuracyRow row{static_cast<Muscle>(g), speed, (effects & 1) != 0, {}, (effects & 2) != 0, {}};
          for (float& error : row.error_m) error = between(1e-4F, 5e-2F);
          rows.push_back(row);
        }
      }
    }
    table.rows = rows;
    for (LevelCost& cost : table.cost) {
      for (std::size_t r = 1; r < level_count; ++r) {
        cost.state_us[r] = between(0.005F, 2);
        cost.points_us[r] = between(0.005F, 0.2F);
      }
    }
  }
};

struct Dice {
  std::mt19937 engine;
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(engine() % n); }
  float between(float low, float high) { return low * std::pow(high / low, static_cast<float>(engine()) * 0x1p-32F); }
  LevelCase a_case() {
    return {below(usual_muscle_count), below(LodTable::speed_steps), below(2) == 1, below(2) == 1, below(2) == 1};
  }
};

template <class Check>
void over_tables(unsigned count, Check check) {
  for (unsigned seed = 0; seed < count; ++seed) {
    const RandomTable random(seed);
    const LodTable lod_table(random.table);
    Dice dice{std::mt19937(seed)};
    check(lod_table, dice);
  }
}

TEST(LodTable, ChoiceIsTheCheapestSufficientOrTheBest) {
  over_tables(50, [](const LodTable& lod_table, Dice& dice) {
    for (int i = 0; i < 100; ++i) {
      const LevelCase of = dice.a_case();
      const float limit = dice.between(5e-5F, 0.1F);
      const std::uint32_t chosen = lod_table.cheapest(of, limit);
      for (std::uint32_t r = 0; r < level_count; ++r) {
        const bool meets = lod_table.error_m(of, r) <= limit;
        if (lod_table.error_m(of, chosen) <= limit) {
          EXPECT_FALSE(meets && lod_table.cost_ps(of, r) < lod_table.cost_ps(of, chosen));
        } else {
          EXPECT_FALSE(meets);
          EXPECT_GE(lod_table.error_m(of, r), lod_table.error_m(of, chosen));
        }
      }
    }
  });
}

TEST(LodTable, LevelStaysWithinTheHysteresis) {
  constexpr float slack = 0.7F;
  over_tables(50, [](const LodTable& lod_table, Dice& dice) {
    const LevelCase of = dice.a_case();
    const float least = dice.between(1e-4F, 0.05F);
    const std::uint32_t first = lod_table.cheapest(of, least);
    if (lod_table.error_m(of, first) > least) return;
    for (int i = 0; i < 50; ++i) {
      EXPECT_EQ(lod_table.from(first, of, dice.between(least, 0.999F * least / slack), slack), first);
    }
  });
}

TEST(LodTable, MissingLevelIsLeftAtOnceAndChosenLevelIsKept) {
  over_tables(50, [](const LodTable& lod_table, Dice& dice) {
    for (int i = 0; i < 100; ++i) {
      const LevelCase of = dice.a_case();
      const float limit = dice.between(5e-5F, 0.1F);
      const std::uint32_t now = dice.below(level_count), next = lod_table.from(now, of, limit, 0.7F);
      if (lod_table.error_m(of, now) > limit) {
        EXPECT_EQ(next, lod_table.cheapest(of, limit));
      } else if (next != now) {
        EXPECT_LT(lod_table.cost_ps(of, next), lod_table.cost_ps(of, now));
      }
      EXPECT_EQ(lod_table.from(next, of, limit, 0.7F), next);
    }
  });
}

TEST(LodTable, ErrorsAreAtLeastTheLinearInterpolation) {
  const RandomTable random(3);
  const LodTable lod_table(random.table);
  for (float speed = 0.9F; speed < 2; speed += 0.013F) {
    const std::size_t c = speed < 1.4F ? 0 : 1;
    const float part = (speed - speed_class_m_s[c]) / (speed_class_m_s[c + 1] - speed_class_m_s[c]);
    const auto row = [&](std::size_t i) {
      return random.table.find(Muscle::quadriceps, static_cast<SpeedClass>(i), true);
    };
    const LevelCase of{1, LodTable::speed_step(speed, static_cast<float>(reference_body_height_m)), true, true};
    for (std::uint32_t r = 0; r < level_count; ++r) {
      // both ends of the step are on the same straight lines, or on either side of a class's speed
      const float a = row(c)->error_m[r], b = row(c + 1)->error_m[r];
      if (std::abs(speed - 1.4F) > 0.1F) {
        EXPECT_GE(lod_table.error_m(of, r), (a + part * (b - a)) * 0.9999F);
      }
    }
  }
  EXPECT_EQ(LodTable::speed_step(NAN, 1.8F), LodTable::speed_steps - 1);
  EXPECT_EQ(LodTable::speed_step(INFINITY, 1.8F), LodTable::speed_steps - 1);
  EXPECT_EQ(LodTable::speed_step(0, 1.8F), 0U);
  EXPECT_GT(LodTable::speed_step(1.4F, 1.5F), LodTable::speed_step(1.4F, 2));
}

TEST(LodTable, UnmeasuredMuscleHasItsGroupsFigures) {
  const LodTable lod_table(accuracy_table());
  for (std::uint32_t m = 0; m < muscles().size(); ++m) {
    const auto group = static_cast<std::uint32_t>(members_of(static_cast<Muscle>(m)).front().group);
    for (std::uint32_t r = 0; r < level_count; ++r) {
      EXPECT_GT(lod_table.error_m({m, 14, true, true}, r), 0);
      const bool own =
          accuracy_table().find(static_cast<Muscle>(m), SpeedClass::free, true)->muscle == static_cast<Muscle>(m);
      EXPECT_TRUE(own || !is_muscle_group(static_cast<Muscle>(m))) << muscle_name(static_cast<Muscle>(m));
      if (!own) {
        EXPECT_EQ(lod_table.error_m({m, 14, true, true}, r), lod_table.error_m({group, 14, true, true}, r));
      }
    }
  }
}

/// Compared with tissue at finite strain, linear shapes have volume errors that finite shapes avoid.
TEST(LodTable, ActiveMusclesHaveTheirOwnFigures) {
  const LodTable lod_table(accuracy_table());
  for (std::uint32_t m = 0; m < muscles().size(); ++m) {
    const LevelCase of{m, 14, true, true, true};
    for (std::uint32_t r = 1; r < level_count; ++r) {
      EXPECT_GT(lod_table.error_m(of, r), 0);
      EXPECT_NE(lod_table.error_m(of, r), lod_table.error_m({m, 14, true, true}, r));
      const LodLevel& level = active_levels[r];
      if (level.finite_shape && level.moving) {
        EXPECT_LT(lod_table.volume_off(of, r), 0.014F) << level.name;
      } else if (!level.finite_shape) {
        EXPECT_GT(lod_table.volume_off(of, r), 0.017F) << level.name;
      }
    }
    const std::uint32_t best = lod_table.cheapest(of, 0);
    float least = INFINITY;
    for (std::uint32_t r = 0; r < level_count; ++r)
      if (active_levels[r].finite_shape && active_levels[r].tuned) least = std::min(least, lod_table.error_m(of, r));
    EXPECT_LE(least, 1.09F * lod_table.error_m(of, best))
        << "errors are rounded up by up to 9 %: " << active_levels[best].name;
    EXPECT_LE(lod_table.cost_ps(of, best), lod_table.cost_ps(of, level_count - 1)) << "none is dearer and no better";
  }
}

struct OneMuscle {
  LevelCase of;
  float size;
};

std::vector<OneMuscle> a_crowd(Dice& dice, std::size_t count) {
  std::vector<OneMuscle> all;
  for (std::size_t i = 0; i < count; ++i) all.push_back({dice.a_case(), 1 / dice.between(2e-4F, 0.05F)});
  return all;
}

/// Returns the cost of a crowd at a factor. Muscles that cannot meet it use their best level.
std::int64_t taken(const LodTable& lod_table, const std::vector<OneMuscle>& crowd, float factor) {
  std::int64_t sum = 0;
  for (const OneMuscle& one : crowd) sum += lod_table.cost_ps(one.of, lod_table.cheapest(one.of, factor / one.size));
  return sum;
}

TEST(CostSpectrum, FindsTheMinimumFactorThatFitsWithinABin) {
  over_tables(20, [](const LodTable& lod_table, Dice& dice) {
    const auto crowd = a_crowd(dice, 300);
    CostSpectrum spectrum;
    spectrum.clear();
    for (const OneMuscle& one : crowd) spectrum.add(lod_table, one.of, one.size);
    const std::int64_t most = taken(lod_table, crowd, CostSpectrum::min_factor);
    std::int64_t before = -1;
    float last = CostSpectrum::max_factor;
    for (int part = 1; part <= 20; ++part) {
      const std::int64_t budget = most * part / 20;
      const float factor = spectrum.factor_within(budget);
      EXPECT_LE(taken(lod_table, crowd, factor), budget);
      if (factor > CostSpectrum::min_factor) {
        EXPECT_GT(taken(lod_table, crowd, factor / 1.07F), budget);
      }
      EXPECT_LE(factor, last) << "more time, a wider tolerance";
      EXPECT_GE(taken(lod_table, crowd, factor), before);
      last = factor;
      before = taken(lod_table, crowd, factor);
    }
  });
}

TEST(CostSpectrum, IndependentOfInsertionOrder) {
  const RandomTable random(1);
  const LodTable lod_table(random.table);
  Dice dice{std::mt19937(1)};
  auto crowd = a_crowd(dice, 200);
  const auto factors = [&] {
    CostSpectrum spectrum;
    for (const OneMuscle& one : crowd) spectrum.add(lod_table, one.of, one.size);
    std::vector<float> all;
    for (std::int64_t budget = 1; budget < 1'000'000'000; budget *= 2) all.push_back(spectrum.factor_within(budget));
    return all;
  };
  const auto in_order = factors();
  std::shuffle(crowd.begin(), crowd.end(), dice.engine);
  EXPECT_EQ(factors(), in_order);
}

TEST(CostSpectrum, EmptySpectrumGivesTheMinimum) {
  const CostSpectrum nobody;
  EXPECT_EQ(nobody.factor_within(0), CostSpectrum::min_factor);
  EXPECT_EQ(nobody.cost_at(1), 0);
}

TEST(MachineFactor, NinetyNinePercentOfTicksAreWithinATenthOfThePlan) {
  for (const double scatter : {0.0, 0.02, 0.1, 0.3}) {
    for (const double slow : {0.5, 1.0, 7.0}) {
      MachineFactor machine;
      std::mt19937 dice(7);
      std::normal_distribution<double> bell;
      constexpr double predicted_s = 1e-3;
      int over = 0;
      constexpr int learning = 300, ticks = 20000;
      for (int t = 0; t < learning + ticks; ++t) {
        const double measured_s = predicted_s * slow * std::max(0.1, 1 + scatter * bell(dice));
        if (t >= learning && measured_s > 1.1 * predicted_s * machine.pessimistic()) ++over;
        machine.observe(measured_s, predicted_s);
      }
      EXPECT_LE(over, 0.012 * ticks) << scatter << " " << slow;
      EXPECT_NEAR(machine.mean(), slow, 0.2 * slow);
      EXPECT_LE(machine.pessimistic(), slow * (1.02 + 3 * scatter));
    }
  }
}

TEST(MachineFactor, LearnsNothingFromNothing) {
  MachineFactor machine(3);
  machine.observe(1, 0);
  machine.observe(0, 1);
  machine.observe(1, 1e-9);
  EXPECT_EQ(machine.mean(), 3);
}

}  // namespace mobil::lod_table_test
