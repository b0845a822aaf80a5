// Random walkers, sixteen at a time: feet that stay in place, legs of constant length, motion without jumps.
#include "systems/gait/kinematics.h"

#include <gtest/gtest.h>

#include <cmath>

#include <mobil/engine/geometry.h>
#include <mobil/rows.h>
#include "tests/gait/walkers.h"

namespace mobil::kinematics_test {
constexpr float tick = 1.0F / 120.0F;

/// Runs blocks of random walkers through several steps. Calls check(walkers, tick number) after each tick.
template <class Check>
void over_walks(Check check) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const auto w = random_walkers(seed);
    for (int t = 0; t < 300; ++t) {
      check(*w, t);
      w->tick(tick);
    }
  }
}

/// Returns the time since a foot's heel strike.
float since_strike(const Walkers& w, std::size_t side, std::size_t l) {
  return w.state.time_s[l] + (w.state.stance_side[l] == side ? 0.0F : w.plan.duration_s[l]);
}

/// Returns true if heel (0) or toes (1) of a foot bear on the ground, in steps that are all equal: the heel from when
/// its pad has yielded to heel rise, the tips of the toes from foot flat to toe-off.
bool bears(const Walkers& w, std::size_t side, std::size_t toe, std::size_t l) {
  const float lag = since_strike(w, side, l), flat = flat_s(w.plan, l);
  const float rise = 2 * (0.30F + w.plan.from.shape[step_shape::times.first + 1][l]) * w.plan.duration_s[l];
  return lag >= flat && lag < (toe == 0 ? rise : w.plan.duration_s[l] + w.plan.double_support_s[l]);
}

const Vec3<Lanes<float>>& sole(const Walkers& w, std::size_t side, std::size_t toe) {
  return toe == 0 ? w.feet.heel_m[side] : w.feet.tip_m[side];
}

/// Motion of points that bear on the ground, along it and off it.
struct Planted {
  struct Point {
    bool down = false;
    Vec3<float> place{};
  };
  std::array<std::array<std::array<Point, 2>, 2>, lane_count> point{};
  double slid = 0, off = 0;
  long counted = 0;

  void forget() { point = {}; }
  void look(const Walkers& w) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      for (std::size_t side = 0; side < 2; ++side) {
        for (std::size_t toe = 0; toe < 2; ++toe) {
          const bool down = bears(w, side, toe, l);
          const Vec3<float> now = at(sole(w, side, toe), l);
          Point& before = point[l][side][toe];
          if (down) {
            off = std::fmax(off, std::fabs(static_cast<double>(now.y)));
            if (before.down) {
              slid = std::fmax(slid, distance(now, before.place));
              ++counted;
            } else {
              before.place = now;
            }
          }
          before.down = down;
        }
      }
    }
  }
};

TEST(Kinematics, PlantedFeetDoNotMove) {
  Planted planted;
  over_walks([&](const Walkers& w, int t) {
    if (t == 0) planted.forget();
    planted.look(w);
  });
  EXPECT_GT(planted.counted, 20000);
  EXPECT_LT(planted.slid, 1e-4);
  EXPECT_LT(planted.off, 1e-4);
}

/// Returns the distance of a segment's origin from its parent's joint, m.
double gap(const Walkers& w, std::size_t s, std::size_t l) {
  const std::size_t p = index(segment_parent[s]);
  const Vec3<float> o = rotated(at(w.pose.rotation[p], l), w.body[l].joint_offset_m[s]);
  const Vec3<float> from = at(w.pose.position_m[p], l);
  return distance(at(w.pose.position_m[s], l), {from.x + o.x, from.y + o.y, from.z + o.z});
}

TEST(Kinematics, SkeletonIsConnectedAndJointsKeepTheirRange) {
  double apart = 0, overreached = 0, unit = 0;
  over_walks([&](const Walkers& w, int) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      for (std::size_t s = 0; s < segment_count; ++s) {
        const Quat<float> q = at(w.pose.rotation[s], l);
        unit = std::fmax(unit, std::fabs(1.0 - (q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w)));
        // Exceptions: the pelvis has no parent, the spine is on a pelvis turned by its neutral tilt, and the kneecap
        // slides round the knee.
        if (s == 0 || s == index(Segment::L5) || s == index(Segment::patella_right) ||
            s == index(Segment::patella_left))
          continue;
        // If the leg cannot reach the planted foot even when straight, the foot stays and the ankle joint opens.
        const bool straight = (s == index(Segment::foot_right) && w.angles.knee_flexion[Side::right][l] < 0.01F) ||
                              (s == index(Segment::foot_left) && w.angles.knee_flexion[Side::left][l] < 0.01F);
        double& most = straight ? overreached : apart;
        most = std::fmax(most, gap(w, s, l));
      }
      for (std::size_t side = 0; side < 2; ++side) {
        ASSERT_GE(w.angles.knee_flexion[side][l], 0.0F);
        ASSERT_LT(w.angles.knee_flexion[side][l], 1.6F);
        ASSERT_LT(std::fabs(w.angles.hip_flexion[side][l]), 1.2F);
        ASSERT_LT(std::fabs(w.angles.ankle_dorsiflexion[side][l]), 0.9F);
      }
    }
  });
  EXPECT_LT(apart, 1e-4);
  EXPECT_LT(overreached, 2e-3);
  EXPECT_LT(unit, 1e-5);
}

TEST(Kinematics, KneecapKeepsItsDistanceFromTheKnee) {
  over_walks([&](const Walkers& w, int) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      for (std::size_t side = 0; side < 2; ++side) {
        const std::size_t cap = index(on_side(Segment::patella_right, side)),
                          knee = index(on_side(Segment::shank_right, side));
        const double wanted = distance(w.body[l].joint_offset_m[cap], w.body[l].joint_offset_m[knee]);
        ASSERT_NEAR(distance(at(w.pose.position_m[cap], l), at(w.pose.position_m[knee], l)), wanted, 1e-5);
      }
    }
  });
}

TEST(Kinematics, FeetAreNeverInTheGround) {
  double heel = 1, toe = 1, tip = 1;
  over_walks([&](const Walkers& w, int) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      for (std::size_t side = 0; side < 2; ++side) {
        heel = std::fmin(heel, static_cast<double>(w.feet.heel_m[side].y[l]));
        toe = std::fmin(toe, static_cast<double>(w.feet.toe_m[side].y[l]));
        // The tip of the toes: along the third axis of their rotation, from below their joint.
        const std::size_t s = index(on_side(Segment::toes_right, side));
        const Quat<Lanes<float>>& q = w.pose.rotation[s];
        const float rise = 2.0F * (q.y[l] * q.z[l] - q.w[l] * q.x[l]);
        tip = std::fmin(tip, static_cast<double>(w.feet.toe_m[side].y[l] + rise * w.body[l].tip_m[s].z));
      }
    }
  });
  EXPECT_GT(heel, -0.003);
  EXPECT_GT(toe, -0.008);  // for hundredths of a second after the steepest toe-offs
  EXPECT_GT(tip, -0.008);
}

TEST(Kinematics, SwingingFeetClearTheGroundInMidSwing) {
  double clearance = 1;
  over_walks([&](const Walkers& w, int) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      const float off = 0.5F + 0.5F * w.plan.double_support_s[l] / w.plan.duration_s[l];
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

Vec3<double> wide(const Vec3<float>& v) {
  return {v.x, v.y, v.z};
}

/// Changes the gait or heading of some walkers.
void wish(Walkers& w, Dice& dice) {
  for (std::size_t l = 0; l < lane_count; ++l) {
    const double what = dice(0, 4);
    if (what < 2) ask_natural(w, l, dice, 0.0);
    if (what > 3) w.ask(l, {.speed_m_s = 0.0F});
    if (what > 1.5) w.gait.heading_rad[l] = dice.single(-3, 3);
  }
}

/// Returns the rotation vector from one orientation to the next, rad, for small turns.
Vec3<double> turn_between(const Quat<float>& a, const Quat<float>& b) {
  const auto wide = [](const Quat<float>& q) { return Quat<double>{q.x, q.y, q.z, q.w}; };
  const Quat<double> by = geometry::product(wide(b), geometry::conjugate(wide(a)));
  using geometry::operator*;
  return (by.w < 0 ? -2.0 : 2.0) * Vec3<double>{by.x, by.y, by.z};
}

/// Maximum speeds of any segment, and maximum changes of its velocity from one tick to the next.
struct Jumps {
  double speed = 0, rate_rad_s = 0;                  // relative to the walk's speed plus 0.5 m/s
  double acceleration_m_s2 = 0, turning_rad_s2 = 0;  // without legs whose knees are nearly straight
  double straight_m_s = 0, straight_rad_s = 0;       // changes of those legs
};

/// A nearly straight knee's angle is the square root of a small length, so its rate is unbounded.
bool nearly_straight(const Walkers& w, std::size_t segment, std::size_t lane) {
  const bool on_right = segment >= index(Segment::thigh_right) && segment < index(Segment::thigh_left);
  const bool on_left = segment >= index(Segment::thigh_left) && segment < index(Segment::clavicle_right);
  return (on_right && w.angles.knee_flexion[Side::right][lane] < 0.1F) ||
         (on_left && w.angles.knee_flexion[Side::left][lane] < 0.1F);
}

/// Returns the jumps of walkers whose requests change on the way, over six seconds.
Jumps jumps(unsigned seed, int ticks_a_second, float forward_swing = 0) {
  using geometry::operator-, geometry::operator*;
  Dice dice{std::mt19937(seed)};
  const auto w = random_walkers(seed);
  const double dt = 1.0 / ticks_a_second;
  auto before = std::make_unique<Pose<Lanes<float>>>();
  std::array<std::array<Vec3<double>, segment_count>, lane_count> velocity, turning;
  Jumps most;
  for (int t = 0; t < 6 * ticks_a_second; ++t) {
    if (t % (ticks_a_second * 3 / 2) == ticks_a_second * 7 / 10) wish(*w, dice);
    for (float& lane : w->gait.style.forward_swing.lane) lane = forward_swing;
    *before = w->pose;
    w->tick(static_cast<float>(dt));
    for (std::size_t l = 0; l < lane_count; ++l) {
      const double walk = std::fmax(w->plan.from.speed_m_s[l], w->plan.to.speed_m_s[l]) + 0.5;
      for (std::size_t s = 0; s < segment_count; ++s) {
        const Vec3<double> v = (1 / dt) * (wide(at(w->pose.position_m[s], l)) - wide(at(before->position_m[s], l)));
        const Vec3<double> r = (1 / dt) * turn_between(at(before->rotation[s], l), at(w->pose.rotation[s], l));
        const double change = geometry::length(v - velocity[l][s]), turn = geometry::length(r - turning[l][s]);
        velocity[l][s] = v;
        turning[l][s] = r;
        EXPECT_TRUE(std::isfinite(geometry::length(v) + geometry::length(r))) << segment_name[s];
        most.speed = std::fmax(most.speed, geometry::length(v) / walk);
        most.rate_rad_s = std::fmax(most.rate_rad_s, geometry::length(r));
        if (t == 0) continue;
        if (nearly_straight(*w, s, l)) {
          most.straight_m_s = std::fmax(most.straight_m_s, change);
          most.straight_rad_s = std::fmax(most.straight_rad_s, turn);
        } else {
          most.acceleration_m_s2 = std::fmax(most.acceleration_m_s2, change / dt);
          most.turning_rad_s2 = std::fmax(most.turning_rad_s2, turn / dt);
        }
      }
    }
  }
  return most;
}

TEST(Kinematics, NothingJumpsAfterAnyRequest) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const Jumps at_1000 = jumps(seed, 1000), at_500 = jumps(seed, 500), at_2000 = jumps(seed, 2000);
    EXPECT_LT(at_1000.speed, 3.8);
    EXPECT_LT(at_1000.rate_rad_s, 27);
    // A jump of a millimetre in one of these ticks would be 1000 m/s².
    EXPECT_LT(at_1000.acceleration_m_s2, 1100);
    EXPECT_LT(at_1000.turning_rad_s2, 3800);
    // A leg stretched past its length turns within half a millimetre: fast, but at most by these amounts.
    EXPECT_LT(at_2000.straight_m_s, 4);
    EXPECT_LT(at_2000.straight_rad_s, 12);
    EXPECT_LT(at_500.straight_m_s, 4);
  }
}

/// Bounds are equal for legs that are integrated forward.
TEST(Kinematics, NothingJumpsWithForwardSwings) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const Jumps most = jumps(seed, 1000, 1);
    EXPECT_LT(most.speed, 3.8);
    EXPECT_LT(most.rate_rad_s, 27);
    EXPECT_LT(most.acceleration_m_s2, 1100);
    EXPECT_LT(most.turning_rad_s2, 3800);
    EXPECT_LT(most.straight_m_s, 8);
  }
}

std::size_t mirrored(std::size_t s) {
  if (s >= index(Segment::clavicle_right)) return s < index(Segment::clavicle_left) ? s + 6 : s - 6;
  if (s >= index(Segment::thigh_right)) return s < index(Segment::thigh_left) ? s + 5 : s - 5;
  return s;
}

/// Returns a random state in a turn.
GaitState<float> bent(float time_s, std::uint32_t stance_side, Dice& dice) {
  GaitState<float> state{};
  state.time_s = time_s;
  state.stance_side = stance_side;
  for (float* turn :
       {&state.turn_rad, &state.turn_before_rad, &state.bend_per_m, &state.bend_before_per_m, &state.bend_next_per_m})
    *turn = dice.single(-0.3, 0.3);
  state.chord_rad = 0.5F * state.turn_rad;
  state.chord_before_rad = -0.5F * state.turn_before_rad;
  for (float* shift : {&state.shift_m, &state.shift_before_m, &state.shift_next_m}) *shift = dice.single(-0.06, 0.06);
  return state;
}

GaitState<float> mirrored(GaitState<float> state) {
  for (float* one :
       {&state.turn_rad, &state.turn_before_rad, &state.chord_rad, &state.chord_before_rad, &state.bend_per_m,
        &state.bend_before_per_m, &state.bend_next_per_m, &state.shift_m, &state.shift_before_m, &state.shift_next_m})
    *one = -*one;
  state.stance_side ^= 1U;
  return state;
}

GaitState<float> at_place(GaitState<float> state, float x, float z, float heading) {
  state.line_x_m = x;
  state.line_z_m = z;
  state.heading_rad = heading;
  return state;
}

TEST(Kinematics, LeftSideIsTheMirrorImageOfTheRight) {
  const auto now = random_walkers(21, 0.5), then = random_walkers(21, 0.5);
  Dice dice{std::mt19937(21)};
  for (int t = 0; t < 40; ++t) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      const float time = now->plan.duration_s[l] * (static_cast<float>(t) + 0.5F) / 40.0F;
      const float x = dice.single(-2, 2), z = dice.single(-2, 2), heading = dice.single(-3, 3);
      const GaitState<float> state = bent(time, Side::right, dice);
      put(at_place(state, x, z, heading), now->state, l);
      put(at_place(mirrored(state), -x, z, -heading), then->state, l);
    }
    now->place();
    then->place();
    for (std::size_t l = 0; l < lane_count; ++l) {
      for (std::size_t s = 0; s < segment_count; ++s) {
        const Vec3<float> a = at(now->pose.position_m[s], l), b = at(then->pose.position_m[mirrored(s)], l);
        ASSERT_LT(distance(a, {-b.x, b.y, b.z}), 2e-5) << segment_name[s];
        const Quat<float> p = at(now->pose.rotation[s], l), q = at(then->pose.rotation[mirrored(s)], l);
        ASSERT_LT(angle_between(p, {q.x, -q.y, -q.z, q.w}), 3e-3) << segment_name[s];
      }
      for (std::size_t side = 0; side < 2; ++side) {
        ASSERT_NEAR(now->angles.knee_flexion[side][l], then->angles.knee_flexion[1 - side][l], 1e-5);
        ASSERT_NEAR(now->feet.phase[side][l], then->feet.phase[1 - side][l], 1e-6);
      }
      ASSERT_NEAR(now->angles.pelvis_list[l], -then->angles.pelvis_list[l], 1e-6);
      ASSERT_NEAR(now->angles.pelvis_rotation[l], -then->angles.pelvis_rotation[l], 1e-6);
      ASSERT_NEAR(now->angles.pelvis_tilt[l], then->angles.pelvis_tilt[l], 1e-6);
    }
  }
}

TEST(Kinematics, HeadingTurnsThePoseAboutTheLinePoint) {
  const auto ahead = random_walkers(22, 0.5), turned = random_walkers(22, 0.5);
  Dice dice{std::mt19937(22)};
  for (int t = 0; t < 20; ++t) {
    std::array<float, lane_count> x, z, heading;
    for (std::size_t l = 0; l < lane_count; ++l) {
      const float time = ahead->plan.duration_s[l] * dice.single(0, 1);
      const GaitState<float> state = bent(time, static_cast<std::uint32_t>(t % 2), dice);
      x[l] = dice.single(-20, 20), z[l] = dice.single(-20, 20), heading[l] = dice.single(-3, 3);
      put(at_place(state, 0, 0, 0), ahead->state, l);
      put(at_place(state, x[l], z[l], heading[l]), turned->state, l);
    }
    ahead->place();
    turned->place();
    for (std::size_t l = 0; l < lane_count; ++l) {
      const Quat<float> about_y = {0, std::sin(heading[l] / 2), 0, std::cos(heading[l] / 2)};
      for (std::size_t s = 0; s < segment_count; ++s) {
        const Vec3<float> a = rotated(about_y, at(ahead->pose.position_m[s], l));
        ASSERT_LT(distance(at(turned->pose.position_m[s], l), {x[l] + a.x, a.y, z[l] + a.z}), 2e-5) << segment_name[s];
      }
      ASSERT_EQ(ahead->angles.knee_flexion[Side::right][l], turned->angles.knee_flexion[Side::right][l]);
      ASSERT_EQ(ahead->angles.hip_flexion[Side::left][l], turned->angles.hip_flexion[Side::left][l]);
    }
  }
}

TEST(Kinematics, WalkStartsOnTheRightHeelAndAdvancesAlongItsHeading) {
  const auto w = random_walkers(3);
  for (std::size_t l = 0; l < lane_count; ++l) {
    EXPECT_EQ(w->feet.phase[Side::right][l], 0.0F);
    EXPECT_NEAR(w->feet.phase[Side::left][l], 0.5F, 1e-6);
    EXPECT_NEAR(w->feet.heel_m[Side::right].y[l], 0.0F, 0.02F);  // on its rim, above its pad
    EXPECT_GT(w->feet.toe_m[Side::right].y[l], 0.005F);
    EXPECT_LT(w->feet.heel_m[Side::right].x[l], 0.0F);  // +X is left
    EXPECT_GT(w->feet.heel_m[Side::right].z[l], w->feet.heel_m[Side::left].z[l]);
    w->state.heading_rad[l] = w->gait.heading_rad[l] = 0.1F * static_cast<float>(l);
  }
  w->place();
  const CentreOfMass<Lanes<float>> start = w->centre;
  for (int t = 0; t < 600; ++t) w->tick(tick);
  for (std::size_t l = 0; l < lane_count; ++l) {
    EXPECT_NEAR(static_cast<float>(w->state.steps[l]) * w->plan.duration_s[l] + w->state.time_s[l], 600 * tick, 1e-3);
    EXPECT_EQ(w->state.stance_side[l], w->state.steps[l] % 2);
    w->state.time_s[l] = 0;
    w->state.stance_side[l] = Side::right;
  }
  w->place();
  for (std::size_t l = 0; l < lane_count; ++l) {
    const float far = static_cast<float>(w->state.steps[l]) * w->plan.step_length_m[l];
    const float heading = 0.1F * static_cast<float>(l);
    EXPECT_NEAR(w->centre.position_m.x[l] - start.position_m.x[l], far * std::sin(heading), 1e-3);
    EXPECT_NEAR(w->centre.position_m.z[l] - start.position_m.z[l], far * std::cos(heading), 1e-3);
    EXPECT_NEAR(w->centre.position_m.y[l], start.position_m.y[l], 1e-4);
  }
}

TEST(Kinematics, HeadStaysInPlaneWhileShouldersCounterRotate) {
  over_walks([](const Walkers& w, int) {
    const Quat<Lanes<float>>&head = w.pose.rotation[index(Segment::head)], &chest = w.pose.rotation[index(Segment::T1)];
    for (std::size_t l = 0; l < lane_count; ++l) {
      ASSERT_LT(std::fabs(head.x[l]) + std::fabs(head.y[l]) + std::fabs(head.z[l]), 1e-6F);
      const float turn = w.angles.pelvis_rotation[l];
      ASSERT_LE(chest.y[l] * turn, std::fabs(turn) > 1e-3F ? -1e-9F : 1e-9F);
    }
  });
}

TEST(Kinematics, NaturalWalkIsWithinMeasuredRanges) {
  // Ranges of Winter's natural cadence and Schwartz's free speed, plus two standard deviations.
  const auto w = random_walkers(1);
  for (std::size_t l = 0; l < lane_count; ++l) {
    w->set_body(l, {.height_m = 1.8F, .mass_kg = 80.0F});
    w->ask(l, {});
  }
  w->begin();
  const float duration = w->plan.duration_s[0];
  float hip_low = 9, hip_high = -9, knee_load = 0, knee_mid = 9, knee_swing = 0, ankle_low = 9, ankle_high = -9;
  float high = 0, low = 9, aside_low = 9, aside_high = -9;
  for (int i = 0; i < 200; ++i) {
    const float lag = 2.0F * duration * static_cast<float>(i) / 200.0F;
    GaitState<float> state{};
    state.time_s = std::fmod(lag, duration);
    state.stance_side = i < 100 ? 0U : 1U;
    put(state, w->state, 5);
    w->place();
    const float degrees = 57.29578F;
    const float hip = w->angles.hip_flexion[Side::right][5] * degrees,
                knee = w->angles.knee_flexion[Side::right][5] * degrees;
    const float ankle = w->angles.ankle_dorsiflexion[Side::right][5] * degrees;
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
  EXPECT_NEAR(hip_high, 37, 6);  // measured from a pelvis that tilts by some 10 deg
  EXPECT_NEAR(hip_low, -12, 6);
  EXPECT_NEAR(knee_load, 21, 8);
  EXPECT_NEAR(knee_mid, 6, 6);
  EXPECT_NEAR(knee_swing, 62, 6);
  EXPECT_NEAR(ankle_high, 12, 7);
  EXPECT_NEAR(ankle_low, -20, 9);
  EXPECT_NEAR(high - low, 0.040, 0.012);
  EXPECT_NEAR(aside_high - aside_low, 0.042, 0.020);  // as the soles require; people sway more
}

}  // namespace mobil::kinematics_test
