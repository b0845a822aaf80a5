// Rules for load and centre of pressure, checked on one man's measured walk. Inputs are his angles and pelvis height;
// results are compared with his measured ground reactions and computed moments.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include <mobil/assets/files/csv_table.h>
#include "assets/body/body_scales.h"
#include "tests/files/reference_data.h"
#include "tests/gait/forces_figure.h"

namespace mobil::forces_measured_test {
using namespace figure;

constexpr double pi = 3.14159265358979;
constexpr double height = 1.803, mass = 72.6, speed = 1.14, stride_s = 1.235;
constexpr double double_support = 0.155;  // of the stride, from the measured vertical forces
constexpr int samples = 100;

/// A measured curve over the stride, 101 points. The last points of the moments are missing.
using Measured = std::vector<std::optional<double>>;

Measured measured(const CsvTable& table, const char* column_name) {
  Measured m;
  for (std::size_t r = 0; r < table.row.size(); ++r) m.push_back(number(cell(table, r, column_name)));
  return m;
}

/// The first harmonics of a curve over the stride, because second differences of raw angles are noise.
struct Harmonics {
  static constexpr int count = 7;
  std::array<double, count + 1> cosine{}, sine{};

  explicit Harmonics(const std::vector<double>& y) {
    for (int k = 0; k <= count; ++k) {
      const auto at = static_cast<std::size_t>(k);
      for (int i = 0; i < samples; ++i) {
        const double angle = 2 * pi * k * i / samples, part = (k == 0 ? 1.0 : 2.0) / samples;
        cosine[at] += part * y[static_cast<std::size_t>(i)] * std::cos(angle);
        sine[at] += part * y[static_cast<std::size_t>(i)] * std::sin(angle);
      }
    }
  }
  double operator()(double part) const {
    double sum = 0;
    for (int k = 0; k <= count; ++k) {
      const auto at = static_cast<std::size_t>(k);
      sum += cosine[at] * std::cos(2 * pi * k * part) + sine[at] * std::sin(2 * pi * k * part);
    }
    return sum;
  }
  /// Returns the second integral over time, without mean and drift.
  double twice_integrated(double part) const {
    double sum = 0;
    for (int k = 1; k <= count; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const double rate = 2 * pi * k / stride_s;
      sum -= (cosine[at] * std::cos(2 * pi * k * part) + sine[at] * std::sin(2 * pi * k * part)) / (rate * rate);
    }
    return sum;
  }
};

/// His pose at any time: angles as measured; hip adduction and rotation of the left leg are those of the right leg half
/// a stride earlier; trunk upright, arms hanging. His forward position was not stored, so the centre of mass follows
/// the measured fore-aft forces.
class Man {
 public:
  explicit Man(const CsvTable& table) {
    auto curve = [&](const char* name) {
      std::vector<double> y;
      for (const auto& v : measured(table, name)) y.push_back(v.value_or(0));
      return y;
    };
    for (const char* name : {"pelvis_tilt_anterior_deg", "pelvis_obliquity_up_deg", "pelvis_rotation_forward_deg",
                             "hip_adduction_deg", "hip_internal_rotation_deg", "pelvis_height_m"})
      body_.emplace_back(curve(name));
    for (const std::string side : {"", "contra_"})
      for (const char* name : {"hip_flexion_deg", "knee_flexion_deg", "ankle_dorsiflexion_deg"})
        leg_.emplace_back(curve((side + name).c_str()));
    std::vector<double> pushed = curve("foreaft_BW");
    const std::vector<double> other = curve("contra_foreaft_BW");
    for (std::size_t i = 0; i < pushed.size(); ++i) pushed[i] = gravity * (pushed[i] + other[i]);
    acceleration_.emplace_back(pushed);
    // The measured height is that of another point of the pelvis. It is shifted so that the right foot is on the ground
    // in mid-stance.
    const Stance flat = posed(0.25);
    const auto at = places(height, flat);
    const std::size_t foot = index(Segment::foot_right);
    const Vector heel =
        at[foot] + flat.rotation[foot] * Vector(0, -fraction::ankle_height, -fraction::heel_back) * height;
    const Vector toe = at[foot + 1] + flat.rotation[foot + 1] * Vector(0, -fraction::toe_joint_height, 0) * height;
    raised_ = -0.5 * (heel.y() + toe.y());
  }

  Stance at(double t) const {
    const double part = t / stride_s - std::floor(t / stride_s);
    Stance s = posed(part);
    s.pelvis.y() += raised_;
    s.pelvis.z() += speed * t + acceleration_[0].twice_integrated(part) - body_centre(height, s).z();
    return s;
  }

 private:
  Stance posed(double part) const {
    constexpr double degree = pi / 180;
    Stance s = upright(height);
    auto angle = [&](std::size_t i, double when) { return body_[i](when) * degree; };
    s.rotation[0] = turn(angle(2, part), Vector::UnitY()) * turn(-angle(1, part), Vector::UnitZ()) *
                    turn(angle(0, part), Vector::UnitX());
    for (std::size_t side = 0; side < 2; ++side) {
      const double out = side == Side::left ? -1 : 1, own = side == Side::left ? part + 0.5 : part;
      auto joint = [&](std::size_t i) { return leg_[3 * side + i](part) * degree; };
      const std::size_t thigh = index(on_side(Segment::thigh_right, side));
      s.rotation[thigh] = s.rotation[0] * turn(-joint(0), Vector::UnitX()) *
                          turn(out * angle(3, own), Vector::UnitZ()) * turn(out * angle(4, own), Vector::UnitY());
      s.rotation[thigh + 1] = s.rotation[thigh];
      s.rotation[thigh + 2] = s.rotation[thigh] * turn(joint(1), Vector::UnitX());
      s.rotation[thigh + 3] = s.rotation[thigh + 2] * turn(-joint(2), Vector::UnitX());
      // Toes stay on the ground as the heel rises.
      const double pitch = std::asin((s.rotation[thigh + 3] * Vector::UnitZ()).y());
      s.rotation[thigh + 4] = s.rotation[thigh + 3] * turn(std::fmin(pitch, 0), Vector::UnitX());
    }
    s.pelvis = {0, body_[5](part), 0};
    return s;
  }

  std::vector<Harmonics> body_, leg_, acceleration_;
  double raised_ = 0;
};

struct Row {
  Vector force[2], joints;
};

/// Returns the results of `joint_forces` over his stride, sample by sample.
std::vector<Row> computed(const Man& man) {
  auto b = std::make_unique<Block>();
  const double dt = stride_s / samples;
  std::vector<Row> rows;
  for (int i = 0; i <= samples; ++i) {
    const int sample = i % samples;
    const bool second = sample >= samples / 2;
    for (std::size_t l = 0; l < lane_count; ++l) {
      put(uniform_size(static_cast<float>(height), static_cast<float>(mass)), b->size, l);
      b->plan.from.speed_m_s[l] = b->plan.to.speed_m_s[l] = 1;
      b->plan.from.shape[step_shape::share.first][l] = b->plan.to.shape[step_shape::share.first][l] = 1.3F;
      b->plan.phase_rate_from[l] = b->plan.phase_rate_to[l] = 1;
      b->plan.double_support[l] = static_cast<float>(2 * double_support);
      b->plan.landing[l] = 1;
      b->plan.duration_s[l] = static_cast<float>(stride_s / 2);
      b->state.stance_side[l] = second ? Side::left : Side::right;
      b->state.time_s[l] = static_cast<float>((sample - (second ? samples / 2 : 0)) * dt);
    }
    forces_of(
        *b, [&](std::size_t, double t) { return man.at(i * dt + t); }, static_cast<float>(dt));
    rows.push_back({{b->force(0, Side::right), b->force(0, Side::left)}, b->joints(0, Side::right)});
  }
  return rows;
}

template <class Value>
double correlation(const char* name, const std::vector<Row>& rows, const Measured& curve, Value value) {
  double n = 0, sx = 0, sy = 0, sxx = 0, syy = 0, sxy = 0, off = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!curve[i]) continue;
    const double x = value(rows[i]), y = *curve[i];
    n += 1, sx += x, sy += y, sxx += x * x, syy += y * y, sxy += x * y, off += (x - y) * (x - y);
  }
  const double r = (sxy - sx * sy / n) / std::sqrt((sxx - sx * sx / n) * (syy - sy * sy / n));
  std::printf("%-26s correlation %.3f, off by %.3f (root mean square)\n", name, r, std::sqrt(off / n));
  return r;
}

TEST(ForcesOfAMeasuredWalk, AgreeWithTheForcePlatesAndTheMoments) {
  const auto measured_walk = test::reference_table("trial_subject01_walk.csv");
  if (!measured_walk) GTEST_SKIP() << test::no_table;
  const auto table = read_csv(measured_walk->string(), {});
  ASSERT_TRUE(table) << table.error().message;
  const std::vector<Row> rows = computed(Man(*table));
  ASSERT_EQ(rows.size(), std::size_t{samples + 1});
  const double weight = mass * gravity;
  auto plate = [&](const char* name, std::size_t side, Eigen::Index axis) {
    return correlation(name, rows, measured(*table, name), [&](const Row& r) { return r.force[side](axis) / weight; });
  };
  auto joint = [&](const char* name, Eigen::Index j) {
    return correlation(name, rows, measured(*table, name), [&](const Row& r) { return r.joints(j) / mass; });
  };
  EXPECT_GT(plate("vertical_BW", Side::right, 1), 0.98);
  EXPECT_GT(plate("contra_vertical_BW", Side::left, 1), 0.98);
  EXPECT_GT(plate("foreaft_BW", Side::right, 2), 0.97);
  EXPECT_GT(plate("contra_foreaft_BW", Side::left, 2), 0.97);
  EXPECT_GT(joint("hip_extensor_Nm_kg", 0), 0.8);
  EXPECT_GT(joint("knee_extensor_Nm_kg", 1), 0.75);  // the centre of pressure is from the filmed motion
  EXPECT_GT(joint("ankle_plantarflexor_Nm_kg", 2), 0.945);
}

}  // namespace mobil::forces_measured_test
