// Ground reactions and joint moments of walking people, compared with mechanics and with measured walks.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <mobil/assets/files/csv_table.h>
#include <mobil/components/step_plan.h>
#include <mobil/simulation.h>
#include <mobil/systems/gait/resolve_gait.h>
#include "tests/files/reference_data.h"
#include "tests/gait/forces_figure.h"

namespace mobil::forces_walk_test {
using namespace figure;

/// Data of one walker at one instant. Side 0 right, 1 left.
struct Instant {
  std::uint32_t steps = 0;
  double part_of_double_support = 0;
  std::size_t stance = 0;
  Vector centre;
  std::array<double, 2> phase{};
  std::array<Vector, 2> heel, toe, force, pressure, joints;
};

Vector vector_of(const Vec3<float>& v) {
  return Eigen::Vector3f(v.x, v.y, v.z).cast<double>();
}

struct Walker {
  double height, mass, tick_s;
  std::vector<Instant> instant;

  double weight() const { return mass * gravity; }
  /// Returns the range from the first to the last heel strike of the right foot.
  std::pair<std::size_t, std::size_t> whole_strides() const {
    std::size_t first = 0, last = 0;
    for (std::size_t i = 2; i + 1 < instant.size(); ++i) {
      if (instant[i].phase[Side::right] >= instant[i - 1].phase[Side::right]) continue;
      if (first == 0) first = i;
      last = i;
    }
    return {first, last};
  }
};

/// Walks for a while at a speed (m/s), then records some strides.
Walker walk(float height, float mass, float speed, double tick_s = 1.0 / 120) {
  Simulation simulation({.tick_s = tick_s});
  const BodyRequest body{.height_m = height, .mass_kg = mass};
  GaitRequest gait{.speed_m_s = speed};
  gait.step_length_m = resolve_gait(*make_body(body), gait, Footwear::barefoot)->step_length_m;
  const Entity person = *simulation.spawn(body, gait);
  simulation.enable(person, Feature::forces);
  Walker w{static_cast<double>(height), static_cast<double>(mass), tick_s, {}};
  const auto settle = static_cast<int>(5 / tick_s), ticks = static_cast<int>(11 / tick_s);
  for (int t = 0; t < ticks; ++t) {
    simulation.tick();
    if (t <= settle) continue;
    const StepPlan<float> plan = *simulation.get<StepPlan>(person);
    const GaitState<float> state = *simulation.get<GaitState>(person);
    const Feet<float> feet = *simulation.get<Feet>(person);
    const GroundReaction<float> ground = *simulation.get<GroundReaction>(person);
    const JointMoments<float> moments = *simulation.get<JointMoments>(person);
    Instant now{};
    now.steps = state.steps;
    now.part_of_double_support = static_cast<double>(state.time_s / plan.double_support_s);
    now.stance = state.stance_side;
    now.centre = vector_of(simulation.get<CentreOfMass>(person)->position_m);
    for (std::size_t side = 0; side < 2; ++side) {
      now.phase[side] = static_cast<double>(feet.phase[side]);
      now.heel[side] = vector_of(feet.heel_m[side]);
      now.toe[side] = vector_of(feet.toe_m[side]);
      now.force[side] = vector_of(ground.force_n[side]);
      now.pressure[side] = vector_of(ground.centre_m[side]);
      now.joints[side] = {static_cast<double>(moments.hip_nm[side]), static_cast<double>(moments.knee_nm[side]),
                          static_cast<double>(moments.ankle_nm[side])};
    }
    w.instant.push_back(now);
  }
  return w;
}

const std::vector<Walker>& walkers() {
  static const std::vector<Walker> all = [] {
    std::vector<Walker> made;
    for (const auto& [height, mass, speed] : std::vector<std::array<float, 3>>{
             {1.803F, 72.6F, 1.14F}, {1.75F, 75.0F, 1.4F}, {1.6F, 55.0F, 0.9F}, {1.9F, 95.0F, 1.7F}})
      made.push_back(walk(height, mass, speed));
    return made;
  }();
  return all;
}

TEST(ForcesOfWalking, GroundForcesCarryTheWeightOverAStride) {
  for (const Walker& w : walkers()) {
    const auto [first, last] = w.whole_strides();
    ASSERT_GT(last, first + 100);
    Vector sum = Vector::Zero();
    for (std::size_t i = first; i < last; ++i) sum += w.instant[i].force[Side::right] + w.instant[i].force[Side::left];
    sum /= static_cast<double>(last - first) * w.weight();
    EXPECT_NEAR(sum.y(), 1, 0.01);
    EXPECT_NEAR(sum.x(), 0, 0.01);
    EXPECT_NEAR(sum.z(), 0, 0.01);
  }
}

TEST(ForcesOfWalking, BothFeetTogetherPushTheCentreOfMass) {
  for (const Walker& w : walkers()) {
    for (std::size_t i = 1; i + 1 < w.instant.size(); ++i) {
      const Vector a =
          (w.instant[i + 1].centre - 2 * w.instant[i].centre + w.instant[i - 1].centre) / (w.tick_s * w.tick_s);
      const Vector f = w.mass * (a + Vector(0, gravity, 0));
      EXPECT_LT((w.instant[i].force[Side::right] + w.instant[i].force[Side::left] - f).norm(),
                0.10 * w.weight());  // at a strike, over 6 ms
    }
  }
}

TEST(ForcesOfWalking, LoadIsOnlyOnGroundedFeetAndWithinTheSole) {
  for (const Walker& w : walkers()) {
    const double toes = fraction::toes_length * w.height;
    for (const Instant& now : w.instant) {
      for (std::size_t side = 0; side < 2; ++side) {
        if (side != now.stance && now.part_of_double_support > 1) {
          EXPECT_EQ(now.force[side].norm(), 0);
          continue;
        }
        const Vector sole = now.toe[side] - now.heel[side], along = Vector(sole.x(), 0, sole.z()).normalized();
        const Vector from_heel = now.pressure[side] - now.heel[side];
        EXPECT_GT(from_heel.dot(along), -0.002);
        EXPECT_LT(from_heel.dot(along), sole.dot(along) + toes + 0.002);
        EXPECT_EQ(now.pressure[side].y(), 0);
      }
    }
  }
}

TEST(ForcesOfWalking, InDoubleSupportTheTrailingLegPushesAndTheLeadingLegBrakes) {
  for (const Walker& w : walkers()) {
    int seen = 0;
    for (const Instant& now : w.instant) {
      if (now.part_of_double_support < 0.3 || now.part_of_double_support > 0.7) continue;
      const Vector lead = now.force[now.stance], trail = now.force[1 - now.stance];
      if (lead.y() < 0.1 * w.weight() || trail.y() < 0.1 * w.weight()) continue;
      EXPECT_GT(trail.z() / trail.y() - lead.z() / lead.y(), 0.2);
      // Each foot is pushed toward the body's middle.
      const double out = now.stance == Side::left ? 1 : -1;
      EXPECT_LT(out * (lead.x() / lead.y() - trail.x() / trail.y()), 0);
      ++seen;
    }
    EXPECT_GT(seen, 5);
  }
}

TEST(ForcesOfWalking, CentreOfPressureMovesForwardFromHeelToToes) {
  for (const Walker& w : walkers()) {
    for (std::size_t side = 0; side < 2; ++side) {
      double place = w.instant.front().pressure[side].z(), strike = 0;
      bool bearing = true, struck = false;
      for (const Instant& now : w.instant) {
        const bool bears = now.force[side].y() > 0.1 * w.weight();
        const double here = now.pressure[side].z();
        if (bears && bearing) {
          // Bound on the change per tick of 8 ms. The motion between fitted steps causes some wandering.
          EXPECT_GT(here, place - 0.10);
          EXPECT_LT(here, place + 0.10);
        }
        if (bears && !bearing) {
          strike = here;
          struck = true;
        }
        if (!bears && bearing && struck) {
          EXPECT_GT(place - strike, 0.08 * w.height);
          EXPECT_LT(place - strike, 0.16 * w.height);
        }
        place = here;
        bearing = bears;
      }
    }
  }
}

// ---- against measured walks -----------------------------------------------------------------------------------------

using Percents = std::vector<std::pair<double, double>>;  // percent of the gait cycle, value

Percents measured(const std::string& file, std::string_view column_name, std::string_view key, std::string_view value) {
  Percents curve;
  const auto table = read_csv(test::reference_table(file).value().string(), {});
  if (!table) throw std::runtime_error(table.error().message);
  for (std::size_t r = 0; r < table->row.size(); ++r) {
    if (!key.empty() && cell(*table, r, key) != value) continue;
    const auto percent = number(cell(*table, r, "percent_gait")), y = number(cell(*table, r, column_name));
    if (percent && y) curve.emplace_back(*percent, *y);
  }
  return curve;
}

/// Returns the walker's mean value over the recorded strides at a percentage of the right foot's cycle.
template <class Value>
double at_percent(const Walker& w, double percent, Value value) {
  double sum = 0;
  int strides = 0;
  for (std::size_t i = 1; i < w.instant.size(); ++i) {
    const double a = 100 * w.instant[i - 1].phase[Side::right];
    double b = 100 * w.instant[i].phase[Side::right], p = percent;
    if (b < a) {
      b += 100;
      if (p < a) p += 100;
    }
    if (p < a || p >= b) continue;
    const double t = (p - a) / (b - a);
    sum += (1 - t) * value(w.instant[i - 1]) + t * value(w.instant[i]);
    ++strides;
  }
  return sum / strides;
}

struct Likeness {
  double correlation, peak;  // ratio of the highest points, simulated to measured
};

/// Prints and returns the similarity of the curves. Extremes are simulated / measured.
template <class Value>
Likeness compare(const Walker& w, const Percents& curve, const char* what, Value value) {
  double sx = 0, sy = 0, sxx = 0, syy = 0, sxy = 0, n = 0;
  double high_x = -1e9, high_y = -1e9, low_x = 1e9, low_y = 1e9;
  for (const auto& [percent, y] : curve) {
    const double x = at_percent(w, percent, value);
    sx += x, sy += y, sxx += x * x, syy += y * y, sxy += x * y, n += 1;
    high_x = std::fmax(high_x, x), high_y = std::fmax(high_y, y);
    low_x = std::fmin(low_x, x), low_y = std::fmin(low_y, y);
  }
  const double r = (sxy - sx * sy / n) / std::sqrt((sxx - sx * sx / n) * (syy - sy * sy / n));
  std::printf("  %-24s correlation %.3f  highest %6.2f / %6.2f  lowest %6.2f / %6.2f\n", what, r, high_x, high_y, low_x,
              low_y);
  return {r, high_x / high_y};
}

/// A measured walk, and for each curve the minimum correlation at that speed: the value reached, less 0.01.
struct Walk {
  const char *name, *ground, *moments, *key, *value;
  float height, mass, speed;
  std::array<double, 5> correlation;
};

void expect_to_resemble(const Walk& m) {
  struct Curve {
    const char* column;
    double highest;  // ratio of peaks, simulated to measured: moments are known to be too large
    double (*value)(const Walker&, const Instant&);
  };
  constexpr std::array<Curve, 5> curves = {
      {{"vertical_BW", 1.1, [](const Walker& w, const Instant& i) { return i.force[Side::right].y() / w.weight(); }},
       {"foreaft_BW", 1.3, [](const Walker& w, const Instant& i) { return i.force[Side::right].z() / w.weight(); }},
       {"hip_extensor_Nm_kg", 1.5, [](const Walker& w, const Instant& i) { return i.joints[Side::right](0) / w.mass; }},
       {"knee_extensor_Nm_kg", 1.7,
        [](const Walker& w, const Instant& i) { return i.joints[Side::right](1) / w.mass; }},
       {"ankle_plantarflexor_Nm_kg", 1.4,
        [](const Walker& w, const Instant& i) { return i.joints[Side::right](2) / w.mass; }}}};
  const Walker w = walk(m.height, m.mass, m.speed, 1.0 / 60);
  std::printf("%s\n", m.name);
  for (std::size_t c = 0; c < curves.size(); ++c) {
    const Percents theirs = measured(c < 2 ? m.ground : m.moments, curves[c].column, m.key, m.value);
    const Likeness like = compare(w, theirs, curves[c].column, [&](const Instant& i) { return curves[c].value(w, i); });
    EXPECT_GT(like.correlation, m.correlation[c]) << m.name << ", " << curves[c].column;
    EXPECT_GT(like.peak, 0.7) << m.name << ", " << curves[c].column;
    EXPECT_LT(like.peak, curves[c].highest) << m.name << ", " << curves[c].column;
  }
}

TEST(ForcesOfWalking, CurvesResembleMeasuredWalksAtThreeSpeeds) {
  // Schwartz's dimensionless speeds on a leg of 0.516 heights.
  const char *ground = "schwartz2008_grf.csv", *moments = "schwartz2008_moments_powers.csv", *key = "speed_class";
  for (const Walk& m :
       {Walk{"Schwartz slow", ground, moments, key, "slow", 1.75F, 75, 0.87F, {0.98, 0.98, 0.95, 0.89, 0.98}},
        Walk{"Schwartz free", ground, moments, key, "free", 1.75F, 75, 1.28F, {0.98, 0.98, 0.95, 0.91, 0.98}},
        Walk{"Schwartz fast", ground, moments, key, "fast", 1.75F, 75, 1.67F, {0.97, 0.98, 0.96, 0.95, 0.98}}}) {
    expect_to_resemble(m);
  }
}

TEST(ForcesOfOtherMeasuredWalks, CurvesResembleWintersAdultsAndOneMan) {
  for (const Walk& m : {Walk{"Winter natural",
                             "winter_grf.csv",
                             "winter_joint_moments.csv",
                             "cadence_class",
                             "natural",
                             1.75F,
                             75,
                             1.33F,
                             {0.98, 0.97, 0.91, 0.92, 0.98}},
                        Walk{"one man",
                             "trial_subject01_walk.csv",
                             "trial_subject01_walk.csv",
                             "",
                             "",
                             1.803F,
                             72.6F,
                             1.14F,
                             {0.96, 0.92, 0.86, 0.77, 0.96}}}) {
    if (!test::reference_table(m.ground) || !test::reference_table(m.moments)) GTEST_SKIP() << test::no_table;
    expect_to_resemble(m);
  }
}

}  // namespace mobil::forces_walk_test
