// Random walkers, sixteen at a time: feet that stand still, legs that keep their length, motion without jumps.
#include "systems/kinematics/kinematics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <random>

#include "assets/anthropometry.h"
#include "systems/gait/gait.h"

namespace mobil {
namespace {

/// One row into one lane of a block: both are nothing but 4-byte words.
template <class Row, class Block>
void put(const Row& row, Block& block, std::size_t lane) {
  static_assert(sizeof(Block) == lane_count * sizeof(Row));
  for (std::size_t i = 0; i < sizeof(Row) / 4; ++i)
    std::memcpy(reinterpret_cast<char*>(&block) + 4 * (i * lane_count + lane),
                reinterpret_cast<const char*>(&row) + 4 * i, 4);
}

struct Walkers {
  std::array<Body, lane_count> body;
  std::array<StepPlan<float>, lane_count> row;
  BodySize<Lanes<float>> size;
  StepPlan<Lanes<float>> plan;
  GaitState<Lanes<float>> state;
  Pose<Lanes<float>> pose;
  JointAngles<Lanes<float>> angles;
  Feet<Lanes<float>> feet;
  CentreOfMass<Lanes<float>> centre;

  void place() {
    pose_skeleton(size, plan, state, pose, angles, feet);
    centre_of_mass(size, pose, centre);
  }
};

std::unique_ptr<Walkers> random_walkers(unsigned seed) {
  std::mt19937 engine(seed);
  auto dice = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(engine()) / 4294967296.0);
  };
  auto w = std::make_unique<Walkers>();
  for (std::size_t l = 0; l < lane_count; ++l) {
    const auto height = static_cast<float>(dice(1.2, 2.2));
    w->body[l] = *make_body({.height_m = height, .mass_kg = static_cast<float>(dice(30, 200))});
    GaitRequest request;
    request.speed_m_s = static_cast<float>(dice(0.35, 2.2)) * std::sqrt(height / 1.8F);
    const auto gait = resolve_gait(w->body[l], request);
    if (!gait) throw std::runtime_error(gait.error().message);
    const auto plan = plan_step(w->body[l], *gait);
    if (!plan) throw std::runtime_error(plan.error().message);
    w->row[l] = *plan;
    put(*plan, w->plan, l);
    put(BodySize<float>{height, w->body[l].request.mass_kg}, w->size, l);
    put(GaitState<float>{}, w->state, l);
  }
  w->place();
  return w;
}

Vec3<float> at(const Vec3<Lanes<float>>& v, std::size_t l) {
  return {v.x[l], v.y[l], v.z[l]};
}
float distance(const Vec3<float>& a, const Vec3<float>& b) {
  return std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y) + (a.z - b.z) * (a.z - b.z));
}

constexpr float tick = 1.0F / 120.0F;
constexpr int ticks = 480;

/// Runs blocks of random walkers through several steps; check(walkers, tick number) after each.
template <class Check>
void over_walks(Check check) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const auto w = random_walkers(seed);
    for (int t = 0; t < ticks; ++t) {
      check(*w, t);
      advance_gait(w->plan, w->state, tick);
      w->place();
    }
  }
}

TEST(Kinematics, StandingFeetStayWhereTheyArePlanted) {
  struct Planted {
    bool down = false;
    Vec3<float> place{};
  };
  std::array<std::array<std::array<Planted, 2>, 2>, lane_count> planted;
  double slid = 0, sunk = 0;
  over_walks([&](const Walkers& w, int t) {
    if (t == 0) planted = {};
    for (std::size_t l = 0; l < lane_count; ++l) {
      const StepPlan<float>& p = w.row[l];
      for (std::size_t side = 0; side < 2; ++side) {
        const float lag = w.feet.phase[side][l] * 2.0F * p.duration_s;
        for (std::size_t toe = 0; toe < 2; ++toe) {
          // The heel from its strike to foot flat, the ball from foot flat to toe-off.
          const bool down = toe == 0 ? lag <= p.flat_s : lag >= p.flat_s && lag < p.duration_s + p.double_support_s;
          const Vec3<float> now = at(toe == 0 ? w.feet.heel_m[side] : w.feet.toe_m[side], l);
          Planted& before = planted[l][side][toe];
          if (down) {
            sunk = std::fmax(sunk, std::fabs(static_cast<double>(now.y)));
            if (before.down)
              slid = std::fmax(slid, static_cast<double>(distance(now, before.place)));
            else
              before.place = now;
          }
          before.down = down;
        }
      }
    }
  });
  EXPECT_LT(slid, 1e-3);
  EXPECT_LT(sunk, 1e-3);
}

TEST(Kinematics, NoFootIsEverInTheGround) {
  double heel = 1, toe = 1, tip = 1;
  over_walks([&](const Walkers& w, int) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      for (std::size_t side = 0; side < 2; ++side) {
        heel = std::fmin(heel, static_cast<double>(w.feet.heel_m[side].y[l]));
        toe = std::fmin(toe, static_cast<double>(w.feet.toe_m[side].y[l]));
        // The toes' tip: along the third axis of their rotation, from under their joint.
        const std::size_t s = index(on_side(Segment::toes_right, side));
        const Quat<Lanes<float>>& q = w.pose.rotation[s];
        const float rise = 2.0F * (q.y[l] * q.z[l] - q.w[l] * q.x[l]);
        tip = std::fmin(tip, static_cast<double>(w.feet.toe_m[side].y[l] + rise * w.body[l].tip_m[s].z));
      }
    }
  });
  EXPECT_GT(heel, -0.003);
  EXPECT_GT(toe, -0.003);
  EXPECT_GT(tip, -0.004);
}

TEST(Kinematics, SwingingFeetClearTheGroundInMidSwing) {
  double clearance = 1;
  over_walks([&](const Walkers& w, int) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      const StepPlan<float>& p = w.row[l];
      const float off = 0.5F + 0.5F * p.double_support_s / p.duration_s;
      for (std::size_t side = 0; side < 2; ++side) {
        const float u = (w.feet.phase[side][l] - off) / (1.0F - off);
        if (u < 0.3F || u > 0.7F) continue;
        clearance = std::fmin(clearance, static_cast<double>(w.feet.heel_m[side].y[l]));
        clearance = std::fmin(clearance, static_cast<double>(w.feet.toe_m[side].y[l]));
      }
    }
  });
  EXPECT_GT(clearance, 0.004);
}

TEST(Kinematics, SegmentsKeepTheirLengthAndJointsTheirRange) {
  double stretched = 0, unit = 0;
  over_walks([&](const Walkers& w, int) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      for (std::size_t s = 0; s < segment_count; ++s) {
        const Quat<Lanes<float>>& q = w.pose.rotation[s];
        unit =
            std::fmax(unit, std::fabs(1.0 - (q.x[l] * q.x[l] + q.y[l] * q.y[l] + q.z[l] * q.z[l] + q.w[l] * q.w[l])));
        if (s == 0 || s == index(Segment::patella_right) || s == index(Segment::patella_left)) continue;
        const Vec3<float>& o = w.body[l].joint_offset_m[s];
        const double wanted = distance(o, {0, 0, 0});
        const double found = distance(at(w.pose.position_m[s], l), at(w.pose.position_m[index(segment_parent[s])], l));
        stretched = std::fmax(stretched, std::fabs(found - wanted));
      }
      for (std::size_t side = 0; side < 2; ++side) {
        ASSERT_GE(w.angles.knee_flexion[side][l], 0.0F);
        ASSERT_LT(w.angles.knee_flexion[side][l], 1.6F);
        ASSERT_LT(std::fabs(w.angles.hip_flexion[side][l]), 1.2F);
        ASSERT_LT(std::fabs(w.angles.ankle_dorsiflexion[side][l]), 0.9F);
      }
    }
  });
  EXPECT_LT(stretched, 1e-4);
  EXPECT_LT(unit, 1e-5);
}

TEST(Kinematics, NothingJumpsNotEvenWhereSidesChange) {
  // A segment moves no farther in a tick than a few times the walking speed carries it, and turns no faster than
  // 30 rad/s; a jump would show at any tick length, so the tick is short.
  constexpr float short_tick = 1.0F / 1000.0F;
  double farthest = 0, turned = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const auto w = random_walkers(seed);
    auto before = std::make_unique<Pose<Lanes<float>>>(w->pose);
    for (int t = 0; t < 1500; ++t) {
      advance_gait(w->plan, w->state, short_tick);
      w->place();
      for (std::size_t l = 0; l < lane_count; ++l) {
        const double pace = w->row[l].step_length_m / w->row[l].duration_s * short_tick;
        for (std::size_t s = 0; s < segment_count; ++s) {
          const double moved = distance(at(w->pose.position_m[s], l), at(before->position_m[s], l));
          ASSERT_TRUE(std::isfinite(moved));
          farthest = std::fmax(farthest, moved / (pace + 0.3 * short_tick));
          const Quat<Lanes<float>>&a = w->pose.rotation[s], &b = before->rotation[s];
          const double same = a.x[l] * b.x[l] + a.y[l] * b.y[l] + a.z[l] * b.z[l] + a.w[l] * b.w[l];
          turned = std::fmax(turned, 2.0 * std::sqrt(std::fmax(2.0 - 2.0 * same, 0.0)));
        }
      }
      *before = w->pose;
    }
  }
  EXPECT_LT(farthest, 5.5);
  EXPECT_LT(turned, 0.030);
}

TEST(Kinematics, LeftIsRightHalfACycleLater) {
  const auto now = random_walkers(21), later = random_walkers(21);
  for (int t = 0; t < 40; ++t) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      const float time = now->row[l].duration_s * (static_cast<float>(t) + 0.5F) / 40.0F;
      put(GaitState<float>{time, right, 0, 0, 0, 0}, now->state, l);
      put(GaitState<float>{time, left, 1, 0, 0, 0}, later->state, l);
    }
    now->place();
    later->place();
    for (std::size_t l = 0; l < lane_count; ++l) {
      for (std::size_t s = 0; s < segment_count; ++s) {
        std::size_t other = s;
        if (s >= index(Segment::thigh_right) && s < index(Segment::clavicle_right))
          other = s < index(Segment::thigh_left) ? s + 5 : s - 5;
        if (s >= index(Segment::clavicle_right)) other = s < index(Segment::clavicle_left) ? s + 6 : s - 6;
        const Vec3<float> a = at(now->pose.position_m[s], l), b = at(later->pose.position_m[other], l);
        EXPECT_LT(distance(a, {-b.x, b.y, b.z}), 2e-5F) << segment_name[s];
      }
      EXPECT_NEAR(now->angles.knee_flexion[right][l], later->angles.knee_flexion[left][l], 1e-5);
      EXPECT_NEAR(now->angles.pelvis_list[l], -later->angles.pelvis_list[l], 1e-6);
    }
  }
}

TEST(Kinematics, AWalkBeginsWithTheRightHeelAndAdvancesAtItsSpeedAlongItsHeading) {
  const auto w = random_walkers(3);
  for (std::size_t l = 0; l < lane_count; ++l) {
    EXPECT_EQ(w->feet.phase[right][l], 0.0F);
    EXPECT_NEAR(w->feet.phase[left][l], 0.5F, 1e-6);
    EXPECT_NEAR(w->feet.heel_m[right].y[l], 0.0F, 1e-5);
    EXPECT_GT(w->feet.toe_m[right].y[l], 0.005F);
    EXPECT_LT(w->feet.heel_m[right].x[l], 0.0F);  // +X is left
    EXPECT_GT(w->feet.heel_m[right].z[l], w->feet.heel_m[left].z[l]);
    w->state.heading_rad[l] = 0.1F * static_cast<float>(l);
  }
  w->place();
  const CentreOfMass<Lanes<float>> start = w->centre;
  std::array<float, lane_count> time{};
  for (int t = 0; t < 600; ++t) advance_gait(w->plan, w->state, tick);
  for (std::size_t l = 0; l < lane_count; ++l) {
    time[l] = static_cast<float>(w->state.steps[l]) * w->row[l].duration_s;
    EXPECT_NEAR(time[l] + w->state.time_s[l], 600 * tick, 1e-3);
    w->state.time_s[l] = 0;
    w->state.stance_side[l] = right;
  }
  w->place();
  for (std::size_t l = 0; l < lane_count; ++l) {
    const float far = static_cast<float>(w->state.steps[l]) * w->row[l].step_length_m;
    const float heading = 0.1F * static_cast<float>(l);
    EXPECT_NEAR(w->centre.position_m.x[l] - start.position_m.x[l], far * std::sin(heading), 1e-3);
    EXPECT_NEAR(w->centre.position_m.z[l] - start.position_m.z[l], far * std::cos(heading), 1e-3);
    EXPECT_NEAR(w->centre.position_m.y[l], start.position_m.y[l], 1e-4);
  }
}

TEST(Kinematics, TheHeadFacesForwardWhileTheShouldersTurnAgainstThePelvis) {
  over_walks([](const Walkers& w, int) {
    const Quat<Lanes<float>>&head = w.pose.rotation[index(Segment::head)], &chest = w.pose.rotation[index(Segment::T1)];
    for (std::size_t l = 0; l < lane_count; ++l) {
      ASSERT_LT(std::fabs(head.y[l]), 1e-6F);
      const float turn = w.angles.pelvis_rotation[l];
      ASSERT_LE(chest.y[l] * turn, std::fabs(turn) > 1e-3F ? -1e-9F : 1e-9F);
    }
  });
}

TEST(Kinematics, ANaturalWalkLooksLikeAPersons) {
  // Ranges of Winter's natural cadence and Schwartz's free speed with two standard deviations' room.
  const auto w = random_walkers(1);
  const Body body = *make_body({.height_m = 1.8F, .mass_kg = 80.0F});
  const StepPlan<float> plan = *plan_step(body, *resolve_gait(body, {}));
  for (std::size_t l = 0; l < lane_count; ++l) {
    put(plan, w->plan, l);
    put(BodySize<float>{1.8F, 80.0F}, w->size, l);
    GaitState<float> s{};
    put(s, w->state, l);
  }
  float hip_low = 9, hip_high = -9, knee_load = 0, knee_mid = 9, knee_swing = 0, ankle_low = 9, ankle_high = -9;
  float high = 0, low = 9, aside_low = 9, aside_high = -9;
  for (int i = 0; i < 200; ++i) {
    const float lag = 2.0F * plan.duration_s * static_cast<float>(i) / 200.0F;
    put(GaitState<float>{std::fmod(lag, plan.duration_s), i < 100 ? 0U : 1U, 0, 0, 0, 0}, w->state, 5);
    w->place();
    const float degrees = 57.29578F;
    const float hip = w->angles.hip_flexion[right][5] * degrees, knee = w->angles.knee_flexion[right][5] * degrees;
    const float ankle = w->angles.ankle_dorsiflexion[right][5] * degrees;
    hip_low = std::fmin(hip_low, hip);
    hip_high = std::fmax(hip_high, hip);
    ankle_low = std::fmin(ankle_low, ankle);
    ankle_high = std::fmax(ankle_high, ankle);
    if (i < 50) knee_load = std::fmax(knee_load, knee);
    if (i >= 50 && i < 100) knee_mid = std::fmin(knee_mid, knee);
    if (i > 120) knee_swing = std::fmax(knee_swing, knee);
    high = std::fmax(high, w->centre.position_m.y[5]);
    low = std::fmin(low, w->centre.position_m.y[5]);
    aside_high = std::fmax(aside_high, w->centre.position_m.x[5]);
    aside_low = std::fmin(aside_low, w->centre.position_m.x[5]);
  }
  EXPECT_NEAR(hip_high, 30, 8);
  EXPECT_NEAR(hip_low, -12, 6);
  EXPECT_NEAR(knee_load, 19, 7);
  EXPECT_NEAR(knee_mid, 6, 6);
  EXPECT_NEAR(knee_swing, 62, 6);
  EXPECT_NEAR(ankle_high, 12, 7);
  EXPECT_NEAR(ankle_low, -19, 6);
  EXPECT_NEAR(high - low, 0.040, 0.012);
  EXPECT_NEAR(aside_high - aside_low, 0.042, 0.015);
}

TEST(Kinematics, AnatomicalPositionStandsOnTheGround) {
  const auto w = random_walkers(2);
  pose_anatomical(w->size, w->pose);
  centre_of_mass(w->size, w->pose, w->centre);
  for (std::size_t l = 0; l < lane_count; ++l) {
    const float height = w->size.height_m[l];
    const std::size_t head = index(Segment::head), foot = index(Segment::foot_left);
    EXPECT_NEAR(w->pose.position_m[head].y[l] + w->body[l].tip_m[head].y, height, 1e-5);
    EXPECT_NEAR(w->pose.position_m[foot].y[l] + w->body[l].heel_m.y, 0.0F, 1e-6);
    EXPECT_GT(w->pose.position_m[foot].x[l], 0.0F);
    // The same centre from the body's own masses, in double.
    double mass = 0, y = 0;
    for (std::size_t s = 0; s < segment_count; ++s) {
      mass += w->body[l].mass_kg[s];
      y += w->body[l].mass_kg[s] * (w->pose.position_m[s].y[l] + w->body[l].centre_of_mass_m[s].y);
    }
    EXPECT_NEAR(w->centre.position_m.y[l], y / mass, 1e-5);
  }
}

}  // namespace
}  // namespace mobil
