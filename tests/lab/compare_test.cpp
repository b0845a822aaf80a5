// Comparison of walks with measurements: judging functions on synthetic curves, tables, plots, and the command.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include <mobil/anthropometry.h>
#include <mobil/engine/geometry.h>
#include <mobil/usual_gait.h>
#include "assets/body/segment_inertia.h"
#include "demo/lab/compare/compare_judge.h"
#include "demo/lab/compare/compare_reference.h"
#include "demo/lab/compare/compare_verdicts.h"
#include "demo/lab/compare/compare_walk.h"
#include "demo/pictures/svg_plot.h"
#include "tests/gait/forces_figure.h"
#include "tests/program/program.h"

namespace mobil::compare_test {
namespace fs = std::filesystem;
using Json = nlohmann::json;

double between(double low, double high) {
  return low + (high - low) * *rc::gen::inRange(0, 10001) / 10000.0;
}

/// Returns a smooth periodic curve with random amplitudes and phases.
CycleCurve random_curve(double amplitude = 30) {
  const double a = between(0.2, 1) * amplitude, b = between(-0.4, 0.4) * amplitude, mean = between(-20, 20);
  const double phase_a = between(0, 6.28), phase_b = between(0, 6.28);
  CycleCurve curve{};
  for (std::size_t i = 0; i < cycle_points; ++i) {
    const double t = 2 * std::numbers::pi * static_cast<double>(i) / (cycle_points - 1);
    curve[i] = mean + a * std::cos(t - phase_a) + b * std::cos(2 * t - phase_b);
  }
  return curve;
}

CycleCurve mapped(const CycleCurve& curve, double scale, double shift) {
  CycleCurve out = curve;
  for (double& v : out) v = scale * v + shift;
  return out;
}

MeasuredCurve with_sd(const CycleCurve& mean, double sd) {
  MeasuredCurve curve{mean, {}};
  curve.sd.fill(sd);
  return curve;
}

RC_GTEST_PROP(Judge, ShiftedCurveIsInsideIfTheShiftIsWithinTheDeviation, ()) {
  const double sd = between(1, 10), shift = between(-20, 20);
  RC_PRE(std::abs(std::abs(shift) - sd) > 1e-6);
  const auto measured = with_sd(random_curve(), sd);
  const auto ours = mapped(measured.mean, 1, shift);
  const CurvePair pair{&ours, &measured};
  RC_ASSERT(inside_bands({&pair, 1}) == (std::abs(shift) <= sd ? 1.0 : 0.0));
  RC_ASSERT(std::abs(rms_distance(ours, measured.mean) - std::abs(shift)) < 1e-9);
}

RC_GTEST_PROP(Judge, TwoSetsAllowAtLeastEachAndAtMostBoth, ()) {
  const auto first = with_sd(random_curve(), between(1, 15)), second = with_sd(random_curve(), between(1, 15));
  const auto ours = random_curve(), other = mapped(ours, 1, between(-10, 10));  // each in its own convention
  const CurvePair pairs[] = {{&ours, &first}, {&other, &second}};
  const double a = inside_bands({&pairs[0], 1}), b = inside_bands({&pairs[1], 1}), both = inside_bands(pairs);
  RC_ASSERT(both >= std::max(a, b) && both <= a + b + 1e-12);
  const double nearer = std::min(rms_distance(ours, first.mean), rms_distance(other, second.mean));
  RC_ASSERT(rms_to_nearer_mean(pairs) <= nearer + 1e-12);
  RC_ASSERT(std::abs(rms_to_nearer_mean({&pairs[0], 1}) - rms_distance(ours, first.mean)) < 1e-12);
}

RC_GTEST_PROP(Judge, CorrelationIgnoresScaleAndShift, ()) {
  const auto a = random_curve(), b = random_curve();
  const double r = correlation(a, b), scale = between(0.1, 5), shift = between(-50, 50);
  RC_ASSERT(r >= -1 - 1e-12 && r <= 1 + 1e-12);
  RC_ASSERT(std::abs(correlation(mapped(a, scale, shift), b) - r) < 1e-9);
  RC_ASSERT(std::abs(correlation(mapped(a, -scale, shift), b) + r) < 1e-9);
  RC_ASSERT(std::abs(correlation(a, a) - 1) < 1e-12);
  CycleCurve flat{};
  RC_ASSERT(correlation(flat, a) == 0);
}

RC_GTEST_PROP(Judge, PeakIsFoundBetweenSamples, ()) {
  const double at = between(10, 90), height = between(5, 60), width = between(8, 20);
  const bool maximum = *rc::gen::arbitrary<bool>();
  CycleCurve curve{};
  for (std::size_t i = 0; i < cycle_points; ++i) {
    const double off = std::remainder(2.0 * static_cast<double>(i) - at, 100) / width;
    curve[i] = (maximum ? 1 : -1) * height * std::exp(-off * off);
  }
  const Peak peak = find_peak(curve, {"", maximum, static_cast<int>(at) - 8, static_cast<int>(at) + 8});
  RC_ASSERT(peak.interior);
  RC_ASSERT(std::abs(peak.percent - at) < 0.1);
  RC_ASSERT(std::abs(std::abs(peak.value) - height) < 0.002 * height);
}

RC_GTEST_PROP(Judge, ValuesBetweenReferencesHaveNoError, ()) {
  const double low = between(1, 50), high = low + between(0.1, 50), ours = between(0.5, 120);
  const double references[] = {high, low}, negative[] = {-high, -low};
  const double errors[] = {ours - low, ours - high};
  const double ratio = ratio_to_range(ours, references);
  RC_ASSERT(ratio_to_range(-ours, negative) == ratio);
  if (ours >= low && ours <= high) {
    RC_ASSERT(ratio == 1 && outside_range(errors) == 0);
  } else {
    const double nearest = ours < low ? low : high;
    RC_ASSERT(std::abs(ratio - ours / nearest) < 1e-12);
    RC_ASSERT(std::abs(outside_range(errors) - (ours - nearest)) < 1e-12);
  }
}

RC_GTEST_PROP(Judge, SamplingReadsALineFromUnevenRows, ()) {
  std::vector<double> phase = {-0.05};
  while (phase.back() < 1.02) phase.push_back(phase.back() + between(0.001, 0.03));
  const double slope = between(-50, 50), start = between(-50, 50);
  std::vector<double> value;
  for (const double p : phase) value.push_back(start + slope * p);
  const auto curve = sample_cycle(phase, value);
  for (std::size_t i = 0; i < cycle_points; ++i) {
    RC_ASSERT(std::abs(curve[i] - (start + slope * static_cast<double>(i) / 50)) < 1e-9);
  }
}

GaitReference built_in() {
  auto reference = read_gait_reference(std::nullopt);
  if (!reference) throw std::runtime_error(reference.error().message);
  return *reference;
}

/// Returns a walker with exactly the mean curves of a set's speed class, whose feet carry the weight.
Comparison mean_walker(const GaitReference& reference, std::size_t speed_class) {
  WalkedStride stride{};
  const auto& curve = reference.sets[0].curve[speed_class];
  const auto mean = [&](GaitQuantity q) { return curve[index(q)].mean; };
  stride.hip_from_pelvis = stride.hip_from_vertical = mean(GaitQuantity::hip);
  stride.knee = mean(GaitQuantity::knee);
  stride.ankle = mean(GaitQuantity::ankle);
  stride.forces = {mean(GaitQuantity::vertical),    mean(GaitQuantity::fore_aft),     mean(GaitQuantity::hip_moment),
                   mean(GaitQuantity::knee_moment), mean(GaitQuantity::ankle_moment), 1.0};
  stride.leg_m = reference.sets[0].leg_m;
  stride.speed_m_s = reference.sets[0].speed_m_s(speed_class, stride.leg_m);
  stride.double_support_cycle = 0.1;
  stride.com_lowest_percent = 4;
  stride.com_highest_percent = 29;
  const double speed = reference.sets[0].speed_m_s(speed_class, 0.9);
  stride.com_highest_m = excursion_of(reference, stride).mean_m;
  return {{}, reference, {{0, speed_class, speed, stride}}, {}, {}, {}, {}, {}};
}

std::vector<std::string> failed(const Comparison& comparison) {
  std::vector<std::string> names;
  for (const auto& verdict : judge(comparison)) {
    if (verdict.what.find("m/s") != std::string::npos && !verdict.held.value_or(false)) names.push_back(verdict.what);
  }
  return names;
}

TEST(Verdicts, MeanWalkerKeepsEveryBound) {
  const auto reference = built_in();
  for (std::size_t c = 0; c < speed_class_count; ++c) {
    ASSERT_TRUE(reference.sets[0].has_class(c));
    EXPECT_EQ(failed(mean_walker(reference, c)), std::vector<std::string>());
  }
}

TEST(Verdicts, EachFaultBreaksItsOwnBound) {
  const auto reference = built_in();
  const auto broken = [&](auto fault) {
    auto comparison = mean_walker(reference, compared_class::free);
    fault(comparison.walks[0].stride);
    std::string all;
    for (const auto& name : failed(comparison)) all += name.substr(name.find(": ") + 2) + "; ";
    return all;
  };
  EXPECT_EQ(broken([](WalkedStride& s) { s.knee = mapped(s.knee, 1, 5.5); }), "knee rms from the nearer mean; ");
  EXPECT_EQ(broken([](WalkedStride& s) { std::rotate(s.ankle.begin(), s.ankle.begin() + 2, s.ankle.end() - 1); }),
            "ankle rms from the nearer mean; ankle peaks off in time; ");
  EXPECT_EQ(broken([](WalkedStride& s) { s.forces->mean_weights = 1.011; }), "mean vertical force of both feet; ");
  EXPECT_EQ(broken([](WalkedStride& s) { s.forces->vertical = mapped(s.forces->vertical, 1.12, 0); }),
            "humps off in size, share; ");
  EXPECT_EQ(broken([](WalkedStride& s) { s.forces->hip_moment = mapped(s.forces->hip_moment, -1, 0); }),
            "hip_moment, correlation; hip_moment, peaks off in size, share; ");
  EXPECT_EQ(broken([](WalkedStride& s) { s.com_highest_percent = 12; }), "centre of mass highest; ");
  EXPECT_EQ(broken([](WalkedStride& s) { s.com_lowest_percent = 25; }), "centre of mass lowest; ");
  EXPECT_EQ(broken([](WalkedStride& s) { s.forces.reset(); }), "ground reaction; joint moments; ");
}

TEST(Verdicts, OneHumpIsNotTwo) {
  auto comparison = mean_walker(built_in(), compared_class::free);
  auto& vertical = comparison.walks[0].stride.forces->vertical;
  for (std::size_t i = 0; i < cycle_points; ++i) {
    vertical[i] = i < 30 ? std::sin(std::numbers::pi * static_cast<double>(i) / 30) : 0;
  }
  const auto names = failed(comparison);
  EXPECT_TRUE(std::ranges::any_of(names, [](const auto& n) { return n.find("humps of the") != std::string::npos; }));
}

TEST(Reference, StepsAreInterpolatedAndNotExtrapolated) {
  const auto reference = built_in();
  ASSERT_EQ(reference.steps.size(), 3U);
  for (const auto& band : reference.steps) {
    ASSERT_GE(band.norm.size(), 3U) << band.name;
    EXPECT_FALSE(band.at(band.norm.front().speed - 1e-6));
    EXPECT_FALSE(band.at(band.norm.back().speed + 1e-6));
    for (std::size_t i = 0; i < band.norm.size(); ++i) {
      const auto& norm = band.norm[i];
      EXPECT_NEAR(band.at(norm.speed)->length, norm.length, 1e-12);
      // measured separately, but the speed is their product
      EXPECT_NEAR(norm.length * norm.cadence / norm.speed, 1, 0.03) << band.name << " " << norm.speed;
      EXPECT_EQ(outside_step_bands(reference, norm, false), 0.0);
      EXPECT_EQ(outside_step_bands(reference, norm, true), 0.0);
    }
  }
}

TEST(Reference, DimensionlessSpeedScalesWithTheLeg) {
  const auto set = built_in().sets[0];
  EXPECT_NEAR(set.speed_m_s(compared_class::free, 0.9), 0.4294 * std::sqrt(9.81 * 0.9), 1e-9);
  EXPECT_NEAR(set.speed_m_s(compared_class::fast, 1.2) / set.speed_m_s(compared_class::fast, 0.3), 2, 1e-9);
}

TEST(Reference, MomentsGrowWithTheLegAndForcesDoNot) {
  const auto set = built_in().sets[0];
  const auto measured = [&](GaitQuantity q) { return set.curve[compared_class::fast][index(q)]; };
  const auto tall = [&](GaitQuantity q) { return set.scaled(compared_class::fast, q, 1.25 * set.leg_m); };
  for (std::size_t i = 0; i < cycle_points; ++i) {
    using enum GaitQuantity;
    EXPECT_EQ(tall(vertical).mean[i], measured(vertical).mean[i]);
    EXPECT_NEAR(tall(hip_moment).mean[i], 1.25 * measured(hip_moment).mean[i], 1e-12);
    EXPECT_NEAR(tall(ankle_moment).sd[i], 1.25 * measured(ankle_moment).sd[i], 1e-12);
  }
}

/// A rigid figure that turns about an axis through its centre of mass with increasing speed.
TEST(Balance, MomentOfTheMotionIsIncluded) {
  const Body body = make_body({.height_m = 1.8F, .mass_kg = 80}).value();
  const figure::Stance upright = figure::upright(1.8);
  const auto place = figure::places(1.8, upright);
  figure::Vector centre = figure::Vector::Zero();
  double mass = 0;
  for (std::size_t s = 0; s < segment_count; ++s) {
    const auto m = static_cast<double>(body.mass_kg[s]);
    centre += m * (place[s] + figure::of(geometry::to_double(body.centre_of_mass_m[s])));
    mass += m;
  }
  centre /= mass;
  constexpr double tick_s = 1.0 / 240, spin_up = 3, weight = 800;  // rad/s²
  for (const bool pitch : {true, false}) {
    const figure::Vector axis = pitch ? figure::Vector::UnitX() : figure::Vector::UnitZ();
    double inertia = 0;
    for (std::size_t s = 0; s < segment_count; ++s) {
      const auto m = static_cast<double>(body.mass_kg[s]);
      const figure::Vector arm = place[s] + figure::of(geometry::to_double(body.centre_of_mass_m[s])) - centre;
      const Vec3<double> own = segment_inertia_kg_m2(body, static_cast<Segment>(s));
      inertia += m * arm.cross(axis).squaredNorm() + (pitch ? own.x : own.z);
    }
    for (const double borne : {0.0, 0.5, 1.0}) {  // fraction of the moment carried by an offset force
      BalanceMeter meter(body);
      const double lever = borne * inertia * spin_up / weight;
      GroundReaction<float> ground{};
      ground.force_n[Side::left] = {0, static_cast<float>(weight), 0};
      // a force up at (x, z) from the centre has the moment (−z F, 0, x F)
      ground.centre_m[Side::left] = {static_cast<float>(centre.x() + (pitch ? 0 : lever)), 0,
                                     static_cast<float>(centre.z() - (pitch ? lever : 0))};
      for (int i = -8; i <= 8; ++i) {
        const double t = i * tick_s;
        const figure::Rotation turn = figure::turn(0.5 * spin_up * t * t, axis);
        Pose<float> pose;
        for (std::size_t s = 0; s < segment_count; ++s) {
          pose.position_m[s] = figure::row(centre + turn * (place[s] - centre));
          pose.rotation[s] = {static_cast<float>(turn.x()), static_cast<float>(turn.y()), static_cast<float>(turn.z()),
                              static_cast<float>(turn.w())};
        }
        meter.add(pose, ground, tick_s);
      }
      const UnbalancedMoment lacking = meter.result();
      const double expected = (1 - borne) * inertia * spin_up / mass;
      EXPECT_NEAR(pitch ? lacking.pitch_rms : lacking.roll_rms, expected, 2e-3);
      EXPECT_NEAR(pitch ? lacking.roll_rms : lacking.pitch_rms, 0, 2e-3);
    }
  }
}

/// Difference of the ground's moment from the motion's, N m/kg: rms in pitch and in roll, for a man of 1.75 m. Those of
/// taller people are in proportion.
TEST(Balance, WalksTurnStopLimpAndStepAsideWithinTheirSoles) {
  const struct {
    std::string_view scene;
    double pitch, roll;
  } bounds[] = {{"straight", 0.015, 0.01},         {"faster and slower", 0.05, 0.03},
                {"turning", 0.092, 0.05},          {"starting and stopping", 0.05, 0.06},
                {"limping", 0.03, 0.03},           {"stepping aside", 0.09, 0.08},
                {"turning on the spot", 0.2, 0.15}};
  GaitStyle forward;
  forward.forward_swing = 1;
  struct Person {
    BodyRequest body;
    GaitStyle style;
    double times = 1;  // of the bounds
  };
  const auto usual = [](const BodyRequest& body) { return Person{body, usual_style(body)}; };
  const Person people[] = {{{.height_m = 1.75F, .mass_kg = 75}, {}},
                           {{.height_m = 1.55F, .mass_kg = 48}, {}},
                           {{.height_m = 1.95F, .mass_kg = 95}, {}},
                           {{.height_m = 1.75F, .mass_kg = 75}, forward},
                           usual({.height_m = 1.75F, .mass_kg = 115}),
                           usual({.height_m = 1.70F, .mass_kg = 70, .age_y = 85}),
                           usual(typical_body(Sex::woman, 25)),
                           usual(typical_body(Sex::woman, 8)),
                           usual(typical_body(Sex::man, 6)),
                           usual(typical_body(Sex::man, 12)),
                           usual(typical_body(Sex::man, 72)),
                           usual(typical_body(Sex::man, 95)),
                           {typical_body(Sex::woman, 85), usual_style(typical_body(Sex::woman, 85)), 1.12}};
  for (const auto& [body, style, times] : people) {
    const auto scenes = walk_balance_scenes(body, style);
    ASSERT_EQ(scenes.size(), std::size(bounds));
    const double most = times * std::max(1.0, static_cast<double>(body.height_m) / 1.75);
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      const BalancedScene& walked = scenes[i];
      EXPECT_EQ(walked.name, bounds[i].scene);
      EXPECT_LT(walked.moment.pitch_rms, most * bounds[i].pitch)
          << walked.name << ", " << body.height_m << " m, " << body.age_y;
      EXPECT_LT(walked.moment.roll_rms, most * bounds[i].roll) << walked.name << ", " << body.height_m << " m";
      EXPECT_LT(walked.moment.yaw_rms, most * 0.03) << walked.name << ", " << body.height_m << " m";
    }
  }
}

/// Checks children against Pinzone et al. 2014 at their speed.
TEST(Compare, ChildrenWalkLikePinzones) {
  using enum GaitQuantity;
  constexpr std::pair<GaitQuantity, double> least[] = {{hip, 0.95},        {knee, 0.95},        {ankle, 0.95},
                                                       {hip_moment, 0.95}, {knee_moment, 0.90}, {ankle_moment, 0.95}};
  for (const float age_y : {6.0F, 8.0F, 10.5F, 13.0F}) {
    const GaitReference reference = *read_gait_reference({}, static_cast<double>(age_y));
    ASSERT_EQ(reference.sets[1].name, "Pinzone 2014");
    for (const Sex sex : {Sex::man, Sex::woman}) {
      const BodyRequest child = typical_body(sex, age_y);
      const double speed = reference.sets[1].speed_m_s(compared_class::free, make_body(child)->hip_height_m);
      GaitRequest gait;
      gait.speed_m_s = static_cast<float>(speed);
      gait.style = usual_style(child);
      const ComparedWalk walk{1, compared_class::free, speed, walk_stride(child, gait)};
      for (const auto& [quantity, bound] : least)
        EXPECT_GE(examine(walk, reference, quantity)->correlation[1], bound) << age_y << ' ' << index(quantity);
    }
  }
  EXPECT_EQ(built_in().sets.size(), 1U) << "adults are not compared with children's own tables";
}

TEST(Reference, FolderIsReadCompletelyOrRefused) {
  const TemporaryFolder folder;
  const auto complaint = [&] { return read_gait_reference(folder.path).error().message; };
  EXPECT_NE(complaint().find("holds none of the tables"), std::string::npos);
  EXPECT_NE(read_gait_reference(folder.path / "absent").error().message.find("no such folder"), std::string::npos);
  const fs::path built = fs::path(MOBIL_SOURCE_DIR) / "assets/reference/schwartz2008_grf.csv";
  std::string text = read_bytes(built);
  std::ofstream(folder.path / "schwartz2008_grf.csv") << text;
  const auto replaced = read_gait_reference(folder.path);
  ASSERT_TRUE(replaced) << replaced.error().message;
  EXPECT_EQ(replaced->sets.size(), 1U);
  EXPECT_FALSE(replaced->note.empty());
  text.replace(text.find("0.012"), 5, "soft!");
  std::ofstream(folder.path / "schwartz2008_grf.csv") << text;
  EXPECT_NE(complaint().find("schwartz2008_grf.csv:2: vertical_BW 'soft!' is not a number"), std::string::npos);
  std::ofstream(folder.path / "schwartz2008_grf.csv") << text.substr(0, text.find("slow,8,"));
  EXPECT_NE(complaint().find("needs the 51 rows"), std::string::npos);
}

TEST(Reference, SecondSetInTheSameFormatJoinsTheBands) {
  const TemporaryFolder folder;
  const auto first = built_in();
  const auto write = [&](const char* file, const std::string& header, std::initializer_list<GaitQuantity> quantities) {
    std::ofstream out(folder.path / file);
    out << "cadence_class,percent_gait" << header << '\n';
    const char* names[] = {"slow", "natural", "fast"};
    for (std::size_t c = compared_class::slow; c <= compared_class::fast; ++c) {
      for (std::size_t i = 0; i < cycle_points; ++i) {
        out << names[c - compared_class::slow] << ',' << 2 * i;
        for (const auto q : quantities) out << ',' << first.sets[0].curve[c][index(q)].mean[i] << ",1";
        out << '\n';
      }
    }
  };
  using enum GaitQuantity;
  write("winter_joint_angles.csv", ",hip_flexion_deg,hip_sd,knee_flexion_deg,knee_sd,ankle_dorsiflexion_deg,ankle_sd",
        {hip, knee, ankle});
  write("winter_grf.csv", ",vertical_BW,vertical_sd,foreaft_BW,foreaft_sd", {vertical, fore_aft});
  EXPECT_FALSE(read_gait_reference(folder.path)) << "speeds and moments are missing";
  write("winter_joint_moments.csv",
        ",hip_extensor_Nm_kg,hip_sd,knee_extensor_Nm_kg,knee_sd,ankle_plantarflexor_Nm_kg,ankle_sd",
        {hip_moment, knee_moment, ankle_moment});
  std::ofstream(folder.path / "com_vertical_excursion_computed.csv")
      << "source,speed_m_s\nwinter_slow,1\nwinter_natural,1.3\nwinter_fast,1.7\n";
  const auto both = read_gait_reference(folder.path);
  ASSERT_TRUE(both) << both.error().message;
  ASSERT_EQ(both->sets.size(), 2U);
  EXPECT_TRUE(both->note.empty());
  EXPECT_TRUE(both->sets[1].hip_from_vertical);
  EXPECT_NEAR(both->sets[1].speed_m_s(compared_class::free, both->sets[1].leg_m), 1.3, 1e-12);
  EXPECT_FALSE(both->sets[1].has_class(compared_class::very_slow) ||
               both->sets[1].has_class(compared_class::very_fast));
  EXPECT_NEAR(both->sets[1].curve[compared_class::fast][index(knee)].mean[20],
              first.sets[0].curve[compared_class::fast][index(knee)].mean[20], 1e-4);
}

std::size_t count(const std::string& text, std::string_view what) {
  std::size_t n = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

TEST(Plot, UndrawableValuesOnlyBreakTheLine) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  PlotPanel panel{"<&>", {"cost \"µs\"", {}, {}, true}, {"error", {}, {}, true}, {}, {}, {}, false};
  panel.lines.push_back({{1, 10, 100, 1000, 1e4}, {1, 0.1, nan, 0.01, 0.02}, "#000", "ours", 1, false});
  panel.bands.push_back({{1, 10, 100}, {0.5, -1, 0.2}, {2, 2, infinite}, "#00f", "band", 0.2});
  panel.points.push_back({{1, 0, 10}, {1, 1, -1}, {"a<b", "no", "no"}, "#f00", "points"});
  const std::string text = svg({.title = "title", .panels = {panel}});
  EXPECT_EQ(text.find("nan"), std::string::npos);
  EXPECT_EQ(text.find("inf"), std::string::npos);
  EXPECT_EQ(count(text, "<circle"), 2U) << "one point and its legend";
  EXPECT_NE(text.find("a&lt;b"), std::string::npos);
  EXPECT_NE(text.find("&lt;&amp;&gt;"), std::string::npos);
  const auto path = text.substr(text.find("fill=\"none\"") - 60, 60);
  EXPECT_EQ(count(path, "M"), 2U) << path;
}

TEST(Plot, EveryPanelIsDrawnAndEmptyFiguresAreValid) {
  for (const std::size_t panels : {std::size_t{0}, std::size_t{1}, std::size_t{5}}) {
    PlotFigure figure{"title", "note", 2, 240, 150, true, std::vector<PlotPanel>(panels)};
    const std::string text = svg(figure);
    EXPECT_EQ(count(text, "<clipPath"), panels);
    EXPECT_EQ(count(text, "<g"), count(text, "</g>"));
    EXPECT_EQ(count(text, "<svg"), 1U);
    EXPECT_EQ(count(text, "</svg>"), 1U);
    EXPECT_EQ(text.find("nan"), std::string::npos);
  }
}

TEST(Command, WritesNumbersAndPlotsAndReportsFailures) {
  const TemporaryFolder folder;
  const Ran ran = run_mobil("compare --height 1.80 --mass 70 --out out", folder.path);
  ASSERT_EQ(ran.status, 0) << ran.err;
  const Json json = Json::parse(read_bytes(folder.path / "out/compare.json"));
  ASSERT_EQ(json.at("walks").size(), 5U);
  for (const auto& walk : json.at("walks")) {
    const auto& knee = walk.at("quantities").at("knee");
    EXPECT_EQ(knee.at("ours").size(), cycle_points);
    EXPECT_GT(knee.at("correlation").at("Schwartz").get<double>(), 0.8) << "it is a knee that walks";
    EXPECT_LE(knee.at("rms_nearer_point").get<double>(), knee.at("rms_nearer_set").get<double>() + 1e-9);
  }
  const auto open = json.at("not_held").get<int>() + json.at("not_simulated").get<int>();
  EXPECT_EQ(json.at("held").get<int>() + open, static_cast<int>(json.at("bounds").size()));
  EXPECT_NE(ran.out.find("of " + std::to_string(json.at("bounds").size()) + " bounds hold"), std::string::npos);
  for (const char* plot : {"angles", "ground_reaction", "moments", "steps", "centre_of_mass", "muscle_forces"}) {
    const std::string text = read_bytes(folder.path / "out" / (std::string(plot) + ".svg"));
    EXPECT_EQ(text.substr(0, 4), "<svg") << plot;
    EXPECT_EQ(text.find("nan"), std::string::npos) << plot;
  }
  EXPECT_EQ(run_mobil("compare --height 1.80 --mass 70 --check --out again", folder.path).status, open > 0 ? 1 : 0);
  EXPECT_EQ(read_bytes(folder.path / "again/compare.json"), read_bytes(folder.path / "out/compare.json"));
}

TEST(Command, RefusesInOneLineAndLeavesNothing) {
  for (const char* arguments : {"--height 3", "--reference absent", "--set no_such=1", "--mass heavy"}) {
    const TemporaryFolder folder;
    const Ran ran = run_mobil(std::string("compare ") + arguments, folder.path);
    EXPECT_EQ(ran.status, 2) << arguments;
    EXPECT_EQ(std::ranges::count(ran.err, '\n'), 1) << ran.err;
    EXPECT_TRUE(fs::is_empty(folder.path)) << arguments;
  }
}

}  // namespace mobil::compare_test
