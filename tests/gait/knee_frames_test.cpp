// Legs as their knees see them: those of the pose, in any part of a step, turning and straight.
#include "systems/kinematics/knee_frames.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "components/segments.h"
#include "tests/engine/row_lanes.h"
#include "tests/gait/walkers.h"

namespace mobil {
namespace {

using namespace geometry;

Quat<double> in_double(const Quat<float>& q) {
  const double x = double{q.x}, y = double{q.y}, z = double{q.z}, w = double{q.w};
  const double norm = std::sqrt(x * x + y * y + z * z + w * w);
  return {x / norm, y / norm, z / norm, w / norm};
}

/// The largest distance of what a knee sees from where the pose has it, m.
double apart(const Pose<float>& pose, std::size_t side, const KneeFrame<float>& knee) {
  const double mirror = side == Side::left ? -1 : 1;
  const auto turn = [&](Segment s) { return in_double(pose.rotation[index(on_side(s, side))]); };
  const Quat<double> thigh = turn(Segment::thigh_right);
  const Quat<double> back = {-thigh.x, -thigh.y, -thigh.z, thigh.w};
  const Vec knee_at = to_double(pose.position_m[index(on_side(Segment::shank_right, side))]);
  const auto seen = [&](const Vec& world) {
    const Vec at = rotated(back, world);
    return Vec{mirror * at.x, at.y, at.z};
  };
  double worst = 0;
  const auto compare = [&](const Vec& due, const Vec3<float>& is) {
    worst = std::max(worst, length(due - to_double(is)));
  };
  compare(seen(to_double(pose.position_m[index(on_side(Segment::thigh_right, side))]) - knee_at), knee.hip_m);
  compare(seen(to_double(pose.position_m[index(on_side(Segment::foot_right, side))]) - knee_at), knee.ankle_m);
  const Quat<double> pelvis = in_double(pose.rotation[index(Segment::pelvis)]), foot = turn(Segment::foot_right);
  const Vec axes[3] = {{mirror, 0, 0}, {0, 1, 0}, {0, 0, 1}};  // of the mirror image
  for (std::size_t a = 0; a < 3; ++a) {
    compare(seen(rotated(pelvis, axes[a])), knee.pelvis[a]);
    compare(seen(rotated(foot, axes[a])), knee.foot[a]);
  }
  const Vec down = seen(rotated(turn(Segment::shank_right), {0, -1, 0}));  // (0, −cos, −sin) of the flexion
  compare(down, {0, -knee.cosine, -knee.sine});
  worst = std::max(worst, std::fabs(std::atan2(-down.z, -down.y) - double{knee.flexion_rad}));
  return worst;
}

TEST(KneeFrames, AreThoseOfThePose) {
  double worst = 0, bent = 0;
  for (unsigned seed = 1; seed < 9; ++seed) {
    auto w = random_walkers(seed, 0.5);
    for (int step = 0; step < 6; ++step) {
      for (std::size_t l = 0; l < lane_count; ++l)
        if ((l + seed) % 3 == 0) w->gait.heading_rad[l] += 0.9F;
      for (const float part : {0.0F, 0.13F, 0.3F, 0.55F, 0.8F, 0.97F}) {
        w->place_at(part);
        KneeFrame<Lanes<float>> leg[2];
        LegPlanAhead nothing(nullptr);
        knee_frames(w->size, w->plan, w->state, leg, nothing);
        for (std::size_t l = 0; l < lane_count; ++l) {
          for (const Side side : {Side::right, Side::left}) {
            worst = std::max(worst, apart(row(w->pose, l), side, row(leg[side], l)));
            bent = std::max(bent, double{leg[side].flexion_rad[l]});
          }
        }
      }
      w->strike();
    }
  }
  EXPECT_LT(worst, 5e-6);  // the pose's own rounding: places of single precision some metres from the origin
  EXPECT_GT(bent, 0.8);
}

}  // namespace
}  // namespace mobil
