#pragma once
// Walkers that receive one request after another at random times, and an observer of each that keeps the largest
// deviations. It uses only the facade; a crowd is determined by its seed.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/components/step_plan.h>
#include <mobil/engine/geometry.h>
#include <mobil/simulation.h>
#include <mobil/systems/muscles/person.h>

namespace mobil::steering {
using geometry::to_double;

/// Random numbers that are equal with every standard library.
struct Source {
  std::mt19937_64 bits;

  double uniform(double low, double high) { return low + (high - low) * static_cast<double>(bits() >> 11) * 0x1p-53; }
  float between(double low, double high) { return static_cast<float>(uniform(low, high)); }
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(bits() % n); }
};

/// Kinds of requests to a crowd.
struct Asking {
  bool heading = true, stop = true;
  bool step_length = false, limp = false, style = false;
  double slowest = 0.3, fastest = 2.3;  // m/s at a leg of 0.90 m, proportional to the root of its length
};

struct Walker {
  Entity entity;
  BodyRequest body;
  double scale = 1;  // of speeds: √(leg / 0.90 m)
  GaitRequest gait;
  double next_s = 0;  // time of the next request
  std::string asked;  // the last two requests
};

inline std::string describe(const GaitRequest& gait) {
  std::ostringstream text;
  if (gait.speed_m_s) text << *gait.speed_m_s << " m/s";
  if (gait.step_length_m) text << ", steps of " << *gait.step_length_m << " m";
  const GaitStyle usual;
  for (const GaitParameter& p : gait_parameters) {
    if (gait.style.*p.value != usual.*p.value) text << ", " << p.name << ' ' << gait.style.*p.value;
  }
  return text.str();
}

inline BodyRequest any_body(Source& random) {
  BodyRequest body;
  body.height_m = random.between(1.2, 2.2);
  body.mass_kg = std::clamp(random.between(17, 40) * body.height_m * body.height_m, 30.0F, 200.0F);
  return body;
}

/// Returns the last request of a walker with one change, which can be out of the walkable range.
inline GaitRequest any_gait(Source& random, const Asking& asking, const Walker& walker) {
  enum Kind { speed, step_length, stop, limp, style };
  std::vector<Kind> kinds = {speed};
  if (asking.step_length) kinds.push_back(step_length);
  if (asking.stop) kinds.push_back(stop);
  if (asking.limp) kinds.push_back(limp);
  if (asking.style) kinds.insert(kinds.end(), {style, style});
  const Kind kind = kinds[random.below(kinds.size())];
  GaitRequest gait = walker.gait;
  const bool stands = gait.speed_m_s == 0.0F;
  if (kind == stop && !stands) return {.speed_m_s = 0.0F, .style = gait.style};
  if (kind <= stop || stands) {
    gait.speed_m_s = static_cast<float>(random.uniform(asking.slowest, asking.fastest) * walker.scale);
    gait.step_length_m.reset();
  }
  if (kind == step_length) {
    const float usual = std::sqrt(0.24F * walker.body.height_m * *gait.speed_m_s);
    gait.step_length_m = random.between(0.8, 1.15) * usual;
  }
  if (kind == limp) {
    const bool limps = random.below(3) != 0;
    gait.style.step_asymmetry = limps ? random.between(-0.3, 0.3) : 0.0F;
    gait.style.time_asymmetry = limps ? random.between(-0.2, 0.2) : 0.0F;
  }
  if (kind == style) {
    const GaitParameter& p = gait_parameters[random.below(gait_parameters.size())];
    float& value = gait.style.*p.value;
    const GaitStyle defaults;
    const float usual = defaults.*p.value;
    const float part = random.between(-1, 1);
    value = usual + part * (part > 0 ? p.high - usual : usual - p.low);
  }
  return gait;
}

/// The largest value of a quantity, and where it occurred.
struct Worst {
  double value = 0;
  std::string where;

  void keep(const Worst& other) {
    if (other.value > value) *this = other;
  }
};

/// One walker at one instant.
struct Sample {
  double time_s;
  Pose<float> pose;
  JointAngles<float> angles;
  Feet<float> feet;
  GaitState<float> state;
};

/// Joints of the legs come first: hip right, hip left, knees, ankles.
inline constexpr std::array joint_names = {
    "hip right",     "hip left",    "knee right", "knee left",       "ankle right", "ankle left", "shoulder right",
    "shoulder left", "elbow right", "elbow left", "pelvis rotation", "pelvis list", "pelvis tilt"};
using Joints = std::array<double, joint_names.size()>;

inline Joints joints(const JointAngles<float>& a) {
  Joints all{};
  const float* const both[] = {a.hip_flexion, a.knee_flexion, a.ankle_dorsiflexion, a.shoulder_flexion,
                               a.elbow_flexion};
  for (std::size_t i = 0; i < 10; ++i) all[i] = static_cast<double>(both[i / 2][i % 2]);
  all[10] = static_cast<double>(a.pelvis_rotation);
  all[11] = static_cast<double>(a.pelvis_list);
  all[12] = static_cast<double>(a.pelvis_tilt);
  return all;
}

/// Below this flexion (rad) a knee's angle is the root of a small length, so its rate is not counted.
inline constexpr double nearly_straight = 0.10;

/// Results for one walker, or for many.
struct Findings {
  Worst origin_speed;                          // of a segment's origin over the walk's speed, (m/s) / (m/s)
  std::array<Worst, 3> joint_rate;             // of hip, knee and ankle, rad/s at a leg of 0.90 m
  std::array<Worst, joint_names.size()> kink;  // change of a joint's rate from tick to tick, rad/s
  Worst slide, turning_slide;                  // of points on the ground, m; and where the line turns
  Worst sunk;                                  // below the ground, m
  Worst apart;                                 // a foot from its shank, m
  Worst not_finite;                            // 1
  Worst speed_off;                             // mean over steady steps, relative to the request
  int steady_steps = 0;
  int changes = 0;

  void keep(const Findings& other) {
    origin_speed.keep(other.origin_speed);
    for (std::size_t i = 0; i < joint_rate.size(); ++i) joint_rate[i].keep(other.joint_rate[i]);
    for (std::size_t i = 0; i < kink.size(); ++i) kink[i].keep(other.kink[i]);
    constexpr std::array<Worst Findings::*, 6> single = {&Findings::slide,      &Findings::turning_slide,
                                                         &Findings::sunk,       &Findings::apart,
                                                         &Findings::not_finite, &Findings::speed_off};
    for (const auto worst : single) (this->*worst).keep(other.*worst);
    steady_steps += other.steady_steps;
    changes += other.changes;
  }
};

/// Observes one walker from tick to tick.
class Watch : public Findings {
 public:
  void see(const Simulation& simulation, const Walker& walker) {
    const Sample now{simulation.time_s(), *simulation.get<Pose>(walker.entity),
                     *simulation.get<JointAngles>(walker.entity), *simulation.get<Feet>(walker.entity),
                     *simulation.get<GaitState>(walker.entity)};
    walker_ = &walker;
    if (samples_ == 0) {
      const Body body = simulation.person(walker.entity)->body;
      shank_ = to_double(body.joint_offset_m[index(Segment::foot_right)]);
      toes_ = static_cast<double>(body.tip_m[index(Segment::toes_right)].z);
    }
    const bool struck = samples_ == 0 || now.state.steps != last_.state.steps || now.state.time_s < last_.state.time_s;
    if (struck) plan_ = *simulation.get<StepPlan>(walker.entity);
    place(now, simulation.tick_s());
    turn(now, simulation.tick_s());
    ground(now);
    if (struck && samples_ > 0) strike(now);
    before_ = last_;
    last_ = now;
    ++samples_;
  }

 private:
  void note(Worst& worst, double value, const Sample& now, std::string_view what) const {
    if (!(value > worst.value)) return;
    std::ostringstream text;
    text << what << " at " << now.time_s << " s: step " << now.state.steps << ", " << now.state.time_s << " of "
         << plan_.duration_s << " s, toe-off " << plan_.double_support_s << ", " << plan_.from.speed_m_s << " to "
         << plan_.to.speed_m_s << " m/s, turn " << now.state.turn_rad << ", clamped " << plan_.clamped << "; "
         << walker_->body.height_m << " m, " << walker_->body.mass_kg << " kg; asked " << walker_->asked;
    worst = {value, text.str()};
  }

  void place(const Sample& now, double tick_s) {
    const double walk = 0.5 + static_cast<double>(std::max(plan_.from.speed_m_s, plan_.to.speed_m_s));
    for (std::size_t s = 0; s < segment_count; ++s) {
      const auto p = to_double(now.pose.position_m[s]);
      const auto& q = now.pose.rotation[s];
      const bool sound =
          std::isfinite(p.x + p.y + p.z) && std::abs(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w - 1) < 1e-4F;
      note(not_finite, sound ? 0 : 1, now, segment_name[s]);
      if (samples_ == 0) continue;
      const auto moved = geometry::operator-(p, to_double(last_.pose.position_m[s]));
      note(origin_speed, geometry::length(moved) / tick_s / walk, now, segment_name[s]);
    }
    for (const Segment foot : {Segment::foot_right, Segment::foot_left}) {
      const std::size_t f = index(foot), s = index(segment_parent[f]);
      const auto end = geometry::operator+(to_double(now.pose.position_m[s]),
                                           geometry::rotated(to_double(now.pose.rotation[s]), shank_));
      note(apart, geometry::length(geometry::operator-(end, to_double(now.pose.position_m[f]))), now, segment_name[f]);
    }
  }

  void turn(const Sample& now, double tick_s) {
    const Joints a = joints(now.angles), b = joints(last_.angles), c = joints(before_.angles);
    for (std::size_t j = 0; j < a.size(); ++j) {
      note(not_finite, std::isfinite(a[j]) ? 0 : 1, now, joint_names[j]);
      const std::size_t knee = 2 + j % 2;
      if (samples_ < 2 || (j < 6 && std::min({a[knee], b[knee], c[knee]}) < nearly_straight)) continue;
      if (j < 6) note(joint_rate[j / 2], walker_->scale * std::abs(a[j] - b[j]) / tick_s, now, joint_names[j]);
      note(kink[j], std::abs(a[j] - 2 * b[j] + c[j]) / tick_s, now, joint_names[j]);
    }
  }

  /// Points within a millimetre of the ground must not move along it while their foot stands.
  void ground(const Sample& now) {
    for (std::uint32_t side = 0; side < 2; ++side) {
      const bool stands = side == now.state.stance_side || now.state.time_s < plan_.double_support_s;
      const Vec3<double> points[] = {to_double(now.feet.heel_m[side]), to_double(now.feet.toe_m[side])};
      const auto& toes = now.pose.rotation[index(side == Side::right ? Segment::toes_right : Segment::toes_left)];
      note(sunk, -points[1].y - geometry::rotated(to_double(toes), Vec3<double>{0, 0, toes_}).y, now, "toes");
      for (std::size_t i = 0; i < 2; ++i) {
        const char* const name = i == 0 ? "heel" : "ball";
        note(sunk, -points[i].y, now, name);
        Anchor& anchor = anchors_[side][i];
        if (!stands || points[i].y > 0.001) {
          anchor.down = false;
          continue;
        }
        if (!anchor.down) anchor = {true, points[i]};
        const bool turns = now.state.turn_rad != 0 || now.state.turn_before_rad != 0;
        note(turns ? turning_slide : slide, std::hypot(points[i].x - anchor.at.x, points[i].z - anchor.at.z), now,
             name);
      }
    }
  }

  /// Measures mean speed from foothold to foothold, starting at the first step that equals the next.
  void strike(const Sample& now) {
    if (now.state.steps == last_.state.steps) return;  // standing
    const Strike next{now.time_s - static_cast<double>(now.state.time_s), static_cast<double>(now.state.line_x_m),
                      static_cast<double>(now.state.line_z_m), walker_->asked};
    const bool steady = plan_.settled == 1 && now.state.turn_rad == 0 && now.state.turn_before_rad == 0;
    if (!steady || steady_ == 0 || next.asked != first_.asked) {
      first_ = next;
      steady_ = steady ? 1 : 0;
      return;
    }
    ++steady_steps;
    ++steady_;
    if (!walker_->gait.speed_m_s) return;
    const double speed = std::hypot(next.x - first_.x, next.z - first_.z) / (next.at - first_.at);
    note(speed_off, std::abs(speed / static_cast<double>(*walker_->gait.speed_m_s) - 1), now, "speed");
  }

  struct Anchor {
    bool down = false;
    Vec3<double> at{};
  };
  struct Strike {
    double at = 0, x = 0, z = 0;
    std::string asked;
  };
  const Walker* walker_ = nullptr;
  Vec3<double> shank_{};  // from knee to ankle in the shank's frame
  double toes_ = 0;       // their length
  StepPlan<float> plan_{};
  Sample last_{}, before_{};
  std::size_t samples_ = 0;
  Anchor anchors_[2][2];
  Strike first_{};
  int steady_ = 0;
};

/// Requests are made between ticks, at multiples of 1/60 s, so crowds of one seed get equal requests at any tick
/// length.
class Crowd {
 public:
  Crowd(double tick_s, std::uint64_t seed, const Asking& asking, std::size_t size = 16)
      : simulation_({.tick_s = tick_s}), random_{std::mt19937_64(seed)}, asking_(asking) {
    while (walkers_.size() < size) {
      Walker walker;
      walker.body = any_body(random_);
      const Body body = *make_body(walker.body);
      walker.scale = std::sqrt(static_cast<double>(body.thigh_length_m + body.shank_length_m) / 0.90);
      walker.gait.speed_m_s = static_cast<float>(random_.uniform(asking.slowest, asking.fastest) * walker.scale);
      const auto entity = simulation_.spawn(walker.body, walker.gait);
      if (!entity) continue;
      walker.entity = *entity;
      walker.asked = describe(walker.gait);
      walker.next_s = pause();
      walkers_.push_back(walker);
    }
    watches_.resize(size);
  }

  Findings walk(double seconds) {
    look();
    const auto ticks = static_cast<int>(std::lround(seconds / simulation_.tick_s()));
    for (int i = 0; i < ticks; ++i) {
      for (Walker& walker : walkers_) {
        if (simulation_.time_s() > walker.next_s - 1e-6) ask(walker);
      }
      simulation_.tick();
      look();
    }
    Findings all;
    for (const Watch& watch : watches_) all.keep(watch);
    all.changes = changes_;
    return all;
  }

 private:
  /// Returns the time to the next request: often before the last one is completed, sometimes long after.
  double pause() { return static_cast<double>(20 + random_.below(180)) / 60; }

  void look() {
    for (std::size_t i = 0; i < walkers_.size(); ++i) watches_[i].see(simulation_, walkers_[i]);
  }

  void ask(Walker& walker) {
    std::ostringstream text;
    if (asking_.heading && random_.below(3) == 0) {
      const float heading = random_.between(-2 * std::numbers::pi, 2 * std::numbers::pi);
      simulation_.turn_to(walker.entity, heading);
      text << "heading " << heading;
    } else {
      const GaitRequest gait = any_gait(random_, asking_, walker);
      walker.next_s += 1.0 / 60;
      if (!simulation_.set_gait(walker.entity, gait)) return;  // requests again at once
      walker.gait = gait;
      text << describe(gait);
    }
    text << " at " << walker.next_s << " s";
    walker.next_s += pause();
    const auto last = walker.asked.rfind("then ");
    walker.asked = walker.asked.substr(last == std::string::npos ? 0 : last + 5) + " then " + text.str();
    ++changes_;
  }

  Simulation simulation_;
  Source random_;
  Asking asking_;
  std::vector<Walker> walkers_;
  std::vector<Watch> watches_;
  int changes_ = 0;
};

}  // namespace mobil::steering
