#include "systems/activation/excitation.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/activation/excitation.cpp"
#include <hwy/foreach_target.h>

#include "engine/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {

void excite_all(const RowExcitation& row, const LegClock<Lanes<float>>& clock, Lanes<float>* member) {
  const Wide asked = load(clock.speed), zero = wide(0.0F);
  const Wide moving = select(asked > zero, asked, zero);  // not where it is no number
  const Wide speed = clamp(moving, least_excitation_speed, most_excitation_speed);
  const Wide walks = min(moving * (1 / least_excitation_speed), 1.0F);
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
    const Wide least = wide(least_activation);
    store(select(level > least, min(level, most_activation), least), member[m]);
  }
}

}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <cmath>

#include "assets/body/anthropometry.h"

namespace mobil {
namespace {
HWY_EXPORT(excite_all);
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
                const GaitState<Lanes<float>>& state, LegPost* posts) {
  constexpr auto leg_g = static_cast<float>(9.81 * fraction::hip_height);
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const float part = state.time_s[lane] / plan.duration_s[lane];
    const float from = plan.from.speed_m_s[lane], to = plan.to.speed_m_s[lane];
    const float speed = (from + (to - from) * part) / std::sqrt(leg_g * size.height_m[lane]);
    for (const Side side : {Side::right, Side::left}) {
      const bool stance = state.stance_side[lane] == side;
      posts[lane].leg[side].clock = {0.5F * part + (stance ? 0.0F : 0.5F), speed};
    }
  }
}

}  // namespace mobil
#endif
