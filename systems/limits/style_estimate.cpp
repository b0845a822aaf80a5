#include "systems/limits/style_estimate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include <mobil/rows.h>
#include <mobil/systems/limits/walk_limits.h>
#include "assets/gait/step_table.h"
#include "systems/gait/gait.h"

namespace mobil::inline v0_3 {
namespace {

constexpr std::array<float, 3> node_heights_m = {1.45F, 1.75F, 2.05F};
constexpr float lowest_speed = 0.4F, speed_step = 0.3F;  // m/s
constexpr std::size_t node_speeds = 7;
constexpr float tenth = 0.1F, rounding = 1e-4F;
constexpr float grid = 2 * 254;  // half a step of what `snapped` rounds to (systems/gait/asleep.h)

/// What of a usual walk is how large, and by how much each number of the style makes it larger or smaller, a tenth of
/// the number up and down.
struct Node {
  std::array<float, bound_count> usual{};
  std::array<std::array<std::array<float, bound_count>, gait_parameters.size()>, 2> adds{};
  bool walked = false;  // false: nobody of that height walks so fast
};
/// Speeds from the lowest up; the last is to stand.
constexpr std::size_t standing = node_speeds;
using Nodes = std::array<std::array<Node, node_speeds + 1>, node_heights_m.size()>;

/// What is kept free below a limit, beside what the style adds: heights and speeds between those of the nodes.
float spare(WalkBound bound) {
  return bound == WalkBound::under_ground ? 0.002F : bound == WalkBound::pelvis_shaken ? 2.0F : 0.03F;
}

void fill(float height_m, float speed_m_s, Node& node) {
  constexpr GaitStyle usual;
  const auto gait = resolve_gait(height_m, {.speed_m_s = speed_m_s});
  if (!gait) return;
  node.walked = true;
  BodySize<Lanes<float>> size{};
  Gait<Lanes<float>> walks{};
  WalkExtremes found{};
  BodySize<float> body{};
  body.height_m = height_m;
  body.mass_kg = 22.5F * height_m * height_m;
  // Sixteen at a time: number 2·p is a tenth more of number p, 2·p + 1 a tenth less; the last is the usual walk.
  constexpr std::size_t count = 2 * gait_parameters.size() + 1;
  std::array<std::array<float, bound_count>, count> value{};
  for (std::size_t first = 0; first < count; first += lane_count) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      const std::size_t which = std::min(first + l, count - 1);
      Gait<float> row = *gait;
      if (which + 1 < count) {
        float& number = row.style.*gait_parameters[which / 2].value;
        number += (which % 2 == 0 ? tenth : -tenth) * std::fabs(number);
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
  for (std::size_t p = 0; p < gait_parameters.size(); ++p) {
    const float by = tenth * std::fabs(usual.*gait_parameters[p].value);
    for (std::size_t way = 0; way < 2; ++way) {
      for (std::size_t b = 0; by > 0 && b < bound_count; ++b)
        node.adds[way][p][b] = (value[2 * p + way][b] - node.usual[b]) / by;
    }
  }
}

const Nodes& nodes() {
  static const auto made = [] {
    auto all = std::make_unique<Nodes>();
    for (std::size_t h = 0; h < node_heights_m.size(); ++h) {
      for (std::size_t v = 0; v < node_speeds; ++v)
        fill(node_heights_m[h], lowest_speed + speed_step * static_cast<float>(v), (*all)[h][v]);
      fill(node_heights_m[h], 0, (*all)[h][standing]);
    }
    return all;
  }();
  return *made;
}

bool keeps(const Node& node, const GaitStyle& style) {
  constexpr GaitStyle usual;
  if (!node.walked) return false;
  std::array<float, bound_count> at = node.usual, either{};
  for (std::size_t p = 0; p < gait_parameters.size(); ++p) {
    const float by = style.*gait_parameters[p].value - usual.*gait_parameters[p].value;
    if (by == 0) continue;
    const auto& adds = node.adds[by > 0 ? 0 : 1][p];
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

bool is_within_usual(const GaitStyle& style, float part) {
  constexpr GaitStyle usual;
  return std::ranges::all_of(gait_parameters, [&](const GaitParameter& p) {
    return std::fabs(style.*p.value - usual.*p.value) <= part * std::fabs(usual.*p.value) + (p.high - p.low) / grid;
  });
}

bool is_near_usual(const GaitStyle& style) {
  constexpr float most_rms = 0.07F;
  constexpr GaitStyle usual;
  float squares = 0, count = 0;
  for (const GaitParameter& p : gait_parameters) {
    const float number = usual.*p.value;
    if (number == 0) continue;
    const float off = (style.*p.value - number) / number;
    squares += off * off;
    ++count;
  }
  return squares <= count * most_rms * most_rms && is_within_usual(style, tenth + 0.001F);
}

bool has_usual_steps(float height_m, float speed_m_s, float step_length_m) {
  const float usual_m = usual_length_m(height_m, speed_m_s);
  constexpr auto shortest = static_cast<float>(step_table::length.front()),
                 longest = static_cast<float>(step_table::length.back());
  return step_length_m >= shortest * usual_m && step_length_m <= longest * usual_m;
}

bool surely_keeps_limits(const BodySize<float>& size, const Gait<float>& gait) {
  const float height_m = size.height_m, place = (gait.speed_m_s - lowest_speed) / speed_step;
  const bool stands = gait.speed_m_s == 0;
  if (!(height_m >= 1.35F && height_m <= 2.15F)) return false;
  if (!stands && !(place >= 0 && place < static_cast<float>(node_speeds - 1))) return false;
  if (!is_within_usual(gait.style, tenth + rounding)) return false;
  const auto& of_height = nodes()[height_m < 1.6F ? 0 : height_m < 1.9F ? 1 : 2];
  if (stands) return keeps(of_height[standing], gait.style);
  const auto plain = resolve_gait(height_m, {.speed_m_s = gait.speed_m_s});
  if (!plain || !(std::fabs(gait.step_length_m - plain->step_length_m) <= 1e-3F * plain->step_length_m)) return false;
  const auto v = static_cast<std::size_t>(place);
  return keeps(of_height[v], gait.style) && keeps(of_height[v + 1], gait.style);
}

}  // namespace mobil::inline v0_3
