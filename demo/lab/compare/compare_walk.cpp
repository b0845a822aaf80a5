#include "demo/lab/compare/compare_walk.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <mobil/components/pose.h>
#include <mobil/forces.h>
#include <mobil/simulation.h>
#include "demo/lab/compare/steady_cycle.h"

namespace mobil {
namespace {

constexpr double degrees = 180 / std::numbers::pi;
constexpr double tick_s = 1.0 / 240;

/// What a tick leaves behind.
struct TickRows {
  std::vector<double> phase;  // cycles since the end of the settling
  std::vector<double> hip, tilt, knee, ankle, com;
  std::vector<double> vertical, fore_aft, hip_moment, knee_moment, ankle_moment, both_feet;
};

double value(float v) {
  return static_cast<double>(v);
}

void add_motion(const Simulation& simulation, Entity entity, TickRows& rows) {
  const auto angles = *simulation.get<JointAngles>(entity);
  rows.hip.push_back(degrees * value(angles.hip_flexion[Side::right]));
  rows.tilt.push_back(degrees * value(angles.pelvis_tilt));
  rows.knee.push_back(degrees * value(angles.knee_flexion[Side::right]));
  rows.ankle.push_back(degrees * value(angles.ankle_dorsiflexion[Side::right]));
  rows.com.push_back(value(simulation.get<CentreOfMass>(entity)->position_m.y));
}

/// False where forces are not simulated.
bool add_forces(const Simulation& simulation, Entity entity, double mass_kg, TickRows& rows) {
  const auto ground = simulation.get<GroundReaction>(entity);
  const auto moments = simulation.get<JointMoments>(entity);
  if (!ground || !moments) return false;
  const double weight = mass_kg * gravity_m_s2;
  rows.vertical.push_back(value(ground->force_n[Side::right].y) / weight);
  rows.fore_aft.push_back(value(ground->force_n[Side::right].z) / weight);  // walking toward +z
  rows.both_feet.push_back(value(ground->force_n[Side::right].y + ground->force_n[Side::left].y) / weight);
  rows.hip_moment.push_back(value(moments->hip_nm[Side::right]) / mass_kg);
  rows.knee_moment.push_back(value(moments->knee_nm[Side::right]) / mass_kg);
  rows.ankle_moment.push_back(value(moments->ankle_nm[Side::right]) / mass_kg);
  return true;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

StrideForces sample_forces(const TickRows& rows) {
  const std::vector<double>& phase = rows.phase;
  const auto sample = [&](const std::vector<double>& values) { return sample_cycle(phase, values); };
  std::vector<double> within;
  for (std::size_t i = 0; i < phase.size(); ++i) {
    if (phase[i] >= 0 && phase[i] < 1) within.push_back(rows.both_feet[i]);
  }
  return {sample(rows.vertical),    sample(rows.fore_aft),     sample(rows.hip_moment),
          sample(rows.knee_moment), sample(rows.ankle_moment), mean(within)};
}

WalkedStride sample_stride(const Human& human, const TickRows& rows, bool with_forces) {
  WalkedStride stride{};
  stride.height_m = value(human.body.request.height_m);
  stride.leg_m = value(human.body.hip_height_m);
  stride.speed_m_s = value(human.gait.speed_m_s);
  stride.step_length_m = value(human.gait.step_length_m);
  stride.step_frequency_hz = value(human.gait.step_frequency_hz);
  stride.double_support_cycle = value(human.gait.double_support_cycle);
  const auto sample = [&](const std::vector<double>& values) { return sample_cycle(rows.phase, values); };
  stride.hip_from_pelvis = sample(rows.hip);
  const CycleCurve tilt = sample(rows.tilt);
  for (std::size_t i = 0; i < cycle_points; ++i) stride.hip_from_vertical[i] = stride.hip_from_pelvis[i] - tilt[i];
  stride.knee = sample(rows.knee);
  stride.ankle = sample(rows.ankle);
  stride.com_height = sample(rows.com);
  const auto [low, high] = std::ranges::minmax_element(rows.com);
  stride.com_mean_m = mean({stride.com_height.begin(), stride.com_height.end() - 1});
  stride.com_lowest_m = *low;
  stride.com_highest_m = *high;
  const auto percent = [&](auto at) {
    return 100 * std::fmod(rows.phase[static_cast<std::size_t>(at - rows.com.begin())] + 1, 0.5);
  };
  stride.com_lowest_percent = percent(low);
  stride.com_highest_percent = percent(high);
  if (with_forces) stride.forces = sample_forces(rows);
  return stride;
}

}  // namespace

const CycleCurve* WalkedStride::curve(GaitQuantity quantity, bool from_vertical) const {
  switch (quantity) {
    case GaitQuantity::hip:
      return from_vertical ? &hip_from_vertical : &hip_from_pelvis;
    case GaitQuantity::knee:
      return &knee;
    case GaitQuantity::ankle:
      return &ankle;
    default:
      break;
  }
  if (!forces) return nullptr;
  switch (quantity) {
    case GaitQuantity::vertical:
      return &forces->vertical;
    case GaitQuantity::fore_aft:
      return &forces->fore_aft;
    case GaitQuantity::hip_moment:
      return &forces->hip_moment;
    case GaitQuantity::knee_moment:
      return &forces->knee_moment;
    default:
      return &forces->ankle_moment;
  }
}

CycleCurve sample_cycle(const std::vector<double>& phase, const std::vector<double>& value) {
  CycleCurve curve{};
  for (std::size_t i = 0; i < cycle_points; ++i) {
    const double wanted = static_cast<double>(i) / (cycle_points - 1);
    const auto after = std::ranges::lower_bound(phase, wanted);
    const auto k = std::clamp<std::size_t>(static_cast<std::size_t>(after - phase.begin()), 1, phase.size() - 1);
    const double t = (wanted - phase[k - 1]) / (phase[k] - phase[k - 1]);
    curve[i] = value[k - 1] + t * (value[k] - value[k - 1]);
  }
  return curve;
}

Result<WalkedStride> walk_stride(const BodyRequest& body, const GaitRequest& gait) {
  SimulationOptions options;
  options.tick_s = tick_s;
  Simulation simulation(options);
  const auto entity = simulation.spawn(body, gait);
  if (!entity) return tl::unexpected(entity.error());
  simulation.add_forces(*entity);

  TickRows rows;
  bool with_forces = true;
  const auto walked = over_steady_cycle(simulation, *entity, [&](double phase) {
    rows.phase.push_back(phase);
    with_forces = with_forces && add_forces(simulation, *entity, static_cast<double>(body.mass_kg), rows);
    add_motion(simulation, *entity, rows);
  });
  if (!walked) return tl::unexpected(walked.error());
  return sample_stride(*simulation.human(*entity), rows, with_forces);
}

}  // namespace mobil
