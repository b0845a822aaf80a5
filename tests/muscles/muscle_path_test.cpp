// Muscle paths compared with published lengths and bone contacts; paths have no jumps.
#include <mobil/assets/muscles/muscle_path.h>

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include <mobil/assets/muscles/leg_sections.h>
#include <mobil/muscle_table.h>
#include "tests/files/reference_data.h"
#include "tests/lines/leg_block.h"
#include "tests/muscles/find_member.h"
#include "tests/muscles/published_lengths.h"

namespace mobil::muscle_path_test {
using namespace geometry;
using test::degree;
using test::every_muscle;
using test::Fit;
using test::LegAngles;
using test::posed;
using test::Random;

const Body reference = make_body({1.80F, 80}).value();

double normalised_length(const MemberMuscle& muscle, const LegAngles& angles) {
  const LegScale<double> scale = leg_scale(reference);
  return member_length(muscle, scale, posed(reference, angles)) / member_length(muscle, scale, posed(reference, {}));
}

// Lengths of the published model in the anatomical position (gait2392, CC BY 3.0, Delp et al. 1990), m.
TEST(MusclePath, PathsAreAsLongAsPublished) {
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
                                                        {"soleus", 0.2914},
                                                        {"tibialis_anterior", 0.30379}};
  const Quat<double> identity{0, 0, 0, 1};
  const LegFrames<double> leg{
      {0, 0, 0}, {0, -published_leg::thigh_m, 0}, {0, -published_leg::leg_m, 0}, identity, identity, identity,
      identity};
  for (const auto& m : member_muscles()) {
    if (!published.contains(m.name)) continue;
    EXPECT_NEAR(member_length(m, {1, 1, 1}, leg) / published.at(m.name), 1, 0.008) << m.name;
  }
}

// Lengths relative to those in the anatomical position, from the published model evaluated on its own rolling knee.
TEST(MusclePath, LengthsFollowThePublishedModelAtChosenAngles) {
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
      {"soleus", {0.9146, 1.0502, 1, 0.9721, 1.0502, 1}},
      {"tibialis_anterior", {1.0665, 0.9505, 1, 1.0236, 0.9505, 1}}};
  for (const auto& [name, values] : published) {
    const auto& at = values.size() == hip_knee.size() ? hip_knee : knee_ankle;
    Fit fit;
    for (std::size_t i = 0; i < at.size(); ++i) fit.add(normalised_length(*find_member_muscle(name), at[i]), values[i]);
    EXPECT_LT(fit.rms(), 0.02) << name;
    EXPECT_GT(fit.correlation(), 0.95) << name;
  }
}

TEST(MusclePath, LengthsFollowThePublishedModelOverItsWholeRange) {
  const auto of_thigh = test::reference_table("mt_length_map_hip_knee.csv"),
             of_shank = test::reference_table("mt_length_map_knee_ankle.csv");
  if (!of_thigh || !of_shank) GTEST_SKIP() << test::no_table;
  const auto hip_knee = test::read_table(*of_thigh);
  const auto knee_ankle = test::read_table(*of_shank);
  ASSERT_GT(hip_knee.size(), 50U);
  ASSERT_GT(knee_ankle.size(), 50U);
  const auto angles = [](const test::TableRow& row) {
    return LegAngles{row("hip_flexion_deg"), row("knee_flexion_deg"), row("ankle_dorsiflexion_deg")};
  };
  const LegScale<double> scale = leg_scale(reference);
  const LegFrames<double> rest = posed(reference, {});
  for (const auto& [name, theirs] : test::published_name) {
    Fit fit;
    for (const auto* map : {&hip_knee, &knee_ankle}) {
      for (const auto& row : *map) {
        if (!row.has(theirs + "_norm")) continue;
        fit.add(normalised_length(*find_member_muscle(name), angles(row)), row(theirs + "_norm"));
      }
    }
    EXPECT_LT(fit.rms(), 0.007) << name;
    EXPECT_GT(fit.correlation(), 0.997) << name;
  }
  // Groups: the published lengths of their members, weighted as in the library.
  const auto published = [&](const MemberMuscle& m, const LegAngles& at) {
    const std::string column = test::published_name.at(m.name) + "_norm";
    const bool of_hip = hip_knee.front().has(column);
    for (const auto& row : of_hip ? hip_knee : knee_ankle) {
      const LegAngles there = angles(row);
      if (there.knee_deg != at.knee_deg) continue;
      if (of_hip ? there.hip_deg == at.hip_deg : there.ankle_deg == at.ankle_deg) return row(column);
    }
    ADD_FAILURE() << column << " has no row";
    return 0.0;
  };
  for (std::size_t g = 0; g < usual_muscle_count; ++g) {
    const auto group = static_cast<Muscle>(g);
    const bool of_ankle = group == Muscle::triceps_surae || group == Muscle::tibialis_anterior;
    Fit fit;
    for (const auto& row : of_ankle ? knee_ankle : hip_knee) {
      double theirs = 0, weight = 0;
      for (const auto& m : members_of(group)) {
        if (!test::published_name.contains(m.name)) continue;  // plantaris
        const double own = member_weight(members_of(group), m);
        weight += own;
        theirs += own * member_length(m, scale, rest) * published(m, angles(row));
      }
      fit.add(muscle_length(group, scale, posed(reference, angles(row))), theirs / weight);
    }
    const double rest_length = muscle_length(group, scale, rest);
    EXPECT_LT(fit.rms() / rest_length, 0.007) << muscle_name(group);
    EXPECT_GT(fit.correlation(), 0.997) << muscle_name(group);
  }
}

/// Returns how deep a point is in a bone, mm of the body, measured towards the middle of its section; negative outside.
double depth_mm(const LegFrame& frame, std::span<const LegSection> bone, const Vec& at) {
  const double level = leg_level(frame, at.y);
  const auto e = leg_ellipse(bone, level);
  if (!e) return -1;
  const double lateral = -(at.x - frame.hip.x) / frame.unit - e->lateral;
  const double anterior = (at.z - frame.hip.z) / frame.unit - e->anterior;
  const double area = e->aa * e->ll - e->al * e->al;
  const double reach = std::hypot(e->ll * anterior - e->al * lateral, e->aa * lateral - e->al * anterior) / area;
  return std::hypot(lateral, anterior) * (1 / std::max(reach, 1e-3) - 1) * frame.unit * 1000;
}

// Published attachments are up to 12 mm inside the bone, so the check starts where the path has first left it. In knees
// flexed beyond 110°, where calf and thigh press on each other, both heads of gastrocnemius run through the rim of the
// tibia: wrapping them round it would make them knee extensors. At the ends of the hip's range, three straight lines
// run through the trochanter. At the ends of the ankle's range, the long extensor of the great toe runs through the
// tibia's edge.
TEST(MusclePath, NoPieceCutsDeepThroughABone) {
  constexpr double deepest_mm = 6, attached_m = 0.05;
  const LegFrame frame = leg_frame(reference);
  const LegFrames<double> standing = anatomical_leg(reference);
  const LegScale<double> scale = leg_scale(reference);
  std::size_t samples = 0;
  for (const auto& m : member_muscles()) {
    double worst = 0;
    for (double hip = -30; hip <= 120; hip += m.path.front().bone == LegBone::pelvis ? 30 : 200) {
      for (double knee = -5; knee <= 140; knee += 5) {
        for (double ankle = -45; ankle <= 30; ankle += 37.5) {
          const LegFrames<double> leg = posed(reference, {hip, knee, ankle});
          const LegFrames<double> there = rolled(scale, leg);
          const auto depth = [&](const Vec& at) {
            const Vec on_thigh = standing.hip_m + rotated(conjugate(leg.thigh), at - leg.hip_m);
            const Vec on_shank = standing.knee_m + rotated(conjugate(leg.shank), at - there.knee_m);
            return std::max({depth_mm(frame, femur_sections(), on_thigh), depth_mm(frame, tibia_sections(), on_shank),
                             depth_mm(frame, fibula_sections(), on_shank)});
          };
          const auto corners = member_path(m, scale, leg);
          std::vector<double> depths, way;
          double along = 0;
          for (std::size_t i = 1; i < corners.size(); ++i) {
            const Vec piece = corners[i].at - corners[i - 1].at;
            constexpr int parts = 24;
            for (int k = 0; k < parts; ++k) {
              depths.push_back(depth(corners[i - 1].at + (k / static_cast<double>(parts)) * piece));
              way.push_back(along + k * length(piece) / parts);
            }
            along += length(piece);
          }
          std::size_t first = 0, last = depths.size();
          while (first < last && depths[first] > 0 && way[first] < attached_m) ++first;
          while (last > first && depths[last - 1] > 0 && along - way[last - 1] < attached_m) --last;
          const bool squeezed = knee > 110 && m.name.starts_with("gastrocnemius");
          for (std::size_t i = first; i < last; ++i, ++samples) {
            worst = std::max(worst, squeezed ? depths[i] - 4 : depths[i]);
          }
        }
      }
    }
    const bool straight = m.name.starts_with("gluteus_medius") || m.name == "tensor_fasciae_latae";
    EXPECT_LT(worst, straight ? 13 : m.name == "extensor_hallucis_longus" ? 9 : deepest_mm) << m.name;
  }
  EXPECT_GT(samples, 100000U);
}

}  // namespace mobil::muscle_path_test
