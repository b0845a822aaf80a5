// Ground reactions and joint moments of figures with known motion, compared with mechanics in double precision.
#include "systems/forces/forces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "assets/body/segment_inertia.h"
#include "tests/gait/forces_figure.h"

namespace mobil::forces_test {
using namespace figure;

constexpr float tick = 1.0F / 120.0F;

double height_of(const Block& b, std::size_t l) {
  return static_cast<double>(b.size.height_m[l]);
}
double mass_of(const Block& b, std::size_t l) {
  return static_cast<double>(b.size.mass_kg[l]);
}
double weight_of(const Block& b, std::size_t l) {
  return gravity * mass_of(b, l);
}

Vector total(const Block& b, std::size_t l) {
  return b.force(l, Side::right) + b.force(l, Side::left);
}

/// Puts all weight on one foot, at fraction `at` of a step whose first fifth is double support.
void on_one_foot(Block& b, std::size_t l, std::uint32_t side, float at = 0.6F) {
  b.state.stance_side[l] = side;
  b.state.time_s[l] = at * b.plan.duration_s[l];
  b.plan.from.speed_m_s[l] = b.plan.to.speed_m_s[l] = 1.0F;
  b.plan.phase_rate_from[l] = b.plan.phase_rate_to[l] = 1.0F;
  b.plan.double_support[l] = 0.2F;
  b.plan.landing[l] = 1.0F;
}

/// Sets random fractions of a step.
void somewhere_in_a_step(Block& b) {
  for (std::size_t l = 0; l < lane_count; ++l) {
    on_one_foot(b, l, l % 2, 0.024F * static_cast<float>(l));
  }
}

/// Returns the rate of change of the angular momentum about the centre of mass at time 0, N m.
Vector angular_rate(double height, double mass, const std::function<Stance(double)>& motion, double dt) {
  const auto momentum = [&](double t) -> Vector {
    const double h = 0.5 * dt;
    const Stance before = motion(t - h), now = motion(t), after = motion(t + h);
    const auto c0 = centres(height, before), c1 = centres(height, now), c2 = centres(height, after);
    const Vector body = body_centre(height, now);
    const Vector drift = (body_centre(height, after) - body_centre(height, before)) / (2 * h);
    Vector sum = Vector::Zero();
    for (std::size_t i = 0; i < segment_count; ++i) {
      const double m = mass * mass_part(i);
      sum += m * (c1[i] - body).cross((c2[i] - c0[i]) / (2 * h) - drift);
      const Eigen::AngleAxisd step(after.rotation[i] * before.rotation[i].conjugate());
      const Vector spin = step.axis() * step.angle() / (2 * h);
      const Eigen::Matrix3d r = now.rotation[i].toRotationMatrix();
      sum += m * height * height * (r * of(unit_inertia[i]).asDiagonal() * r.transpose() * spin);
    }
    return sum;
  };
  return (momentum(0.5 * dt) - momentum(-0.5 * dt)) / dt;
}

TEST(Forces, StandingIsBalancedByHalfTheWeightUnderEachFoot) {
  const auto b = random_people(2);
  std::vector<double> heading(lane_count);
  for (std::size_t l = 0; l < lane_count; ++l) heading[l] = 0.7 * static_cast<double>(l);
  forces_of(
      *b,
      [&](std::size_t l, double) {
        return moved(upright(height_of(*b, l)), heading[l], {0.1, 0, -0.2});
      },
      tick);
  for (std::size_t l = 0; l < lane_count; ++l) {
    const double height = height_of(*b, l), weight = weight_of(*b, l), tolerance = 1e-3 * weight * height;
    const Stance s = upright(height);
    const auto at = centres(height, s);
    const Vector body = body_centre(height, s), forward = turn(heading[l], Vector::UnitY()) * Vector::UnitZ();
    for (std::size_t side = 0; side < 2; ++side) {
      EXPECT_NEAR(b->force(l, side).y(), 0.5 * weight, 1e-3 * weight);
      EXPECT_NEAR(b->force(l, side).dot(forward), 0, 1e-3 * weight);
      EXPECT_NEAR((b->pressure(l, side) - Vector(0.1, 0, -0.2)).dot(forward), body.z(), 1e-4 * height);
      // Ankle, knee and hip are above one another. The moment is that of the body's centre in front of them, less the
      // leg's.
      const double reaction = 0.5 * weight * body.z();
      auto hanging = [&](Segment first) {
        double sum = 0;
        for (std::size_t i = index(on_side(first, side)); i <= index(on_side(Segment::toes_right, side)); ++i)
          sum += weight * mass_part(i) * at[i].z();
        return sum;
      };
      EXPECT_NEAR(b->joints(l, side)(0), reaction - hanging(Segment::thigh_right), tolerance);
      EXPECT_NEAR(b->joints(l, side)(1), -(reaction - hanging(Segment::shank_right)), tolerance);
      EXPECT_NEAR(b->joints(l, side)(2), reaction - hanging(Segment::foot_right), tolerance);
    }
  }
}

TEST(Forces, DoubleSupportIsFullyBalanced) {
  const auto b = random_people(8);
  // A walker in double support with an offset to one side; then the trunk swings as well.
  bool swings = false;
  const auto motion = [&](std::size_t l, double t) {
    const double height = height_of(*b, l), angle = swings ? 0.02 * std::sin(5 * t + static_cast<double>(l)) : 0;
    Stance s = upright(height);
    s.pelvis += Vector(0.003 * height * (swings ? std::sin(4 * t) : 1), 0, 0);
    for (std::size_t i = index(Segment::L5); i <= index(Segment::head); ++i)
      s.rotation[i] = turn(angle, Vector(1, 0, 0.5).normalized());
    return s;
  };
  for (const float part : {0.2F, 0.5F, 0.8F, -0.5F}) {
    swings = part > 0;
    for (std::size_t l = 0; l < lane_count; ++l) on_one_foot(*b, l, Side::right, 0.2F * std::fabs(part));
    forces_of(*b, motion, tick);
    for (std::size_t l = 0; l < lane_count; ++l) {
      const double height = height_of(*b, l), mass = mass_of(*b, l), dt = static_cast<double>(tick);
      const Vector body = body_centre(height, motion(l, 0));
      Vector moment = -angular_rate(
          height, mass, [&](double t) { return motion(l, t); }, dt);
      for (std::size_t side = 0; side < 2; ++side) {
        moment += (b->pressure(l, side) - body).cross(b->force(l, side));
        moment.y() += b->aside(l, side)(2);
      }
      EXPECT_NEAR(moment.y(), 0, (swings ? 6e-3 : 1e-3) * weight_of(*b, l));
      EXPECT_NEAR(moment.x(), 0, (swings ? 6e-3 : 1e-3) * weight_of(*b, l));
      EXPECT_NEAR(moment.z(), 0, (swings ? 6e-3 : 1e-3) * weight_of(*b, l));
    }
  }
}

/// Returns the moment about a joint of all bodies distal of it, one after the other, in three dimensions.
double oracle_moment(double height, double mass, const std::function<Stance(double)>& motion, double dt, Segment joint,
                     std::size_t side, const Vector& force, const Vector& pressure, const Vector& axis) {
  const Stance now = motion(0);
  const Vector about = places(height, now)[index(on_side(joint, side))];
  const auto c0 = centres(height, motion(-dt)), c1 = centres(height, now), c2 = centres(height, motion(dt));
  Vector sum = -(pressure - about).cross(force);
  // The radii of gyration below are those of the thigh with its kneecap and of the foot with its toes.
  const std::vector<std::vector<Segment>> bodies = {{Segment::thigh_right, Segment::patella_right},
                                                    {Segment::shank_right},
                                                    {Segment::foot_right, Segment::toes_right}};
  for (const auto& body : bodies) {
    if (body.front() < joint) continue;
    double part = 0;
    Vector centre = Vector::Zero(), a = Vector::Zero();
    for (const Segment s : body) {
      const std::size_t i = index(on_side(s, side));
      part += mass_part(i);
      centre += mass_part(i) * c1[i];
      a += mass_part(i) * (c0[i] - 2 * c1[i] + c2[i]) / (dt * dt);
    }
    sum += mass * (centre / part - about).cross(a + part * Vector(0, gravity, 0));
  }
  // Angular momentum of the rods about their own centres, from angular velocity and inertia tensor.
  struct Rod {
    Segment from, to;
    double mass, gyration;
  };
  const Rod rods[] = {{Segment::thigh_right, Segment::shank_right, 0.1416, 0.3256},
                      {Segment::shank_right, Segment::foot_right, 0.0433, 0.2493},
                      {Segment::foot_right, Segment::toes_right, 0.0137, 0.475}};
  for (const Rod& rod : rods) {
    if (rod.from < joint) continue;
    const std::size_t i = index(on_side(rod.from, side));
    const Vector along = height * of(unit_body.joint_offset[index(on_side(rod.to, side))]);
    const double inertia = mass * rod.mass * std::pow(rod.gyration * along.norm(), 2);
    const Vector u = along.normalized();
    const Eigen::Matrix3d tensor = inertia * (Eigen::Matrix3d::Identity() - u * u.transpose());
    auto momentum = [&](double t) -> Vector {
      const double h = 1e-4;
      const Eigen::AngleAxisd step(motion(t + h).rotation[i] * motion(t - h).rotation[i].conjugate());
      const Vector spin = step.axis() * step.angle() / (2 * h);
      const Eigen::Matrix3d r = motion(t).rotation[i].toRotationMatrix();
      return r * tensor * r.transpose() * spin;
    };
    sum += (momentum(1e-3) - momentum(-1e-3)) / 2e-3;
  }
  return sum.dot(axis);
}

TEST(Forces, AnyMotionAgreesWithThreeDimensionalFreeBodies) {
  Vector worst = Vector::Zero();  // hip, knee, ankle, relative to weight times height
  double worst_aside = 0;         // frontal and transverse, at the hip
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const auto b = random_people(seed);
    somewhere_in_a_step(*b);
    auto motion = [&](std::size_t l, double t) {
      return moved(Thrashing(100 * seed + static_cast<unsigned>(l), height_of(*b, l)).at(t),
                   0.5 * static_cast<double>(l), {0.3 * t, 0, 1.2 * t});
    };
    forces_of(*b, motion, tick);
    for (std::size_t l = 0; l < lane_count; ++l) {
      const double height = height_of(*b, l), mass = mass_of(*b, l), dt = static_cast<double>(tick);
      const auto c0 = centres(height, motion(l, -dt)), c1 = centres(height, motion(l, 0)),
                 c2 = centres(height, motion(l, dt));
      Vector force = Vector::Zero();
      for (std::size_t i = 0; i < segment_count; ++i)
        force += mass * mass_part(i) * ((c0[i] - 2 * c1[i] + c2[i]) / (dt * dt) + Vector(0, gravity, 0));
      EXPECT_LT((total(*b, l) - force).norm(), 3e-3 * weight_of(*b, l));

      const Stance now = motion(l, 0);
      Vector axis = now.rotation[index(Segment::thigh_right)] * Vector::UnitX() +
                    now.rotation[index(Segment::thigh_left)] * Vector::UnitX();
      axis = Vector(axis.x(), 0, axis.z()).normalized();
      const Segment joints[] = {Segment::thigh_right, Segment::shank_right, Segment::foot_right};
      for (std::size_t side = 0; side < 2; ++side) {
        for (std::size_t j = 0; j < 3; ++j) {
          const double sign = j == 1 ? -1 : 1;
          const double moment = sign * oracle_moment(
                                           height, mass, [&](double t) { return motion(l, t); }, dt, joints[j], side,
                                           b->force(l, side), b->pressure(l, side), axis);
          const auto at = static_cast<Eigen::Index>(j);
          const double off = std::abs(b->joints(l, side)(at) - moment);
          worst(at) = std::fmax(worst(at), off / (weight_of(*b, l) * height));
        }
        const auto of_hip = [&](const Vector& about) {
          return oracle_moment(
              height, mass, [&](double t) { return motion(l, t); }, dt, Segment::thigh_right, side, b->force(l, side),
              b->pressure(l, side), about);
        };
        const double outward = side == Side::left ? 1 : -1;
        const Vector aside = b->aside(l, side);
        for (const double off : {aside(0) - outward * of_hip(axis.cross(Vector::UnitY())),
                                 aside(1) + outward * (of_hip(Vector::UnitY()) - aside(2))})
          worst_aside = std::fmax(worst_aside, std::abs(off) / (weight_of(*b, l) * height));
      }
    }
  }
  EXPECT_LT(worst(0), 1e-4);
  EXPECT_LT(worst(1), 5e-6);
  EXPECT_LT(worst(2), 1e-6);
  EXPECT_LT(worst_aside, 2e-4);
}

TEST(Forces, MirrorImageExchangesSides) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const auto b = random_people(seed), m = random_people(seed);
    somewhere_in_a_step(*b);
    somewhere_in_a_step(*m);
    for (std::size_t l = 0; l < lane_count; ++l) m->state.stance_side[l] ^= 1U;
    auto motion = [&](std::size_t l, double t) {
      return Thrashing(seed + 50 * static_cast<unsigned>(l), height_of(*b, l)).at(t);
    };
    forces_of(*b, motion, tick);
    forces_of(
        *m, [&](std::size_t l, double t) { return mirrored(motion(l, t)); }, tick);
    for (std::size_t l = 0; l < lane_count; ++l) {
      const double weight = weight_of(*b, l);
      for (std::size_t side = 0; side < 2; ++side) {
        const Vector f = b->force(l, side), c = b->pressure(l, side);
        EXPECT_LT((m->force(l, 1 - side) - Vector(-f.x(), f.y(), f.z())).norm(), 2e-3 * weight);
        EXPECT_LT((m->pressure(l, 1 - side) - Vector(-c.x(), c.y(), c.z())).norm(), 1e-3);
        EXPECT_LT((m->joints(l, 1 - side) - b->joints(l, side)).norm(), 4e-3 * weight);
        const Vector aside = b->aside(l, side);
        EXPECT_LT((m->aside(l, 1 - side) - Vector(aside.x(), aside.y(), -aside.z())).norm(), 4e-3 * weight);
      }
    }
  }
}

}  // namespace mobil::forces_test
