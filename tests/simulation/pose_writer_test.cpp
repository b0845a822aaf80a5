// Poses of any people in bulk, at any instant of a tick, in any host's layout.
#include <mobil/pose_writer.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include <mobil/components/pose.h>
#include <mobil/each.h>
#include <mobil/engine/jobs.h>
#include <mobil/engine/world.h>
#include <mobil/simulation.h>
#include "engine/eigen.h"
#include "tests/engine/counting_heap.h"
#include "tests/labels.h"

MOBIL_TEST_LABELS("threads");

namespace mobil::pose_writer_test {

using Rows = std::vector<float>;

Rows write(const World& world, std::span<const Entity> people, double ahead_s, const PoseLayout& layout = {},
           std::size_t floats = 7, const Jobs& jobs = {}) {
  const std::size_t segments = layout.segments.empty() ? segment_count : layout.segments.size();
  Rows out(people.size() * segments * floats, -7777.0F);
  PoseWriter writer;
  const auto done = writer.write(world, people, ahead_s, layout, {std::as_writable_bytes(std::span(out))}, jobs);
  EXPECT_TRUE(done) << done.error().message;
  return out;
}

/// Walkers who start, stop, turn, step aside and change speed, and some people animated by the host.
struct Scene {
  Simulation simulation;
  std::vector<Entity> people;
  std::mt19937 random{11};

  explicit Scene(double tick_s, std::size_t walkers = 37) : simulation({.tick_s = tick_s}) {
    for (std::size_t i = 0; i < walkers; ++i) {
      const auto part = static_cast<float>(i) / static_cast<float>(walkers);
      const BodyRequest body{.height_m = 1.5F + 0.5F * part, .mass_kg = 50 + 40 * part};
      people.push_back(i % 7 == 3 ? simulation.spawn_posed(body).value()
                                  : simulation.spawn(body, {.speed_m_s = i % 5 == 0 ? 0 : 0.8F + part}).value());
    }
  }
  void wish() {
    for (std::size_t i = 0; i < people.size(); ++i) {
      if (i % 7 == 3) continue;
      const auto dice = static_cast<float>(random() % 1000) / 1000;
      switch (random() % 4) {
        case 0:
          EXPECT_TRUE(simulation.turn_to(people[i], 6 * dice - 3));
          break;
        case 1:
          EXPECT_TRUE(simulation.change_gait(people[i], {.speed_m_s = 0.6F + dice}));
          break;
        case 2:
          EXPECT_TRUE(simulation.change_gait(people[i], {.speed_m_s = 0.0F}));
          break;
        default:
          simulation.step_aside(people[i], 0.2F * dice, 0);  // refused for walkers
      }
    }
  }
  void ticks(int count) {
    for (int i = 0; i < count; ++i) simulation.tick();
  }
};

TEST(PoseWriter, AfterATickWritesTheTablesPoses) {
  Scene scene(1.0 / 60);
  scene.ticks(50);
  std::vector<Entity> some = {scene.people[30], scene.people[3], scene.people[3], scene.people[0], scene.people[17]};
  const Rows rows = write(scene.simulation.world(), some, 0);
  for (std::size_t i = 0; i < some.size(); ++i) {
    const auto pose = *scene.simulation.get<Pose>(some[i]);
    for (std::size_t s = 0; s < segment_count; ++s) {
      const float* row = &rows[(i * segment_count + s) * 7];
      EXPECT_EQ(std::memcmp(row, &pose.position_m[s], 12), 0);
      EXPECT_EQ(std::memcmp(row + 3, &pose.rotation[s], 16), 0);
    }
  }
}

/// Interpolated coarse ticks equal fine ticks, for any requests, through strikes and turns.
TEST(PoseWriter, BetweenTicksMatchesFinerTicks) {
  constexpr int finer = 8;
  Scene coarse(1.0 / 60), fine(1.0 / (60 * finer));
  double furthest_m = 0, max_turned = 0;
  for (int t = 0; t < 400; ++t) {
    if (t % 40 == 10) {
      coarse.wish();
      fine.wish();
    }
    for (int i = 1; i <= finer; ++i) {
      fine.simulation.tick();
      if (t % 3 != 0 && i != 5) continue;
      if (i == finer) coarse.simulation.tick();
      const Rows at = write(coarse.simulation.world(), coarse.people, i == finer ? 0 : i / (60.0 * finer));
      const Rows is = write(fine.simulation.world(), fine.people, 0);
      for (std::size_t row = 0; row < at.size(); row += 7) {
        const Eigen::Map<const Eigen::Vector3f> a(&at[row]), b(&is[row]);
        const Eigen::Map<const Eigen::Vector4f> p(&at[row + 3]), q(&is[row + 3]);
        furthest_m = std::fmax(furthest_m, static_cast<double>((a - b).norm()));
        max_turned = std::fmax(max_turned, static_cast<double>(std::min((p - q).norm(), (p + q).norm())));
      }
    }
    if (t % 3 != 0) coarse.simulation.tick();
  }
  EXPECT_LT(furthest_m, 2e-4);
  EXPECT_LT(max_turned, 2e-3);
}

/// Compared with matrices in double precision: M R Mᵀ, M p.
TEST(PoseWriter, AxesUnitsAndFormsAreAsRequested) {
  Scene scene(1.0 / 60, 9);
  scene.ticks(70);
  struct Axes {
    PoseAxes axes;
    Eigen::Matrix3d ours_to_theirs;
  };
  auto rows = [](std::array<double, 9> m) {
    return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(m.data()).eval();
  };
  const Axes all[] = {{PoseAxes::y_up, Eigen::Matrix3d::Identity()},
                      {PoseAxes::y_up_left_handed, rows({-1, 0, 0, 0, 1, 0, 0, 0, 1})},
                      {PoseAxes::z_up, rows({0, 0, 1, 1, 0, 0, 0, 1, 0})},
                      {PoseAxes::z_up_left_handed, rows({0, 0, 1, -1, 0, 0, 0, 1, 0})},
                      {PoseAxes::y_up_z_back, rows({-1, 0, 0, 0, 1, 0, 0, 0, -1})}};
  const World& world = scene.simulation.world();
  for (const auto& [axes, m] : all) {
    for (const bool to_parent : {false, true}) {
      const PoseLayout layout{.axes = axes, .units_per_m = 100, .to_parent = to_parent};
      auto of = [&](PoseForm form, std::size_t floats) {
        PoseLayout other = layout;
        other.form = form;
        return write(world, scene.people, 0.007, other, floats);
      };
      const Rows plain = write(world, scene.people, 0.007);
      const Rows quaternions = of(PoseForm::place_and_quaternion, 7), matrices = of(PoseForm::matrix, 12),
                 duals = of(PoseForm::dual_quaternion, 8);
      for (std::size_t i = 0; i < scene.people.size(); ++i) {
        auto world_of = [&](std::size_t s) {
          const float* row = &plain[(i * segment_count + s) * 7];
          Eigen::Isometry3d at = Eigen::Isometry3d::Identity();
          at.linear() = Eigen::Quaterniond(row[6], row[3], row[4], row[5]).toRotationMatrix();
          at.translation() = Eigen::Vector3d(row[0], row[1], row[2]);
          return at;
        };
        for (std::size_t s = 0; s < segment_count; ++s) {
          Eigen::Isometry3d at = world_of(s);
          const std::size_t parent = index(segment_parent[s]);
          if (to_parent && parent != s) at = world_of(parent).inverse() * at;
          const Eigen::Matrix3d turn = m * at.linear() * m.transpose();
          const Eigen::Vector3d place = 100 * m * at.translation();
          const std::size_t k = i * segment_count + s;
          const float* q = &quaternions[7 * k];
          const Eigen::Quaterniond quaternion(q[6], q[3], q[4], q[5]);
          EXPECT_LT((quaternion.toRotationMatrix() - turn).norm(), 1e-5);
          EXPECT_LT((Eigen::Vector3d(q[0], q[1], q[2]) - place).norm(), 2e-3);
          const Eigen::Map<const Eigen::Matrix<float, 3, 4, Eigen::RowMajor>> matrix(&matrices[12 * k]);
          EXPECT_LT((matrix.leftCols<3>().cast<double>() - turn).norm(), 1e-5);
          EXPECT_LT((matrix.col(3).cast<double>() - place).norm(), 2e-3);
          const float* d = &duals[8 * k];
          const Eigen::Quaterniond real(d[3], d[0], d[1], d[2]), dual(d[7], d[4], d[5], d[6]);
          const Eigen::Quaterniond moved = dual * real.conjugate();
          EXPECT_LT((real.toRotationMatrix() - turn).norm(), 1e-5);
          EXPECT_LT((2 * moved.vec() - place).norm(), 2e-3);
        }
      }
    }
  }
}

TEST(PoseWriter, WritesChosenSegmentsAtTheirStridesAndNothingElse) {
  Scene scene(1.0 / 60, 5);
  scene.ticks(20);
  const std::array segments = {Segment::head, Segment::foot_left, Segment::head};
  constexpr std::size_t person_stride = 301, segment_stride = 40, before = 3;
  std::vector<std::byte> out(before + 5 * person_stride, std::byte{0xAB});
  PoseWriter writer;
  ASSERT_TRUE(writer.write(scene.simulation.world(), scene.people, 0, {.segments = segments},
                           {std::span(out).subspan(before), person_stride, segment_stride}));
  std::vector<std::byte> expected(out.size(), std::byte{0xAB});
  for (std::size_t i = 0; i < scene.people.size(); ++i) {
    const auto pose = *scene.simulation.get<Pose>(scene.people[i]);
    for (std::size_t k = 0; k < segments.size(); ++k) {
      std::byte* at = &expected[before + i * person_stride + k * segment_stride];
      std::memcpy(at, &pose.position_m[index(segments[k])], 12);
      std::memcpy(at + 12, &pose.rotation[index(segments[k])], 16);
    }
  }
  EXPECT_EQ(out, expected);
}

TEST(PoseWriter, ThreadedWritesMatchTheWorld) {
  Scene scene(1.0 / 60, 100);
  scene.ticks(33);
  const std::uint64_t before = scene.simulation.state_hash();
  const Threads threads(2);
  const Rows one = write(scene.simulation.world(), scene.people, 0.011),
             two = write(scene.simulation.world(), scene.people, 0.011, {}, 7, threads.jobs());
  EXPECT_EQ(std::memcmp(one.data(), two.data(), one.size() * sizeof(float)), 0);
  EXPECT_EQ(scene.simulation.state_hash(), before);
}

TEST(PoseWriter, AllocatesNothingForKnownCounts) {
  Scene scene(1.0 / 60);
  PoseWriter writer;
  Rows out(scene.people.size() * segment_count * 7);
  const PoseTarget target{std::as_writable_bytes(std::span(out))};
  scene.ticks(2);
  ASSERT_TRUE(writer.write(scene.simulation.world(), scene.people, 0.01, {}, target));
  const std::size_t before = heap_requests;
  for (int i = 0; i < 30; ++i) {
    scene.simulation.tick();
    ASSERT_TRUE(writer.write(scene.simulation.world(), scene.people, 0.01, {}, target));
  }
  EXPECT_EQ(heap_requests, before);
}

TEST(PoseWriter, BadRequestsAreRefusedBeforeAnythingIsWritten) {
  Scene scene(1.0 / 60, 4);
  Rows out(4 * segment_count * 7, 5.0F);
  const Rows untouched = out;
  const auto bytes = std::as_writable_bytes(std::span(out));
  PoseWriter writer;
  auto complaint = [&](std::span<const Entity> people, double ahead_s, const PoseLayout& layout,
                       const PoseTarget& target) {
    const auto done = writer.write(scene.simulation.world(), people, ahead_s, layout, target);
    EXPECT_EQ(out, untouched);
    return done ? std::string() : done.error().message;
  };
  auto people = scene.people;
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double ahead_s : {-1e-9, 0.3, nan})
    EXPECT_NE(complaint(people, ahead_s, {}, {bytes}).find("0 to 0.2"), std::string::npos);
  for (const float units : {0.0F, static_cast<float>(nan), 1e9F})
    EXPECT_NE(complaint(people, 0, {.units_per_m = units}, {bytes}).find("units a metre"), std::string::npos);
  const std::array none = {static_cast<Segment>(99)};
  EXPECT_NE(complaint(people, 0, {.segments = none}, {bytes}).find("segment number 99"), std::string::npos);
  EXPECT_NE(complaint(people, 0, {}, {bytes, 0, 27}).find("at least 28"), std::string::npos);
  EXPECT_NE(complaint(people, 0, {}, {bytes.first(bytes.size() - 1)}).find("are needed"), std::string::npos);
  EXPECT_NE(complaint(people, 0, {.form = PoseForm::matrix}, {bytes}).find("are needed"), std::string::npos);
  ASSERT_EQ(scene.simulation.despawn(people[2]), Status::ok);
  EXPECT_NE(complaint(people, 0, {}, {bytes}).find("person 2 of the list"), std::string::npos);
  EXPECT_EQ(complaint({}, 0, {}, {}), "");
}

}  // namespace mobil::pose_writer_test
