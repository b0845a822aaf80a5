#include <mobil/systems/limits/walk_limits.h>

#include <fmt/format.h>
#include <hwy/base.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/step_plan.h>
#include <mobil/engine/interrupt.h>
#include <mobil/rows.h>
#include "assets/body/column.h"
#include "assets/body/joint_limits.h"
#include "assets/gait/step_table.h"
#include "systems/gait/gait.h"

namespace mobil::inline v0_3 {
namespace {

constexpr double limit_degree = 3.14159265358979324 / 180;
constexpr std::uint32_t max_parts = 4;

/// Returns the limit, in one direction, of the joint at the origin of a segment.
constexpr double limb_limit(Segment segment, std::string_view joint, std::string_view motion, bool more) {
  for (const JointLimit& limit : limb_limits) {
    if (limit.segment == segment && limit.joint == joint && limit.motion == motion)
      return limit_degree * (more ? limit.high_deg : -limit.low_deg);
  }
  return 0;
}

/// Factor for a column that bends and turns at once, which moves some joints slightly more than others.
constexpr double evenly = 0.95;

/// Returns the angle between pelvis and chest at which the first joint between them reaches its limit.
constexpr double column_limit(double VertebraLimit::*motion, bool both_ways) {
  constexpr ColumnParts parts = column_parts();
  double least = 90;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const double part = parts[i] - (i == 0 ? 0 : parts[i - 1]);
    least = std::min(least, (both_ways ? 1.0 : 0.5) * vertebra_limits[i].*motion / part);
  }
  return evenly * limit_degree * least;
}
constexpr double neck_limit() {
  constexpr std::size_t first = index(Segment::C7) - index(Segment::L5);
  constexpr double joints = index(Segment::head) - index(Segment::T1);
  double least = 90;
  for (std::size_t i = first; i < vertebra_limits.size(); ++i)
    least = std::min(least, 0.5 * vertebra_limits[i].flexion_extension * joints);
  return evenly * limit_degree * least;
}

using enum Segment;
constexpr double mm = 0.001, deg = limit_degree;
constexpr std::string_view flexes = "flexion-extension", abducts = "abduction-adduction",
                           turns = "internal-external rotation";
constexpr std::array<WalkLimit, bound_count> limits = {{
    {WalkBound::under_ground, 0.005, mm, "a foot would be {} mm under the ground"},
    {WalkBound::hip_back, limb_limit(thigh_right, "hip", flexes, false), deg, "a hip would be extended by {} deg"},
    {WalkBound::hip_forward, limb_limit(thigh_right, "hip", flexes, true), deg, "a hip would be bent by {} deg"},
    {WalkBound::hip_outward, limb_limit(thigh_right, "hip", abducts, true), deg, "a leg would be {} deg aside"},
    {WalkBound::hip_inward, limb_limit(thigh_right, "hip", abducts, false), deg, "a leg would be {} deg across"},
    {WalkBound::hip_turned_out, limb_limit(thigh_right, "hip", turns, false), deg,
     "a hip would be turned out by {} deg"},
    {WalkBound::hip_turned_in, limb_limit(thigh_right, "hip", turns, true), deg, "a hip would be turned in by {} deg"},
    {WalkBound::knee_straight, limb_limit(shank_right, "knee", flexes, false), deg,
     "a knee would be overstretched by {} deg"},
    {WalkBound::knee_bent, limb_limit(shank_right, "knee", flexes, true), deg, "a knee would be bent by {} deg"},
    {WalkBound::ankle_down, limb_limit(foot_right, "ankle", "dorsiflexion-plantarflexion", false), deg,
     "an ankle would be plantarflexed by {} deg"},
    {WalkBound::ankle_up, limb_limit(foot_right, "ankle", "dorsiflexion-plantarflexion", true), deg,
     "an ankle would be dorsiflexed by {} deg"},
    {WalkBound::foot_inverted, limb_limit(foot_right, "hindfoot", "inversion-eversion", true), deg,
     "a foot would be inverted by {} deg"},
    {WalkBound::foot_everted, limb_limit(foot_right, "hindfoot", "inversion-eversion", false), deg,
     "a foot would be everted by {} deg"},
    {WalkBound::toes_down, limb_limit(toes_right, "metatarsophalangeal", "extension-flexion", false), deg,
     "toes would be bent down by {} deg"},
    {WalkBound::toes_up, limb_limit(toes_right, "metatarsophalangeal", "extension-flexion", true), deg,
     "toes would be bent up by {} deg"},
    {WalkBound::arm_back, limb_limit(upper_arm_right, "shoulder", flexes, false), deg, "an arm would be {} deg back"},
    {WalkBound::arm_forward, limb_limit(upper_arm_right, "shoulder", flexes, true), deg,
     "an arm would be {} deg forward"},
    {WalkBound::elbow_straight, limb_limit(forearm_right, "elbow", flexes, false), deg,
     "an elbow would be overstretched by {} deg"},
    {WalkBound::elbow_bent, limb_limit(forearm_right, "elbow", flexes, true), deg, "an elbow would be bent by {} deg"},
    {WalkBound::trunk_forward, column_limit(&VertebraLimit::flexion_extension, false), deg,
     "the trunk would be bent forward by {} deg"},
    {WalkBound::trunk_back, column_limit(&VertebraLimit::flexion_extension, false), deg,
     "the trunk would be bent back by {} deg"},
    {WalkBound::trunk_aside, column_limit(&VertebraLimit::lateral_bending, true), deg,
     "the trunk would be bent aside by {} deg"},
    {WalkBound::neck_bent, neck_limit(), deg, "the neck would be bent by {} deg"},
    {WalkBound::pelvis_shaken, 16, 1, "the pelvis would be shaken with {} m/s2"},
}};
static_assert([] {
  for (std::size_t i = 0; i < limits.size(); ++i)
    if (limits[i].bound != static_cast<WalkBound>(i) ||
        (limits[i].limit <= 0 && limits[i].bound != WalkBound::elbow_straight))
      return false;
  return true;
}());

/// Steps examined of walks whose later steps are not the mirrored first one: two of each side, including the first.
constexpr int uneven_steps = 4;

/// Maximum number of steps in which a person stops.
constexpr int stopping_steps = 6;

/// Examined turns and changes of speed, and their numbers of steps. By their end nearly all people walk as before.
constexpr float turned_rad = 1.05F, slowed_to = 0.6F;
constexpr int turning_steps = 6, scaled_steps = 3, quickening_steps = 5;

/// Heights of the pelvis of sixteen walks at successive instants.
using Heights = std::array<Lanes<float>, 2 * max_parts>;

/// Sixteen walks, advanced step by step and examined `lag` times in difference_s.
class WalkLooked {
 public:
  WalkLooked(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& gait, std::uint32_t lag)
      : size_(size), gait_(gait), lag_(lag), instant_s_(difference_s / static_cast<float>(lag)) {
    plan_first_step(size_, gait_, plan_);
  }

  const Lanes<std::uint32_t>& settled() const { return plan_.settled; }
  bool all_stand() const {
    return std::ranges::all_of(plan_.from.speed_m_s.lane, [](float speed_m_s) { return speed_m_s <= 0; });
  }
  /// From the next step on, all walkers stop and stand in their own style.
  void end() { gait_.speed_m_s = gait_.step_length_m = gait_.step_frequency_hz = {}; }
  /// From the next step on, all walkers turn by this angle from their present heading.
  void turn(float rad) {
    gait_.heading_rad = in_every_lane<Lanes<float>>(rad);
    turns_ = true;
  }
  /// From the next step on, all walkers take this part of their speed, but at least the lowest allowed speed, with the
  /// usual steps for that speed.
  void scale_speed(float part) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      const float height_m = size_.leg_scale_m[l], speed_m_s = gait_.speed_m_s[l];
      if (!(speed_m_s > 0)) continue;
      const float slow_m_s = std::max(part * speed_m_s, std::min(speed_m_s, lowest_speed_m_s(height_m)));
      const Gait<float> slow = complete_gait(height_m, slow_m_s, usual_length_m(height_m, slow_m_s), {});
      gait_.speed_m_s[l] = slow.speed_m_s;
      gait_.step_length_m[l] = slow.step_length_m;
      gait_.step_frequency_hz[l] = slow.step_frequency_hz;
    }
  }
  /// From the next step on, all walkers use this gait.
  void walk_as(const Gait<Lanes<float>>& gait) { gait_ = gait; }
  const StepBounds<Lanes<float>>& bounds() const { return bounds_; }

  /// Computes the bounds of this step, starting from cleared ones.
  void walk() {
    clear_bounds(bounds_);
    const float longest_s = *std::ranges::max_element(plan_.duration_s.lane);
    std::array<Lanes<float>, 2 * max_parts + 1> up_m{};  // at the last few instants
    for (std::uint32_t k = 0; static_cast<float>(k) * instant_s_ <= longest_s; ++k) {
      const float time_s = static_cast<float>(k) * instant_s_;
      // A walker past the end of the step stays at the last instant before it, so longer steps of others add nothing.
      look([&](std::size_t l) { return time_s <= plan_.duration_s[l] ? time_s : state_.time_s[l]; });
      const auto ago = [&](std::uint32_t instants) -> Lanes<float>& { return up_m[(k - instants) % up_m.size()]; };
      ago(0) = bounds_.pelvis_up_m;
      if (k < 2 * lag_) {
        begin_m_[k] = ago(0);
        continue;
      }
      for (std::size_t l = 0; l < lane_count; ++l)
        if (time_s <= plan_.duration_s[l]) note_shaken(l, ago(0)[l], ago(lag_)[l], ago(2 * lag_)[l]);
    }
    for (std::uint32_t k = 0; k < 2 * lag_; ++k) {
      const float before_s = static_cast<float>(2 * lag_ - k) * instant_s_;
      look([&](std::size_t l) { return std::max(plan_.duration_s[l] - before_s, 0.0F); });
      end_m_[k] = bounds_.pelvis_up_m;
    }
    if (steps_ == 0) note_strike(end_m_, [this](std::size_t l) { return plan_.settled[l] != 0; });
  }
  /// Advances to the next step. The heel strike between both counts as part of the new one.
  void step() {
    const Heights before_m = end_m_;
    state_.time_s = plan_.duration_s;
    advance_gait(plan_, state_, 0);
    plan_next_step(size_, gait_, state_, plan_);
    if (turns_) turn_gait(size_, plan_, gait_, state_, difference_s);
    ++steps_;
    walk();
    note_strike(before_m, [](std::size_t) { return true; });
  }

 private:
  template <class Time>
  void look(Time time) {
    for (std::size_t l = 0; l < lane_count; ++l) state_.time_s[l] = time(l);
    step_bounds(size_, plan_, state_, bounds_);
  }
  void note_shaken(std::size_t lane, float now_m, float before_m, float first_m) {
    float& most = bounds_.value[static_cast<std::size_t>(WalkBound::pelvis_shaken)][lane];
    most = std::max(most, pelvis_acceleration(now_m, before_m, first_m));
  }
  /// Notes the heel strike at which this step begins. `ended_m` contains the final heights of the step before.
  template <class Where>
  void note_strike(const Heights& ended_m, Where where) {
    const auto at = [&](std::uint32_t k) -> const Lanes<float>& {
      return k < 2 * lag_ ? ended_m[k] : begin_m_[k - 2 * lag_];
    };
    for (std::uint32_t k = 2 * lag_; k < 4 * lag_; ++k)
      for (std::size_t l = 0; l < lane_count; ++l)
        if (where(l)) note_shaken(l, at(k)[l], at(k - lag_)[l], at(k - 2 * lag_)[l]);
  }

  const BodySize<Lanes<float>>& size_;
  Gait<Lanes<float>> gait_;
  std::uint32_t lag_;
  float instant_s_;
  int steps_ = 0;
  bool turns_ = false;
  StepPlan<Lanes<float>> plan_{};
  GaitState<Lanes<float>> state_{};
  StepBounds<Lanes<float>> bounds_{};
  Heights begin_m_{}, end_m_{};  // of this step
};

}  // namespace

std::span<const WalkLimit, bound_count> walk_limits() {
  return limits;
}

void walk_extremes(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& gait, Looking looking,
                   WalkExtremes& extremes) {
  check_interrupt();
  const bool seldom = looking == Looking::roughly || looking == Looking::at_changes;
  Lanes<std::uint32_t> settled{};
  const auto note = [&](const WalkLooked& looked, WalkPart part, auto whose) {
    WalkReach& reach = part == WalkPart::steady || part == WalkPart::stop ? extremes.steady : extremes.changing;
    for (std::size_t b = 0; b < bound_count; ++b)
      for (std::size_t l = 0; l < lane_count; ++l) {
        const float value = looked.bounds().value[b][l];
        if (!whose(l) || value <= reach.value[b][l]) continue;
        reach.value[b][l] = value;
        reach.part[b][l] = part;
      }
  };
  const auto note_steps = [&](WalkLooked& looked, int steps, WalkPart part, auto whose) {
    for (int step = 0; step < steps; ++step) {
      looked.step();
      note(looked, part, whose);
    }
  };
  const auto uneven = [&settled](std::size_t l) { return settled[l] == 0; };
  bool all_even = true;
  const auto walk_steadily = [&]() HWY_NOINLINE {
    WalkLooked walk(size, gait, seldom ? 1 : max_parts);
    settled = walk.settled();
    walk.walk();
    for (WalkReach* const reach : {&extremes.steady, &extremes.changing}) {
      std::ranges::fill(reach->value, in_every_lane<Lanes<float>>(min_bound));
      for (auto& of_bound : reach->part) of_bound.fill(WalkPart::steady);
    }
    std::ranges::copy(walk.bounds().value, extremes.steady.value);
    // In a settled walk the left step is the mirrored right one.
    all_even = std::ranges::none_of(settled.lane, [](std::uint32_t is) { return is == 0; });
    if (!all_even && looking != Looking::at_changes) note_steps(walk, uneven_steps - 1, WalkPart::steady, uneven);
  };
  walk_steadily();
  // The walks have 24 kB. In functions of their own, two of them are on the stack at once.
  const auto note_stop = [&](WalkLooked stop, auto whose) HWY_NOINLINE {
    stop.end();
    for (int step = 0; step < stopping_steps && !stop.all_stand(); ++step) note_steps(stop, 1, WalkPart::stop, whose);
  };
  const auto note_turn = [&](WalkLooked turn, float rad, auto whose) HWY_NOINLINE {
    turn.turn(rad);
    note_steps(turn, turning_steps, WalkPart::turn, whose);
  };
  const auto note_other_speed = [&](WalkLooked other, auto whose) HWY_NOINLINE {
    other.scale_speed(slowed_to);
    note_steps(other, scaled_steps, WalkPart::change_of_speed, whose);
    other.walk_as(gait);
    note_steps(other, quickening_steps, WalkPart::change_of_speed, whose);
  };
  const auto note_changes = [&](const WalkLooked& from, auto whose) HWY_NOINLINE {
    for (const float rad : {turned_rad, -turned_rad}) note_turn(from, rad, whose);
    note_other_speed(from, whose);
  };
  const auto from_either_foot = [&](std::uint32_t lag, auto note_from) HWY_NOINLINE {
    WalkLooked from(size, gait, lag);
    from.walk();
    note_from(from, [](std::size_t) { return true; });
    if (all_even) return;
    from.step();
    note_from(from, uneven);
  };
  if (looking == Looking::at_stops_too || looking == Looking::at_changes_too)
    from_either_foot(max_parts / 2, note_stop);
  if (looking == Looking::at_changes || looking == Looking::at_changes_too) from_either_foot(1, note_changes);
}

bool has_usual_steps(float height_m, float speed_m_s, float step_length_m) {
  const float usual_m = usual_length_m(height_m, speed_m_s);
  constexpr auto shortest = static_cast<float>(step_table::length.front()),
                 longest = static_cast<float>(step_table::length.back());
  return step_length_m >= shortest * usual_m && step_length_m <= longest * usual_m;
}

double for_turns(WalkBound bound, Looking looking) {
  using enum WalkBound;
  if (looking != Looking::at_stops_too && looking != Looking::at_changes_too) return 0;
  return bound == ankle_up || bound == ankle_down ? 0.12 : bound == hip_back || bound == hip_forward ? 0.04 : 0;
}

float held_to(std::size_t bound, Looking looking, bool usual_style) {
  struct Spare {
    double m, rad, m_s2;
  };
  constexpr Spare close = {0.001, 0.015, 2}, rough = {0.002, 0.05, 9}, smooth = {0.001, 0.001, 2};
  const WalkLimit& limit = walk_limits()[bound];
  const Spare& spare = looking == Looking::roughly ? rough : usual_style ? smooth : close;
  const double free = limit.bound == WalkBound::under_ground    ? spare.m
                      : limit.bound == WalkBound::pelvis_shaken ? spare.m_s2
                                                                : spare.rad + for_turns(limit.bound, looking);
  return static_cast<float>(limit.limit - free);
}

std::string_view said_of(WalkPart part) {
  switch (part) {
    case WalkPart::stop:
      return "in stopping from";
    case WalkPart::turn:
      return "in turning at";
    case WalkPart::change_of_speed:
      return "in slowing down from and coming back to";
    case WalkPart::steady:
      break;
  }
  return "at";
}

bool same_style(const GaitStyle& a, const GaitStyle& b) {
  return std::ranges::all_of(gait_parameters, [&](const GaitParameter& p) { return a.*p.value == b.*p.value; });
}

bool same_walk(const Gait<float>& a, const Gait<float>& b) {
  return a.speed_m_s == b.speed_m_s && a.step_length_m == b.step_length_m && same_style(a.style, b.style);
}

}  // namespace mobil::inline v0_3
