#include "assets/gait/step_lookup.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mobil::inline v0_3 {
namespace {

namespace table = step_table;

/// Values of standing; the others are those of the slowest walk.
constexpr double standing_length = 0.25, standing_double_support = 0.22;

/// Nodes of a value, with their weights.
struct Blend {
  std::array<std::size_t, 4> node;
  std::array<float, 4> weight;
  float walks;  // 1; less below the slowest node
};

/// Position of a speed among the nodes.
struct Place {
  std::size_t node;  // the slower neighbour
  float part;        // of the way to the faster one
  float walks;       // 1; less below the slowest node
};

Place place_of(float at) {
  constexpr auto first = static_cast<float>(table::speed.front());
  constexpr auto apart = static_cast<float>((table::speed.back() - table::speed.front()) / (table::speed_count - 1));
  const float place = std::clamp((at - first) / apart, 0.0F, static_cast<float>(table::speed_count - 1));
  const std::size_t node = std::min(static_cast<std::size_t>(place), table::speed_count - 2);
  return {node, place - static_cast<float>(node), std::clamp(at / first, 0.0F, 1.0F)};
}

Blend speed_blend(float at) {
  const auto [i, u, walks] = place_of(at);
  const float v = 1 - u;
  Blend b;
  b.node = {i == 0 ? 0 : i - 1, i, i + 1, std::min(i + 2, table::speed_count - 1)};
  b.weight = {-0.5F * u * v * v, v * (1 + u - 1.5F * u * u), u * (1 + v - 1.5F * v * v), -0.5F * v * u * u};
  // Without a neighbour, the slope is that to the other one.
  if (i == 0) {
    b.weight[1] += 2 * b.weight[0];
    b.weight[2] -= b.weight[0];
    b.weight[0] = 0;
  }
  if (i + 2 == table::speed_count) {
    b.weight[2] += 2 * b.weight[3];
    b.weight[1] -= b.weight[3];
    b.weight[3] = 0;
  }
  b.walks = walks;
  return b;
}

StepGiven usual_of(const Blend& b) {
  StepGiven sum{};
  for (std::size_t k = 0; k < 4; ++k) {
    const StepGiven& g = step_given[b.node[k]];
    const auto w = static_cast<double>(b.weight[k]);
    sum.step_length += w * g.step_length;
    sum.double_support += w * g.double_support;
    sum.pelvis_tilt += w * g.pelvis_tilt;
    sum.pelvis_rotation += w * g.pelvis_rotation;
    sum.pelvis_list += w * g.pelvis_list;
  }
  const auto walks = static_cast<double>(b.walks);
  sum.step_length = standing_length + walks * (sum.step_length - standing_length);
  sum.double_support = standing_double_support + walks * (sum.double_support - standing_double_support);
  sum.pelvis_rotation *= walks;
  sum.pelvis_list *= walks;
  return sum;
}

}  // namespace

StepGiven usual_step(float at) {
  return usual_of(speed_blend(at));
}

double usual_step_length(float at) {
  const double beyond = std::max(static_cast<double>(at) / table::speed.back(), 1.0);
  return usual_step(at).step_length * std::sqrt(beyond);
}

TabledStep tabled_step(float at, float step_length, const StepMix& mix) {
  const Blend b = speed_blend(at);
  TabledStep out{usual_of(b), {}};
  constexpr auto least = static_cast<float>(table::length.front()), most = static_cast<float>(table::length.back());
  const float times = std::clamp(step_length / static_cast<float>(out.usual.step_length), least, most);
  std::size_t l = 0;
  while (l + 2 < table::length_count && times > static_cast<float>(table::length[l + 1])) ++l;
  const auto low = static_cast<float>(table::length[l]), high = static_cast<float>(table::length[l + 1]);
  const float part = (times - low) / (high - low);
  const float grown = 1 - mix.child;
  const std::pair<StepKind, float> kinds[] = {
      {StepKind::man, grown * (1 - mix.woman)}, {StepKind::woman, grown * mix.woman}, {StepKind::child, mix.child}};
  for (const auto& [kind, kind_part] : kinds) {
    if (kind_part == 0) continue;
    const StepShapes& shapes = step_shapes(kind);
    for (std::size_t k = 0; k < 4; ++k) {
      const float weight = kind_part * b.walks * b.weight[k], shorter = weight * (1 - part), longer = weight * part;
      const TabledShape &x = shapes[b.node[k]][l], &y = shapes[b.node[k]][l + 1];
      for (std::size_t i = 0; i < step_shape::size; ++i) out.shape[i] += shorter * x[i] + longer * y[i];
    }
  }
  return out;
}

void add_styles(float at, std::span<const float, style_effects.size()> amounts, TabledShape& shape) {
  const auto [node, part, walks] = place_of(at);
  for (std::size_t e = 0; e < amounts.size(); ++e) {
    if (amounts[e] == 0.0F) continue;
    const float slower = walks * (1 - part) * amounts[e], faster = walks * part * amounts[e];
    const TabledShape &a = step_styles[node][e], &b = step_styles[node + 1][e];
    for (std::size_t i = 0; i < step_shape::size; ++i) shape[i] += slower * a[i] + faster * b[i];
  }
}

}  // namespace mobil::inline v0_3
