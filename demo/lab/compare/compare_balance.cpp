#include "demo/lab/compare/compare_balance.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <mobil/engine/geometry.h>
#include <mobil/simulation.h>
#include "assets/body/segment_inertia.h"

namespace mobil {
namespace {

using namespace geometry;

constexpr double scene_tick_s = 1.0 / 240;

/// Rotation vector per second from one attitude to the next, world axes.
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

/// What somebody is asked while the meter runs.
struct Request {
  double after_s;
  double speed_m_s;
  double heading_deg = 0;
  double left_m = 0, ahead_m = 0;  // a step of somebody who stands
};

struct Scene {
  std::string_view name;
  std::vector<Request> requests;  // the first holds from the beginning; each until the next
  double seconds;
  float step_asymmetry = 0, time_asymmetry = 0;
};

Result<UnbalancedMoment> walk_scene(const BodyRequest& body, GaitStyle style, const Scene& scene) {
  style.step_asymmetry += scene.step_asymmetry;
  style.time_asymmetry += scene.time_asymmetry;
  SimulationOptions options;
  options.tick_s = scene_tick_s;
  Simulation simulation(options);
  const auto asked = [&](const Request& request) {
    GaitRequest gait;
    gait.speed_m_s = static_cast<float>(request.speed_m_s);
    gait.style = style;
    return gait;
  };
  const auto person = simulation.spawn(body, asked(scene.requests.front()));
  if (!person) return tl::unexpected(person.error());
  simulation.add_forces(*person);
  BalanceMeter meter(simulation.human(*person)->body);
  std::size_t next = 1;
  while (simulation.time_s() < scene.seconds) {
    if (next < scene.requests.size() && simulation.time_s() >= scene.requests[next].after_s) {
      const Request& request = scene.requests[next++];
      if (auto done = simulation.set_gait(*person, asked(request)); !done) return tl::unexpected(done.error());
      const double heading = request.heading_deg * std::numbers::pi / 180;
      if (auto done = simulation.turn_to(*person, static_cast<float>(heading)); !done)
        return tl::unexpected(done.error());
      const auto left_m = static_cast<float>(request.left_m), ahead_m = static_cast<float>(request.ahead_m);
      if (left_m != 0 || ahead_m != 0) {
        if (auto done = simulation.step_aside(*person, left_m, ahead_m); !done) return tl::unexpected(done.error());
      }
    }
    simulation.tick();
    meter.add(*simulation.get<Pose>(*person), *simulation.get<GroundReaction>(*person), scene_tick_s);
  }
  return meter.result();
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
  }
  const Vec ahead = normalised(before.forward + after.forward), across{ahead.z, 0, -ahead.x};
  const double pitch = dot(lacking, across) / total_kg_, roll = dot(lacking, ahead) / total_kg_;
  ++counted_;
  pitch_squares_ += pitch * pitch;
  roll_squares_ += roll * roll;
  pitch_peak_ = std::max(pitch_peak_, std::abs(pitch));
  roll_peak_ = std::max(roll_peak_, std::abs(roll));
}

UnbalancedMoment BalanceMeter::result() const {
  const double n = std::max<double>(static_cast<double>(counted_), 1);
  return {std::sqrt(pitch_squares_ / n), pitch_peak_, std::sqrt(roll_squares_ / n), roll_peak_};
}

Result<std::vector<BalancedScene>> walk_balance_scenes(const BodyRequest& body, const GaitStyle& style) {
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
    if (!moment) return tl::unexpected(moment.error());
    walked.push_back({scene.name, *moment});
  }
  return walked;
}

}  // namespace mobil
