#include "systems/people/style_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <string_view>

#include "assets/gait/step_table.h"
#include "engine/rows.h"
#include "systems/gait/gait.h"
#include "systems/people/person.h"
#include "systems/people/style_estimate.h"
#include "systems/people/walk_limits.h"

namespace mobil {
namespace {

constexpr std::size_t parameter_count = gait_parameters.size();
constexpr int halvings = 8;

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
                                                                : spare.rad;
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
std::array<std::size_t, parameter_count> giving_back_order() {
  std::array<std::size_t, parameter_count> order{};
  std::size_t count = 0;
  for (std::size_t p = 0; p < parameter_count; ++p)
    if (std::ranges::find(blamed, gait_parameters[p].value) == std::end(blamed)) order[count++] = p;
  for (const auto value : blamed)
    order[count++] = static_cast<std::size_t>(std::ranges::find(gait_parameters, value, &GaitParameter::value) -
                                              gait_parameters.begin());
  return order;
}

/// The step that is usual at a speed, m.
float usual_length_m(float height_m, float speed_m_s) {
  if (speed_m_s == 0) return 0;
  const auto gait = resolve_gait(height_m, {.speed_m_s = speed_m_s});
  return gait ? gait->step_length_m : 0;
}

bool same_walk(const Gait<float>& a, const Gait<float>& b) {
  return a.speed_m_s == b.speed_m_s && a.step_length_m == b.step_length_m && same_style(a.style, b.style);
}

/// Usual steps of the usual style: of lengths that the table of steps has (assets/gait/README.md).
bool is_usual(float height_m, const Gait<float>& gait) {
  if (!same_style(gait.style, {})) return false;
  const float length_m = usual_length_m(height_m, gait.speed_m_s);
  constexpr auto shortest = static_cast<float>(step_table::length.front()),
                 longest = static_cast<float>(step_table::length.back());
  return gait.step_length_m >= shortest * length_m && gait.step_length_m <= longest * length_m;
}

/// A bound that a walk breaks, and where it would come to.
struct Break {
  WalkBound bound;
  float value;
};

/// Sixteen walkers on the way from the usual style to that asked for.
class StyleBlock {
 public:
  /// Of those people: at most sixteen.
  StyleBlock(std::span<const BodySize<float>> sizes, std::span<const Gait<float>> gaits,
             std::span<const std::size_t> people) {
    step_share_.fill(1);
    for (std::size_t l = 0; l < lane_count; ++l) {
      const std::size_t i = people[l < people.size() ? l : 0];
      put_row(sizes[i], size_, l);
      Gait<float>& row = gait_row_[l];
      row = {};
      row.speed_m_s = gaits[i].speed_m_s;
      row.step_length_m = gaits[i].step_length_m;
      row.step_frequency_hz = gaits[i].step_frequency_hz;
      asked_[l] = tried_[l] = gaits[i].style;
      asked_m_[l] = gaits[i].step_length_m;
      usual_m_[l] = usual_length_m(sizes[i].height_m, gaits[i].speed_m_s);
    }
  }

  /// Who breaks a limit as asked, be it with the usual style too, or roughly looked at comes near.
  std::array<bool, lane_count> broken(Looking looking) {
    hold_to_limits(looking);
    return still_broken(looking);
  }
  void draw_nearer() {
    hold_to_limits(Looking::closely);
    tried_.fill(usual_);
    step_share_.fill(0);
    look();
    for (std::size_t b = 0; b < bound_count; ++b)
      for (std::size_t l = 0; l < lane_count; ++l) held_[b][l] = std::max(held_[b][l], found_.value[b][l]);
    step_share_.fill(1);
    drawn_ = still_broken(Looking::closely);
    for (std::size_t l = 0; l < lane_count; ++l) step_why_[l] = worst(l);
    if (any(drawn_)) halve([&](std::size_t l, float share) { step_share_[l] = step_why_[l] ? share : 1; });
    tried_ = asked_;
    const auto broken = still_broken(Looking::closely);
    for (std::size_t l = 0; l < lane_count; ++l) drawn_[l] = drawn_[l] || broken[l];
    if (!any(broken)) return;
    for (std::size_t l = 0; l < lane_count; ++l)
      if (broken[l]) moved_[l].fill(true);
    give_back();
    halve([&](std::size_t l, float share) { tried_[l] = at(l, share); });
  }

  bool is_drawn(std::size_t lane) const { return drawn_[lane]; }
  const GaitStyle& style(std::size_t lane) const { return tried_[lane]; }
  float step_length_m(std::size_t lane) const { return length_m(lane); }
  std::vector<StyleChange> changes(std::size_t lane) const {
    std::vector<StyleChange> changes;
    const float speed_m_s = gait_row_[lane].speed_m_s;
    if (const auto& why = step_why_[lane])
      changes.push_back({parameter_count, asked_m_[lane], length_m(lane), why->bound, why->value, speed_m_s});
    for (std::size_t p = 0; p < parameter_count; ++p) {
      const auto value = gait_parameters[p].value;
      if (!moved_[lane][p] || asked_[lane].*value == tried_[lane].*value) continue;
      const Break& why = why_[lane][p];
      changes.push_back({p, asked_[lane].*value, tried_[lane].*value, why.bound, why.value, speed_m_s});
    }
    return changes;
  }

 private:
  void hold_to_limits(Looking looking) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      const bool usual_style = same_style(asked_[l], usual_);
      for (std::size_t b = 0; b < bound_count; ++b) held_[b][l] = held_to(b, looking, usual_style);
    }
  }
  std::array<bool, lane_count> still_broken(Looking looking) {
    look(looking);
    std::array<bool, lane_count> broken{};
    for (std::size_t l = 0; l < lane_count; ++l) broken[l] = worst(l).has_value();
    return broken;
  }
  /// How far the walks go that are tried.
  void look(Looking looking = Looking::closely) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      gait_row_[l].style = tried_[l];
      gait_row_[l].step_length_m = length_m(l);
      gait_row_[l].step_frequency_hz = asked_m_[l] > 0 ? gait_row_[l].speed_m_s / length_m(l) : 0;
      put_row(gait_row_[l], gait_, l);
    }
    walk_extremes(size_, gait_, looking, found_);
  }
  /// What the walk looked at last breaks most, in parts of the limit.
  std::optional<Break> worst(std::size_t lane) const {
    std::optional<Break> worst;
    double most = 0;
    for (std::size_t b = 0; b < bound_count; ++b) {
      const float value = found_.value[b][lane];
      const double by = static_cast<double>(value - held_[b][lane]) / std::max(walk_limits()[b].limit, 0.1);
      if (by <= most) continue;
      most = by;
      worst = Break{static_cast<WalkBound>(b), value};
    }
    return worst;
  }
  /// All that may stay as asked, and the others so far from the usual ones.
  GaitStyle at(std::size_t lane, float share) const {
    GaitStyle style = asked_[lane];
    for (std::size_t p = 0; p < parameter_count; ++p) {
      const auto value = gait_parameters[p].value;
      if (moved_[lane][p]) style.*value = usual_.*value + share * (asked_[lane].*value - usual_.*value);
    }
    return style;
  }
  float length_m(std::size_t lane) const {
    return step_share_[lane] == 1 ? asked_m_[lane]
                                  : usual_m_[lane] + step_share_[lane] * (asked_m_[lane] - usual_m_[lane]);
  }
  static bool any(const std::array<bool, lane_count>& lanes) {
    return std::ranges::any_of(lanes, [](bool is) { return is; });
  }
  /// One number after another becomes what was asked, and stays so if nothing breaks.
  void give_back() {
    static const auto order = giving_back_order();
    for (const std::size_t p : order) {
      const auto value = gait_parameters[p].value;
      std::array<bool, lane_count> given{};
      for (std::size_t l = 0; l < lane_count; ++l) {
        given[l] = moved_[l][p] && asked_[l].*value != usual_.*value;
        moved_[l][p] = false;
        tried_[l] = at(l, 0);
      }
      if (!any(given)) continue;
      look();
      for (std::size_t l = 0; l < lane_count; ++l) {
        const auto breaks = given[l] ? worst(l) : std::nullopt;
        moved_[l][p] = breaks.has_value();
        if (breaks) why_[l][p] = *breaks;
      }
    }
  }
  /// Shares of what was asked, as large as nothing breaks, from that of 0 on; `set` has it tried.
  template <class Set>
  void halve(Set set) {
    std::array<float, lane_count> kept{}, broken_at{};
    broken_at.fill(1);
    for (int i = 0; i < halvings; ++i) {
      for (std::size_t l = 0; l < lane_count; ++l) set(l, 0.5F * (kept[l] + broken_at[l]));
      look();
      for (std::size_t l = 0; l < lane_count; ++l) (worst(l) ? broken_at : kept)[l] = 0.5F * (kept[l] + broken_at[l]);
    }
    for (std::size_t l = 0; l < lane_count; ++l) set(l, kept[l]);
  }

  static constexpr GaitStyle usual_{};
  std::array<GaitStyle, lane_count> asked_, tried_;
  std::array<Gait<float>, lane_count> gait_row_;
  std::array<std::array<bool, parameter_count>, lane_count> moved_{};
  std::array<std::array<Break, parameter_count>, lane_count> why_{};
  std::array<bool, lane_count> drawn_{};
  std::array<float, lane_count> asked_m_{}, usual_m_{}, step_share_{};
  std::array<std::optional<Break>, lane_count> step_why_{};
  BodySize<Lanes<float>> size_{};
  Gait<Lanes<float>> gait_{};
  WalkExtremes found_{};
  Lanes<float> held_[bound_count];
};

}  // namespace

bool same_style(const GaitStyle& a, const GaitStyle& b) {
  return std::ranges::all_of(gait_parameters, [&](const GaitParameter& p) { return a.*p.value == b.*p.value; });
}

std::string described(const StyleChange& change) {
  const WalkLimit& limit = walk_limits()[static_cast<std::size_t>(change.bound)];
  const bool raised = change.walked > change.asked;
  const std::string number = fmt::format("{:.3g}", static_cast<double>(change.would_be) / limit.shown);
  const std::string_view name =
      change.parameter < parameter_count ? gait_parameters[change.parameter].name : "step_length_m";
  return fmt::format("{} {} was {} to {:.4g}: {} at {:.3g} m/s", name, change.asked, raised ? "raised" : "lowered",
                     change.walked, fmt::format(fmt::runtime(limit.says), number), change.speed_m_s);
}

void keep_walk_limits(const Jobs& jobs, std::span<const BodySize<float>> sizes, std::span<Gait<float>> gaits,
                      StyleWork& work, std::span<std::vector<StyleChange>> moved) {
  // As much room as everybody may need, so that it grows with how many are asked, not with who they are.
  for (auto* const list : {&work.unusual, &work.near}) {
    list->clear();
    if (list->capacity() < gaits.size()) list->reserve(2 * gaits.size());
  }
  if (work.breaks.capacity() < gaits.size()) work.breaks.reserve(2 * gaits.size());
  work.breaks.assign(gaits.size(), 1);
  in_parallel(jobs, gaits.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (is_usual(sizes[i].height_m, gaits[i]) || surely_keeps_limits(sizes[i], gaits[i])) work.breaks[i] = 0;
  });
  std::vector<std::size_t>& unusual = work.unusual;
  for (std::size_t i = 0; i < gaits.size(); ++i)
    if (work.breaks[i] != 0) unusual.push_back(i);
  if (unusual.empty()) return;
  const auto in_blocks = [&](std::span<const std::size_t> people, auto look_at) {
    in_parallel(jobs, (people.size() + lane_count - 1) / lane_count, [&](std::size_t begin, std::size_t end) {
      for (std::size_t first = begin * lane_count; first < std::min(end * lane_count, people.size());
           first += lane_count) {
        const auto some = people.subspan(first, std::min(lane_count, people.size() - first));
        StyleBlock block(sizes, gaits, some);
        look_at(some, block);
      }
    });
  };
  // Few come near a limit, fewer break one: those come together in blocks of their own.
  const auto look = [&](std::span<const std::size_t> people, Looking looking) {
    in_blocks(people, [&](std::span<const std::size_t> some, StyleBlock& block) {
      const auto broken = block.broken(looking);
      for (std::size_t l = 0; l < some.size(); ++l) work.breaks[some[l]] = static_cast<std::uint8_t>(broken[l]);
    });
    std::erase_if(unusual, [&](std::size_t i) { return work.breaks[i] == 0; });
  };
  constexpr float near_part = 0.101F;  // of styles that are looked at roughly first
  std::ranges::copy_if(unusual, std::back_inserter(work.near),
                       [&](std::size_t i) { return is_within_usual(gaits[i].style, near_part); });
  look(work.near, Looking::roughly);
  work.near.assign(unusual.begin(), unusual.end());
  look(work.near, Looking::closely);
  in_blocks(unusual, [&](std::span<const std::size_t> people, StyleBlock& block) {
    block.draw_nearer();
    for (std::size_t l = 0; l < people.size(); ++l) {
      if (!block.is_drawn(l)) continue;
      const float height_m = sizes[people[l]].height_m;
      Gait<float>& gait = gaits[people[l]];
      if (!moved.empty()) moved[people[l]] = block.changes(l);
      const Gait<float> kept = complete_gait(height_m, gait.speed_m_s, block.step_length_m(l), block.style(l));
      gait.style = kept.style;
      gait.step_length_m = kept.step_length_m;
      gait.step_frequency_hz = kept.step_frequency_hz;
      gait.double_support_cycle = kept.double_support_cycle;
    }
  });
}

void keep_walk_limits(const World& world, const Jobs& jobs, std::span<const Entity> people,
                      std::span<Gait<float>> gaits, StyleWork& work) {
  work.others.clear();
  work.sizes.clear();
  work.asked.clear();
  for (std::size_t i = 0; i < people.size(); ++i) {
    if (same_walk(*gait_of(world, people[i]), gaits[i])) continue;
    work.others.push_back(i);
    work.sizes.push_back(body_size(world, people[i]));
    work.asked.push_back(gaits[i]);
  }
  keep_walk_limits(jobs, work.sizes, work.asked, work);
  for (std::size_t k = 0; k < work.others.size(); ++k) gaits[work.others[k]] = work.asked[k];
}

std::vector<StyleChange> keep_walk_limits(const BodySize<float>& size, Gait<float>& gait) {
  std::vector<StyleChange> moved;
  StyleWork work;
  keep_walk_limits({}, {&size, 1}, {&gait, 1}, work, {&moved, 1});
  return moved;
}

}  // namespace mobil
