// Lines of the hip, the foot and the two-joint muscles between, compared with published models: Rajagopal 2016, which
// bends paths around cylinders, and gait2392.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <mobil/assets/muscles/muscle_path.h>
#include "tests/lines/leg_pose.h"
#include "tests/lines/opensim_leg.h"
#include "tests/muscles/find_member.h"
#include "tests/terrain/hike.h"

namespace mobil::published_path_test {
namespace {

using namespace geometry;
using namespace test::opensim;
using test::arm, test::freedoms, test::toe, test::ankle, test::knee, test::subtalar, test::hip_flexion,
    test::hip_adduction, test::hip_rotation, test::Angles;
using test::degree;

/// The pelvis of Rajagopal's model is so much further forward than gait2392's, by the muscles' origins.
constexpr double rajagopal_pelvis_deg = 6.86;
/// Forward tilt of the measured pelvis of running people where the library's is level.
constexpr double measured_tilt_deg = 10;

/// Returns the angles of a right leg in a pose.
Angles angles_of(const Pose<float>& pose) {
  const auto turn = [&](Segment parent, Segment child) {
    return test::product(conjugate(to_double(pose.rotation[index(parent)])), to_double(pose.rotation[index(child)]));
  };
  const Quat<double> hip = turn(Segment::pelvis, Segment::thigh_right),
                     bent = turn(Segment::thigh_right, Segment::shank_right),
                     foot = turn(Segment::shank_right, Segment::foot_right),
                     toes_turn = turn(Segment::foot_right, Segment::toes_right);
  const Vec up = rotated(hip, {0, 1, 0});
  const Vec below = normalised(test::subtalar_axis), there = rotated(foot, below);
  Angles q{};
  q[hip_flexion] = std::atan2(-up.z, up.y);
  q[hip_adduction] = std::asin(-up.x);
  q[hip_rotation] = std::atan2(rotated(hip, {0, 0, 1}).x, rotated(hip, {1, 0, 0}).x);
  q[knee] = 2 * std::atan2(bent.x, bent.w);
  q[ankle] = std::atan2(there.y, there.z) - std::atan2(below.y, below.z);
  const Quat<double> rest = test::product(test::about({1, 0, 0}, q[ankle] / degree), foot);
  q[subtalar] = 2 * std::atan2(rest.x * below.x + rest.y * below.y + rest.z * below.z, rest.w);
  const Vec ahead = rotated(toes_turn, {0, 0, 1});
  q[toe] = std::atan2(ahead.y, ahead.z);
  return q;
}

std::vector<Angles> walking(float speed_m_s) {
  std::vector<Angles> poses;
  Simulation simulation;
  const Entity person = simulation.spawn({.height_m = 1.8F, .mass_kg = 80}, {.speed_m_s = speed_m_s}).value();
  for (int tick = 0; tick < 240; ++tick) {
    simulation.tick();
    if (tick >= 120) poses.push_back(angles_of(*simulation.get<Pose>(person)));
  }
  return poses;
}

std::vector<Angles> on_stairs(float rise_m) {
  std::vector<Angles> poses;
  Hike hike(stairs(rise_m, 0.3F, 20), {.speed_m_s = 0.5F, .step_length_m = 0.3F});
  for (int tick = 0; tick < 420; ++tick) {
    hike.tick();
    if (tick >= 240) poses.push_back(angles_of(hike.get<Pose>()));
  }
  return poses;
}

/// Returns mean angles of runners at 2.5 and 4.5 m/s, every 5 % of a stride of the right leg. Source: Fukuchi, Fukuchi
/// & Duarte, A public dataset of running biomechanics, PeerJ 5, 2017 (CC BY 4.0). The hip's rotation, which is measured
/// on skin, is halved.
std::vector<Angles> running() {
  // Hip flexion from the tilted pelvis, adduction and inward rotation; knee flexion; dorsiflexion. Degrees.
  constexpr double measured[][5] = {
      {32.2, 3.9, 6.9, 10.5, 2.3},     {31.3, 5.0, 8.3, 22.8, 6.5},    {31.6, 7.1, 6.8, 36.4, 17.0},
      {27.3, 6.5, 6.2, 40.2, 23.9},    {20.6, 4.4, 6.9, 37.1, 26.2},   {12.5, 3.2, 6.0, 29.2, 21.3},
      {4.6, 1.8, 2.8, 20.0, 8.7},      {-1.1, 1.0, -1.4, 13.8, -6.1},  {-3.3, 1.8, -2.9, 15.2, -15.7},
      {-2.2, 3.1, -1.2, 26.0, -18.5},  {1.0, 3.1, -1.1, 43.5, -16.2},  {5.3, 2.1, -3.9, 62.0, -13.5},
      {12.5, -0.9, -4.3, 77.9, -9.4},  {22.2, -2.4, -1.6, 88.1, -3.9}, {32.2, -2.0, 2.4, 89.2, -0.1},
      {39.7, -0.3, 4.4, 80.8, 2.2},    {43.2, 2.2, 6.4, 64.6, 3.2},    {42.2, 3.9, 9.3, 42.9, 3.6},
      {38.1, 4.1, 9.3, 21.1, 3.7},     {34.5, 4.0, 5.5, 8.5, 3.2},     {39.5, 6.3, 7.3, 12.7, 0.8},
      {37.4, 8.0, 7.7, 25.7, 4.5},     {37.0, 9.8, 5.6, 40.0, 17.3},   {27.8, 7.9, 6.0, 41.0, 25.3},
      {15.5, 3.9, 6.6, 34.2, 24.6},    {2.5, 1.6, 2.7, 22.7, 9.9},     {-7.7, 0.7, -3.9, 11.3, -13.3},
      {-11.0, 1.6, -7.7, 11.9, -25.7}, {-9.7, 3.8, -5.2, 26.8, -23.6}, {-7.0, 5.0, -3.5, 47.4, -22.3},
      {-3.2, 3.8, -7.4, 69.3, -22.0},  {4.1, 1.6, -10.8, 90.0, -17.9}, {17.9, -1.8, -8.7, 106.8, -12.1},
      {33.9, -2.9, -4.4, 114.2, -7.1}, {47.2, -1.5, 1.0, 109.6, -3.8}, {55.6, 2.8, 3.5, 95.4, -1.9},
      {59.5, 6.9, 7.4, 75.1, -0.4},    {58.9, 7.2, 12.9, 50.9, 2.3},   {52.6, 6.2, 10.3, 25.6, 3.2},
      {44.9, 5.6, 5.8, 10.9, 2.5}};
  std::vector<Angles> poses;
  for (const auto& [flexion, adduction, rotation, bent, dorsiflexion] : measured)
    poses.push_back({(flexion - measured_tilt_deg) * degree, adduction * degree, rotation / 2 * degree, bent * degree,
                     dorsiflexion * degree, 0, 0});
  return poses;
}

/// Returns poses within ranges of joints, which are wider than those of walking and running.
std::vector<Angles> anywhere() {
  std::mt19937 dice(7);
  const auto between = [&](double low, double high) {
    return degree * std::uniform_real_distribution<double>(low, high)(dice);
  };
  std::vector<Angles> poses;
  for (int i = 0; i < 600; ++i) {
    poses.push_back(
        {between(-25, 70), between(-15, 12), between(-15, 15), between(0, 120), between(-25, 25), between(-8, 8), 0});
  }
  return poses;
}

/// Returns the length in the model, of several strands the mean by volume.
double published_length(std::string_view line, Angles q) {
  double sum = 0, weights = 0;
  for (const Strand& strand : strands) {
    if (strand.line != line) continue;
    Angles own = q;
    if (strand.model == Model::rajagopal2016) own[hip_flexion] += rajagopal_pelvis_deg * degree;
    sum += strand.volume_cm3 * path_length(strand, Leg(strand.model, own));
    weights += strand.volume_cm3;
  }
  return sum / weights;
}
double mobil_length(const MemberMuscle& line, const Angles& q) {
  return member_length(line, {1, 1, 1}, test::turned_leg(q, published_leg::thigh_m, published_leg::shank_m));
}
/// Differences from the model, mm: root mean square of length, its maximum, and the largest root mean square of an arm.
/// A constant difference of length is subtracted before, because it only changes the tendon.
struct Misfit {
  double length = 0, worst_length = 0, worst_arm = 0;
};
Misfit misfit(const MemberMuscle& line, const std::vector<Angles>& poses, double constant_m) {
  Misfit of;
  std::array<double, freedoms> arms{};
  for (const Angles& q : poses) {
    const auto ours = [&](const Angles& at) { return mobil_length(line, at); };
    const auto theirs = [&](const Angles& at) { return published_length(line.name, at); };
    const double off = 1e3 * (ours(q) - theirs(q) - constant_m);
    of.length += off * off;
    of.worst_length = std::max(of.worst_length, std::abs(off));
    for (std::size_t f = 0; f < toe; ++f) arms[f] += std::pow(1e3 * (arm(ours, q, f) - arm(theirs, q, f)), 2);
  }
  const auto count = static_cast<double>(poses.size());
  of.length = std::sqrt(of.length / count);
  for (const double squares : arms) of.worst_arm = std::max(of.worst_arm, std::sqrt(squares / count));
  return of;
}

std::vector<std::string_view> lines_of_models() {
  std::vector<std::string_view> names;
  for (const Strand& strand : strands)
    if (names.empty() || names.back() != strand.line) names.push_back(strand.line);
  return names;
}

/// Returns the mean difference of the lengths.
double constant(const MemberMuscle& line, const std::vector<Angles>& poses) {
  double sum = 0;
  for (const Angles& q : poses) sum += mobil_length(line, q) - published_length(line.name, q);
  return sum / static_cast<double>(poses.size());
}

bool runs_to_the_toes(std::string_view line) {
  return line.ends_with("digitorum_longus") || line.ends_with("hallucis_longus");
}

/// The model's toes bend; the library's paths run to toes that are a part of the foot.
TEST(PublishedPaths, LengthsAndArmsOfWalkingRunningAndStairs) {
  const std::vector<std::pair<std::string, std::vector<Angles>>> kinds = {
      {"0.8 m/s", walking(0.8F)}, {"1.3 m/s", walking(1.3F)},     {"1.8 m/s", walking(1.8F)},
      {"running", running()},     {"upstairs", on_stairs(0.17F)}, {"downstairs", on_stairs(-0.17F)}};
  std::vector<Angles> all;
  for (const auto& [name, poses] : kinds) all.insert(all.end(), poses.begin(), poses.end());
  ASSERT_EQ(lines_of_models().size(), 23U);
  for (const std::string_view name : lines_of_models()) {
    const MemberMuscle& line = *find_member_muscle(name);
    const double apart_m = constant(line, all);
    for (const auto& [kind, poses] : kinds) {
      const Misfit of = misfit(line, poses, apart_m);
      EXPECT_LT(of.length, runs_to_the_toes(name) ? 2.3 : 0.3) << name << ", " << kind;
    }
    EXPECT_LT(misfit(line, all, apart_m).worst_arm, 2.2) << name;
  }
}

TEST(PublishedPaths, LengthsAndArmsOfRandomPoses) {
  const std::vector<Angles> poses = anywhere();
  for (const std::string_view name : lines_of_models()) {
    const MemberMuscle& line = *find_member_muscle(name);
    const Misfit of = misfit(line, poses, constant(line, poses));
    EXPECT_LT(of.length, name == "gluteus_maximus" ? 1 : 0.4) << name;
    EXPECT_LT(of.worst_length, name == "gluteus_maximus" ? 4 : 2) << name;
  }
}

}  // namespace
}  // namespace mobil::published_path_test
