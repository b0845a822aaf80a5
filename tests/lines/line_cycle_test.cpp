// Muscle lengths over the walking cycle: computed paths on published joint angles, and in simulated walks.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <mobil/components/gait.h>
#include <mobil/components/pose.h>
#include <mobil/each.h>
#include <mobil/muscle_table.h>
#include <mobil/simulation.h>
#include "assets/body/column.h"
#include "tests/files/reference_data.h"
#include "tests/lines/leg_block.h"
#include "tests/muscles/find_member.h"
#include "tests/muscles/published_lengths.h"
#include "tests/simulation/people.h"

namespace mobil::line_cycle_test {
using test::Fit;
using test::LegAngles;
using test::posed;
using test::read_table;
using test::TableRow;

/// A curve's published name, and the muscles that it averages.
struct Curve {
  std::string name;
  std::vector<std::string_view> members;
};
const std::vector<Curve> group_curves = {
    {"hamstrings", {"semimembranosus", "semitendinosus", "biceps_femoris_long_head"}},
    {"rectus_femoris", {"rectus_femoris"}},
    {"gastrocnemius", {"gastrocnemius_medial", "gastrocnemius_lateral"}},
    {"soleus", {"soleus"}},
    {"tibialis_anterior", {"tibialis_anterior"}}};

/// Returns the mean of the members' lengths, each relative to that in the anatomical position.
double normalised_length(const Curve& curve, const LegAngles& angles) {
  static const Body body = make_body({1.80F, 80}).value();
  double sum = 0;
  for (const auto name : curve.members) {
    const MemberMuscle& m = *find_member_muscle(name);
    sum += member_length(m, leg_scale(body), posed(body, angles)) / member_length(m, leg_scale(body), posed(body, {}));
  }
  return sum / static_cast<double>(curve.members.size());
}

/// Returns a row's angles for a hip that is measured from a pelvis tilted by `tilt_deg`.
LegAngles angles_of(const TableRow& row, double tilt_deg) {
  return {row("hip_flexion_deg") - tilt_deg, row("knee_flexion_deg"), row("ankle_dorsiflexion_deg")};
}

/// Returns the rows of a table that belong to one walk.
std::vector<TableRow> rows_of(const std::vector<TableRow>& table, std::string_view column, std::string_view name) {
  std::vector<TableRow> rows;
  for (const TableRow& row : table) {
    if (column.empty() || row.cell.find(column)->second == name) rows.push_back(row);
  }
  return rows;
}

void expect_to_fit(const std::vector<Curve>& curves, const std::vector<TableRow>& lengths,
                   const std::vector<TableRow>& angles, const std::string& walk, std::string_view suffix,
                   double tilt_deg) {
  ASSERT_GE(lengths.size(), 51U) << walk;
  ASSERT_EQ(lengths.size(), angles.size()) << walk;
  for (const Curve& curve : curves) {
    Fit fit;
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      ASSERT_EQ(lengths[i]("percent_gait"), angles[i]("percent_gait"));
      fit.add(normalised_length(curve, angles_of(angles[i], tilt_deg)), lengths[i](curve.name + std::string(suffix)));
    }
    EXPECT_LT(fit.rms(), 0.005) << curve.name << " of " << walk;
    EXPECT_GT(fit.correlation(), 0.995) << curve.name << " of " << walk;
  }
}

TEST(LineCycle, LengthsOnPublishedAnglesMatch) {
  const auto lengths = read_table(test::reference_table("muscle_lengths.csv").value()),
             angles = read_table(test::reference_table("schwartz2008_angles.csv").value());
  for (const std::string speed : {"slow", "free", "fast"}) {
    expect_to_fit(group_curves, rows_of(lengths, "curve", "schwartz_" + speed), rows_of(angles, "speed_class", speed),
                  "schwartz_" + speed, "", neutral_tilt / test::degree);
  }
}

TEST(LineCycle, LengthsMatchOnEveryPublishedWalk) {
  const auto published = test::reference_table("mt_length_curves.csv");
  if (!published) GTEST_SKIP() << test::no_table;
  std::vector<Curve> curves;
  for (const auto& [ours, theirs] : test::published_name) curves.push_back({theirs, {ours}});
  const auto lengths = read_table(*published);
  struct Walk {
    std::string curve, file, column, name;
  };
  for (const Walk& walk : {Walk{"winter_slow", "winter_joint_angles.csv", "cadence_class", "slow"},
                           {"winter_natural", "winter_joint_angles.csv", "cadence_class", "natural"},
                           {"winter_fast", "winter_joint_angles.csv", "cadence_class", "fast"},
                           {"schwartz_slow", "schwartz2008_angles.csv", "speed_class", "slow"},
                           {"schwartz_free", "schwartz2008_angles.csv", "speed_class", "free"},
                           {"schwartz_fast", "schwartz2008_angles.csv", "speed_class", "fast"},
                           {"opensim_normal_gait", "opensim_normal_gait_angles.csv", "", ""},
                           {"subject01", "trial_subject01_walk.csv", "", ""}}) {
    expect_to_fit(curves, rows_of(lengths, "curve", walk.curve),
                  rows_of(read_table(test::reference_table(walk.file).value()), walk.column, walk.name), walk.curve,
                  "_norm", 0);
  }
}

/// One walker of a simulation, and its muscles' lengths at every 2 % of the right leg's cycle once the walk is steady,
/// in the order of group_curves.
struct Walker {
  BodyRequest body;
  std::string speed;
  Entity person{};
  int strides = -3;
  double phase = 0, total = 0;  // of the last tick
  std::array<double, 5> now{};
  std::vector<std::array<double, 5>> cycle{};

  bool done() const { return cycle.size() == 51; }

  void follow(const Simulation& simulation) {
    const double here = static_cast<double>(simulation.get<Feet>(person)->phase[Side::right]);
    if (here < phase - 0.5) ++strides;
    const double before = total;
    const std::array<double, 5> last = now;
    phase = here;
    total = strides + here;
    for (std::size_t c = 0; c < now.size(); ++c) {
      now[c] = 0;
      for (const auto name : group_curves[c].members) {
        const auto line = *simulation.get<LineOfAction>(simulation.muscle(person, *find_muscle(name), Side::right));
        now[c] += static_cast<double>(line.length_m / line.rest_length_m);
      }
      now[c] /= static_cast<double>(group_curves[c].members.size());
    }
    while (!done()) {
      const double wanted = 0.02 * static_cast<double>(cycle.size());
      if (total < wanted) return;
      auto& at = cycle.emplace_back();
      const double w = (wanted - before) / (total - before);
      for (std::size_t c = 0; c < at.size(); ++c) at[c] = last[c] + w * (now[c] - last[c]);
    }
  }
};

LegMuscles only(const std::vector<std::string_view>& names) {
  LegMuscles choice{.muscles = {}, .method = Method::statics, .cells = {2, 2, 2}};
  for (const auto name : names) choice.muscles.set(static_cast<std::size_t>(*find_muscle(name)));
  return choice;
}

// Compares adults of several sizes with children at equal speed over √(g·leg). The remaining errors are the ankle's
// (soleus, gastrocnemius, tibialis anterior) and, at the highest speed, the hip's (hamstrings, rectus femoris). With
// the measured angle of that one joint the lengths agree as well as the paths do.
TEST(LineCycle, SimulatedWalkLengthensMusclesAsMeasured) {
  const auto lengths = read_table(test::reference_table("muscle_lengths.csv").value());
  const std::map<std::string, double> speeds = {{"slow", 0.2902}, {"free", 0.4294}, {"fast", 0.5599}};
  std::vector<std::string_view> members;
  for (const Curve& curve : group_curves) members.insert(members.end(), curve.members.begin(), curve.members.end());
  Simulation simulation(sharing());
  std::vector<Walker> walkers;
  for (const BodyRequest& request : {BodyRequest{1.55F, 50}, BodyRequest{1.80F, 80}, BodyRequest{1.95F, 95}}) {
    const Body body = make_body(request).value();
    const double leg_m = static_cast<double>(body.thigh_length_m + body.shank_length_m + 0.039F * request.height_m);
    for (const auto& [speed, dimensionless] : speeds) {
      const auto speed_m_s = static_cast<float>(dimensionless * std::sqrt(9.81 * leg_m));
      walkers.push_back({request, speed, simulation.spawn(request, {.speed_m_s = speed_m_s}).value()});
      ASSERT_TRUE(simulation.set_muscles(walkers.back().person, only(members)));
    }
  }
  while (simulation.time_s() < 20 && !std::ranges::all_of(walkers, &Walker::done)) {
    simulation.tick();
    for (Walker& walker : walkers) walker.follow(simulation);
  }
  for (const Walker& walker : walkers) {
    ASSERT_TRUE(walker.done());
    const auto curve = rows_of(lengths, "curve", "schwartz_" + walker.speed);
    for (std::size_t c = 0; c < group_curves.size(); ++c) {
      const std::string& name = group_curves[c].name;
      Fit fit;
      int inside = 0;
      for (std::size_t i = 0; i < walker.cycle.size(); ++i) {
        fit.add(walker.cycle[i][c], curve[i](name));
        if (std::abs(fit.ours.back() - fit.published.back()) <= curve[i](name + "_sd")) ++inside;
      }
      const std::string whose = name + ' ' + walker.speed + ' ' + std::to_string(walker.body.height_m);
      EXPECT_LT(fit.rms(), 0.016) << whose;
      EXPECT_GT(fit.correlation(), 0.85) << whose;
      EXPECT_GE(inside, 36) << whose;  // of 51 samples
    }
  }
}

}  // namespace mobil::line_cycle_test
