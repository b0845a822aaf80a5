#include "systems/deformation/finite_shape.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/deformation/finite_shape.cpp"
#include <hwy/foreach_target.h>

#include <cmath>

#include "engine/wide_exp-inl.h"
#include "systems/deformation/report-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {
namespace {

/// 0 to 1 as the activation is (activation_root).
HWY_INLINE Wide root_of(const Wide& activation) {
  constexpr float offset = static_cast<float>(activation_offset);
  const float least = 0.1F, most = 1.00498756F;  // √offset, √(1 + offset)
  static_assert(activation_offset == 0.01);
  return (sqrt(activation + offset) - least) * (1 / (most - least));
}

void blend_all(const ShapeBlock& block, ShapeBlend& blend) {
  const FiniteShape& shape = block.shape;
  const Wide across = load(block.scale.across), along = load(block.scale.along);
  const Wide length = along * shape.length_m, moved = load(block.far_end_m);
  const Wide e = clamp(-moved / length, least_shortening, most_shortening);
  const Wide ratio = clamp(across / along, least_slenderness, most_slenderness);
  const Wide slender = log(ratio), slender2 = slender * slender;
  const Wide root = block.activation == nullptr ? wide(0.0F) : root_of(max(load(*block.activation), 0.0F));
  const Wide e2 = e * e, root2 = root * root;
  const Wide amount[shape_amount_count] = {e,         e2,        e * e2,       root,          e * root,        root2,
                                           e2 * root, e * root2, root * root2, e * e2 * root, e * root * root2};
  for (std::size_t v = 0; v < shape_vectors; ++v) {
    Wide sum = wide(0.0F);
    for (std::size_t f = 0; f < shape_amount_count; ++f) {
      const auto& c = shape.coefficient[v][f];
      sum = fma(fma(slender2, wide(c[2]), fma(slender, wide(c[1]), wide(c[0]))), amount[f], sum);
    }
    store(sum, blend.vector[v]);
  }
  const Wide within = -(e * length);
  store(within, blend.within_m);
  store(moved - within, blend.beyond_m);
}

void add_all(const ShapeBlock& block, const ShapeBlend& blend, bool in_place_of_linear, const float* computed,
             float* shown) {
  const FiniteShape& shape = block.shape;
  const Wide along = load(block.scale.along), across = load(block.scale.across);
  Wide vector[shape_vectors];
  for (std::size_t v = 0; v < shape_vectors; ++v) vector[v] = load(blend.vector[v]);
  const Wide within = load(blend.within_m), aside = within * (across / along);
  const float linear = in_place_of_linear ? 1.0F : 0.0F;
  const std::size_t components = shape.even.size();
  for (std::size_t c = 0; c < components; c += 3) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float* const row = &shape.vector[(c + axis) * shape_vectors];
      Wide sum = wide(row[0]) * vector[0];
      for (std::size_t v = 1; v < shape_vectors; ++v) sum = fma(wide(row[v]), vector[v], sum);
      const std::size_t at = (c + axis) * lane_count;
      const Wide drawn = wide(shape.even[c + axis] - linear * shape.stretch[c + axis]);
      const Wide base = fma(drawn, axis == 2 ? within : aside, load(computed + at));
      store(fma(sum, axis == 2 ? along : across, base), shown + at);
    }
  }
}

void find_volume(const MuscleTemplate& control, const BellyScale<Lanes<float>>& scale, const float* shown,
                 Lanes<float>& volume_ratio) {
  for (std::size_t lane = 0; lane < lane_count; lane += vector_lanes) {
    const Factors factor = factors(scale, lane);
    const V volume = enclosed_volume(control.kernel, factor.b, factor.a, shown + lane);
    const V rest = hn::Mul(factor.mass, hn::Set(d, control.kernel.volume_m3));
    hn::Store(hn::Div(volume, rest), d, volume_ratio.lane + lane);
  }
}

}  // namespace
}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil {
namespace {
HWY_EXPORT(blend_all);
HWY_EXPORT(add_all);
HWY_EXPORT(find_volume);
}  // namespace

ShapeBlend blend_of(const ShapeBlock& block) {
  ShapeBlend blend;
  HWY_DYNAMIC_DISPATCH(blend_all)(block, blend);
  return blend;
}

void add_shape(const ShapeBlock& block, const ShapeBlend& blend, bool in_place_of_linear, const float* computed,
               float* shown) {
  HWY_DYNAMIC_DISPATCH(add_all)(block, blend, in_place_of_linear, computed, shown);
}

void report_volume(const MuscleTemplate& control, const BellyScale<Lanes<float>>& scale, const float* shown,
                   Lanes<float>& volume_ratio) {
  HWY_DYNAMIC_DISPATCH(find_volume)(control, scale, shown, volume_ratio);
}

}  // namespace mobil
#endif
