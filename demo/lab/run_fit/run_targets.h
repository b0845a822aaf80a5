#pragma once
// Measured running, to which running steps are fitted: curves at two speeds, straight lines between and beyond them.

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "assets/gait/run_table.h"

namespace mobil {

/// Quantities over the cycle from a leg's contact. Angles are in degrees: flexion, dorsiflexion and toes up positive,
/// the hip from the tilted pelvis. Ground reactions are of one foot, in body weights; moments of extensors and
/// plantarflexors, N m/kg. The height of the hips is less its mean, over the leg's length.
enum class RunQuantity {
  hip,
  knee,
  ankle,
  foot_pitch,
  vertical,
  fore_aft,
  hip_moment,
  knee_moment,
  ankle_moment,
  hip_height,
  pelvis_tilt,
  pelvis_turn,
  pelvis_list
};
inline constexpr std::size_t run_quantity_count = 13;
/// Number of quantities with which a fitted step is compared; the others are given or follow.
inline constexpr std::size_t run_compared_count = 9;
constexpr std::size_t index(RunQuantity quantity) {
  return static_cast<std::size_t>(quantity);
}

/// Number of points of a measured curve, every 1 % from contact to the next contact.
inline constexpr std::size_t run_points = 101;

/// Mean and standard deviation between people.
struct RunCurve {
  std::array<double, run_points> mean{}, sd{};
};

/// A mean over people, with its deviation if that is known.
struct RunFigure {
  double mean;
  std::optional<double> sd;
};

/// People measured at one speed. Forces and moments are over the mean vertical force, because a steady run carries its
/// weight and force plates under a belt read less.
struct RunMeasured {
  double speed_m_s;
  std::array<RunCurve, run_quantity_count> curve;
};

/// Returns the measured curves of a speed that has them (2.5 or 4.5 m/s).
RunMeasured run_measured(double speed_m_s);

/// Returns a figure of fukuchi2017_running_spatiotemporal.csv at 2.5, 3.5 or 4.5 m/s.
RunFigure run_figure(double speed_m_s, std::string_view quantity);

/// Mean and deviation at equal intervals of the cycle.
struct RunTarget {
  std::vector<double> mean, sd;
};

/// Aims of a step of a man whose legs have the scale `fitted_height_m`.
struct RunTargets {
  double speed_m_s, frequency_hz, duty;
  double times;  // step length over the usual one
  std::array<RunTarget, run_quantity_count> curve;
  RunGiven given;
  double min_rise_m, max_rise_m;  // of the centre of mass
};

/// Number of intervals of the cycle in a fit.
inline constexpr std::size_t run_fit_samples = 200;

/// Returns aims at a speed: straight lines through both measured speeds, stance and swing each in its own time. With
/// `times` the usual step length, the frequency is lower by that factor; the rise grows with its square.
RunTargets run_targets(double speed_m_s, double leg_m, double times = 1, std::size_t samples = run_fit_samples);

}  // namespace mobil
