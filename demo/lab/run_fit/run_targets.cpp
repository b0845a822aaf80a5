#include "demo/lab/run_fit/run_targets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

#include <mobil/assets/files/csv_table.h>
#include <mobil/components/body.h>
#include "demo/lab/compare/compare_reference.h"
#include "demo/lab/compare/reference_tables.h"
#include "demo/program/must.h"

namespace mobil {
namespace {

constexpr double slower = 2.5, faster = 4.5;  // m/s, measured and fitted
constexpr double radian = std::numbers::pi / 180;

/// Columns of a quantity.
struct RunColumn {
  std::string_view file, mean, sd;
};
constexpr std::array<RunColumn, run_quantity_count> run_columns = {
    {{"angles", "hip_flexion_deg", "hip_flexion_sd"},
     {"angles", "knee_flexion_deg", "knee_flexion_sd"},
     {"angles", "ankle_dorsiflexion_deg", "ankle_dorsiflexion_sd"},
     {"angles", "foot_pitch_deg", "foot_pitch_sd"},
     {"grf", "vertical_BW", "vertical_sd"},
     {"grf", "foreaft_BW", "foreaft_sd"},
     {"moments", "hip_extensor_Nm_kg", "hip_moment_sd"},
     {"moments", "knee_extensor_Nm_kg", "knee_moment_sd"},
     {"moments", "ankle_plantarflexor_Nm_kg", "ankle_moment_sd"},
     {"hip_height", "hip_height_per_leg", "hip_height_sd"},
     {"angles", "pelvis_tilt_deg", "pelvis_tilt_sd"},
     {"angles", "pelvis_rotation_deg", "pelvis_rotation_sd"},
     {"angles", "pelvis_list_deg", "pelvis_list_sd"}}};

CsvTable run_csv(std::string_view file, std::span<const std::string_view> required) {
  const std::string name = fmt::format("fukuchi2017_running_{}.csv", file);
  for (const ReferenceTable& table : reference_tables()) {
    if (table.name == name) return must(parse_csv(table.text, name, required));
  }
  throw Stopped(name + " is missing in the program");
}

double run_cell(const CsvTable& table, std::size_t row, std::string_view column) {
  if (const auto read = number(number_cell(table, row, column))) return *read;
  throw Stopped(fmt::format("{}:{}: {} is not a number", table.path, table.line[row], column));
}

bool is_force_or_moment(std::size_t quantity) {
  return quantity >= index(RunQuantity::vertical) && quantity <= index(RunQuantity::ankle_moment);
}

/// Arms of two men: mean, cosines, sines of two harmonics of the cycle, rad. Computed from data of Hamner and Delp 2013
/// (2.0 m/s) and of Hamner, Seth and Delp 2010 (3.96 m/s).
struct RunArms {
  double speed_m_s;
  std::array<double, 5> shoulder, elbow;
};
constexpr RunArms slow_arms = {
    2.0, {-0.48986, -0.17130, -0.06663, 0.14986, 0.04357}, {1.87565, -0.08097, 0.13215, 0.08860, -0.15899}};
constexpr RunArms fast_arms = {
    3.96, {-0.31776, -0.22092, -0.08186, 0.15727, 0.08131}, {1.53187, -0.25752, 0.10238, 0.22626, -0.15297}};
constexpr double most_of_arms = 1.6;  // of the way from the slower to the faster man

/// Returns the mean, or a harmonic's cosine and sine, of a curve at equal intervals of the cycle.
std::pair<double, double> run_harmonic(const std::vector<double>& curve, int harmonic) {
  double cosine = 0, sine = 0;
  const auto n = static_cast<double>(curve.size());
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const double angle = 2 * std::numbers::pi * harmonic * static_cast<double>(i) / n;
    cosine += curve[i] * std::cos(angle);
    sine += curve[i] * std::sin(angle);
  }
  const double times = (harmonic == 0 ? 1 : 2) / n;
  return {times * cosine, times * sine};
}

double point_at(const std::array<double, run_points>& curve, double percent) {
  const auto k = std::min(static_cast<std::size_t>(percent), run_points - 2);
  return std::lerp(curve[k], curve[k + 1], percent - static_cast<double>(k));
}

/// Both speeds, read once.
struct BothSpeeds {
  RunMeasured at[2] = {run_measured(slower), run_measured(faster)};
  double duty[2] = {run_figure(slower, "duty_factor").mean, run_figure(faster, "duty_factor").mean};
  double frequency[2] = {run_figure(slower, "step_frequency_hz").mean, run_figure(faster, "step_frequency_hz").mean};
  double rise[2] = {run_figure(slower, "com_vertical_excursion_m").mean,
                    run_figure(faster, "com_vertical_excursion_m").mean};
};

RunGiven run_given_of(const RunTargets& targets, double leg_m) {
  RunGiven given{};
  given.frequency = targets.frequency_hz * std::sqrt(leg_m / gravity_m_s2);
  given.duty = targets.duty;
  const auto set = [&](RunQuantity quantity, std::initializer_list<int> harmonics, std::span<double> to) {
    std::vector<double> curve = targets.curve[index(quantity)].mean;
    for (double& angle : curve) angle *= radian;
    std::size_t k = 0;
    for (const int harmonic : harmonics) {
      const auto [cosine, sine] = run_harmonic(curve, harmonic);
      const std::size_t sine_at = to.size() / 2 + k;  // past the cosines, the mean included where there is one
      to[k] = cosine;
      if (harmonic != 0) to[sine_at] = sine;
      ++k;
    }
  };
  set(RunQuantity::pelvis_tilt, {0, 2, 4}, given.tilt);
  set(RunQuantity::pelvis_turn, {1, 3}, given.turn);
  set(RunQuantity::pelvis_list, {1, 3}, given.list);
  const double part = std::clamp(
      (targets.speed_m_s - slow_arms.speed_m_s) / (fast_arms.speed_m_s - slow_arms.speed_m_s), 0.0, most_of_arms);
  for (std::size_t i = 0; i < given.shoulder.size(); ++i) {
    given.shoulder[i] = std::lerp(slow_arms.shoulder[i], fast_arms.shoulder[i], part);
    given.elbow[i] = std::lerp(slow_arms.elbow[i], fast_arms.elbow[i], part);
  }
  return given;
}

}  // namespace

RunFigure run_figure(double speed_m_s, std::string_view quantity) {
  static constexpr std::array<std::string_view, 4> columns = {"speed_m_s", "quantity", "mean", "sd"};
  const CsvTable table = run_csv("spatiotemporal", columns);
  for (std::size_t r = 0; r < table.row.size(); ++r) {
    if (run_cell(table, r, "speed_m_s") == speed_m_s && cell(table, r, "quantity") == quantity)
      return {run_cell(table, r, "mean"), number(number_cell(table, r, "sd"))};
  }
  throw Stopped(fmt::format("{}: no {} at {:g} m/s", table.path, quantity, speed_m_s));
}

RunMeasured run_measured(double speed_m_s) {
  RunMeasured measured{speed_m_s, {}};
  const double carried = run_figure(speed_m_s, "mean_vertical_force_BW").mean;
  for (std::size_t q = 0; q < run_quantity_count; ++q) {
    const RunColumn& column = run_columns[q];
    const std::array<std::string_view, 4> required = {"speed_m_s", "percent_gait", column.mean, column.sd};
    const CsvTable table = run_csv(column.file, required);
    const double times = is_force_or_moment(q) ? 1 / carried : 1;
    std::size_t count = 0;
    for (std::size_t r = 0; r < table.row.size(); ++r) {
      if (run_cell(table, r, "speed_m_s") != speed_m_s) continue;
      if (count == run_points || run_cell(table, r, "percent_gait") != static_cast<double>(count)) break;
      measured.curve[q].mean[count] = times * run_cell(table, r, column.mean);
      measured.curve[q].sd[count++] = times * run_cell(table, r, column.sd);
    }
    if (count != run_points)
      throw Stopped(fmt::format("{}: {:g} m/s needs the {} rows of percent_gait 0, 1, … 100 in order", table.path,
                                speed_m_s, run_points));
  }
  return measured;
}

RunTargets run_targets(double speed_m_s, double leg_m, double times, std::size_t samples) {
  static const BothSpeeds both;
  const double part = (speed_m_s - slower) / (faster - slower);
  const auto mixed = [&](double a, double b) { return (1 - part) * a + part * b; };
  RunTargets targets{};
  targets.speed_m_s = speed_m_s;
  targets.times = times;
  targets.frequency_hz = mixed(both.frequency[0], both.frequency[1]);
  targets.duty = 1 / mixed(1 / both.duty[0], 1 / both.duty[1]);
  constexpr double rise_sd_m = 0.012, least_rise_m = 0.05, least_sd = 0.3;
  const double rise = mixed(both.rise[0], both.rise[1]), grown = times * times, spare = times == 1 ? 0 : 0.05;
  targets.min_rise_m = grown * (1 - spare) * std::max(rise - 0.5 * rise_sd_m, least_rise_m);
  targets.max_rise_m = grown * (1 + spare) * (rise + rise_sd_m);
  for (std::size_t q = 0; q < run_quantity_count; ++q) {
    RunTarget& target = targets.curve[q];
    target.mean.resize(samples);
    target.sd.resize(samples);
    for (std::size_t i = 0; i < samples; ++i) {
      const double phase = static_cast<double>(i) / static_cast<double>(samples);
      double mean[2], sd[2];
      for (std::size_t k = 0; k < 2; ++k) {
        const double own = both.duty[k], duty = targets.duty;
        const double at = 100 * (phase < duty ? phase / duty * own : own + (phase - duty) / (1 - duty) * (1 - own));
        mean[k] = point_at(both.at[k].curve[q].mean, at);
        sd[k] = point_at(both.at[k].curve[q].sd, at);
      }
      target.mean[i] = mixed(mean[0], mean[1]);
      target.sd[i] = std::max(mixed(sd[0], sd[1]), least_sd * sd[0]);
    }
  }
  std::vector<double>& vertical = targets.curve[index(RunQuantity::vertical)].mean;
  const double carried = 2 * std::accumulate(vertical.begin(), vertical.end(), 0.0) / static_cast<double>(samples);
  for (double& force : vertical) force /= carried;
  targets.given = run_given_of(targets, leg_m);
  targets.frequency_hz /= times;
  return targets;
}

}  // namespace mobil
