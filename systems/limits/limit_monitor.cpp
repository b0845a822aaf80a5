#include <mobil/systems/limits/limit_monitor.h>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <string_view>

#include <mobil/components/step_plan.h>
#include <mobil/rows.h>
#include <mobil/systems/limits/walk_limits.h>
#include "systems/gait/step_limits.h"
#include "systems/limits/walk_estimate.h"

namespace mobil::inline v0_3 {
namespace {

constexpr auto shaken = static_cast<std::size_t>(WalkBound::pelvis_shaken);

/// Computes the present bounds of sixteen walkers.
void bounds_now(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                const GaitState<Lanes<float>>& state, StepBounds<Lanes<float>>& bounds) {
  clear_bounds(bounds);
  GaitState<Lanes<float>> before = state;
  StepBounds<Lanes<float>> unused = bounds;
  Lanes<float> up_m[2];
  for (Lanes<float>& up : up_m) {
    for (float& time_s : before.time_s.lane) time_s = std::max(time_s - difference_s, 0.0F);
    step_bounds(size, plan, before, unused);
    up = unused.pelvis_up_m;
  }
  step_bounds(size, plan, state, bounds);
  for (std::size_t l = 0; l < lane_count; ++l)
    if (state.time_s[l] >= 2 * difference_s)
      bounds.value[shaken][l] = pelvis_acceleration(bounds.pelvis_up_m[l], up_m[0][l], up_m[1][l]);
}

/// Returns true if all lanes continue a settled walk straight ahead, as most blocks of a crowd do in most ticks.
bool all_go_straight_on(const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state) {
  std::uint32_t otherwise = 0;
  for (std::size_t l = 0; l < lane_count; ++l)
    otherwise |= static_cast<std::uint32_t>(plan.settled[l] == 0) |
                 static_cast<std::uint32_t>(state.bend_before_per_m[l] != 0) |
                 static_cast<std::uint32_t>(state.bend_per_m[l] != 0) |
                 static_cast<std::uint32_t>(state.bend_next_per_m[l] != 0);
  return otherwise == 0;
}

/// Returns true if the sideways push changes within a step by more than one turn needs (step_limits::max_sideways).
bool turns_back(const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state, std::size_t lane) {
  constexpr float more_m_s2 = 1.1F * step_limits::max_sideways;
  const float speed_m_s = std::max(plan.from.speed_m_s[lane], plan.to.speed_m_s[lane]);
  const float here = state.bend_per_m[lane], change = std::max(std::fabs(here - state.bend_before_per_m[lane]),
                                                               std::fabs(state.bend_next_per_m[lane] - here));
  return change * speed_m_s * speed_m_s > more_m_s2;
}

/// Returns true if the step leads from one custom style to another at one speed, as it does after a change of style.
bool changes_style(const StepPlan<Lanes<float>>& plan, std::size_t lane) {
  return plan.from.own_style[lane] >= 1 && plan.to.own_style[lane] >= 1 && plan.from.speed_m_s[lane] > 0 &&
         plan.from.speed_m_s[lane] == plan.to.speed_m_s[lane];
}

bool is_beyond(std::size_t bound, float value) {
  return value > static_cast<float>(walk_limits()[bound].limit);
}

}  // namespace

std::string described(const LimitViolation& broken) {
  const WalkLimit& limit = walk_limits()[static_cast<std::size_t>(broken.bound)];
  const auto shown = [&](double value) { return fmt::format("{:.4g}", value / limit.shown); };
  std::string says(limit.says);
  const std::string_view would = "would be";
  says.replace(says.find(would), would.size(), says.starts_with("toes") ? "are" : "is");
  return fmt::format("{}; the limit is {}", fmt::format(fmt::runtime(says), shown(static_cast<double>(broken.value))),
                     shown(limit.limit));
}

void count_limit_violations(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                            const GaitState<Lanes<float>>& state, const Gait<Lanes<float>>& wanted, const Rows& rows,
                            Tally<LimitViolations> beyond) {
  if (all_go_straight_on(plan, state)) return;
  std::uint32_t looked_at = 0;
  for (std::size_t l = 0; l < rows.live; ++l)
    if (turns_back(plan, state, l) ||
        (plan.settled[l] == 0 && (changes_style(plan, l) ||
                                  !has_usual_steps(size.leg_scale_m[l], wanted.speed_m_s[l], wanted.step_length_m[l]) ||
                                  !is_near_usual(row_of(wanted.style, l)))))
      looked_at |= 1U << l;
  if (looked_at == 0) return;
  StepBounds<Lanes<float>> bounds;
  bounds_now(size, plan, state, bounds);
  std::uint32_t broken = 0;
  for (std::size_t b = 0; b < bound_count; ++b)
    for (std::size_t l = 0; l < lane_count; ++l)
      broken |= static_cast<std::uint32_t>(is_beyond(b, bounds.value[b][l])) << l;
  beyond.add(static_cast<std::uint64_t>(std::popcount(broken & looked_at)));
}

std::vector<LimitViolation> limit_violations(const World& world, Entity person) {
  std::vector<LimitViolation> broken;
  const auto size = world.get<BodySize>(person);
  const auto plan = world.get<StepPlan>(person);
  const auto state = world.get<GaitState>(person);
  if (!size || !plan || !state) return broken;
  StepBounds<Lanes<float>> bounds;
  bounds_now(broadcast(*size), broadcast(*plan), broadcast(*state), bounds);
  for (std::size_t b = 0; b < bound_count; ++b)
    if (is_beyond(b, bounds.value[b][0])) broken.push_back({static_cast<WalkBound>(b), bounds.value[b][0]});
  return broken;
}

}  // namespace mobil::inline v0_3
