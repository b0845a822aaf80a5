#include "systems/deformation/modal.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include <hwy/cache_control.h>

#include <array>

#include "assets/reduction/modal_belly.h"
#include "engine/wide-inl.h"
#include "engine/wide_exp-inl.h"
#include "systems/deformation/modal-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {

/// Returns X² + W², which is not finite if X or W is not finite or is beyond 1.8e19.
HWY_INLINE Wide squares(const Wide& x, const Wide& w) {
  return fma(x, x, w * w);
}

/// Advances one motion over a tick in which its s grows at `rate`. Returns the squares of its state.
HWY_INLINE Wide swing(float* state, const float* motion, const Wide& rate) {
  const Wide a = load(motion), b = load(motion + lane_count), g = load(motion + 2 * lane_count);
  const Wide y = fma(g, rate, load(state)), v = load(state + lane_count) - rate;
  const Wide next_y = fma(a, y, b * v), next_v = fnma(b, y, fnma(g, b, a) * v);
  const Wide x = fnma(g, rate, next_y), w = next_v + rate;
  store(x, state);
  store(w, state + lane_count);
  return squares(x, w);
}

/// Lanes of a block that are not finite, from sums of 0 · squares, which are 0 in all other lanes.
class Health {
 public:
  HWY_INLINE Health() : sum_(wide(0.0F)) {}
  HWY_INLINE void add(const Wide& squares) { sum_ = fma(squares, wide(0.0F), sum_); }

  /// Restarts those lanes at rest and returns them as bits.
  HWY_INLINE std::uint32_t restart(std::size_t modes, float* state) const {
    if (all(sum_ >= 0.0F)) return 0;
    Lanes<float> sum;
    store(sum_, sum);
    std::uint32_t lanes = 0;
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      if (sum[lane] == 0) continue;
      lanes |= 1U << lane;
      for (std::size_t row = 0; row < 2 * modes; ++row) state[row * lane_count + lane] = 0;
    }
    return lanes;
  }

 private:
  Wide sum_;
};

std::uint32_t deform_tick(const ModalBlock& block, const FarFaceDrive& end, float tick_s) {
  const ModalInputs inputs = modal_inputs(end, block.frame);
  const std::size_t modes = block.basis.modes;
  const float per_s = 1.0F / tick_s;
  std::array<Wide, max_inputs> rate;
  for (std::size_t i = 0; i < inputs.count; ++i) rate[i] = (load(*inputs.to[i]) - load(*inputs.from[i])) * per_s;
  float* state = block.state;
  const float* motion = block.motion;
  Health health;
  const std::size_t full = full_inputs(inputs.count);
  const std::size_t width = modal_motion_width(1, static_cast<std::uint32_t>(inputs.count));
  Ahead states(block.next_state, modes, 2, 2), motions(block.next_motion, modes, width, width);
  if (inputs.count == 1) {
    for (std::size_t j = 0; j < modes; ++j, state += 2 * lane_count, motion += 3 * lane_count) {
      states.fetch_some(2);
      motions.fetch_some(width);
      health.add(swing(state, motion, rate[0]));
    }
    return health.restart(modes, block.state);
  }
  for (std::size_t j = 0; j < modes; ++j, state += 2 * lane_count) {
    states.fetch_some(2);
    motions.fetch_some(width);
    const float* participation = motion + 3 * lane_count;
    Wide sum = load(participation) * rate[0];
    participation += lane_count;
    for (std::size_t i = 1; i < full; ++i, participation += lane_count) sum = fma(load(participation), rate[i], sum);
    for (std::size_t i = full; i < inputs.count; i += 2, participation += lane_count) {
      const WidePair pair = load_pair(participation);
      sum = fma(pair.odd, rate[i + 1], fma(pair.even, rate[i], sum));
    }
    health.add(swing(state, motion, sum));
    motion = participation;
  }
  return health.restart(modes, block.state);
}

std::uint32_t swing_all(std::size_t modes, const Lanes<float>& from, const Lanes<float>& to, float tick_s, float* state,
                        const float* motion) {
  const Wide rate = (load(to) - load(from)) * (1.0F / tick_s);
  Health health;
  for (std::size_t j = 0; j < modes; ++j, motion += 3 * lane_count)
    health.add(swing(state + 2 * j * lane_count, motion, rate));
  return health.restart(modes, state);
}

/// Activation, and values of this tick common to all motions of a tuned belly.
struct Tuning {
  Wide activation, half, decay;  // α/2, e^(−αh/2)
};

HWY_INLINE Wide tuned_square(const float* motion, const Wide& activation) {
  return fma(activation, load(motion + 2 * lane_count), load(motion + lane_count));
}

/// Computes them with damping limited so that no motion creeps.
HWY_INLINE Tuning tuning(const float* motion, std::size_t modes, std::size_t width, const Wide& activation,
                         float tick_s) {
  Wide least = tuned_square(motion, activation);
  for (std::size_t j = 1; j < modes; ++j) least = min(least, tuned_square(motion + j * width * lane_count, activation));
  constexpr auto slack = static_cast<float>(tuned_damping_per_s(0) / 2);
  constexpr auto taut = static_cast<float>(tuned_damping_per_s(1) / 2);
  const Wide half = min(fma(activation, wide(taut - slack), wide(slack)), 0.95F * sqrt(least));
  return {activation, half, exp(wide(-tick_s) * half)};
}

/// Advances one tuned motion over a tick. The end's displacement moves its rest position by `end_moved`. The frame's
/// loads would move it from `from` to `to` without the stiffness added by tension. Returns the squares of its state.
HWY_INLINE Wide swing_tuned(float* state, const float* motion, const Tuning& tuning, float tick_s,
                            const Wide& end_moved, const Wide& from, const Wide& to) {
  const Wide inverse = load(motion), square = tuned_square(motion, tuning.activation);
  const Wide own =
      fma(load(motion + 2 * lane_count), wide(static_cast<float>(tuned_activation)), load(motion + lane_count));
  const Wide flexibility = 1.0F / square, held = 1.0F - own * flexibility;
  const Wide swing = sqrt(fnma(tuning.half, tuning.half, square));
  Wide sine, cosine;
  sin_cos(swing * tick_s, sine, cosine);
  sine = tuning.decay * sine / swing;
  const Wide a = fma(tuning.decay, cosine, tuning.half * sine);
  const Wide rate = fnma(held, to - from, end_moved + (to - from)) * (1.0F / tick_s);
  const Wide lag = 2.0F * tuning.half * flexibility * rate;
  const Wide y = fma(held, from, fma(inverse, load(state), lag)), v = load(state + lane_count) - rate;
  const Wide next_y = fma(a, y, sine * v), next_v = fnma(square * sine, y, fnma(2.0F * tuning.half, sine, a) * v);
  const Wide x = own * inverse * fnma(held, to, next_y - lag), w = next_v + rate;
  store(x, state);
  store(w, state + lane_count);
  return squares(x, w);
}

std::uint32_t tuned_tick(const ModalBlock& block, const FarFaceDrive& end, const Lanes<float>& active, float tick_s) {
  const ModalInputs inputs = modal_inputs(end, block.frame);
  const std::size_t modes = block.basis.modes, full = full_inputs(inputs.count);
  const std::size_t width = modal_motion_width(1, static_cast<std::uint32_t>(inputs.count));
  float* state = block.state;
  const float* motion = block.motion;
  const Tuning all = tuning(motion, modes, width, load(active), tick_s);
  Health health;
  const Wide none = wide(0.0F), first_moved = load(*inputs.to[0]) - load(*inputs.from[0]);
  Ahead states(block.next_state, modes, 2, 2), motions(block.next_motion, modes, width, width);
  for (std::size_t j = 0; j < modes; ++j, state += 2 * lane_count, motion += width * lane_count) {
    states.fetch_some(2);
    motions.fetch_some(width);
    if (inputs.count == 1) {
      health.add(swing_tuned(state, motion, all, tick_s, first_moved, none, none));
      continue;
    }
    const float* participation = motion + 3 * lane_count;
    Wide end_moved = load(participation) * first_moved, from = none, to = none;
    participation += lane_count;
    for (std::size_t i = 1; i < full; ++i, participation += lane_count) {
      end_moved = fma(load(participation), load(*inputs.to[i]) - load(*inputs.from[i]), end_moved);
    }
    for (std::size_t i = full; i < inputs.count; i += 2, participation += lane_count) {
      const WidePair pair = load_pair(participation);
      from = fma(pair.odd, load(*inputs.from[i + 1]), fma(pair.even, load(*inputs.from[i]), from));
      to = fma(pair.odd, load(*inputs.to[i + 1]), fma(pair.even, load(*inputs.to[i]), to));
    }
    health.add(swing_tuned(state, motion, all, tick_s, end_moved, from, to));
  }
  return health.restart(modes, block.state);
}

template <bool streamed>
HWY_INLINE void write(const Wide& w, float* p) {
  if constexpr (!streamed) return store(w, p);
  for (std::size_t i = 0; i < vector_count; ++i) hn::Stream(w.part[i], FloatTag{}, p + i * vector_lanes);
}

/// Writes the displacements of the `nodes` nodes whose coefficients begin at `row`. `amount` contains the amounts of
/// the modes, preceded by that of the lift if there is one. Loading a register of coefficients at a time is not faster,
/// because all multiply-adds broadcast theirs from memory.
template <std::size_t nodes, bool streamed>
HWY_INLINE void place_nodes(const float* row, std::size_t stride, std::size_t count, const Wide* amount, float* u) {
  std::array<Wide, 3 * nodes> sum;
  const Wide first = amount[0];
  for (std::size_t c = 0; c < 3 * nodes; ++c) sum[c] = wide(row[c * stride]) * first;
  for (std::size_t k = 1; k < count; ++k) {
    const Wide now = amount[k];
    for (std::size_t c = 0; c < 3 * nodes; ++c) sum[c] = fma(wide(row[c * stride + k]), now, sum[c]);
  }
  for (std::size_t c = 0; c < 3 * nodes; ++c) write<streamed>(sum[c], u + c * lane_count);
}

/// Number of nodes whose sums fit into the registers together with their operands.
inline constexpr std::size_t nodes_at_once = vector_count == 1 ? 3 : vector_count == 2 ? 2 : 1;

/// Computes the end's displacement and then the amounts of the modes. `x` is X of the motions, or null for static.
HWY_INLINE void find_amounts(const ModalInputs& inputs, std::size_t modes, const float* shape, const float* x,
                             Wide* amount) {
  std::array<Wide, max_inputs> input;
  for (std::size_t i = 0; i < inputs.count; ++i) input[i] = load(*inputs.to[i]);
  amount[0] = input[0];
  for (std::size_t k = 1; k <= modes; ++k) {
    const float* share = shape + modes * lane_count;
    Wide sum = load(share) * input[0];
    for (std::size_t i = 1; i < inputs.count; ++i) sum = fma(load(share + i * lane_count), input[i], sum);
    for (std::size_t j = 0; x != nullptr && j < modes; ++j) {
      sum = fma(load(shape + j * lane_count), load(x + 2 * j * lane_count), sum);
    }
    amount[k] = sum;
    shape = share + inputs.count * lane_count;
  }
}

template <bool streamed>
HWY_INLINE void place_all(const ModalBasis& basis, bool held, const Wide* amount, float* u, Ahead states,
                          Ahead shapes) {
  const Cells& cells = basis.options.control_cells;
  const std::size_t stride = std::size_t{basis.modes} + 1, node_stride = 3 * lane_count;
  const std::size_t far = first_insertion_node(cells), all = node_count(cells), past = held ? far : all;
  const std::size_t skipped = held ? 0 : 1, count = stride - skipped;
  const Wide none = wide(0.0F);
  std::size_t n = 0;
  for (; n < plane_nodes(cells); ++n, u += node_stride) {
    for (std::size_t c = 0; c < node_stride; c += lane_count) write<streamed>(none, u + c);
  }
  const float* row = basis.shape.data() + 3 * n * stride + skipped;
  const std::size_t groups = (past - n) / nodes_at_once + 1;
  const std::size_t shape_rows = shapes.rows() / groups + 1;
  const std::size_t state_rows = states.rows() / groups + 1;
  const auto place_some = [&]<std::size_t nodes>() HWY_ATTR {
    for (; n + nodes <= past; n += nodes, u += nodes * node_stride, row += 3 * nodes * stride) {
      states.fetch_some(state_rows);
      shapes.fetch_some(shape_rows);
      place_nodes<nodes, streamed>(row, stride, count, amount + skipped, u);
    }
  };
  place_some.template operator()<nodes_at_once>();
  place_some.template operator()<1>();
  for (; n < all; ++n, u += node_stride) {
    write<streamed>(none, u);
    write<streamed>(none, u + lane_count);
    write<streamed>(amount[0], u + 2 * lane_count);
  }
  if constexpr (streamed) hwy::FlushStream();
}

void place(const ModalBlock& block, const ControlPoints& points, const FarFaceDrive& end, const float* x) {
  std::array<Wide, max_modes + 1> amount;
  find_amounts(modal_inputs(end, block.frame), block.basis.modes, points.shape, x, amount.data());
  const bool held = end.way == FarEnd::held;
  const std::size_t modes = block.basis.modes;
  // A static solution reads only the inputs' part of a shape.
  const std::size_t row = modes + block.basis.inputs, first = x == nullptr ? modes : 0;
  const Ahead states(x == nullptr ? nullptr : block.next_state, modes, 2, 2);
  const Ahead shapes(points.next_shape == nullptr ? nullptr : points.next_shape + first * lane_count, modes,
                     row - first, row);
  if (points.streamed) {
    place_all<true>(block.basis, held, amount.data(), points.displacement, states, shapes);
  } else {
    place_all<false>(block.basis, held, amount.data(), points.displacement, states, shapes);
  }
}

void place_moving(const ModalBlock& block, const ControlPoints& points, const FarFaceDrive& end) {
  place(block, points, end, block.state);
}

void place_at_rest(const ModalBlock& block, const ControlPoints& points, const FarFaceDrive& end) {
  place(block, points, end, nullptr);
}

}  // namespace
}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {
namespace {
HWY_EXPORT(deform_tick);
HWY_EXPORT(swing_all);
HWY_EXPORT(tuned_tick);
HWY_EXPORT(place_moving);
HWY_EXPORT(place_at_rest);
}  // namespace

std::uint32_t deform_modal(const ModalBlock& block, const FarFaceDrive& end, float tick_s) {
  return HWY_DYNAMIC_DISPATCH(deform_tick)(block, end, tick_s);
}

std::uint32_t swing_modal(std::size_t modes, const Lanes<float>& from, const Lanes<float>& to, float tick_s,
                          float* state, const float* motion) {
  return HWY_DYNAMIC_DISPATCH(swing_all)(modes, from, to, tick_s, state, motion);
}

std::uint32_t deform_tuned(const ModalBlock& block, const FarFaceDrive& end, const Lanes<float>& activation,
                           float tick_s) {
  return HWY_DYNAMIC_DISPATCH(tuned_tick)(block, end, activation, tick_s);
}

void place_control_points(const ModalBlock& block, const ControlPoints& points, const FarFaceDrive& end) {
  HWY_DYNAMIC_DISPATCH(place_moving)(block, points, end);
}

void place_static(const ModalBlock& block, const ControlPoints& points, const FarFaceDrive& end) {
  HWY_DYNAMIC_DISPATCH(place_at_rest)(block, points, end);
}

}  // namespace mobil::inline v0_3
#endif
