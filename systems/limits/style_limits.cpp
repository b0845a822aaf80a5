#include <mobil/systems/limits/style_limits.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <new>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/rows.h>
#include <mobil/systems/limits/walk_limits.h>
#include "systems/gait/gait.h"
#include "systems/limits/walk_estimate.h"

namespace mobil::inline v0_3 {
namespace {
constexpr std::size_t parameter_count = gait_parameters.size();
/// Search from the requested style toward the usual one for up to 16 walkers, with `lanes_each` lanes per walker.
/// Several lanes evaluate several possible next results at once, with the same outcome.
class StyleLimitSearch {
 public:
  StyleLimitSearch(std::span<const BodySize<float>> sizes, std::span<const Gait<float>> gaits,
                   std::span<const std::size_t> people, Looking looking, std::size_t lanes_each = 1);
  /// Finds the walkers that break a limit with the requested style, or come near one if walks are examined roughly.
  std::array<bool, lane_count> broken();
  /// Moves step lengths and styles as far as limits require. See mobil/systems/limits/style_limits.h.
  void clamp_toward_default();
  /// Results of clamp_toward_default by walker: true if anything was moved; the style and the step length; and the
  /// changes, step length before style parameters.
  bool is_drawn(std::size_t walker) const { return walkers_[walker].step_why || walkers_[walker].is_moved(); }
  const GaitStyle& style(std::size_t walker) const { return walkers_[walker].style; }
  float step_length_m(std::size_t walker) const { return walkers_[walker].length_m(); }
  std::vector<StyleChange> changes(std::size_t walker) const;

 private:
  static constexpr GaitStyle usual_{};
  static constexpr std::size_t try_usual_walk = 0, try_usual_style = 1, try_as_asked = 2, try_without = 3;
  /// With one of these at its usual value, the first one preferred, 99 of 100 styles near the usual one keep their
  /// limit.
  static constexpr std::array without = {&GaitStyle::pelvis_tilt_deg, &GaitStyle::double_support_scale};
  static constexpr std::size_t tries = try_without + without.size();

  /// A bound that a walk breaks, and the value that it reaches.
  struct Break {
    WalkBound bound;
    float value;
    WalkPart part;
  };
  struct Walker {
    GaitStyle asked{}, style{};  // `style` and `step_share` are tried values, and at the end the kept ones
    float asked_m = 0, usual_m = 0, step_share = 1;
    std::optional<Break> step_why;
    std::array<bool, parameter_count> moved{};
    std::array<Break, parameter_count> why{};
    std::optional<std::size_t> culprit;  // index in `without`: all other parameters can stay as requested

    bool is_moved() const { return std::ranges::count(moved, true) > 0; }
    /// Returns the requested style with the moved parameters at this share of the way from their usual values.
    GaitStyle at(float share) const {
      GaitStyle there = asked;
      for (std::size_t p = 0; p < parameter_count; ++p) {
        const auto value = gait_parameters[p].value;
        if (moved[p]) there.*value = usual_.*value + share * (asked.*value - usual_.*value);
      }
      return there;
    }
    float length_m() const { return step_share == 1 ? asked_m : usual_m + step_share * (asked_m - usual_m); }
  };

  std::span<Walker> walkers() { return std::span(walkers_).first(people_); }
  std::size_t walker_of(std::size_t lane) const { return lane / each_ < people_ ? lane / each_ : 0; }
  void hold_to_limits();
  std::array<bool, lane_count> still_broken();
  void look_at_walkers();
  /// Examines the usual walk, which limits must allow; the usual style with the requested steps; the full request; and
  /// the request with one parameter at its usual value.
  void look_at_usual_and_asked();
  void note_try(std::size_t which, std::size_t w, std::size_t lane);
  void try_in(std::size_t lane, const Walker& walker);
  /// Computes the extremes of the walks to be tried.
  void look();
  /// Returns the bound that the last examined walk breaks by the largest part of its limit.
  std::optional<Break> worst(std::size_t lane) const;
  /// Restores one requested parameter after another, and keeps it if no limit breaks. A walker's lanes try the next
  /// parameters, each with all before it. Results are valid up to the first one that breaks a limit.
  void give_back();
  /// Finds the largest share of the request at which no limit breaks, by halving, for the walkers selected by `of`.
  /// Share 0 is accepted unseen. `set` applies a share. A walker's lanes try all possible next halvings as a binary
  /// tree, in which node n has the children 2n and 2n + 1.
  template <class Of, class Set>
  void halve(Of of, Set set);

  std::size_t people_, each_;
  Looking looking_;
  std::array<Walker, lane_count> walkers_;
  std::array<Gait<float>, lane_count> gait_row_;
  BodySize<Lanes<float>> size_{};
  Gait<Lanes<float>> gait_{};
  WalkExtremes found_{};
  struct {
    Lanes<float> steady[bound_count], changing[bound_count];
  } held_;                                       // limits for the values of WalkExtremes
  std::array<bool, lane_count> asked_broken_{};  // by walker
};

constexpr int halvings = 8;

/// Parameters that are blamed last, the last of them first, where changing any one of several would do.
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

/// Returns the order in which the requested parameters are restored.
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

StyleLimitSearch::StyleLimitSearch(std::span<const BodySize<float>> sizes, std::span<const Gait<float>> gaits,
                                   std::span<const std::size_t> people, Looking looking, std::size_t lanes_each)
    : people_(people.size()), each_(lanes_each), looking_(looking) {
  for (std::size_t w = 0; w < people_; ++w) {
    const Gait<float>& gait = gaits[people[w]];
    Walker& walker = walkers_[w];
    walker.asked = walker.style = gait.style;
    walker.asked_m = walker.usual_m = gait.step_length_m;
    const float leg_m = sizes[people[w]].leg_scale_m, speed = gait.speed_m_s;
    if (!has_usual_steps(leg_m, speed, gait.step_length_m)) walker.usual_m = usual_length_m(leg_m, speed);
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

std::array<bool, lane_count> StyleLimitSearch::broken() {
  hold_to_limits();
  return still_broken();
}

void StyleLimitSearch::clamp_toward_default() {
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

std::vector<StyleChange> StyleLimitSearch::changes(std::size_t walker) const {
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

void StyleLimitSearch::hold_to_limits() {
  for (std::size_t l = 0; l < lane_count; ++l) {
    const bool usual_style = same_style(walkers_[walker_of(l)].asked, usual_);
    for (std::size_t b = 0; b < bound_count; ++b) {
      held_.steady[b][l] = held_to(b, looking_, usual_style);
      held_.changing[b][l] = held_to(b, Looking::closely, usual_style);
    }
  }
}

std::array<bool, lane_count> StyleLimitSearch::still_broken() {
  look_at_walkers();
  std::array<bool, lane_count> broken{};
  for (std::size_t w = 0; w < people_; ++w) broken[w] = worst(w * each_).has_value();
  return broken;
}

void StyleLimitSearch::look_at_walkers() {
  for (std::size_t l = 0; l < lane_count; ++l) try_in(l, walkers_[walker_of(l)]);
  look();
}

void StyleLimitSearch::look_at_usual_and_asked() {
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

void StyleLimitSearch::note_try(std::size_t which, std::size_t w, std::size_t lane) {
  const auto breaks = which == try_usual_walk ? std::nullopt : worst(lane);
  Walker& walker = walkers_[w];
  if (which == try_usual_style) walker.step_why = breaks;
  if (which == try_as_asked) asked_broken_[w] = breaks.has_value();
  if (which == try_as_asked && breaks) walker.why.fill(*breaks);
  if (which >= try_without && !breaks && !walker.culprit) walker.culprit = which - try_without;
  for (std::size_t b = 0; b < bound_count && which == try_usual_walk; ++b) {
    // A walk that exceeds the usual one only slightly needs no margin for turns, because the usual walk turns as well.
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

void StyleLimitSearch::try_in(std::size_t lane, const Walker& walker) {
  Gait<float>& row = gait_row_[lane];
  row.style = walker.style;
  row.step_length_m = walker.length_m();
  row.step_frequency_hz = walker.asked_m > 0 ? row.speed_m_s / row.step_length_m : 0;
}

void StyleLimitSearch::look() {
  for (std::size_t l = 0; l < lane_count; ++l) put_row(gait_row_[l], gait_, l);
  walk_extremes(size_, gait_, looking_, found_);
}

std::optional<StyleLimitSearch::Break> StyleLimitSearch::worst(std::size_t lane) const {
  std::optional<Break> worst;
  double most = 0;
  const auto note = [&](std::size_t b, const WalkReach& reach, float held) {
    const double by = static_cast<double>(reach.value[b][lane] - held) / std::max(walk_limits()[b].limit, 0.1);
    if (by <= most) return;
    most = by;
    worst = Break{static_cast<WalkBound>(b), reach.value[b][lane], reach.part[b][lane]};
  };
  // The usual style with the requested steps needs no margin for turns.
  const bool usual = same_style(gait_row_[lane].style, usual_);
  for (std::size_t b = 0; b < bound_count; ++b) {
    const float steady = held_.steady[b][lane];
    const bool more = usual && for_turns(static_cast<WalkBound>(b), looking_) > 0;
    note(b, found_.steady, more ? std::max(steady, held_to(b, Looking::closely, false)) : steady);
    note(b, found_.changing, held_.changing[b][lane]);
  }
  return worst;
}

void StyleLimitSearch::give_back() {
  static const auto order = giving_back_order();
  std::array<std::size_t, lane_count> next{};
  for (;;) {
    std::array<std::array<std::size_t, lane_count>, lane_count> given{};  // indices in `order`
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
void StyleLimitSearch::halve(Of of, Set set) {
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

namespace {

/// Returns true for the usual style with usual steps.
bool is_usual(float height_m, const Gait<float>& gait) {
  return same_style(gait.style, {}) && has_usual_steps(height_m, gait.speed_m_s, gait.step_length_m);
}

/// Returns true if a style is near the usual one, and its stop keeps all limits that its steady walk keeps. Among 12
/// 000 random styles with each number within a tenth of the usual one, 230 broke a limit only while stopping, all with
/// mid-stance at 0.910 or lower. Styles that pass are examined roughly first, the others including stops.
bool stops_as_it_walks(const GaitStyle& style) {
  return is_near_usual(style) && style.mid_stance_height >= 0.93F;
}

/// Adds changes to a gait that can have earlier changes, whose requested values and reasons stay. The step length comes
/// first, then the style parameters.
void add_changes(std::span<const StyleChange> later, std::vector<StyleChange>& changes) {
  for (const StyleChange& change : later) {
    const auto before = std::ranges::find(changes, change.parameter, &StyleChange::parameter);
    if (before == changes.end())
      changes.push_back(change);
    else
      before->walked = change.walked;
  }
  std::ranges::sort(changes, {},
                    [](const StyleChange& change) { return (change.parameter + 1) % (parameter_count + 1); });
}

}  // namespace

std::string described(const StyleChange& change) {
  const WalkLimit& limit = walk_limits()[static_cast<std::size_t>(change.bound)];
  const bool raised = change.walked > change.asked;
  const std::string number = fmt::format("{:.3g}", static_cast<double>(change.would_be) / limit.shown);
  const std::string_view name =
      change.parameter < parameter_count ? gait_parameters[change.parameter].name : "step_length_m";
  return fmt::format("{} {} was {} to {:.4g}: {} {} {:.3g} m/s", name, change.asked, raised ? "raised" : "lowered",
                     change.walked, fmt::format(fmt::runtime(limit.says), number), said_of(change.part),
                     change.speed_m_s);
}

void keep_walk_limits(const Jobs& jobs, std::span<const BodySize<float>> sizes, std::span<Gait<float>> gaits,
                      StyleLimitWork& work, std::span<std::vector<StyleChange>> moved) {
  // The reserved memory depends on the number of people alone.
  for (std::vector<StyleChange>& of : moved) of.clear();
  for (auto* const list : {&work.near, &work.far, &work.farther}) {
    list->clear();
    if (list->capacity() < gaits.size()) list->reserve(2 * gaits.size());
  }
  if (work.breaks.capacity() < gaits.size()) work.breaks.reserve(2 * gaits.size());
  work.breaks.assign(gaits.size(), 1);
  in_parallel(jobs, gaits.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (is_usual(sizes[i].leg_scale_m, gaits[i]) ||
          (stops_as_it_walks(gaits[i].style) && surely_keeps_limits(sizes[i], gaits[i])))
        work.breaks[i] = 0;
  });
  for (std::size_t i = 0; i < gaits.size(); ++i)
    if (work.breaks[i] != 0) (stops_as_it_walks(gaits[i].style) ? work.near : work.far).push_back(i);
  if (work.near.empty() && work.far.empty()) return;
  const auto in_blocks = [&](std::span<const std::size_t> people, Looking looking, std::size_t lanes_each,
                             auto look_at) {
    const std::size_t of_block = lane_count / lanes_each;
    work.searches.prepare((sizeof(StyleLimitSearch) + sizeof(float) - 1) / sizeof(float), jobs.threads);
    in_parallel(jobs, (people.size() + of_block - 1) / of_block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t first = begin * of_block; first < std::min(end * of_block, people.size()); first += of_block) {
        const auto some = people.subspan(first, std::min(of_block, people.size() - first));
        const ScratchLease room(&work.searches);
        look_at(some, *new (room.data()) StyleLimitSearch(sizes, gaits, some, looking, lanes_each));  // owns nothing
      }
    });
  };
  // Few people come near a limit or break one, so these are collected in blocks of their own.
  const auto keep_broken = [&](std::vector<std::size_t>& people, Looking looking) {
    in_blocks(people, looking, 1, [&](std::span<const std::size_t> some, StyleLimitSearch& block) {
      const auto broken = block.broken();
      for (std::size_t l = 0; l < some.size(); ++l) work.breaks[some[l]] = static_cast<std::uint8_t>(broken[l]);
    });
    std::erase_if(people, [&](std::size_t i) { return work.breaks[i] == 0; });
  };
  const auto draw = [&](std::span<const std::size_t> some, StyleLimitSearch& block) {
    block.clamp_toward_default();
    for (std::size_t w = 0; w < some.size(); ++w) {
      if (!block.is_drawn(w)) continue;
      const float height_m = sizes[some[w]].leg_scale_m;
      Gait<float>& gait = gaits[some[w]];
      if (!moved.empty()) add_changes(block.changes(w), moved[some[w]]);
      const Gait<float> kept = complete_gait(height_m, gait.speed_m_s, block.step_length_m(w), block.style(w));
      gait.style = kept.style;
      gait.step_length_m = kept.step_length_m;
      gait.step_frequency_hz = kept.step_frequency_hz;
      gait.double_support_cycle = kept.double_support_cycle;
    }
  };
  // Uses as many lanes per walker as keep all threads busy in one round.
  const auto draw_all = [&](std::vector<std::size_t>& people, Looking looking, std::size_t lanes_each = lane_count) {
    while (lanes_each > 1 && people.size() * lanes_each > lane_count * std::max<std::size_t>(jobs.threads, 1))
      lanes_each /= 2;
    in_blocks(people, looking, lanes_each, draw);
  };
  keep_broken(work.near, Looking::roughly);
  keep_broken(work.near, Looking::closely);
  draw_all(work.near, Looking::closely);
  std::ranges::copy_if(work.far, std::back_inserter(work.farther),
                       [&](std::size_t i) { return !is_near_usual(gaits[i].style); });
  keep_broken(work.far, Looking::at_stops_too);
  draw_all(work.far, Looking::at_stops_too);
  keep_broken(work.farther, Looking::at_changes);
  draw_all(work.farther, Looking::at_changes_too);
}

std::vector<StyleChange> keep_walk_limits(const BodySize<float>& size, Gait<float>& gait) {
  std::vector<StyleChange> moved;
  StyleLimitWork work;
  keep_walk_limits({}, {&size, 1}, {&gait, 1}, work, {&moved, 1});
  return moved;
}

}  // namespace mobil::inline v0_3
