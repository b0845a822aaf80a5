#include "systems/activation/excitation.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include <mobil/anthropometry.h>
#include "engine/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

void excite_all(const RowExcitation& row, const LegClock<Lanes<float>>& clock, Lanes<float>* member) {
  const Wide asked = load(clock.speed), zero = wide(0.0F);
  const Wide moving = select(asked > zero, asked, zero);  // false for NaN
  const Wide speed = clamp(moving, min_excitation_speed, max_excitation_speed);
  const Wide walks = min(moving * (1 / min_excitation_speed), 1.0F);
  Wide wave[excitation_terms];
  wave[0] = wide(1.0F);
  sin_cos(load(clock.cycle) * 6.28318531F, wave[2], wave[1]);
  for (std::size_t k = 2; k <= excitation_harmonics; ++k) {
    const Wide &cos = wave[1], &sin = wave[2], &c = wave[2 * k - 3], &s = wave[2 * k - 2];
    wave[2 * k - 1] = fnma(s, sin, c * cos);
    wave[2 * k] = fma(s, cos, c * sin);
  }
  for (std::size_t m = 0; m < row.members; ++m) {
    const ExcitationTerms& terms = row.member[m].curve->terms;
    Wide sum = wide(0.0F);
    for (std::size_t i = 0; i < excitation_terms; ++i) {
      const Wide term = fma(speed, fma(speed, wide(terms[i][2]), wide(terms[i][1])), wide(terms[i][0]));
      sum = fma(term, wave[i], sum);
    }
    const Wide standing = wide(row.member[m].standing);
    const Wide level = fma(walks, excitation_scale * sum - standing, standing);
    const Wide least = wide(min_activation);
    store(select(level > least, min(level, max_activation), least), member[m]);
  }
}

/// Computes the clocks of the stance legs.
void find_clocks(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                 const GaitState<Lanes<float>>& state, LegClock<Lanes<float>>& clock) {
  constexpr auto leg_g = static_cast<float>(9.81 * fraction::hip_height);
  const Wide part = load(state.time_s) / load(plan.duration_s), from = load(plan.from.speed_m_s);
  store(part * 0.5F, clock.cycle);
  store(fma(load(plan.to.speed_m_s) - from, part, from) / sqrt(load(size.leg_scale_m) * leg_g), clock.speed);
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {
namespace {
HWY_EXPORT(excite_all);
HWY_EXPORT(find_clocks);
}  // namespace

RowExcitation row_excitation(Muscle muscle) {
  RowExcitation row{};
  for (const MemberMuscle& member : members_of(muscle)) row.member[row.members++] = member_excitation(member);
  return row;
}

void excite(const RowExcitation& row, const LegClock<Lanes<float>>& clock, Lanes<float>* member) {
  HWY_DYNAMIC_DISPATCH(excite_all)(row, clock, member);
}

void set_clocks(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                const GaitState<Lanes<float>>& state, PublishedLeg* posts) {
  LegClock<Lanes<float>> stance;
  HWY_DYNAMIC_DISPATCH(find_clocks)(size, plan, state, stance);
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const std::uint32_t side = state.stance_side[lane];
    posts[lane].leg[side & 1U].clock = {stance.cycle[lane], stance.speed[lane]};
    posts[lane].leg[~side & 1U].clock = {stance.cycle[lane] + 0.5F, stance.speed[lane]};
  }
}

}  // namespace mobil::inline v0_3
#endif
