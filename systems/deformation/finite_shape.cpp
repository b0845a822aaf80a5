#include "systems/deformation/finite_shape.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include <cmath>

#include "engine/wide_exp-inl.h"
#include "systems/deformation/report-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {

/// Maps activation to 0 to 1 (activation_root).
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
  const Wide asked = -moved / length, e = clamp(asked, min_shortening, max_shortening);
  const Wide ratio = clamp(across / along, min_slenderness, max_slenderness);
  const Wide slender = log(ratio), slender2 = slender * slender;
  const Wide root = block.activation == nullptr ? wide(0.0F) : root_of(max(load(*block.activation), 0.0F));
  const Wide e2 = e * e, root2 = root * root;
  const Wide amount[shape_amount_count] = {e,         e2,        e * e2,       root,          e * root,        root2,
                                           e2 * root, e * root2, root * root2, e * e2 * root, e * root * root2};
  for (std::size_t v = 0; v < shape_modes; ++v) {
    Wide sum = wide(0.0F);
    for (std::size_t f = 0; f < shape_amount_count; ++f) {
      const auto& c = shape.coefficient[v][f];
      sum = fma(fma(slender2, wide(c[2]), fma(slender, wide(c[1]), wide(c[0]))), amount[f], sum);
    }
    store(sum, blend.vector[v]);
  }
  const Wide within = select((asked < e) | (asked > e), -(e * length), moved);
  store(within, blend.within_m);
  store(moved - within, blend.beyond_m);
}

/// Moves the nodes of an end, all by the same distance.
HWY_INLINE void move_end(std::size_t first, std::size_t count, const Wide& along, const float* computed, float* shown) {
  for (std::size_t at = first * lane_count; at < (first + count) * lane_count; at += 3 * lane_count) {
    for (std::size_t c = 0; c < 2 * lane_count; c += lane_count) store(load(computed + at + c), shown + at + c);
    store(load(computed + at + 2 * lane_count) + along, shown + at + 2 * lane_count);
  }
}

/// Moves a point between the ends along one axis, by `vector` times the row's numbers and the belly's stretch
/// `drawn_m`.
HWY_INLINE void move_point(const float* row, const Wide* vector, float drawn, const Wide& drawn_m,
                           const float* computed, float* shown) {
  Wide sum = fma(wide(row[0]), vector[0], load(computed));
  for (std::size_t v = 1; v < shape_modes; ++v) sum = fma(wide(row[v]), vector[v], sum);
  store(fma(wide(drawn), drawn_m, sum), shown);
}

void add_all(const ShapeBlock& block, const ShapeBlend& blend, bool in_place_of_linear, const float* computed,
             float* shown) {
  const FiniteShape& shape = block.shape;
  const Wide along = load(block.scale.along), across = load(block.scale.across);
  Wide aside_vector[shape_modes], along_vector[shape_modes];
  for (std::size_t v = 0; v < shape_modes; ++v) {
    aside_vector[v] = across * load(blend.vector[v]);
    along_vector[v] = along * load(blend.vector[v]);
  }
  const Wide within = load(blend.within_m), aside = within * (across / along), none = wide(0.0F);
  const float linear = in_place_of_linear ? 1.0F : 0.0F;
  const std::size_t plane = 3 * std::size_t{plane_nodes(shape.cells)}, far = plane * shape.cells[2];
  move_end(0, plane, none, computed, shown);
  for (std::size_t c = plane; c < far; c += 3) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t i = c + axis, at = i * lane_count;
      const float drawn = shape.even[i] - linear * shape.stretch[i];
      move_point(&shape.vector[i * shape_modes], axis == 2 ? along_vector : aside_vector, drawn,
                 axis == 2 ? within : aside, computed + at, shown + at);
    }
  }
  move_end(far, plane, (1 - linear) * within, computed, shown);
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
}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {
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

}  // namespace mobil::inline v0_3
#endif
