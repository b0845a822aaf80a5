#pragma once
// Sixteen walks that are drawn from the style and step asked for toward the usual ones, as far as limits ask.

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/systems/limits/style_limits.h>
#include <mobil/systems/limits/walk_limits.h>

namespace mobil::inline v0_3 {

/// Walkers on the way from the usual style to that asked for: sixteen lanes, `lanes_each` to a walker. With several
/// lanes several of the next answers are foreseen in one look; what is found is the same.
class StyleBlock {
 public:
  StyleBlock(std::span<const BodySize<float>> sizes, std::span<const Gait<float>> gaits,
             std::span<const std::size_t> people, Looking looking, std::size_t lanes_each = 1);
  /// Who breaks a limit with what was asked, or comes near one where walks are looked at roughly.
  std::array<bool, lane_count> broken();
  /// Moves step lengths and styles as far as limits ask, as keep_walk_limits says
  /// (mobil/systems/limits/style_limits.h).
  void draw_nearer();
  /// What draw_nearer came to, walker by walker: whether anything was moved; the style and the step length; what was
  /// moved, the step length before the numbers of the style.
  bool is_drawn(std::size_t walker) const { return walkers_[walker].step_why || walkers_[walker].is_moved(); }
  const GaitStyle& style(std::size_t walker) const { return walkers_[walker].style; }
  float step_length_m(std::size_t walker) const { return walkers_[walker].length_m(); }
  std::vector<StyleChange> changes(std::size_t walker) const;

 private:
  static constexpr std::size_t parameter_count = gait_parameters.size();
  static constexpr GaitStyle usual_{};
  static constexpr std::size_t try_usual_walk = 0, try_usual_style = 1, try_as_asked = 2, try_without = 3;
  /// Of 100 styles near the usual one that break a limit, 99 keep it with one of these as usual, the first before the
  /// second.
  static constexpr std::array without = {&GaitStyle::pelvis_tilt_deg, &GaitStyle::double_support_scale};
  static constexpr std::size_t tries = try_without + without.size();

  /// A bound that a walk breaks, and where it would come to.
  struct Break {
    WalkBound bound;
    float value;
    WalkPart part;
  };
  struct Walker {
    GaitStyle asked{}, style{};  // `style`, `step_share`: what is tried, and at the end what is kept
    float asked_m = 0, usual_m = 0, step_share = 1;
    std::optional<Break> step_why;
    std::array<bool, parameter_count> moved{};
    std::array<Break, parameter_count> why{};
    std::optional<std::size_t> culprit;  // of `without`: all the others may stay as asked

    bool is_moved() const {
      return std::ranges::any_of(moved, [](bool is) { return is; });
    }
    /// All that may stay as asked, and the others so far from the usual ones.
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
  /// The usual walk, which limits are to allow; the usual style with the steps asked for; all as asked; all but one
  /// number as asked.
  void look_at_usual_and_asked();
  void note_try(std::size_t which, std::size_t w, std::size_t lane);
  void try_in(std::size_t lane, const Walker& walker);
  /// How far the walks go that are tried.
  void look();
  /// What the walk looked at last breaks most, in parts of the limit.
  std::optional<Break> worst(std::size_t lane) const;
  /// One number after another becomes what was asked, and stays so if nothing breaks. A walker's lanes try the next
  /// numbers, each with those before it: what is tried is right up to the first that breaks something.
  void give_back();
  /// Shares of what was asked, as large as nothing breaks, from that of 0 on, of whom `of` says; `set` has one tried. A
  /// walker's lanes try what the next halvings may come to: a binary tree, whose node n has the children 2n and 2n + 1.
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
  } held_;                                       // how far walks may go, as WalkExtremes has it
  std::array<bool, lane_count> asked_broken_{};  // walkers
};

}  // namespace mobil::inline v0_3
