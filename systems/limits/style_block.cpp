#include "systems/limits/style_block.h"

#include <cmath>
#include <iterator>

#include <mobil/rows.h>
#include "systems/gait/gait.h"

namespace mobil::inline v0_3 {
namespace {

constexpr int halvings = 8;

/// Besides, in steady walks and stops of styles far from the usual one: turns and changes of speed bend hips and ankles
/// so much further.
double for_turns(WalkBound bound, Looking looking) {
  using enum WalkBound;
  if (looking != Looking::at_stops_too && looking != Looking::at_changes_too) return 0;
  return bound == ankle_up || bound == ankle_down ? 0.12 : bound == hip_back || bound == hip_forward ? 0.04 : 0;
}

/// What is kept free below the limits, for a walk goes a little further between the instants that are looked at.
/// The usual style with other steps moves smoothly.
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

/// Numbers that are blamed last, the last of them first, where one of several would do.
constexpr float GaitStyle::*blamed[] = {&GaitStyle::strike_pitch_deg,
                                        &GaitStyle::strike_knee_deg,
                                        &GaitStyle::stance_knee_deg,
                                        &GaitStyle::swing_ankle_deg,
                                        &GaitStyle::swing_knee_deg,
                                        &GaitStyle::toe_clearance_m,
                                        &GaitStyle::foot_pivot_h,
                                        &GaitStyle::roll_over,
                                        &GaitStyle::hip_fall,
                                        &GaitStyle::leg_damping,
                                        &GaitStyle::leg_stiffness_n_per_m,
                                        &GaitStyle::toe_off_knee_deg,
                                        &GaitStyle::knee_release_cycle,
                                        &GaitStyle::double_support_scale,
                                        &GaitStyle::forward_swing,
                                        &GaitStyle::pelvis_tilt_deg,
                                        &GaitStyle::toe_out_deg,
                                        &GaitStyle::mid_stance_height,
                                        &GaitStyle::foot_flat_cycle,
                                        &GaitStyle::step_asymmetry,
                                        &GaitStyle::time_asymmetry};

/// In which numbers are given back what was asked of them.
std::array<std::size_t, gait_parameters.size()> giving_back_order() {
  std::array<std::size_t, gait_parameters.size()> order{};
  std::size_t count = 0;
  for (std::size_t p = 0; p < gait_parameters.size(); ++p)
    if (std::ranges::find(blamed, gait_parameters[p].value) == std::end(blamed)) order[count++] = p;
  for (const auto value : blamed)
    order[count++] = static_cast<std::size_t>(std::ranges::find(gait_parameters, value, &GaitParameter::value) -
                                              gait_parameters.begin());
  return order;
}

}  // namespace

StyleBlock::StyleBlock(std::span<const BodySize<float>> sizes, std::span<const Gait<float>> gaits,
                       std::span<const std::size_t> people, Looking looking, std::size_t lanes_each)
    : people_(people.size()), each_(lanes_each), looking_(looking) {
  for (std::size_t w = 0; w < people_; ++w) {
    const Gait<float>& gait = gaits[people[w]];
    Walker& walker = walkers_[w];
    walker.asked = walker.style = gait.style;
    walker.asked_m = gait.step_length_m;
    walker.usual_m = usual_length_m(sizes[people[w]].height_m, gait.speed_m_s);
  }
  for (std::size_t l = 0; l < lane_count; ++l) {
    const std::size_t i = people[walker_of(l)];
    put_row(sizes[i], size_, l);
    Gait<float>& row = gait_row_[l];
    row = {};
    row.speed_m_s = gaits[i].speed_m_s;
    row.step_length_m = gaits[i].step_length_m;
    row.step_frequency_hz = gaits[i].step_frequency_hz;
  }
}

std::array<bool, lane_count> StyleBlock::broken() {
  hold_to_limits();
  return still_broken();
}

void StyleBlock::draw_nearer() {
  hold_to_limits();
  look_at_usual_and_asked();
  const auto is_shortened = [](const Walker& walker) { return walker.step_why.has_value(); };
  halve(is_shortened, [](Walker& walker, float share) { walker.step_share = share; });
  for (Walker& walker : walkers()) walker.style = walker.asked;
  if (std::ranges::any_of(walkers(), is_shortened)) asked_broken_ = still_broken();
  for (std::size_t w = 0; w < people_; ++w) {
    Walker& walker = walkers_[w];
    if (!asked_broken_[w] || walker.step_why) walker.culprit.reset();
    for (std::size_t p = 0; p < parameter_count; ++p) {
      const auto value = gait_parameters[p].value;
      walker.moved[p] = asked_broken_[w] &&
                        (walker.culprit ? value == without[*walker.culprit] : walker.asked.*value != usual_.*value);
    }
  }
  give_back();
  halve([](const Walker& walker) { return walker.is_moved(); },
        [](Walker& walker, float share) { walker.style = walker.at(share); });
}

std::vector<StyleChange> StyleBlock::changes(std::size_t walker) const {
  std::vector<StyleChange> changes;
  const Walker& of = walkers_[walker];
  const float speed_m_s = gait_row_[walker * each_].speed_m_s;
  if (const auto& why = of.step_why)
    changes.push_back({parameter_count, of.asked_m, of.length_m(), why->bound, why->value, speed_m_s, why->part});
  for (std::size_t p = 0; p < parameter_count; ++p) {
    const auto value = gait_parameters[p].value;
    if (!of.moved[p] || of.asked.*value == of.style.*value) continue;
    changes.push_back(
        {p, of.asked.*value, of.style.*value, of.why[p].bound, of.why[p].value, speed_m_s, of.why[p].part});
  }
  return changes;
}

void StyleBlock::hold_to_limits() {
  for (std::size_t l = 0; l < lane_count; ++l) {
    const bool usual_style = same_style(walkers_[walker_of(l)].asked, usual_);
    for (std::size_t b = 0; b < bound_count; ++b) {
      held_.steady[b][l] = held_to(b, looking_, usual_style);
      held_.changing[b][l] = held_to(b, Looking::closely, usual_style);
    }
  }
}

std::array<bool, lane_count> StyleBlock::still_broken() {
  look_at_walkers();
  std::array<bool, lane_count> broken{};
  for (std::size_t w = 0; w < people_; ++w) broken[w] = worst(w * each_).has_value();
  return broken;
}

void StyleBlock::look_at_walkers() {
  for (std::size_t l = 0; l < lane_count; ++l) try_in(l, walkers_[walker_of(l)]);
  look();
}

void StyleBlock::look_at_usual_and_asked() {
  const auto together = std::min(each_, tries);
  for (std::size_t first = 0; first < tries; first += together) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      const std::size_t which = std::min(first + l % each_, tries - 1);
      Walker walker = walkers_[walker_of(l)];
      if (which < try_as_asked) walker.style = usual_;
      if (which >= try_without) walker.style.*without[which - try_without] = usual_.*without[which - try_without];
      walker.step_share = which == try_usual_walk ? 0 : 1;
      try_in(l, walker);
    }
    look();
    for (std::size_t which = first; which < std::min(first + together, tries); ++which)
      for (std::size_t w = 0; w < people_; ++w) note_try(which, w, w * each_ + which - first);
  }
  for (Walker& walker : walkers()) walker.style = usual_;
}

void StyleBlock::note_try(std::size_t which, std::size_t w, std::size_t lane) {
  const auto breaks = which == try_usual_walk ? std::nullopt : worst(lane);
  Walker& walker = walkers_[w];
  if (which == try_usual_style) walker.step_why = breaks;
  if (which == try_as_asked) asked_broken_[w] = breaks.has_value();
  if (which == try_as_asked && breaks) walker.why.fill(*breaks);
  if (which >= try_without && !breaks && !walker.culprit) walker.culprit = which - try_without;
  for (std::size_t b = 0; b < bound_count && which == try_usual_walk; ++b) {
    // What is kept free for turns is not asked of who goes little further than the usual walk, which turns as well.
    constexpr float little_rad = 0.05F;
    const float usual = found_.steady.value[b][lane], changing = found_.changing.value[b][lane];
    const bool more = for_turns(static_cast<WalkBound>(b), looking_) > 0;
    const float near = more ? std::min(usual + little_rad, held_to(b, Looking::closely, false)) : usual;
    for (std::size_t l = w * each_; l < (w + 1) * each_; ++l) {
      held_.steady[b][l] = std::max({held_.steady[b][l], usual, near});
      held_.changing[b][l] = std::max(held_.changing[b][l], changing);
    }
  }
}

void StyleBlock::try_in(std::size_t lane, const Walker& walker) {
  Gait<float>& row = gait_row_[lane];
  row.style = walker.style;
  row.step_length_m = walker.length_m();
  row.step_frequency_hz = walker.asked_m > 0 ? row.speed_m_s / row.step_length_m : 0;
}

void StyleBlock::look() {
  for (std::size_t l = 0; l < lane_count; ++l) put_row(gait_row_[l], gait_, l);
  walk_extremes(size_, gait_, looking_, found_);
}

std::optional<StyleBlock::Break> StyleBlock::worst(std::size_t lane) const {
  std::optional<Break> worst;
  double most = 0;
  const auto note = [&](std::size_t b, const WalkReach& reach, float held) {
    const double by = static_cast<double>(reach.value[b][lane] - held) / std::max(walk_limits()[b].limit, 0.1);
    if (by <= most) return;
    most = by;
    worst = Break{static_cast<WalkBound>(b), reach.value[b][lane], reach.part[b][lane]};
  };
  // The usual style with the steps asked for needs nothing free for turns.
  const bool usual = same_style(gait_row_[lane].style, usual_);
  for (std::size_t b = 0; b < bound_count; ++b) {
    const float steady = held_.steady[b][lane];
    const bool more = usual && for_turns(static_cast<WalkBound>(b), looking_) > 0;
    note(b, found_.steady, more ? std::max(steady, held_to(b, Looking::closely, false)) : steady);
    note(b, found_.changing, held_.changing[b][lane]);
  }
  return worst;
}

void StyleBlock::give_back() {
  static const auto order = giving_back_order();
  std::array<std::size_t, lane_count> next{};
  for (;;) {
    std::array<std::array<std::size_t, lane_count>, lane_count> given{};  // places in `order`
    std::array<std::size_t, lane_count> count{};
    bool any = false;
    for (std::size_t w = 0; w < people_; ++w) {
      Walker walker = walkers_[w];
      if (walker.culprit) continue;
      for (std::size_t k = next[w]; k < parameter_count && count[w] < each_; ++k) {
        if (!walker.moved[order[k]]) continue;
        walker.moved[order[k]] = false;
        walker.style = walker.at(0);
        try_in(w * each_ + count[w], walker);
        given[w][count[w]++] = k;
        any = true;
      }
    }
    if (!any) break;
    for (std::size_t l = 0; l < lane_count; ++l)  // lanes without a try settle at once
      if (l / each_ >= people_ || l % each_ >= count[l / each_]) gait_row_[l].style = usual_;
    look();
    for (std::size_t w = 0; w < people_; ++w) {
      Walker& walker = walkers_[w];
      for (std::size_t c = 0; c < count[w]; ++c) {
        const std::size_t p = order[given[w][c]];
        const auto breaks = worst(w * each_ + c);
        next[w] = given[w][c] + 1;
        walker.moved[p] = breaks.has_value();
        if (!breaks) continue;
        walker.why[p] = *breaks;
        break;
      }
    }
  }
}

template <class Of, class Set>
void StyleBlock::halve(Of of, Set set) {
  struct Between {
    float kept, broken_at;
    float middle() const { return 0.5F * (kept + broken_at); }
  };
  int depth = 1;
  while ((std::size_t{2} << depth) <= each_ + 1) ++depth;
  std::array<Between, lane_count> now;
  now.fill({0, 1});
  const bool none = std::ranges::none_of(walkers(), of);
  for (int done = 0; done < halvings && !none; done += depth) {
    std::array<std::array<Between, 2 * lane_count>, lane_count> tree{};
    for (std::size_t w = 0; w < people_; ++w) {
      tree[w][1] = now[w];
      for (std::size_t n = 1; n < std::size_t{1} << depth; ++n) {
        const Between& at = tree[w][n];
        tree[w][2 * n] = {at.kept, at.middle()};
        tree[w][2 * n + 1] = {at.middle(), at.broken_at};
        Walker walker = walkers_[w];
        if (of(walker)) set(walker, at.middle());
        try_in(w * each_ + n - 1, walker);
      }
    }
    look();
    for (std::size_t w = 0; w < people_; ++w) {
      std::size_t n = 1;
      for (int level = 0; level < depth && done + level < halvings; ++level)
        n = 2 * n + (worst(w * each_ + n - 1) ? 0 : 1);
      now[w] = tree[w][n];
    }
  }
  for (std::size_t w = 0; w < people_; ++w)
    if (of(walkers_[w])) set(walkers_[w], now[w].kept);
}

}  // namespace mobil::inline v0_3
