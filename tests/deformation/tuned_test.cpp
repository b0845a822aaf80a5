// Tuned kernels on random motions, compared with the closed form of each, with a different activation in each lane and
// tick.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "tests/deformation/modal_block.h"

namespace mobil::tuned_test {
namespace {

constexpr std::array far_ends = {FarEnd::held, FarEnd::sliding, FarEnd::free};

/// Bellies whose motions are stiffened by tension up to a factor of five.
struct TunedBodies : ModalBodies {
  std::array<std::array<double, lane_count>, max_modes> tension{};
  Lanes<float> activation{};
  std::mt19937 random{107};

  TunedBodies(std::uint32_t modes, FarEnd end, bool frame) : ModalBodies(modes, end, frame, 0) {
    write_motion(1.0 / 60);
    std::uniform_real_distribution<double> share(0, 5);
    const std::size_t width = motion.size() / modes;
    for (std::size_t j = 0; j < modes; ++j) {
      for (std::size_t l = 0; l < lane_count; ++l) {
        const double square = omega[j][l] * omega[j][l];
        tension[j][l] = share(random) * square;
        motion[j * width][l] = static_cast<float>(1 / omega[j][l]);
        motion[j * width + 1][l] = static_cast<float>(square - tuned_activation * tension[j][l]);
        motion[j * width + 2][l] = static_cast<float>(tension[j][l]);
      }
    }
    for (float& a : activation.lane) a = 0.3F;
  }

  void excite() {
    std::uniform_real_distribution<float> any(0.01F, 1);
    for (float& a : activation.lane) a = any(random);
  }

  std::uint32_t tick_tuned(const ModalDrive& drive, double tick_s) {
    std::uint32_t restarted = 0;
    drive.give([&](const FarFaceDrive& end, const FrameLoad<Lanes<float>>& frame) {
      restarted = deform_tuned(block(frame), end, activation, static_cast<float>(tick_s));
    });
    return restarted;
  }

  double square(std::size_t j, std::size_t l) const {
    return omega[j][l] * omega[j][l] + (double{activation[l]} - tuned_activation) * tension[j][l];
  }

  /// Returns the kernel's damping, which overdamps no motion of a lane.
  double damping_of(std::size_t l) const {
    double least = square(0, l);
    for (std::size_t j = 1; j < basis.modes; ++j) least = std::min(least, square(j, l));
    return std::min(tuned_damping_per_s(double{activation[l]}), 1.9 * std::sqrt(least));
  }

  /// Returns the part of s from the ends, or from the frame.
  double part(const Columns& inputs, std::size_t j, std::size_t l, bool frame) const {
    if (basis.inputs == 1) return frame ? 0 : double{inputs[0][l]};
    const std::size_t ends = input_count(basis.options.far_end, false);
    double s = 0;
    for (std::size_t i = frame ? ends : 0; i < (frame ? basis.inputs : ends); ++i)
      s += participation[j][i][l] * double{inputs[i][l]};
    return s;
  }
};

TEST(Tuned, EveryMotionMatchesItsClosedFormAtAnyActivation) {
  for (const FarEnd end : far_ends) {
    for (const bool frame : {false, true}) {
      for (const std::uint32_t modes : {1U, 5U, 12U, 32U}) {
        TunedBodies bodies(modes, end, frame);
        std::vector<ClosedForm> exact(modes * lane_count, {1, 1});
        std::vector<double> error(exact.size()), largest(exact.size(), 1e-30);
        ModalDrive drive(bodies, 5);
        constexpr double tick_s = 1.0 / 60;
        for (int tick = 0; tick < 120; ++tick) {
          drive.advance();
          bodies.excite();
          bodies.tick_tuned(drive, tick_s);
          for (std::size_t j = 0; j < modes; ++j) {
            for (std::size_t l = 0; l < lane_count; ++l) {
              ClosedForm& z = exact[j * lane_count + l];
              const double own = bodies.omega[j][l], square = bodies.square(j, l), give = own * own / square;
              const auto rest = [&](const Columns& inputs) {
                return bodies.part(inputs, j, l, false) + give * bodies.part(inputs, j, l, true);
              };
              z.omega = std::sqrt(square);
              z.damping = bodies.damping_of(l);
              z.step(rest(drive.from), rest(drive.to), tick_s);
              const double untuned = bodies.part(drive.to, j, l, false) + bodies.part(drive.to, j, l, true);
              const double moved = rest(drive.to) - rest(drive.from);
              const double x = own * (z.z - untuned);
              const auto kept = bodies.kept(j, l);
              double& worst = error[j * lane_count + l];
              worst = std::max({worst, std::abs(kept[0] - x), std::abs(kept[1] - z.speed)});
              double& most = largest[j * lane_count + l];
              most = std::max({most, std::abs(x), std::abs(z.speed), std::abs(moved) / tick_s});
            }
          }
        }
        for (std::size_t at = 0; at < error.size(); ++at) EXPECT_LT(error[at] / largest[at], 2e-4) << at;
      }
    }
  }
}

/// At the activation that a belly's modes are computed for, tension adds no stiffness: it moves as untuned, with equal
/// damping.
TEST(Tuned, AtItsModesActivationItMovesAsUntuned) {
  TunedBodies tuned(12, FarEnd::held, true);
  for (float& a : tuned.activation.lane) a = static_cast<float>(tuned_activation);
  ModalBodies plain(12, FarEnd::held, true, tuned_damping_per_s(tuned_activation));
  plain.write_motion(1.0 / 60);
  ModalDrive drive(plain, 9);
  for (int tick = 0; tick < 120; ++tick) {
    drive.advance();
    plain.tick(drive, 1.0 / 60);
    tuned.tick_tuned(drive, 1.0 / 60);
  }
  double off = 0, most = 0;
  for (std::size_t i = 0; i < plain.state.size(); ++i) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      off = std::max(off, std::abs(double{plain.state[i][l]} - double{tuned.state[i][l]}));
      most = std::max(most, std::abs(double{plain.state[i][l]}));
    }
  }
  EXPECT_LT(off, 1e-4 * most);
}

}  // namespace
}  // namespace mobil::tuned_test
