// The modal kernels on random motions, compared with the closed form of each and with sums in double precision.
#include "systems/deformation/modal.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "assets/fem/muscle_template.h"
#include "tests/deformation/modal_block.h"
#include "tests/engine/instruction_sets.h"

namespace mobil::modal_test {
constexpr std::array far_ends = {FarEnd::held, FarEnd::sliding, FarEnd::free};

struct Kind {
  std::uint32_t modes;
  FarEnd end;
  bool frame;
};

/// Returns every far end with and without frame loads, and mode counts that fit registers well, badly or not at all.
std::vector<Kind> kinds() {
  std::vector<Kind> all;
  for (const FarEnd end : far_ends) {
    for (const bool frame : {false, true}) {
      for (const std::uint32_t modes : {1U, 5U, 12U, 32U}) all.push_back({modes, end, frame});
    }
  }
  return all;
}

/// Returns the largest difference of X and W of any motion from the closed form over `ticks` ticks, relative to the
/// maximum of either and of ṡ. (A motion with a whole number of periods a tick hardly moves.)
double distance_from_closed_form(ModalBodies& bodies, int ticks, double tick_s) {
  bodies.write_motion(tick_s);
  const std::size_t count = bodies.basis.modes;
  std::vector<ClosedForm> exact;
  for (std::size_t j = 0; j < count; ++j) {
    for (std::size_t l = 0; l < lane_count; ++l) exact.push_back({bodies.omega[j][l], bodies.damping});
  }
  std::vector<double> error(exact.size()), largest(exact.size(), 1e-30);
  ModalDrive drive(bodies, 5);
  for (int tick = 0; tick < ticks; ++tick) {
    drive.advance();
    bodies.tick(drive, tick_s);
    for (std::size_t j = 0; j < count; ++j) {
      for (std::size_t l = 0; l < lane_count; ++l) {
        const std::size_t at = j * lane_count + l;
        const double from = bodies.rest(drive.from, j, l), to = bodies.rest(drive.to, j, l);
        exact[at].step(from, to, tick_s);
        const double x = exact[at].omega * (exact[at].z - to), w = exact[at].speed;
        const auto kept = bodies.kept(j, l);
        error[at] = std::max({error[at], std::abs(kept[0] - x), std::abs(kept[1] - w)});
        largest[at] = std::max({largest[at], std::abs(x), std::abs(w), std::abs(to - from) / tick_s});
      }
    }
  }
  double worst = 0;
  for (std::size_t at = 0; at < error.size(); ++at) worst = std::max(worst, error[at] / largest[at]);
  return worst;
}

TEST(Modal, EveryMotionMatchesItsClosedForm) {
  for (const Kind& kind : kinds()) {
    for (const double damping : {0.0, 8.0, 60.0, 900.0}) {  // the largest overdamps the slower motions
      ModalBodies bodies(kind.modes, kind.end, kind.frame, damping);
      ModalBodies finer(bodies);
      EXPECT_LT(distance_from_closed_form(bodies, 120, 1.0 / 60), 1e-4) << damping;
      EXPECT_LT(distance_from_closed_form(finer, 120, 1.0 / 240), 1e-4) << damping;
    }
  }
}

TEST(Modal, ControlPointsMatchSumsInDoublePrecision) {
  for (const Kind& kind : kinds()) {
    for (const Cells& cells : {Cells{2, 2, 8}, Cells{1, 1, 2}, Cells{2, 3, 4}}) {
      ModalBodies bodies(kind.modes, kind.end, kind.frame, 8, cells);
      bodies.fill(bodies.state, 11, 1);
      ModalDrive drive(bodies, 13);
      drive.advance();
      for (const bool at_rest : {false, true}) {
        bodies.place(drive, at_rest);
        for (std::size_t l = 0; l < lane_count; ++l) {
          const auto expected = bodies.expected_displacement(drive, l, at_rest);
          for (std::size_t i = 0; i < expected.size(); ++i) {
            ASSERT_NEAR(static_cast<double>(bodies.displacement[i][l]), expected[i].value, 1e-6 * expected[i].terms)
                << "component " << i << " lane " << l;
          }
        }
      }
    }
  }
}

TEST(Modal, BellyWithoutItsOwnMotionIsInItsStaticShape) {
  for (const Kind& kind : kinds()) {
    ModalBodies moving(kind.modes, kind.end, kind.frame, 8), at_rest(moving);
    ModalDrive drive(moving, 29);
    drive.advance();
    moving.place(drive, false);
    at_rest.place(drive, true);
    EXPECT_TRUE(same_bits(moving.displacement, at_rest.displacement, lane_count));
  }
}

MuscleTemplate control_of(FarEnd end) {
  return *make_muscle_template(*make_block({2, 2, 8}, 0.015), Material{}, {.far_end = end});
}

std::vector<Lanes<float>> figures(const BellyReport<Lanes<float>>& report) {
  return {report.elongation_m, report.reaction_n, report.volume_ratio, report.kinetic_energy_j, report.strain_energy_j};
}

TEST(Modal, ReportsHaveTheSameBitsEverywhereAndKeepNanInItsLane) {
  for (const Kind& kind : kinds()) {
    const MuscleTemplate control = control_of(kind.end);
    constexpr std::size_t sick = 6;
    std::vector<std::vector<Lanes<float>>> results;
    const auto run = [&](bool dirty) {
      ModalBodies bodies(kind.modes, kind.end, kind.frame, 8);
      bodies.write_motion(1.0 / 60);
      ModalDrive drive(bodies, 47);
      drive.advance();
      bodies.tick(drive, 1.0 / 60);
      if (dirty) bodies.state.front()[sick] = std::numeric_limits<float>::quiet_NaN();
      bodies.place(drive, false);
      results.push_back(figures(bodies.report(drive, control, 1.0 / 60)));
    };
    for_each_fused_instruction_set([&] { run(false); });
    run(true);
    for (const auto& result : results) EXPECT_TRUE(same_bits(result, results.front(), sick));
    EXPECT_FALSE(std::isfinite(results.back()[4][sick]));
  }
}

TEST(Modal, BellyAtRestHasItsVolumeAndNoEnergy) {
  for (const Kind& kind : kinds()) {
    ModalBodies bodies(kind.modes, kind.end, kind.frame, 8);
    bodies.write_motion(1.0 / 60);
    const ModalDrive still(bodies, 1);
    bodies.place(still, false);
    const auto report = bodies.report(still, control_of(kind.end), 1.0 / 60);
    for (std::size_t l = 0; l < lane_count; ++l) {
      EXPECT_NEAR(static_cast<double>(report.volume_ratio[l]), 1, 1e-5);
      for (const auto& figure :
           {report.elongation_m, report.reaction_n, report.kinetic_energy_j, report.strain_energy_j}) {
        EXPECT_EQ(figure[l], 0.0F);
      }
    }
  }
}

}  // namespace mobil::modal_test
