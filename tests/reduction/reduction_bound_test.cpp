// A certificate: never below the error against the full model, and near enough to it to be of use.
#include "tests/reduction/bound/reduction_bound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/muscle_table.h>
#include "assets/reduction/reduced_basis.h"
#include "assets/reduction/reduced_belly.h"
#include "assets/surfaces/muscle_cage.h"
#include "tests/fem/oracle.h"
#include "tests/labels.h"
#include "tests/reduction/reduction_truth.h"

namespace mobil::reduction_bound_test {
using Loads = std::vector<std::vector<double>>;
constexpr double tick_s = 1.0 / 60;

struct Case {
  HexahedralMesh mesh;
  Material material;
  Element element = Element::full;
  ReducedOptions options;
  std::vector<double> fields;
  StiffnessTerms terms;
  ReducedBasis basis;
  ReductionBound bound;
};

Case prepared(HexahedralMesh mesh, const Material& material, Element element, ReducedOptions options,
              std::uint32_t space = 64) {
  options.corrected = false;
  Case made{std::move(mesh), material, element, options, {}, {}, {}, {}};
  made.terms = assemble(made.mesh, material, element).value();
  made.basis = make_reduced_basis(made.mesh, material, element, options, &made.fields).value();
  made.bound = make_reduction_bound(made.mesh, material, element, made.basis, made.fields, space).value();
  return made;
}

HexahedralMesh muscle_mesh(Muscle muscle, const Cells& cells) {
  return bend_block(cells, muscle_cage(muscle), reference_belly_m(muscle), belly_grading).value();
}

/// Stride of 1.1 s at 60 Hz: smooth but for what heel strikes and a line that slips over bone do. m.
Loads walk_stretches(int ticks) {
  Loads loads;
  for (int i = 0; i < ticks; ++i) {
    const double t = i * tick_s, phase = std::fmod(t, 1.1);
    const double strike = phase > 0.15 ? std::exp(-30 * (phase - 0.15)) * std::sin(110 * (phase - 0.15)) : 0;
    const double slip = 0.004 * std::abs(std::sin(2 * std::numbers::pi * t / 1.1 + 0.6));
    const double swing =
        0.02 * std::sin(2 * std::numbers::pi * t / 1.1) + 0.007 * std::sin(4 * std::numbers::pi * t / 1.1);
    loads.push_back({swing + slip + 0.003 * strike});
  }
  return loads;
}

/// A walk of random waves and, at some ticks, jerks, each input to a size of its own.
Loads any_loads(std::mt19937& random, const ReducedBasis& basis, double end_size, int ticks) {
  std::uniform_real_distribution<double> one(-1, 1);
  Loads loads(static_cast<std::size_t>(ticks), std::vector<double>(basis.inputs));
  const double jerkiness = std::abs(one(random));
  for (std::size_t k = 0; k < basis.inputs; ++k) {
    const bool frame = basis.options.frame_loads && k + frame_inputs >= basis.inputs;
    const double size = frame ? 10 : end_size, slow = 8 * one(random), fast = 40 * one(random);
    double jerk = 0;
    for (int i = 0; i < ticks; ++i) {
      if (std::abs(one(random)) < 0.2) jerk = jerkiness * one(random);
      loads[static_cast<std::size_t>(i)][k] =
          size * (std::sin(slow * i * tick_s) + 0.2 * std::sin(fast * i * tick_s + 1) + jerk);
    }
  }
  return loads;
}

struct Compared {
  std::vector<double> energy, rms;  // bound over truth
};

Compared compare(const Case& c, double across, double along, double damping_per_s, const Loads& loads, double step_s) {
  auto belly = BoundedBelly::make(c.bound, across, along, damping_per_s).value();
  FullBelly truth(c.mesh, c.terms, c.basis, c.fields, across, along, damping_per_s);
  Compared all;
  const auto keep = [&](const ReductionError& bound) {
    const FullBelly::Error error = truth.error(belly.coordinates());
    if (error.energy < 1e-12 * bound.own) return;  // rounding's
    all.energy.push_back(bound.energy / error.energy);
    all.rms.push_back(bound.rms_m / error.rms_m);
  };
  truth.start(loads[0]);
  keep(belly.start(loads[0]));
  for (std::size_t i = 1; i < loads.size(); ++i) {
    truth.step(loads[i], step_s);
    keep(belly.step(loads[i], step_s));
  }
  return all;
}

double median(std::vector<double> numbers) {
  std::nth_element(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2), numbers.end());
  return numbers[numbers.size() / 2];
}

double least(const std::vector<double>& numbers) {
  return *std::min_element(numbers.begin(), numbers.end());
}

struct Size {
  double across, along;
};
Size size_of(double ratio, double product) {
  return {std::sqrt(ratio * product), std::sqrt(product / ratio)};
}

TEST(ReductionBound, IsNeverBelowTheErrorWhateverTheBellyItsEndAndItsLoads) {
  MOBIL_SLOW();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(0, 1);
  const auto between = [&](double low, double high) { return low + (high - low) * part(random); };
  for (int round = 0; round < 12; ++round) {
    std::vector<CageStation> stations;
    for (const float t : {0.0F, 0.4F, 1.0F}) {
      const auto draw = [&](double low, double high) { return static_cast<float>(between(low, high)); };
      stations.push_back({t, draw(-0.01, 0.01), draw(-0.01, 0.01), draw(0.02, 0.04), draw(0.02, 0.04)});
    }
    ReducedOptions o;
    o.vectors = static_cast<std::uint32_t>(between(3, 17));
    o.far_end = static_cast<FarEnd>(round % 3);
    o.frame_loads = round % 2 == 1;
    o.foundation_hz = round % 4 == 1 ? between(2, 8) : 0;
    o.middle_ratio = between(0.7, 1.4);
    o.ratio_width = round % 5 == 4 ? 1 : between(1.02, 1.08);
    const Material material{1000, between(5e3, 5e4), between(0, 0.42)};
    const Case c = prepared(bend_block({2, 2, 8}, stations, between(0.15, 0.3)).value(), material,
                            static_cast<Element>(round % 3), o, o.vectors + static_cast<std::uint32_t>(between(0, 50)));
    for (const double side : {-1.0, between(-1, 1), 1.0}) {
      const double ratio = o.middle_ratio * std::pow(o.ratio_width, side);
      const Size size = size_of(ratio, between(0.7, 1.3));
      const double damping = between(0.1, 1.2) * body_range(c.bound, size.across, size.along).slowest_1_s;
      Loads loads = any_loads(random, c.basis, o.far_end == FarEnd::held ? 0.02 : 0.5, 60);
      if (round % 4 == 2) std::fill(loads.begin() + 3, loads.end(), loads[2]);  // what was kicked swings on alone
      const Compared all = compare(c, size.across, size.along, damping, loads, between(0.004, 0.03));
      EXPECT_GE(least(all.energy), 1) << "round " << round << " side " << side;
      EXPECT_GE(least(all.rms), 1) << "round " << round << " side " << side;
    }
  }
}

TEST(ReductionBound, OfWalksIsWithinTenTimesTheError) {
  for (const Muscle muscle : {Muscle::triceps_surae, Muscle::tibialis_anterior}) {
    const Case c = prepared(muscle_mesh(muscle, {2, 2, 8}), Material{}, Element::full, {});
    std::vector<double> all;
    for (const double ratio : {1 / 1.05, 0.98, 1.03, 1.05}) {
      const Size size = size_of(ratio, 0.9 + 5 * (ratio - 1));
      const Compared ratios = compare(c, size.across, size.along, 8, walk_stretches(240), tick_s);
      EXPECT_GE(least(ratios.energy), 1);
      EXPECT_GE(least(ratios.rms), 1);
      all.insert(all.end(), ratios.energy.begin(), ratios.energy.end());
    }
    EXPECT_LE(median(all), 10) << static_cast<int>(muscle);
  }
}

TEST(ReductionBound, OfAFinerMeshIsWithinTenTimesTheErrorToo) {
  const Case c =
      prepared(muscle_mesh(Muscle::hamstrings, {4, 4, 12}), Material{}, Element::full, {.control_cells = {2, 2, 6}});
  const Size size = size_of(1.03, 0.95);
  const Compared all = compare(c, size.across, size.along, 8, walk_stretches(180), tick_s);
  EXPECT_GE(least(all.energy), 1);
  EXPECT_GE(least(all.rms), 1);
  EXPECT_LE(median(all.energy), 10);
}

TEST(ReductionBound, IsZeroWhereNothingPullsAndNearRoundingWhereTheVectorsSpanAll) {
  ReducedOptions o;
  o.frame_loads = true;
  o.vectors = 12;
  o.control_cells = {1, 1, 2};
  const Case c = prepared(muscle_mesh(Muscle::hamstrings, {1, 1, 2}), Material{}, Element::full, o, 12);
  auto belly = BoundedBelly::make(c.bound, 1.02, 0.99, 6).value();
  const std::vector<double> nothing(c.basis.inputs);
  EXPECT_EQ(belly.start(nothing).energy, 0);
  EXPECT_EQ(belly.step(nothing, tick_s).energy, 0);
  EXPECT_EQ(belly.step(nothing, tick_s).rms_m, 0);
  std::mt19937 random(3);
  const Loads loads = any_loads(random, c.basis, 0.02, 60);
  belly.start(loads[0]);
  for (std::size_t i = 1; i < loads.size(); ++i) {
    const ReductionError error = belly.step(loads[i], tick_s);
    EXPECT_LT(error.energy - error.rounding, 1e-3 * error.own);
    EXPECT_GT(error.own, 0);
  }
}

TEST(ReductionBound, RestsOnRangesOfStiffnessThatHold) {
  for (const double hz : {0.0, 6.0}) {
    ReducedOptions o;
    o.foundation_hz = hz;
    o.frame_loads = hz > 0;
    const Case c = prepared(muscle_mesh(Muscle::tibialis_anterior, {2, 2, 8}), Material{}, Element::full, o);
    const Eigen::Index rows = 3 * Eigen::Index{node_count(c.mesh.cells)};
    std::vector<Eigen::Index> moving;
    for (Eigen::Index row = 0; row < rows; ++row) {
      if (moves(c.mesh.cells, o.far_end, static_cast<std::uint32_t>(row / 3), static_cast<std::size_t>(row % 3))) {
        moving.push_back(row);
      }
    }
    const auto matrix = [&](const OperatorMix& mix) -> Eigen::MatrixXd {
      return applied(c.terms, mix, Columns::Identity(rows, rows))(moving, moving);
    };
    const double brace = c.basis.foundation_1_s2, p0 = o.middle_product;
    const Eigen::MatrixXd reference = matrix({1, 1, 1, p0 * brace, 0}), mass = matrix({0, 0, 0, 1, 1});
    for (const double ratio : {1 / 1.05, 0.98, 1.0, 1.035, 1.05}) {
      for (const double p : {0.7, p0, 1.3}) {
        const Size size = size_of(ratio, p);
        const BodyRange range = body_range(c.bound, size.across, size.along);
        const Eigen::MatrixXd k = matrix({1 / ratio, 1, ratio, p * brace, 0});
        const Eigen::VectorXd against = oracle::eigenvalues(k, reference);
        const Eigen::VectorXd swing = oracle::eigenvalues(k / p, mass);
        const double low = against(0), high = against.tail(1)(0);
        const double slow = std::sqrt(swing(0));
        EXPECT_LE(range.least, low * (1 + 1e-10));
        EXPECT_GE(range.most, high * (1 - 1e-10));
        EXPECT_LE(range.slowest_1_s, slow);
        if (hz > 0) continue;
        EXPECT_GT(range.least, low - 0.05);
        EXPECT_LT(range.most, high + 0.08);
        EXPECT_GT(range.slowest_1_s, 0.99 * slow);
      }
    }
  }
}

TEST(ReductionBound, FollowsTheReducedBellyItself) {
  ReducedOptions o;
  o.frame_loads = true;
  const Case c = prepared(muscle_mesh(Muscle::triceps_surae, {2, 2, 8}), Material{}, Element::full, o);
  const double across = 1.01, along = 0.98, damping = 7;
  const ReducedBelly belly = make_reduced_belly(c.basis, across, along).value();
  auto bounded = BoundedBelly::make(c.bound, across, along, damping).value();
  std::mt19937 random(5);
  const Loads loads = any_loads(random, c.basis, 0.02, 60);
  bounded.start(loads[0]);
  const auto at_rest = [&](std::size_t j, const std::vector<double>& input) {
    double sum = 0;
    for (std::size_t k = 0; k < belly.inputs; ++k) sum += belly.participation[j][k] * input[k];
    return sum;
  };
  std::vector<FreeOrForced> motion;
  for (std::size_t j = 0; j < belly.vectors; ++j) {
    motion.push_back({belly.omega_1_s[j] * belly.omega_1_s[j], damping, at_rest(j, loads[0]), 0});
  }
  for (std::size_t i = 1; i < loads.size(); ++i) {
    bounded.step(loads[i], tick_s);
    const std::vector<double> q = bounded.coordinates();
    std::vector<double> expected(belly.vectors);
    for (std::size_t j = 0; j < belly.vectors; ++j) {
      motion[j].step(at_rest(j, loads[i - 1]), at_rest(j, loads[i]), tick_s);
      const double moved = motion[j].z - belly.lift_share[j] * loads[i][0];
      for (std::size_t v = 0; v < belly.vectors; ++v) expected[v] += belly.eigenvector[v][j] * moved;
    }
    double size = 0;
    for (const double number : expected) size = std::max(size, std::abs(number));
    for (std::size_t v = 0; v < belly.vectors; ++v) EXPECT_NEAR(q[v], expected[v], 1e-8 * size);
  }
}

TEST(ReductionBound, IsRefusedInOneLineWhereItWouldNotHold) {
  const HexahedralMesh mesh = muscle_mesh(Muscle::triceps_surae, {2, 2, 8});
  const auto message = [](const auto& result) { return result ? std::string("none") : result.error().message; };
  ReducedOptions o;
  std::vector<double> fields;
  const ReducedBasis corrected = make_reduced_basis(mesh, {}, Element::full, o, &fields).value();
  EXPECT_NE(message(make_reduction_bound(mesh, {}, Element::full, corrected, fields)).find("correction"),
            std::string::npos);
  o.corrected = false;
  const ReducedBasis basis = make_reduced_basis(mesh, {}, Element::full, o, &fields).value();
  std::vector<double> other = fields;
  other[1000] += 0.1;
  EXPECT_NE(message(make_reduction_bound(mesh, {}, Element::full, basis, other)).find("fields"), std::string::npos);
  other.pop_back();
  EXPECT_NE(message(make_reduction_bound(mesh, {}, Element::full, basis, other)).find("fields"), std::string::npos);
  EXPECT_NE(message(make_reduction_bound(mesh, {}, Element::full, basis, fields, 400)).find("160"), std::string::npos);
  const auto bound = make_reduction_bound(mesh, {}, Element::full, basis, fields).value();
  EXPECT_NE(message(BoundedBelly::make(bound, 1.2, 1, 8)).find("ratio"), std::string::npos);
  EXPECT_NE(message(BoundedBelly::make(bound, 1, 1, 80)).find("damping"), std::string::npos);
  EXPECT_NE(message(BoundedBelly::make(bound, 1, 1, 0)).find("damping"), std::string::npos);
}

}  // namespace mobil::reduction_bound_test
