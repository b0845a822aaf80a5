#include "systems/limits/walk_estimate.h"

#include <hwy/base.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>

#include <mobil/rows.h>
#include <mobil/systems/limits/walk_limits.h>
#include "assets/body/body_scales.h"
#include "systems/gait/gait.h"

namespace mobil::inline v0_3 {
namespace {

constexpr std::array<float, 5> node_scales_m = {1.03F, 1.22F, 1.45F, 1.75F, 2.05F};  // of the leg
constexpr float lowest_speed = 0.4F, speed_step = 0.3F;                              // m/s
constexpr std::size_t node_speeds = 7;
constexpr float grid = 2 * 254;  // half a rounding step of `snapped` (systems/gait/asleep.h)

/// Returns how far a parameter of a usual person (usual_style) or one a tenth off is from GaitStyle{}, as a part of it.
constexpr float usual_range(const GaitParameter& parameter) {
  constexpr float of_all = 0.1F;
  constexpr std::pair<float GaitStyle::*, float> wider[] = {{&GaitStyle::pelvis_rotation_deg, 0.5F},
                                                            {&GaitStyle::pelvis_list_deg, 0.25F},
                                                            {&GaitStyle::trunk_lean_deg, 1.0F},
                                                            {&GaitStyle::arm_back_deg, 0.4F},
                                                            {&GaitStyle::arm_forward_deg, 0.4F}};
  for (const auto& [value, range] : wider)
    if (value == parameter.value) return range;
  return of_all;
}

/// Step lengths of usual people over those of the table: old and barefoot, or children in shoes.
constexpr float shortest_steps = 0.88F, longest_steps = 1.20F;

/// Changes of a walk whose effects are known: of each style parameter, and of the step length last.
constexpr std::size_t step_change = gait_parameters.size(), change_count = step_change + 1;

/// Bounds reached by a usual walk, and how much each change adds per unit, measured at both ends of its range. A change
/// of the step length is relative.
struct Node {
  std::array<float, bound_count> usual{};
  std::array<std::array<std::array<float, bound_count>, change_count>, 2> adds{};
  bool walked = false;  // false: no person of that height walks so fast
};
/// Index of the node for standing, which follows the speeds in ascending order.
constexpr std::size_t standing = node_speeds;
using Nodes = std::array<std::array<Node, node_speeds + 1>, node_scales_m.size()>;

/// Margin below a limit for heights and speeds between the nodes. The effects of the style come on top.
float spare(WalkBound bound) {
  return bound == WalkBound::under_ground ? 0.002F : bound == WalkBound::pelvis_shaken ? 2.0F : 0.03F;
}

float table_step(float scale_m, float speed_m_s) {
  return speed_m_s > 0 ? usual_length_m(scale_m, speed_m_s) : 0;
}

void fill(float scale_m, float speed_m_s, Node& node) {
  constexpr GaitStyle usual;
  constexpr double adult_legs = 0.973;
  const auto gait = resolve_gait(scale_m, {.speed_m_s = speed_m_s, .step_length_m = table_step(scale_m, speed_m_s)});
  if (!gait) return;
  node.walked = true;
  BodySize<Lanes<float>> size{};
  Gait<Lanes<float>> walks{};
  WalkExtremes found{};
  const auto height_m = static_cast<float>(scale_m / adult_legs);
  const auto body = make_size({.height_m = height_m, .mass_kg = 22.5F * height_m * height_m}, 0.18F);
  // Sixteen at a time: walk 2·c has the maximum of change c, walk 2·c + 1 the minimum. The last is the usual walk.
  constexpr std::size_t count = 2 * change_count + 1;
  std::array<std::array<float, bound_count>, count> value{};
  std::array<float, count> by{};
  for (std::size_t first = 0; first < count; first += lane_count) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      const std::size_t which = std::min(first + l, count - 1), change = which / 2;
      Gait<float> row = *gait;
      if (change < step_change) {
        float& number = row.style.*gait_parameters[change].value;
        by[which] = usual_range(gait_parameters[change]) * std::fabs(number);
        number += which % 2 == 0 ? by[which] : -by[which];
      } else if (change == step_change && speed_m_s > 0) {
        const float share = which % 2 == 0 ? longest_steps : shortest_steps;
        by[which] = std::fabs(share - 1);
        row.step_length_m *= share;
        row.step_frequency_hz /= share;
      }
      put_row(body, size, l);
      put_row(row, walks, l);
    }
    walk_extremes(size, walks, Looking::closely, found);
    for (std::size_t l = 0; l < std::min(lane_count, count - first); ++l) {
      for (std::size_t b = 0; b < bound_count; ++b) value[first + l][b] = found.steady.value[b][l];
    }
  }
  node.usual = value[count - 1];
  for (std::size_t which = 0; which + 1 < count; ++which) {
    for (std::size_t b = 0; by[which] > 0 && b < bound_count; ++b)
      node.adds[which % 2][which / 2][b] = (value[which][b] - node.usual[b]) / by[which];
  }
}

const Nodes& nodes() {
  static const auto made = [] {
    auto all = std::make_unique<Nodes>();
    for (std::size_t h = 0; h < node_scales_m.size(); ++h) {
      for (std::size_t v = 0; v < node_speeds; ++v)
        fill(node_scales_m[h], lowest_speed + speed_step * static_cast<float>(v), (*all)[h][v]);
      fill(node_scales_m[h], 0, (*all)[h][standing]);
    }
    return all;
  }();
  return *made;
}

bool keeps(const Node& node, const GaitStyle& style, float longer_steps) {
  constexpr GaitStyle usual;
  if (!node.walked) return false;
  std::array<float, bound_count> at = node.usual, either{};
  for (std::size_t c = 0; c < change_count; ++c) {
    const float by =
        c == step_change ? longer_steps : style.*gait_parameters[c].value - usual.*gait_parameters[c].value;
    if (by == 0) continue;
    const auto& adds = node.adds[by > 0 ? 0 : 1][c];
    for (std::size_t b = 0; b < bound_count; ++b) {
      const float added = std::fabs(by) * adds[b];
      at[b] += added;
      either[b] += std::fabs(added);
    }
  }
  for (std::size_t b = 0; b < bound_count; ++b) {
    const WalkLimit& limit = walk_limits()[b];
    if (!(at[b] + 0.25F * either[b] < static_cast<float>(limit.limit) - spare(limit.bound))) return false;
  }
  return true;
}

}  // namespace

bool is_within_usual(const GaitStyle& style) {
  constexpr GaitStyle usual;
  return std::ranges::all_of(gait_parameters, [&](const GaitParameter& p) {
    return std::fabs(style.*p.value - usual.*p.value) <=
           (usual_range(p) + 0.001F) * std::fabs(usual.*p.value) + (p.high - p.low) / grid;
  });
}

bool is_near_usual(const GaitStyle& style) {
  constexpr float max_rms = 0.7F;
  constexpr GaitStyle usual;
  float squares = 0, count = 0;
  for (const GaitParameter& p : gait_parameters) {
    const float range = usual_range(p) * usual.*p.value;
    if (range == 0) continue;
    const float off = (style.*p.value - usual.*p.value) / range;
    squares += off * off;
    ++count;
  }
  return squares <= count * max_rms * max_rms && is_within_usual(style);
}

bool surely_keeps_limits(const BodySize<float>& size, const Gait<float>& gait) {
  constexpr std::array<float, 6> scales_m = {0.95F, 1.12F, 1.33F, 1.6F, 1.9F, 2.15F};  // ranges of the nodes
  const float scale_m = size.leg_scale_m, place = (gait.speed_m_s - lowest_speed) / speed_step;
  const bool stands = gait.speed_m_s == 0;
  if (!(scale_m >= scales_m.front() && scale_m <= scales_m.back())) return false;
  if (!stands && !(place >= 0 && place < static_cast<float>(node_speeds - 1))) return false;
  if (!is_within_usual(gait.style)) return false;
  const auto node = static_cast<std::size_t>(std::ranges::upper_bound(scales_m, scale_m) - scales_m.begin()) - 1;
  const auto& of_scale = nodes()[std::min(node, node_scales_m.size() - 1)];
  if (stands) return keeps(of_scale[standing], gait.style, 0);
  const float steps = gait.step_length_m / table_step(scale_m, gait.speed_m_s);
  if (!(steps >= shortest_steps && steps <= longest_steps)) return false;
  const auto v = static_cast<std::size_t>(place);
  return keeps(of_scale[v], gait.style, steps - 1) && keeps(of_scale[v + 1], gait.style, steps - 1);
}

}  // namespace mobil::inline v0_3
