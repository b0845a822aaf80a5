// K, M and the operator of a step, applied to a register of lanes, and the solution by the banded factor of a body of
// about their size. For inclusion only inside Highway's targets.

#if defined(MOBIL_SYSTEMS_DEFORMATION_OPERATOR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_DEFORMATION_OPERATOR_INL_H_
#undef MOBIL_SYSTEMS_DEFORMATION_OPERATOR_INL_H_
#else
#define MOBIL_SYSTEMS_DEFORMATION_OPERATOR_INL_H_
#endif

#include <algorithm>

#include "assets/fem/belly_solver.h"
#include "engine/fused-inl.h"
#include "systems/deformation/band_solve-inl.h"
#include "systems/deformation/elastic-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {

/// One register of lanes of a block during one tick.
struct Bellies {
  const BellyBlock& block;
  const BellySolver& solver;
  const KernelArrays& kernel;
  const Cells& cells;
  FarEnd end;
  std::uint32_t first, past;  // nodes that move
  float *u, *v;
  float *residual, *direction, *image;  // scratch, of as many floats as u
  Factors factor;
  std::size_t first_lane;
};

/// Operator of a step's equations: mass·M₁ of each component + stiffness·K.
struct Operator {
  V mass_x, mass_y, mass_z, stiffness;
};

/// Loads at an instant: total of the uniform traction, and the frame's field.
struct Loads {
  Vector traction;
  FrameField field;
};

HWY_INLINE Vector zero_vector() {
  const V none = hn::Zero(d);
  return {none, none, none};
}

/// Calls f for each node of the moving planes, in the kernel's order.
template <class F>
HWY_INLINE void for_each_moving_node(const Bellies& belly, F&& f) {
  const Cells cells = belly.cells;
  std::uint32_t n = belly.first;
  for (std::uint32_t k = 1; n < belly.past; ++k) {
    for (std::uint32_t j = 0; j <= cells[1]; ++j) {
      for (std::uint32_t i = 0; i <= cells[0]; ++i, ++n) f(n, i, j, k);
    }
  }
}

/// Returns (M₁·x) of a node. `pair` points to its row of the consistent mass and advances to the next one.
template <Mass mass>
HWY_INLINE Vector inertia(const Bellies& belly, std::uint32_t n, std::uint32_t i, std::uint32_t j, std::uint32_t k,
                          const float* x, const float*& pair) {
  if constexpr (mass == Mass::lumped) {
    const V m = hn::Set(d, belly.kernel.mass_kg[n]);
    const float* const p = x + node_stride * n;
    return {hn::Mul(m, hn::Load(d, p)), hn::Mul(m, hn::Load(d, p + lane_count)),
            hn::Mul(m, hn::Load(d, p + 2 * lane_count))};
  } else {
    const Cells& cells = belly.cells;
    const std::uint32_t i_low = i > 0 ? i - 1 : 0, i_high = std::min(i + 1, cells[0]);
    const std::uint32_t j_low = j > 0 ? j - 1 : 0, j_high = std::min(j + 1, cells[1]);
    const std::uint32_t k_low = k > 1 ? k - 1 : 1, k_high = std::min(k + 1, cells[2]);
    const float* m = pair;
    Vector sum = zero_vector();
    for (std::uint32_t kk = k_low; kk <= k_high; ++kk) {
      for (std::uint32_t jj = j_low; jj <= j_high; ++jj) {
        const float* p = x + node_stride * node_index(cells, i_low, jj, kk);
        for (std::uint32_t ii = i_low; ii <= i_high; ++ii, p += node_stride) {
          const V w = hn::Set(d, *m++);
          sum.x = mul_add(w, hn::Load(d, p), sum.x);
          sum.y = mul_add(w, hn::Load(d, p + lane_count), sum.y);
          sum.z = mul_add(w, hn::Load(d, p + 2 * lane_count), sum.z);
        }
      }
    }
    pair = m;
    return sum;
  }
}

/// Returns M₁·(the field's accelerations) of a node, from its row's sums of mass and of mass times position.
HWY_INLINE Vector field_inertia(const FrameField& field, float mass_kg, const float* moment_kg_m) {
  const V m = hn::Set(d, mass_kg), mx = hn::Set(d, moment_kg_m[0]), my = hn::Set(d, moment_kg_m[1]),
          mz = hn::Set(d, moment_kg_m[2]);
  const auto row = [&](V c, const Vector& g)
                       HWY_ATTR { return mul_add(g.x, mx, mul_add(g.y, my, mul_add(g.z, mz, hn::Mul(c, m)))); };
  return {row(field.constant.x, field.x), row(field.constant.y, field.y), row(field.constant.z, field.z)};
}

/// residual ← loads − K·strained − S²·l·M₁·rates (null: none), on the moving nodes.
template <Stiffness stiffness, Mass mass>
HWY_NOINLINE void write_residual(const Bellies& belly, const float* strained, const float* rates, const Loads& loads) {
  const Cells cells = belly.cells;
  const Factors factor = belly.factor;
  const float* coefficient = coefficients<stiffness>(belly.kernel, 1);
  const float* pair = belly.kernel.consistent_mass_kg.data();
  const std::uint32_t far = first_insertion_node(cells);
  const bool framed = belly.block.frame != nullptr;
  for_each_moving_node(belly, [&](std::uint32_t n, std::uint32_t i, std::uint32_t j, std::uint32_t k) HWY_ATTR {
    const Vector elastic = elastic_force<stiffness>(cells, i, j, k, strained, factor, coefficient);
    Vector r{hn::Neg(elastic.x), hn::Neg(elastic.y), hn::Neg(elastic.z)};
    if (rates != nullptr || framed) {
      Vector inert = zero_vector();
      if (framed) {
        inert =
            field_inertia(loads.field, belly.kernel.mass_kg[n], belly.solver.moment_kg_m.data() + 3 * std::size_t{n});
      }
      if (rates != nullptr) {
        const Vector m = inertia<mass>(belly, n, i, j, k, rates, pair);
        inert = {hn::Sub(inert.x, m.x), hn::Sub(inert.y, m.y), hn::Sub(inert.z, m.z)};
      }
      r = {mul_add(factor.mass, inert.x, r.x), mul_add(factor.mass, inert.y, r.y), mul_add(factor.mass, inert.z, r.z)};
    }
    if (n >= far) {
      const V share = hn::Set(d, belly.kernel.far_share[n - far]);
      r = {mul_add(share, loads.traction.x, r.x), mul_add(share, loads.traction.y, r.y),
           mul_add(share, loads.traction.z, r.z)};
    }
    store_vector(r, belly.residual + node_stride * n);
  });
}

/// image ← operator·direction; returns directionᵀ·image.
template <Stiffness stiffness, Mass mass>
HWY_NOINLINE V apply(const Bellies& belly, const Operator& what) {
  const Cells cells = belly.cells;
  const Factors factor = belly.factor;
  const float* coefficient = coefficients<stiffness>(belly.kernel, 1);
  const float* pair = belly.kernel.consistent_mass_kg.data();
  V work = hn::Zero(d);
  for_each_moving_node(belly, [&](std::uint32_t n, std::uint32_t i, std::uint32_t j, std::uint32_t k) HWY_ATTR {
    const Vector elastic = elastic_force<stiffness>(cells, i, j, k, belly.direction, factor, coefficient);
    const Vector m = inertia<mass>(belly, n, i, j, k, belly.direction, pair);
    const Vector q{mul_add(what.mass_x, m.x, hn::Mul(what.stiffness, elastic.x)),
                   mul_add(what.mass_y, m.y, hn::Mul(what.stiffness, elastic.y)),
                   mul_add(what.mass_z, m.z, hn::Mul(what.stiffness, elastic.z))};
    const Vector p = load_vector(belly.direction + node_stride * n);
    work = mul_add(p.x, q.x, mul_add(p.y, q.y, mul_add(p.z, q.z, work)));
    store_vector(q, belly.image + node_stride * n);
  });
  return work;
}

/// Returns a / b, or 0 if b is not positive.
HWY_INLINE V ratio_or_zero(V a, V b) {
  const auto sound = hn::Gt(b, hn::Zero(d));
  return hn::IfThenElseZero(sound, hn::Div(a, hn::IfThenElse(sound, b, hn::Set(d, 1.0F))));
}

/// target ← target + gain·operator⁻¹·residual, by conjugate gradients preconditioned with the solver's factor. If the
/// factor is the operator's own (`exact`), it solves again for the remainder instead. Overwrites the residual.
template <Stiffness stiffness, Mass mass>
HWY_NOINLINE void solve(const Bellies& belly, const Operator& what, bool exact, float gain, float* target) {
  const BandFactor& factor = belly.solver.factor;
  const std::size_t from = node_stride * belly.first, to = node_stride * belly.past;
  const std::uint32_t sweeps = exact ? belly.solver.refinements : belly.solver.sweeps;
  for (std::size_t at = to; at < node_stride * node_count(belly.cells); at += lane_count) {
    hn::Store(hn::Zero(d), d, belly.direction + at);
  }
  V last_square = hn::Zero(d), last_step = hn::Set(d, 1.0F);
  for (std::uint32_t sweep = 0; sweep < sweeps; ++sweep) {
    const V square = solve_forward<3>(factor, belly.image + from, [&](std::uint32_t n) HWY_ATTR {
      return load_vector(belly.residual + from + node_stride * n);
    });
    const V keep = exact || sweep == 0 ? hn::Zero(d) : ratio_or_zero(square, last_square);
    const bool anew = exact || sweep == 0;
    solve_backward<3>(factor, belly.image + from, [&](std::uint32_t n, const Vector& z) HWY_ATTR {
      float* const p = belly.direction + from + node_stride * n;
      if (anew) return store_vector(z, p);
      const Vector old = load_vector(p);
      store_vector({mul_add(keep, old.x, z.x), mul_add(keep, old.y, z.y), mul_add(keep, old.z, z.z)}, p);
    });
    const bool more = sweep + 1 < sweeps;
    V step = hn::Set(d, 1.0F);
    if (more || (sweep == 0 && !exact)) {
      const V work = apply<stiffness, mass>(belly, what);
      if (!exact) step = ratio_or_zero(square, work);
    } else if (!exact) {
      step = last_step;  // a good preconditioner has similar steps: saves a product, loses no accuracy
    }
    const V advance = hn::Mul(hn::Set(d, gain), step);
    for (std::size_t at = from; at < to; at += lane_count) {
      hn::Store(mul_add(advance, hn::Load(d, belly.direction + at), hn::Load(d, target + at)), d, target + at);
      if (more) {
        const V left = neg_mul_add(step, hn::Load(d, belly.image + at), hn::Load(d, belly.residual + at));
        hn::Store(left, d, belly.residual + at);
      }
    }
    last_square = square;
    last_step = step;
  }
}

}  // namespace
}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
