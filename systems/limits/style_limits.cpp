#include <mobil/anthropometry.h>
#include <mobil/systems/limits/style_limits.h>

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string_view>

#include <mobil/systems/limits/walk_limits.h>
#include "systems/gait/gait.h"
#include "systems/limits/style_block.h"
#include "systems/limits/style_estimate.h"

namespace mobil::inline v0_3 {
namespace {

constexpr std::size_t parameter_count = gait_parameters.size();

/// Usual steps of the usual style.
bool is_usual(float height_m, const Gait<float>& gait) {
  return same_style(gait.style, {}) && has_usual_steps(height_m, gait.speed_m_s, gait.step_length_m);
}

/// Whether a style is near the usual one, and its stop keeps all limits that its steady walk keeps. Of 12 000 random
/// styles with each number within a tenth of the usual one, 230 broke a limit in stopping alone; mid-stance was at
/// 0.910 or lower in all of them. Such styles are looked at roughly first, the others in stopping too.
bool stops_as_it_walks(const GaitStyle& style) {
  constexpr float bent_knees = 0.93F;
  return is_near_usual(style) && style.mid_stance_height >= bent_knees;
}

/// Adds changes of a gait that may have been changed before: what was asked and why stay as they were. The step length
/// comes first, then the numbers of the style.
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

}  // namespace

bool same_style(const GaitStyle& a, const GaitStyle& b) {
  return std::ranges::all_of(gait_parameters, [&](const GaitParameter& p) { return a.*p.value == b.*p.value; });
}

bool same_walk(const Gait<float>& a, const Gait<float>& b) {
  return a.speed_m_s == b.speed_m_s && a.step_length_m == b.step_length_m && same_style(a.style, b.style);
}

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
                      StyleWork& work, std::span<std::vector<StyleChange>> moved) {
  // As much room as everybody may need, so that it grows with how many are asked, not with who they are.
  for (std::vector<StyleChange>& of : moved) of.clear();
  for (auto* const list : {&work.near, &work.far, &work.farther}) {
    list->clear();
    if (list->capacity() < gaits.size()) list->reserve(2 * gaits.size());
  }
  if (work.breaks.capacity() < gaits.size()) work.breaks.reserve(2 * gaits.size());
  work.breaks.assign(gaits.size(), 1);
  in_parallel(jobs, gaits.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (is_usual(sizes[i].height_m, gaits[i]) ||
          (stops_as_it_walks(gaits[i].style) && surely_keeps_limits(sizes[i], gaits[i])))
        work.breaks[i] = 0;
  });
  for (std::size_t i = 0; i < gaits.size(); ++i)
    if (work.breaks[i] != 0) (stops_as_it_walks(gaits[i].style) ? work.near : work.far).push_back(i);
  if (work.near.empty() && work.far.empty()) return;
  const auto in_blocks = [&](std::span<const std::size_t> people, Looking looking, std::size_t lanes_each,
                             auto look_at) {
    const std::size_t of_block = lane_count / lanes_each;
    in_parallel(jobs, (people.size() + of_block - 1) / of_block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t first = begin * of_block; first < std::min(end * of_block, people.size()); first += of_block) {
        const auto some = people.subspan(first, std::min(of_block, people.size() - first));
        StyleBlock block(sizes, gaits, some, looking, lanes_each);
        look_at(some, block);
      }
    });
  };
  // Few come near a limit, fewer break one: those come together in blocks of their own.
  const auto keep_broken = [&](std::vector<std::size_t>& people, Looking looking) {
    in_blocks(people, looking, 1, [&](std::span<const std::size_t> some, StyleBlock& block) {
      const auto broken = block.broken();
      for (std::size_t l = 0; l < some.size(); ++l) work.breaks[some[l]] = static_cast<std::uint8_t>(broken[l]);
    });
    std::erase_if(people, [&](std::size_t i) { return work.breaks[i] == 0; });
  };
  const auto draw = [&](std::span<const std::size_t> some, StyleBlock& block) {
    block.draw_nearer();
    for (std::size_t w = 0; w < some.size(); ++w) {
      if (!block.is_drawn(w)) continue;
      const float height_m = sizes[some[w]].height_m;
      Gait<float>& gait = gaits[some[w]];
      if (!moved.empty()) add_changes(block.changes(w), moved[some[w]]);
      const Gait<float> kept = complete_gait(height_m, gait.speed_m_s, block.step_length_m(w), block.style(w));
      gait.style = kept.style;
      gait.step_length_m = kept.step_length_m;
      gait.step_frequency_hz = kept.step_frequency_hz;
      gait.double_support_cycle = kept.double_support_cycle;
    }
  };
  const auto draw_all = [&](std::vector<std::size_t>& people, Looking looking) {
    // As many lanes each as keep all threads at work in one round.
    std::size_t lanes_each = lane_count;
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
  StyleWork work;
  keep_walk_limits({}, {&size, 1}, {&gait, 1}, work, {&moved, 1});
  return moved;
}

}  // namespace mobil::inline v0_3
