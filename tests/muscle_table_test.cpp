// The muscles' figures against what was published, and what a plan makes of them for any body.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "assets/anthropometry.h"
#include "assets/hexahedral_mesh.h"
#include "assets/leg_sections.h"
#include "assets/muscle_plan.h"
#include "assets/muscle_table.h"
#include "tests/leg_pose.h"
#include "tests/people.h"

namespace mobil {
namespace {

using namespace geometry;
using test::degree;
using test::LegAngles;
using test::posed;

constexpr std::array groups = {Muscle::hamstrings, Muscle::quadriceps, Muscle::triceps_surae,
                               Muscle::tibialis_anterior};

Body body_of(float height_m, float mass_kg, Constitution constitution = Constitution::average, float meso = 4) {
  return make_body({height_m, mass_kg, {3, meso, 3}, constitution}).value();
}
const Body reference = body_of(1.80F, 80);

MusclePlan plan_of(const Body& body, Muscle group) {
  return make_muscle_plan(body, group).value();
}

double normalised_length(const MemberMuscle& muscle, const LegAngles& angles) {
  const LegScale<double> scale = leg_scale(reference);
  return member_length(muscle, scale, posed(reference, angles)) / member_length(muscle, scale, posed(reference, {}));
}

struct Fit {
  std::vector<double> ours, published;

  void add(double our, double theirs) {
    ours.push_back(our);
    published.push_back(theirs);
  }
  double rms() const {
    double sum = 0;
    for (std::size_t i = 0; i < ours.size(); ++i) sum += (ours[i] - published[i]) * (ours[i] - published[i]);
    return std::sqrt(sum / static_cast<double>(ours.size()));
  }
  double correlation() const {
    const auto n = static_cast<double>(ours.size());
    double x = 0, y = 0, xx = 0, yy = 0, xy = 0;
    for (std::size_t i = 0; i < ours.size(); ++i) x += ours[i] / n, y += published[i] / n;
    for (std::size_t i = 0; i < ours.size(); ++i) {
      const double a = ours[i] - x, b = published[i] - y;
      xx += a * a, yy += b * b, xy += a * b;
    }
    return xy / std::sqrt(xx * yy);
  }
};

TEST(MuscleTable, EveryMemberRunsFromAFixedOriginToAFixedEnd) {
  std::set<std::string_view> names;
  std::size_t in_groups = 0;
  for (const auto group : groups) in_groups += members_of(group).size();
  EXPECT_EQ(in_groups, member_muscle_count);
  for (const auto& m : member_muscles()) {
    names.insert(m.name);
    EXPECT_EQ(find_member_muscle(m.name), &m);
    EXPECT_GE(m.path.size() + (m.kneecap != nullptr ? 1 : 0), 2U) << m.name;
    EXPECT_LE(m.path.front().from_deg, -180) << m.name;
    EXPECT_GE(m.path.front().to_deg, 180) << m.name;
    EXPECT_TRUE(m.kneecap != nullptr || m.path.back().to_deg >= 180) << m.name;
    for (std::size_t i = 1; i < m.path.size(); ++i) EXPECT_GE(m.path[i].bone, m.path[i - 1].bone) << m.name;
    for (std::size_t i = 1; i < m.sections.size(); ++i) EXPECT_GT(m.sections[i].level, m.sections[i - 1].level);
  }
  EXPECT_EQ(names.size(), member_muscle_count);
  EXPECT_EQ(find_member_muscle("sartorius"), nullptr);
}

// Lengths in the anatomical position of the published model (gait2392, CC BY 3.0, Delp et al. 1990), m.
TEST(MuscleTable, PathsAreAsLongAsPublished) {
  const std::map<std::string_view, double> published = {{"semimembranosus", 0.41457},
                                                        {"semitendinosus", 0.46323},
                                                        {"biceps_femoris_long_head", 0.4202},
                                                        {"biceps_femoris_short_head", 0.24625},
                                                        {"rectus_femoris", 0.41032},
                                                        {"vastus_medialis", 0.17226},
                                                        {"vastus_intermedius", 0.18205},
                                                        {"vastus_lateralis", 0.20018},
                                                        {"gastrocnemius_medial", 0.45071},
                                                        {"gastrocnemius_lateral", 0.44706},
                                                        {"soleus", 0.2914}};
  const Quat<double> identity{0, 0, 0, 1};
  const LegFrames<double> leg{
      {0, 0, 0}, {0, -published_leg::thigh_m, 0}, {0, -published_leg::leg_m, 0}, identity, identity, identity,
      identity};
  for (const auto& m : member_muscles()) {
    EXPECT_NEAR(member_length(m, {1, 1, 1}, leg) / published.at(m.name), 1, 0.008) << m.name;
  }
}

// Lengths over those in the anatomical position, from the published model evaluated on its own rolling knee.
TEST(MuscleTable, LengthsFollowThePublishedModelAtChosenAngles) {
  const std::vector<LegAngles> hip_knee = {{-20, 0, 0}, {0, 40, 0}, {30, 0, 0}, {30, 60, 0}, {60, 30, 0}};
  const std::vector<LegAngles> knee_ankle = {{0, 0, -30},  {0, 0, 20},  {0, 30, 0},
                                             {0, 60, -10}, {0, 60, 20}, {0, 90, 0}};
  const std::map<std::string_view, std::vector<double>> published = {
      {"semimembranosus", {0.9644, 0.9376, 1.0693, 0.9725, 1.0933}},
      {"semitendinosus", {0.9646, 0.9345, 1.0739, 0.9713, 1.1037}},
      {"biceps_femoris_long_head", {0.9593, 0.9453, 1.0784, 0.996, 1.1163}},
      {"rectus_femoris", {1.0311, 1.0836, 0.9377, 1.0594, 0.9332}},
      {"biceps_femoris_short_head", {1, 1, 0.9408, 0.8699, 0.8699, 0.8077}},
      {"vastus_medialis", {1, 1, 1.1371, 1.2588, 1.2588, 1.3566}},
      {"vastus_intermedius", {1, 1, 1.1313, 1.2501, 1.2501, 1.3425}},
      {"vastus_lateralis", {1, 1, 1.1177, 1.2241, 1.2241, 1.306}},
      {"gastrocnemius_medial", {0.9454, 1.0338, 0.974, 0.9333, 0.9852, 0.9328}},
      {"gastrocnemius_lateral", {0.9436, 1.0346, 0.9737, 0.9327, 0.9858, 0.9338}},
      {"soleus", {0.9146, 1.0502, 1, 0.9721, 1.0502, 1}}};
  for (const auto& [name, values] : published) {
    const auto& at = values.size() == hip_knee.size() ? hip_knee : knee_ankle;
    Fit fit;
    for (std::size_t i = 0; i < at.size(); ++i) fit.add(normalised_length(*find_member_muscle(name), at[i]), values[i]);
    EXPECT_LT(fit.rms(), 0.02) << name;
    EXPECT_GT(fit.correlation(), 0.95) << name;
  }
}

std::optional<std::filesystem::path> reference_folder() {
  const char* named = std::getenv("MOBIL_REFERENCE");
  const std::filesystem::path folder =
      named != nullptr ? std::filesystem::path(named) : std::filesystem::path(MOBIL_SOURCE_DIR) / "../shared/reference";
  if (!std::filesystem::exists(folder)) return std::nullopt;
  return folder;
}

/// A CSV of numbers under a header: rows of column name → value.
std::vector<std::map<std::string, double>> numbers(const std::filesystem::path& file) {
  std::ifstream in(file);
  const auto cells = [](const std::string& line) {
    std::vector<std::string> found;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) found.push_back(cell);
    return found;
  };
  std::string line;
  std::getline(in, line);
  const auto names = cells(line);
  std::vector<std::map<std::string, double>> rows;
  while (std::getline(in, line)) {
    const auto values = cells(line);
    auto& row = rows.emplace_back();
    for (std::size_t i = 0; i < std::min(names.size(), values.size()); ++i) row[names[i]] = std::stod(values[i]);
  }
  return rows;
}

TEST(MuscleTable, LengthsFollowThePublishedModelOverItsWholeRange) {
  const auto folder = reference_folder();
  if (!folder) GTEST_SKIP() << "no reference data: set MOBIL_REFERENCE to their folder";
  const std::map<std::string, std::string> column = {{"semimembranosus", "semimem"},
                                                     {"semitendinosus", "semiten"},
                                                     {"biceps_femoris_long_head", "bifemlh"},
                                                     {"biceps_femoris_short_head", "bifemsh"},
                                                     {"rectus_femoris", "rect_fem"},
                                                     {"vastus_medialis", "vas_med"},
                                                     {"vastus_intermedius", "vas_int"},
                                                     {"vastus_lateralis", "vas_lat"},
                                                     {"gastrocnemius_medial", "med_gas"},
                                                     {"gastrocnemius_lateral", "lat_gas"},
                                                     {"soleus", "soleus"}};
  const auto hip_knee = numbers(*folder / "mt_length_map_hip_knee.csv");
  const auto knee_ankle = numbers(*folder / "mt_length_map_knee_ankle.csv");
  ASSERT_GT(hip_knee.size(), 50U);
  ASSERT_GT(knee_ankle.size(), 50U);
  const auto angle = [](const std::map<std::string, double>& row, const char* name) {
    const auto found = row.find(name);
    return found == row.end() ? 0.0 : found->second;
  };
  for (const auto& m : member_muscles()) {
    const std::string name = column.at(std::string(m.name)) + "_norm";
    Fit fit;
    for (const auto* map : {&hip_knee, &knee_ankle}) {
      for (const auto& row : *map) {
        if (!row.contains(name)) continue;
        fit.add(normalised_length(m, {angle(row, "hip_flexion_deg"), angle(row, "knee_flexion_deg"),
                                      angle(row, "ankle_dorsiflexion_deg")}),
                row.at(name));
      }
    }
    EXPECT_LT(fit.rms(), 0.02) << m.name;
    EXPECT_GT(fit.correlation(), 0.95) << m.name;
  }
  // Groups: the published lengths of their members, weighted as ours.
  const auto published = [&](const MemberMuscle& m, const LegAngles& at) {
    const std::string name = column.at(std::string(m.name)) + "_norm";
    for (const auto* map : {&hip_knee, &knee_ankle}) {
      if (!map->front().contains(name)) continue;
      for (const auto& row : *map) {
        if (row.at("knee_flexion_deg") != at.knee_deg) continue;
        if (map == &hip_knee ? row.at("hip_flexion_deg") == at.hip_deg
                             : row.at("ankle_dorsiflexion_deg") == at.ankle_deg) {
          return row.at(name);
        }
      }
    }
    ADD_FAILURE() << name << " has no row";
    return 0.0;
  };
  const LegScale<double> scale = leg_scale(reference);
  const LegFrames<double> rest = posed(reference, {});
  for (const auto group : groups) {
    Fit fit;
    for (const auto& row : group == Muscle::triceps_surae ? knee_ankle : hip_knee) {
      const LegAngles at{angle(row, "hip_flexion_deg"), row.at("knee_flexion_deg"),
                         angle(row, "ankle_dorsiflexion_deg")};
      double theirs = 0;
      for (const auto& m : members_of(group)) {
        theirs += member_weight(members_of(group), m) * member_length(m, scale, rest) * published(m, at);
      }
      const double rest_length = muscle_length(group, scale, rest);
      fit.add(muscle_length(group, scale, posed(reference, at)) / rest_length, theirs / rest_length);
    }
    EXPECT_LT(fit.rms(), 0.02) << muscle_name(group);
    EXPECT_GT(fit.correlation(), 0.95) << muscle_name(group);
  }
}

// Handsfield et al. 2014, tabulated by the regression for 80 kg and 1.80 m, cm³.
TEST(MuscleTable, VolumesAreThePublishedOnes) {
  const std::map<std::string_view, double> published = {{"semimembranosus", 275.1},
                                                        {"semitendinosus", 212.7},
                                                        {"biceps_femoris_long_head", 230.5},
                                                        {"biceps_femoris_short_head", 115.0},
                                                        {"rectus_femoris", 303.7},
                                                        {"vastus_medialis", 491.8},
                                                        {"vastus_intermedius", 296.3},
                                                        {"vastus_lateralis", 950.9},
                                                        {"gastrocnemius_medial", 289.7},
                                                        {"gastrocnemius_lateral", 168.5},
                                                        {"soleus", 486.5}};
  for (const auto& m : member_muscles()) {
    EXPECT_NEAR(handsfield_volume_cm3(m, 1.80, 80), published.at(m.name), 0.1) << m.name;
  }
  for (const auto group : groups) {
    double sum = 0, weights = 0;
    for (const auto& m : members_of(group)) sum += published.at(m.name), weights += member_weight(members_of(group), m);
    EXPECT_NEAR(1e6 * plan_of(reference, group).volume_m3 / sum, 1, 0.15) << muscle_name(group);
    EXPECT_NEAR(weights, 1, 1e-12);
  }
}

RC_GTEST_PROP(MusclePlan, VolumeGrowsWithHeightAndWithMass, ()) {
  const auto height = static_cast<float>(*rc::gen::inRange(1200, 2190)) / 1000;
  const float mass = living_mass(height + 0.01F, *rc::gen::inRange(0, 951) / 1000.0);
  for (const auto group : groups) {
    const double volume = plan_of(body_of(height, mass), group).volume_m3;
    RC_ASSERT(volume > 0);
    RC_ASSERT(plan_of(body_of(height + 0.01F, mass), group).volume_m3 > volume);
    RC_ASSERT(plan_of(body_of(height, mass + 1), group).volume_m3 > volume);
  }
}

TEST(MusclePlan, SectionGrowsWithPhysique) {
  for (const auto group : groups) {
    const auto section = [group](Constitution c, float meso) {
      return plan_of(body_of(1.8F, 80, c, meso), group).section_m2;
    };
    const double average = section(Constitution::average, 4);
    EXPECT_LT(section(Constitution::thin, 4), average);
    EXPECT_LT(average, section(Constitution::heavy, 4));
    EXPECT_LT(section(Constitution::heavy, 4), section(Constitution::athletic, 4));
    EXPECT_LT(section(Constitution::average, 3), average);
    EXPECT_LT(average, section(Constitution::average, 6));
  }
}

RC_GTEST_PROP(MusclePlan, ATallerBodyHasTheSameLegsLonger, ()) {
  const auto height = static_cast<float>(*rc::gen::inRange(1200, 2200)) / 1000;
  const float mass = living_mass(height, *rc::gen::inRange(0, 1001) / 1000.0);
  const double by = static_cast<double>(height) / 1.80;
  for (const auto group : groups) {
    const MusclePlan own = plan_of(body_of(height, mass), group), other = plan_of(reference, group);
    RC_ASSERT(std::abs(own.rest_length_m / (by * other.rest_length_m) - 1) < 1e-6);
    RC_ASSERT(std::abs(own.belly_length_m / (by * other.belly_length_m) - 1) < 1e-6);
    RC_ASSERT(std::abs(static_cast<double>(own.scale.along) / by - 1) < 1e-6);
    // The template scaled has the plan's size.
    const double s = static_cast<double>(own.scale.across);
    RC_ASSERT(std::abs(s * s * other.section_m2 / own.section_m2 - 1) < 1e-5);
  }
}

TEST(MusclePlan, BelliesLieWhereTheAnatomyHasThem) {
  const std::map<Muscle, std::pair<double, double>> span = {
      {Muscle::hamstrings, {0.26, 0.30}}, {Muscle::quadriceps, {0.28, 0.33}}, {Muscle::triceps_surae, {0.22, 0.28}}};
  const LegFrames<double> leg = anatomical_leg(reference);
  for (const auto group : groups) {
    const MusclePlan plan = plan_of(reference, group);
    EXPECT_GE(plan.belly_length_m, span.at(group).first);
    EXPECT_LE(plan.belly_length_m, span.at(group).second);
    EXPECT_NEAR(plan.belly_length_m, reference_belly_m(group), 1e-7);
    EXPECT_GT(plan.tendon_length_m, 0);
    EXPECT_EQ(plan.scale.across, 1);
    EXPECT_NEAR(plan.section_m2 * plan.belly_length_m, plan.volume_m3, 1e-12);
    const Vec z = rotated(plan.rotation, {0, 0, 1}), y = rotated(plan.rotation, {0, 1, 0});
    EXPECT_LT(z.y, -0.95);
    EXPECT_GT(y.z, 0.95);
    // Behind the thigh, in front of it, behind the shank; from the middle of the cage.
    const CageStation& middle = muscle_cage(group)[cage_station_count / 2];
    const Vec centre =
        plan.start_m + rotated(plan.rotation, {static_cast<double>(middle.offset_x_m),
                                               static_cast<double>(middle.offset_y_m), plan.belly_length_m / 2});
    const double upper = group == Muscle::triceps_surae ? leg.knee_m.y : leg.hip_m.y;
    const double lower = group == Muscle::triceps_surae ? leg.ankle_m.y : leg.knee_m.y;
    EXPECT_LT(centre.y, upper);
    EXPECT_GT(centre.y, lower);
    if (group == Muscle::quadriceps) {
      EXPECT_GT(centre.z, 0.01);
    } else {
      EXPECT_LT(centre.z, -0.01);
    }
    EXPECT_LT(centre.x, 0);  // the right leg
  }
}

TEST(MusclePlan, TheCageHoldsItsMembersWithATenthToSpare) {
  const LegFrame leg = leg_frame(reference);
  for (const auto group : groups) {
    const MusclePlan plan = plan_of(reference, group);
    const CageStations& cage = muscle_cage(group);
    std::size_t inside = 0;
    for (const auto& m : members_of(group)) {
      for (const auto& s : m.sections) {
        for (int corner = 0; corner < 4; ++corner) {
          const double angle = static_cast<double>(s.angle_deg) * degree + corner * std::numbers::pi / 2;
          const auto semi = static_cast<double>(corner % 2 == 0 ? s.semi_1 : s.semi_2);
          const Vec world =
              leg_point(leg, static_cast<double>(s.level), static_cast<double>(s.lateral) + semi * std::sin(angle),
                        static_cast<double>(s.anterior) + semi * std::cos(angle));
          const Vec p = rotated(conjugate(plan.rotation), world - plan.start_m);
          const double at = 8 * p.z / plan.belly_length_m;
          if (at < 0 || at > 8) continue;
          const auto i = std::min(static_cast<std::size_t>(at), cage_station_count - 2);
          const double w = at - static_cast<double>(i);
          const auto mix = [&](float CageStation::*f) {
            return (1 - w) * static_cast<double>(cage[i].*f) + w * static_cast<double>(cage[i + 1].*f);
          };
          const double reach = std::hypot((p.x - mix(&CageStation::offset_x_m)) / mix(&CageStation::semi_x_m),
                                          (p.y - mix(&CageStation::offset_y_m)) / mix(&CageStation::semi_y_m));
          EXPECT_LT(reach, 0.93) << m.name << " at level " << s.level;
          ++inside;
        }
      }
    }
    EXPECT_GT(inside, 60U);
  }
}

TEST(MusclePlan, TheCageIsSmoothAndItsElementsWellShaped) {
  for (const auto group : groups) {
    const CageStations& cage = muscle_cage(group);
    float widest_x = 0, widest_y = 0;
    for (const auto& s : cage) widest_x = std::max(widest_x, s.semi_x_m), widest_y = std::max(widest_y, s.semi_y_m);
    for (std::size_t i = 0; i < cage.size(); ++i) {
      EXPECT_FLOAT_EQ(cage[i].t, static_cast<float>(i) / 8);
      EXPECT_GE(cage[i].semi_x_m, 0.35F * widest_x);
      EXPECT_GE(cage[i].semi_y_m, 0.35F * widest_y);
      if (i == 0) continue;
      EXPECT_LT(std::abs(cage[i].semi_x_m - cage[i - 1].semi_x_m), 0.2F * widest_x);
      EXPECT_LT(std::abs(cage[i].semi_y_m - cage[i - 1].semi_y_m), 0.25F * widest_y);
      EXPECT_LT(std::abs(cage[i].offset_x_m - cage[i - 1].offset_x_m), 0.01F);
      EXPECT_LT(std::abs(cage[i].offset_y_m - cage[i - 1].offset_y_m), 0.01F);
    }
    for (const Cells cells : {Cells{2, 2, 8}, Cells{4, 4, 20}}) {
      const auto mesh = bend_block(cells, cage, reference_belly_m(group));
      ASSERT_TRUE(mesh) << mesh.error().message;
      EXPECT_GT(smallest_scaled_jacobian(*mesh), 0.3);
    }
  }
}

TEST(MusclePlan, StiffnessIsThePapersThirdEquation) {
  const Material material;
  EXPECT_DOUBLE_EQ(bar_stiffness(material, 0.003, 0.4), material.young_pa * 0.003 / 0.4);
}

TEST(MusclePlan, ABodyThatWasNeverMadeIsRefused) {
  const auto plan = make_muscle_plan(Body{}, Muscle::quadriceps);
  ASSERT_FALSE(plan);
  EXPECT_NE(plan.error().message.find("must be positive"), std::string::npos);
  EXPECT_FALSE(make_muscle_plan(reference, static_cast<Muscle>(99)));
}

}  // namespace
}  // namespace mobil
