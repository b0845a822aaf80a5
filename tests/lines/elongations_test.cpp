// Line lengths from knee frames, compared with the paths in double precision, for random legs in any pose.
#include "systems/lines/elongations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <mobil/rows.h>
#include "tests/lines/leg_block.h"

namespace mobil::test {
namespace {

using namespace geometry;

/// Returns a leg in the frame of its knee, computed in double precision.
KneeFrame<float> knee_frame(const LegFrames<double>& leg, double flexion_rad) {
  const Quat<double> back = {-leg.thigh.x, -leg.thigh.y, -leg.thigh.z, leg.thigh.w};
  const auto place = [&](const Vec& world) { return to_float(rotated(back, world - leg.knee_m)); };
  KneeFrame<float> knee{};
  knee.hip_m = place(leg.hip_m);
  knee.ankle_m = place(leg.ankle_m);
  const Vec axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (std::size_t a = 0; a < 3; ++a) {
    knee.pelvis[a] = to_float(rotated(back, rotated(leg.pelvis, axes[a])));
    knee.foot[a] = to_float(rotated(back, rotated(leg.foot, axes[a])));
  }
  knee.flexion_rad = static_cast<float>(flexion_rad);
  knee.sine = static_cast<float>(std::sin(flexion_rad));
  knee.cosine = static_cast<float>(std::cos(flexion_rad));
  return knee;
}

TEST(Elongations, MatchThePathsInAnyPose) {
  Random random;
  double worst = 0, most = 0, constant = 0;
  for (int round = 0; round < 40; ++round) {
    KneeFrame<Lanes<float>> knees;
    LegScale<Lanes<float>> scale;
    std::vector<LegFrames<double>> legs;
    std::vector<LegScale<double>> sizes;
    for (std::size_t l = 0; l < lane_count; ++l) {
      const Body body = random.body();
      const double flexion = random.between(0, 110);
      const Quat<double> pelvis = about({random.between(-1, 1), random.between(-1, 1), 1}, random.between(-60, 60));
      legs.push_back(posed(body, {random.between(-25, 70), flexion, random.between(-30, 25)}, pelvis,
                           {random.between(-1, 1), 1, random.between(-1, 1)}));
      sizes.push_back(leg_scale(body));
      put_row(knee_frame(legs.back(), flexion * degree), knees, l);
      put_row(LegScale<float>{static_cast<float>(sizes[l].thigh), static_cast<float>(sizes[l].shank),
                              static_cast<float>(sizes[l].across)},
              scale, l);
    }
    for (const Muscle muscle : every_muscle()) {
      Lanes<float> slack, out;
      for (std::size_t l = 0; l < lane_count; ++l)
        slack[l] = static_cast<float>(0.4 - constant_length_m(lines_of(muscle), row_of(scale, l)));
      const ElongatedLine line{&lines_of(muscle), &slack, &out};
      elongations({&line, 1}, scale, knees);
      for (std::size_t l = 0; l < lane_count; ++l) {
        const double length = muscle_length(muscle, sizes[l], legs[l]);
        worst = std::max(worst, std::fabs(double{out[l]} - (length - 0.4)));
        most = std::max(most, length);
        constant = std::max(constant, constant_length_m(lines_of(muscle), row_of(scale, l)));
      }
    }
  }
  EXPECT_LT(worst, 2e-6);
  EXPECT_GT(most, 0.4);
  EXPECT_GT(constant, 0.05);  // some paths are within one bone
}

}  // namespace
}  // namespace mobil::test
