#include "demo/lab/compare/compare_walk.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include <mobil/engine/geometry.h>
#include <mobil/systems/gait/resolve_gait.h>
#include <mobil/systems/muscles/person.h>
#include "assets/body/segment_inertia.h"
#include "demo/program/must.h"

namespace mobil {
namespace {

using namespace geometry;

constexpr double scene_tick_s = 1.0 / 240;

/// Returns the rotation vector per second from one attitude to the next, world axes.
Vec turning(const Quat<double>& before, const Quat<double>& after, double span_s) {
  Quat<double> q = product(after, conjugate(before));
  if (q.w < 0) q = {-q.x, -q.y, -q.z, -q.w};
  const Vec axis{q.x, q.y, q.z};
  const double sine = length(axis);
  return sine < 1e-12 ? (2 / span_s) * axis : (2 * std::atan2(sine, q.w) / (sine * span_s)) * axis;
}

Quat<double> halfway(const Quat<double>& a, const Quat<double>& b) {
  const double sign = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w < 0 ? -1 : 1;
  const Quat<double> q{a.x + sign * b.x, a.y + sign * b.y, a.z + sign * b.z, a.w + sign * b.w};
  const double size = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  return {q.x / size, q.y / size, q.z / size, q.w / size};
}

/// A person's requests while energy is measured.
struct Request {
  double after_s;
  double speed_m_s;
  double heading_deg = 0;
  double left_m = 0, ahead_m = 0;  // a step of a standing person
};

struct Scene {
  std::string_view name;
  std::vector<Request> requests;  // the first applies from the start; each until the next
  double seconds;
  float step_asymmetry = 0, time_asymmetry = 0;
};

/// Walks a scene. Its speeds and distances are those of a man of 1.75 m, and scale with the leg.
UnbalancedMoment walk_scene(const BodyRequest& body, GaitStyle style, const Scene& scene) {
  const double size = leg_ratio(body);
  style.step_asymmetry += scene.step_asymmetry;
  style.time_asymmetry += scene.time_asymmetry;
  SimulationOptions options;
  options.tick_s = scene_tick_s;
  Simulation simulation(options);
  const auto asked = [&](const Request& request) {
    GaitRequest gait;
    gait.speed_m_s = static_cast<float>(std::sqrt(size) * request.speed_m_s);
    gait.style = style;
    return barefoot(body, gait);
  };
  const auto person = must(simulation.spawn(body, asked(scene.requests.front())));
  simulation.enable(person, Feature::forces);
  BalanceMeter meter(simulation.person(person)->body);
  std::size_t next = 1;
  while (simulation.time_s() < scene.seconds) {
    if (next < scene.requests.size() && simulation.time_s() >= scene.requests[next].after_s) {
      const Request& request = scene.requests[next++];
      must(simulation.set_gait(person, asked(request)));
      const double heading = request.heading_deg * std::numbers::pi / 180;
      must(simulation.turn_to(person, static_cast<float>(heading)));
      const auto left_m = static_cast<float>(size * request.left_m),
                 ahead_m = static_cast<float>(size * request.ahead_m);
      if (left_m != 0 || ahead_m != 0) must(simulation.step_aside(person, left_m, ahead_m));
    }
    simulation.tick();
    meter.add(*simulation.get<Pose>(person), *simulation.get<GroundReaction>(person), scene_tick_s);
  }
  return meter.result();
}

constexpr int settling_cycles = 3;
constexpr double longest_s = 60;  // any gait within range takes less for five strides
constexpr double margin_cycles = 0.1;

constexpr double degrees = 180 / std::numbers::pi;
constexpr double tick_s = 1.0 / 240;

/// Data of the ticks.
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

/// Returns false if forces are not simulated.
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

WalkedStride sample_stride(const Person& person, const TickRows& rows, bool with_forces) {
  WalkedStride stride{};
  stride.height_m = value(person.body.request.height_m);
  stride.leg_m = value(person.body.hip_height_m);
  stride.speed_m_s = value(person.gait.speed_m_s);
  stride.step_length_m = value(person.gait.step_length_m);
  stride.step_frequency_hz = value(person.gait.step_frequency_hz);
  stride.double_support_cycle = value(person.gait.double_support_cycle);
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

BalanceMeter::BalanceMeter(const Body& body) {
  for (std::size_t s = 0; s < segment_count; ++s) {
    mass_[s] = static_cast<double>(body.mass_kg[s]);
    centre_[s] = to_double(body.centre_of_mass_m[s]);
    inertia_[s] = segment_inertia_kg_m2(body, static_cast<Segment>(s));
    total_kg_ += mass_[s];
  }
}

BalanceMeter::Moving BalanceMeter::between(const Pose<float>& before, const Pose<float>& after, double span_s) const {
  std::array<Vec, segment_count> place, velocity;
  Vec centre{}, drift{};
  for (std::size_t s = 0; s < segment_count; ++s) {
    const Vec a = to_double(before.position_m[s]) + rotated(to_double(before.rotation[s]), centre_[s]);
    const Vec b = to_double(after.position_m[s]) + rotated(to_double(after.rotation[s]), centre_[s]);
    place[s] = 0.5 * (a + b);
    velocity[s] = (1 / span_s) * (b - a);
    centre = centre + (mass_[s] / total_kg_) * place[s];
    drift = drift + (mass_[s] / total_kg_) * velocity[s];
  }
  Vec momentum{};
  for (std::size_t s = 0; s < segment_count; ++s) {
    momentum = momentum + mass_[s] * cross(place[s] - centre, velocity[s] - drift);
    const Quat<double> from = to_double(before.rotation[s]), to = to_double(after.rotation[s]);
    const Quat<double> now = halfway(from, to);
    const Vec own = rotated(conjugate(now), turning(from, to, span_s)), &i = inertia_[s];
    momentum = momentum + rotated(now, Vec{i.x * own.x, i.y * own.y, i.z * own.z});
  }
  const Vec ahead = rotated(halfway(to_double(before.rotation[0]), to_double(after.rotation[0])), Vec{0, 0, 1});
  return {centre, normalised(Vec{ahead.x, 0, ahead.z}), momentum};
}

void BalanceMeter::add(const Pose<float>& pose, const GroundReaction<float>& ground, double tick_s) {
  if (last_.size() == 3) last_.erase(last_.begin());
  last_.push_back(pose);
  const GroundReaction<float> reaction = std::exchange(ground_, ground);
  if (last_.size() < 3) return;
  const Moving before = between(last_[0], last_[1], tick_s), after = between(last_[1], last_[2], tick_s);
  const Vec centre = 0.5 * (before.centre + after.centre);
  Vec lacking = (-1 / tick_s) * (after.momentum - before.momentum);
  for (std::size_t side = 0; side < 2; ++side) {
    const Vec arm = to_double(reaction.centre_m[side]) - centre;
    lacking = lacking + cross(arm, to_double(reaction.force_n[side]));
    lacking.y += static_cast<double>(reaction.free_moment_nm[side]);
  }
  const Vec ahead = normalised(before.forward + after.forward), across{ahead.z, 0, -ahead.x};
  ++counted_;
  const auto add = [&](double moment, double& squares, double& peak) {
    const double per_kg = moment / total_kg_;
    squares += per_kg * per_kg;
    peak = std::max(peak, std::abs(per_kg));
  };
  add(dot(lacking, across), sums_.pitch_rms, sums_.pitch_peak);
  add(dot(lacking, ahead), sums_.roll_rms, sums_.roll_peak);
  add(lacking.y, sums_.yaw_rms, sums_.yaw_peak);
}

double leg_ratio(const BodyRequest& body) {
  return static_cast<double>(must(make_body(body)).size.leg_scale_m / must(make_body({})).size.leg_scale_m);
}

float pace_of(const BodyRequest& body) {
  return static_cast<float>(std::sqrt(std::min(leg_ratio(body), 1.0)));
}

UnbalancedMoment BalanceMeter::result() const {
  UnbalancedMoment moment = sums_;
  for (double* const squares : {&moment.pitch_rms, &moment.roll_rms, &moment.yaw_rms})
    *squares = std::sqrt(*squares / std::max(static_cast<double>(counted_), 1.0));
  return moment;
}

std::vector<BalancedScene> walk_balance_scenes(const BodyRequest& body, const GaitStyle& style) {
  const Scene scenes[] = {{"straight", {{0, 1.3}}, 5},
                          {"faster and slower", {{0, 0.9}, {2, 1.7}, {6, 0.8}}, 10},
                          {"turning", {{0, 1.3}, {1, 1.3, 90}, {4, 1.3, -30}}, 8},
                          {"starting and stopping", {{0, 0}, {1, 1.3}, {5, 0}}, 8},
                          {"limping", {{0, 1.1}}, 5, 0.12F, 0.10F},
                          {"stepping aside", {{0, 0}, {1, 0, 0, 0.2}, {3, 0, 0, 0, -0.15}}, 5},
                          {"turning on the spot", {{0, 0}, {1, 0, 90}}, 4}};
  std::vector<BalancedScene> walked;
  for (const Scene& scene : scenes) {
    const auto moment = walk_scene(body, style, scene);
    walked.push_back({scene.name, moment});
  }
  return walked;
}

void over_steady_cycle(Simulation& simulation, Entity person, const std::function<void(double)>& row) {
  int cycles = -settling_cycles;
  double last = 0;
  while (simulation.time_s() < longest_s) {
    simulation.tick();
    const double phase = static_cast<double>(simulation.get<Feet>(person)->phase[Side::right]);
    if (phase < last - 0.5) ++cycles;
    last = phase;
    const double total = cycles + phase;
    if (total < -margin_cycles) continue;
    row(total);
    if (total > 1 + margin_cycles) return;
  }
  throw Stopped("the walk takes too long to get through five strides; ask for a quicker one");
}

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

GaitRequest barefoot(const BodyRequest& body, GaitRequest request) {
  if (!request.step_length_m && request.speed_m_s && *request.speed_m_s > 0)
    request.step_length_m = must(resolve_gait(must(make_body(body)), request, Footwear::barefoot)).step_length_m;
  return request;
}

WalkedStride walk_stride(const BodyRequest& body, const GaitRequest& gait) {
  SimulationOptions options;
  options.tick_s = tick_s;
  Simulation simulation(options);
  const auto entity = must(simulation.spawn(body, barefoot(body, gait)));
  simulation.enable(entity, Feature::forces);

  TickRows rows;
  bool with_forces = true;
  over_steady_cycle(simulation, entity, [&](double phase) {
    rows.phase.push_back(phase);
    with_forces = with_forces && add_forces(simulation, entity, static_cast<double>(body.mass_kg), rows);
    add_motion(simulation, entity, rows);
  });
  return sample_stride(*simulation.person(entity), rows, with_forces);
}

}  // namespace mobil
