// The crowd's distributions and families, compared with formulas written for this test.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/components/step_plan.h>
#include <mobil/rows.h>
#include <mobil/simulation.h>
#include <mobil/systems/limits/limit_monitor.h>
#include <mobil/usual_gait.h>
#include "demo/scene/crowd_parties.h"
#include "demo/scene/crowd_people.h"

namespace mobil::crowd_people_test {
namespace {

constexpr std::uint64_t seed = 5, drawn = 10000;

/// Means, deviations and correlation of two quantities.
struct Pairs {
  std::vector<double> x, y;
  void add(double a, double b) {
    x.push_back(a);
    y.push_back(b);
  }
  auto count() const { return static_cast<double>(x.size()); }
  static double mean(const std::vector<double>& of) {
    double sum = 0;
    for (const double one : of) sum += one;
    return sum / static_cast<double>(of.size());
  }
  static double deviation(const std::vector<double>& of) {
    const double middle = mean(of);
    double sum = 0;
    for (const double one : of) sum += (one - middle) * (one - middle);
    return std::sqrt(sum / static_cast<double>(of.size()));
  }
  double correlation() const {
    const double a = mean(x), b = mean(y);
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i) sum += (x[i] - a) * (y[i] - b);
    return sum / count() / deviation(x) / deviation(y);
  }
};

/// Adults of 18 to 65 years of one sex.
struct Grown {
  Pairs height_mass, age_index;
  void add(double age_y, double height_m, double mass_kg) {
    height_mass.add(height_m, mass_kg);
    age_index.add(age_y, mass_kg / (height_m * height_m));
  }
};

/// Statures and masses by the published formulas, with the standard library's distributions.
Grown by_formula(bool woman, std::size_t count) {
  std::mt19937 random(1);
  std::piecewise_linear_distribution<double> age;
  const std::vector<double> years = {18, 30, 45, 60, 65}, density = {1.1, 1.25, 1.3, 1.3, 1.15};
  age = std::piecewise_linear_distribution<double>(years.begin(), years.end(), density.begin());
  std::normal_distribution<double> normal;
  const auto z = [&] { return std::clamp(normal(random), -2.5, 2.5); };
  Grown all;
  for (std::size_t i = 0; i < count; ++i) {
    const double a = age(random), older = std::max(0.0, (a - 30) / 40);
    const double height = (woman ? 1.629 + 0.064 * z() : 1.757 + 0.069 * z()) - (woman ? 0.05 : 0.03) * older * older;
    const double index = (woman ? 23.6 : 24.6) * (1 + 0.0035 * (a - 30)) * std::exp((woman ? 0.160 : 0.145) * z());
    all.add(a, height, index * height * height);
  }
  return all;
}

TEST(CrowdPeople, AreDistributedAsPublished) {
  std::size_t women = 0, young = 0, old = 0;
  Grown grown[2];
  for (std::uint64_t number = 0; number < drawn; ++number) {
    const BodyRequest body = crowd_person(seed, number, 0).body;
    women += body.sex == Sex::woman;
    young += body.age_y < 18;
    old += body.age_y >= 65;
    ASSERT_GE(body.age_y, 6);
    ASSERT_LE(body.age_y, 90);
    if (body.age_y >= 18 && body.age_y < 65)
      grown[static_cast<int>(body.sex)].add(double{body.age_y}, double{body.height_m}, double{body.mass_kg});
  }
  const auto share = [](std::size_t count) { return static_cast<double>(count) / drawn; };
  const auto three_errors = [](double p) { return 3 * std::sqrt(p * (1 - p) / drawn); };
  // Areas of the density: 13.2 from 6 to 18 years, 16.875 from 65 on, 88.875 in all.
  EXPECT_NEAR(share(women), 0.5, three_errors(0.5));
  EXPECT_NEAR(share(young), 13.2 / 88.875, three_errors(0.15));
  EXPECT_NEAR(share(old), 16.875 / 88.875, three_errors(0.19));
  std::printf("women %.1f %%, under 18 %.1f %%, from 65 %.1f %%\n", 100 * share(women), 100 * share(young),
              100 * share(old));
  struct Figures {
    double height_m, height_deviation_m, mass_kg, mass_deviation_kg, height_with_mass, age_with_index;
  };
  const Figures published[] = {{1.751, 0.068, 79.6, 13.5, 0.43, 0.29}, {1.622, 0.064, 65.5, 11.9, 0.41, 0.27}};
  for (const int sex : {0, 1}) {
    const Grown formula = by_formula(sex == 1, 100000), &is = grown[sex];
    const double n = is.height_mass.count(), root = std::sqrt(n),
                 also = std::sqrt(1 / n + 1 / 2000.0);  // 6000 drawn there
    const auto check = [&](const char* what, double value, double expected, double figure, double error) {
      EXPECT_NEAR(value, expected, 3 * error / root) << sex << ' ' << what;
      EXPECT_NEAR(value, figure, 3 * error * also + 0.5e-3 * std::abs(figure)) << sex << ' ' << what;
      std::printf("%s: %.4g, formula %.4g, design %.4g\n", what, value, expected, figure);
    };
    const auto& [height_m, height_deviation_m, mass_kg, mass_deviation_kg, height_with_mass, age_with_index] =
        published[sex];
    const auto &h = is.height_mass.x, &m = is.height_mass.y, &fh = formula.height_mass.x, &fm = formula.height_mass.y;
    const double dh = Pairs::deviation(h), dm = Pairs::deviation(m);
    check("stature", Pairs::mean(h), Pairs::mean(fh), height_m, dh);
    check("its deviation", dh, Pairs::deviation(fh), height_deviation_m, dh / std::sqrt(2));
    check("mass", Pairs::mean(m), Pairs::mean(fm), mass_kg, dm);
    check("its deviation", dm, Pairs::deviation(fm), mass_deviation_kg, dm);
    check("r(stature, mass)", is.height_mass.correlation(), formula.height_mass.correlation(), height_with_mass, 1);
    check("r(age, index)", is.age_index.correlation(), formula.age_index.correlation(), age_with_index, 1);
  }
}

TEST(CrowdPeople, WalkInPartiesOfFamilies) {
  std::map<std::uint32_t, std::size_t> parties;
  Pairs spouses, fathers, mothers, siblings;
  std::vector<double> births_y;
  for (std::uint64_t block = 0; block < 300; ++block) {
    const CrowdBlock people = crowd_block(seed, block);
    for (std::size_t at = 0; at < people.size(); at += people[at].party_size) {
      const std::uint32_t size = people[at].party_size;
      ++parties[std::min(size, 3U)];
      ASSERT_LE(at + size, people.size());
      for (std::size_t k = at; k < at + size; ++k) {
        EXPECT_EQ(people[k].party_first, block * crowd_block_size + at);
        if (people[k].age_y < 10) {
          EXPECT_GE(people[at].age_y, 18);
        }
      }
      if (size < 3 || people[at].age_y < 18 || people[at + 1].age_y < 18 || people[at + 2].age_y >= 18) continue;
      if (people[at].sex == Sex::man || people[at + 1].sex == Sex::woman) continue;
      spouses.add(double{people[at].height_z}, double{people[at + 1].height_z});
      for (std::size_t k = at + 2; k < at + size; ++k) {
        births_y.push_back(double{people[at].age_y - people[k].age_y});
        mothers.add(double{people[at].height_z}, double{people[k].height_z});
        fathers.add(double{people[at + 1].height_z}, double{people[k].height_z});
        if (k > at + 2) siblings.add(double{people[k - 1].height_z}, double{people[k].height_z});
      }
    }
  }
  EXPECT_EQ(parties[1], 60 * 300U);
  EXPECT_EQ(parties[2], 27 * 300U);
  EXPECT_EQ(parties[3], 13 * 300U);
  const auto near = [](const char* what, const Pairs& of, double expected) {
    EXPECT_NEAR(of.correlation(), expected, 3 / std::sqrt(of.count())) << what;
    std::printf("%s: r %.3f of %g\n", what, of.correlation(), of.count());
  };
  near("spouses", spouses, 0.28);
  near("father", fathers, 0.40 * 1.28);
  near("mother", mothers, 0.40 * 1.28);
  near("siblings", siblings, 2 * 0.16 * 1.28);
  std::printf("mother at birth: %.1f, %.1f years\n", Pairs::mean(births_y), Pairs::deviation(births_y));
  EXPECT_NEAR(Pairs::mean(births_y), 30, 1);
  EXPECT_NEAR(Pairs::deviation(births_y), 5, 1);
}

TEST(CrowdPeople, WalkAtTheSpeedOfThePartysSlowest) {
  for (std::uint64_t number = 0; number < 500; ++number) {
    const CrowdPerson one = crowd_person(seed, number, 0);
    float slowest_m_s = 9;
    for (std::uint64_t k = one.party_first; k < one.party_first + one.party_size; ++k) {
      const CrowdPerson other = crowd_person(seed, k, 0);
      EXPECT_EQ(*other.gait.speed_m_s, *one.gait.speed_m_s);
      slowest_m_s = std::min(slowest_m_s, usual_speed_m_s(other.body));
    }
    EXPECT_LE(*one.gait.speed_m_s, 1.30F * slowest_m_s);
  }
  const CrowdOffset left = crowd_abreast(0, 2, 0), right = crowd_abreast(1, 2, 0);
  EXPECT_NEAR(std::hypot(left.x_m - right.x_m, left.z_m - right.z_m), 0.75, 1e-6);
  EXPECT_EQ(left.z_m, right.z_m);
}

TEST(CrowdPeople, CanNearlyAllWalkAsDrawn) {
  std::size_t again = 0;
  for (std::uint64_t number = 0; number < drawn; ++number) {
    std::uint8_t draw = 0;
    ASSERT_TRUE(crowd_walker(seed, number, draw));
    again += draw;
  }
  std::printf("%zu of %llu drawn again\n", again, static_cast<unsigned long long>(drawn));
  EXPECT_LE(again, 10U);
}

/// Steady walks of people of all ages have no steps beyond bounded forces and break no limit.
TEST(CrowdPeople, WalkSteadilyWithinLimits) {
  constexpr std::size_t people = 600;
  Simulation simulation;
  std::vector<SpawnRequest> requests;
  for (std::uint64_t number = 0; number < people; ++number) {
    std::uint8_t draw = 0;
    const CrowdPerson person = crowd_walker(seed, number, draw).value();
    requests.push_back({.body = person.body, .gait = person.gait});
  }
  std::vector<Entity> walkers(people);
  ASSERT_TRUE(simulation.spawn(requests, walkers));
  std::size_t clamped = 0, broken = 0;
  for (int tick = 0; tick < 240; ++tick) {
    simulation.tick();
    for (const Entity one : walkers) {
      clamped += simulation.get<StepPlan>(one)->clamped != 0;
      broken += limit_violations(simulation.world(), one).size();
    }
  }
  EXPECT_EQ(clamped, 0U);
  EXPECT_EQ(broken, 0U);
}

}  // namespace
}  // namespace mobil::crowd_people_test
