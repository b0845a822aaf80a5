// The elastic force on a node, and other parts common to the methods, one register of lanes at a time. For inclusion
// only inside Highway's targets.

#if defined(MOBIL_SYSTEMS_DEFORMATION_ELASTIC_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_DEFORMATION_ELASTIC_INL_H_
#undef MOBIL_SYSTEMS_DEFORMATION_ELASTIC_INL_H_
#else
#define MOBIL_SYSTEMS_DEFORMATION_ELASTIC_INL_H_
#endif

#include <algorithm>

#include "engine/fused-inl.h"
#include "engine/wide-inl.h"
#include "systems/deformation/deformation.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

// Kernels process one register of lanes at a time, for a whole tick. Nine sums, three displacements and a coefficient
// then fit into the sixteen registers of AVX2.
using V = hn::Vec<FloatTag>;
inline constexpr FloatTag d;
inline constexpr std::size_t node_stride = 3 * lane_count;

using Vector = Vec3<V>;

/// Loads a value that is used several times. gcc would fold the load into every use, and then loads, not arithmetic,
/// would limit the kernel.
HWY_INLINE V load_once(const float* p) {
  V value = hn::Load(d, p);
#if HWY_ARCH_X86 && HWY_COMPILER_GCC_ACTUAL
  asm("" : "+v"(value.raw));
#endif
  return value;
}

HWY_INLINE V lanes_or_zero(const Lanes<float>* lanes, std::size_t first_lane) {
  return lanes == nullptr ? hn::Zero(d) : hn::Load(d, lanes->lane + first_lane);
}

/// Factors of A, B and C for each lane, and of the mass. S²/l is split into two parts: a slender belly bends about ten
/// thousand times more easily than it stretches, so the three terms must cancel to full precision.
struct Factors {
  V a, b, c, c_rest;
  V mass;
};

HWY_INLINE Factors factors(const BellyScale<Lanes<float>>& scale, std::size_t first_lane) {
  const V across = hn::Load(d, scale.across.lane + first_lane), along = hn::Load(d, scale.along.lane + first_lane);
  const V area = hn::Mul(across, across);
  const V c = hn::Div(area, along);
  const V c_rest = hn::Div(hn::Add(neg_mul_add(c, along, area), mul_sub(across, across, area)), along);
  return {along, across, c, c_rest, hn::Mul(area, along)};
}

template <Stiffness stiffness>
inline constexpr std::size_t words =
    stiffness == Stiffness::individual ? KernelArrays::individual_words : KernelArrays::shared_words;

template <Stiffness stiffness>
HWY_INLINE const float* coefficients(const KernelArrays& kernel, std::uint32_t plane) {
  return (stiffness == Stiffness::individual ? kernel.individual : kernel.shared).data() +
         kernel.plane_pair[plane] * words<stiffness>;
}

/// Nine partial sums of a node's force. Individual: sums of A (x y z), B and C. Shared: sums of x, y and z.
struct Sums {
  V a0, a1, a2, b0, b1, b2, c0, c1, c2;
};

HWY_INLINE V add(float coefficient, V value, V sum) {
  return mul_add(hn::Set(d, coefficient), value, sum);
}

/// Adds the coupling `q` to the neighbour whose displacement is at `p`.
template <Stiffness stiffness>
HWY_INLINE void add_neighbour(const float* p, const float* q, Sums& s) {
  const V x = load_once(p), y = load_once(p + lane_count), z = load_once(p + 2 * lane_count);
  if constexpr (stiffness == Stiffness::individual) {
    s.a0 = add(q[0], x, s.a0);  // A: xx xy yx yy zz
    s.a1 = add(q[2], x, s.a1);
    s.a2 = add(q[4], z, s.a2);
    s.b0 = add(q[5], z, s.b0);  // B: xz yz zx zy
    s.b1 = add(q[6], z, s.b1);
    s.b2 = add(q[7], x, s.b2);
    s.c0 = add(q[9], x, s.c0);  // C: xx yy zz
    s.c1 = add(q[10], y, s.c1);
    s.c2 = add(q[11], z, s.c2);
    s.a0 = add(q[1], y, s.a0);
    s.a1 = add(q[3], y, s.a1);
    s.b2 = add(q[8], y, s.b2);
  } else {
    s.a0 = add(q[0], x, s.a0);
    s.a1 = add(q[3], x, s.a1);
    s.a2 = add(q[6], x, s.a2);
    s.b0 = add(q[1], y, s.b0);
    s.b1 = add(q[4], y, s.b1);
    s.b2 = add(q[7], y, s.b2);
    s.c0 = add(q[2], z, s.c0);
    s.c1 = add(q[5], z, s.c1);
    s.c2 = add(q[8], z, s.c2);
  }
}

/// Adds the neighbours of `across` × `deep` nodes in each plane from the one that begins at `plane` to `last_plane`.
template <Stiffness stiffness, std::size_t across, std::size_t deep>
HWY_INLINE const float* add_planes(const float* plane, const float* last_plane, std::size_t row_stride,
                                   std::size_t plane_stride, const float* q, Sums& sums) {
  for (; plane <= last_plane; plane += plane_stride) {
    for (std::size_t row = 0; row < deep; ++row) {
      const float* p = plane + row * row_stride;
      for (std::size_t n = 0; n < across; ++n, p += node_stride, q += words<stiffness>) {
        add_neighbour<stiffness>(p, q, sums);
      }
    }
  }
  return q;
}

/// Returns (K·u) of node (i, j, k), k > 0, in N. `coefficient` points to its row and advances to the next one.
template <Stiffness stiffness>
HWY_INLINE Vector elastic_force(const Cells& cells, std::uint32_t i, std::uint32_t j, std::uint32_t k, const float* u,
                                const Factors& factor, const float*& coefficient) {
  const std::size_t row_stride = node_stride * (cells[0] + 1), plane_stride = row_stride * (cells[1] + 1);
  const std::uint32_t k_low = k > 1 ? k - 1 : 1, k_high = std::min(k + 1, cells[2]);  // the first plane is fixed
  const float* const first =
      u + plane_stride * k_low + row_stride * (j > 0 ? j - 1 : 0) + node_stride * (i > 0 ? i - 1 : 0);
  const float* const last = first + plane_stride * (k_high - k_low);
  const bool wide = i > 0 && i<cells[0], deep = j> 0 && j < cells[1];
  const V zero = hn::Zero(d);
  Sums s{zero, zero, zero, zero, zero, zero, zero, zero, zero};
  const float* c = coefficient;
  if (wide) {
    c = deep ? add_planes<stiffness, 3, 3>(first, last, row_stride, plane_stride, c, s)
             : add_planes<stiffness, 3, 2>(first, last, row_stride, plane_stride, c, s);
  } else {
    c = deep ? add_planes<stiffness, 2, 3>(first, last, row_stride, plane_stride, c, s)
             : add_planes<stiffness, 2, 2>(first, last, row_stride, plane_stride, c, s);
  }
  coefficient = c;
  if constexpr (stiffness == Stiffness::individual) {
    const auto join = [&factor](V a, V b, V e) HWY_ATTR {
      return mul_add(factor.a, a, mul_add(factor.b, b, mul_add(factor.c, e, hn::Mul(factor.c_rest, e))));
    };
    return {join(s.a0, s.b0, s.c0), join(s.a1, s.b1, s.c1), join(s.a2, s.b2, s.c2)};
  } else {
    return {hn::Add(hn::Add(s.a0, s.b0), s.c0), hn::Add(hn::Add(s.a1, s.b1), s.c1), hn::Add(hn::Add(s.a2, s.b2), s.c2)};
  }
}

/// Acceleration of the nodes by gravity and the frame's motion, for one register of lanes at one instant.
struct FrameField {
  Vector constant, x, y, z;  // rows of the gradient, over the template's rest positions

  HWY_INLINE Vector at(const float* rest) const {
    const V px = hn::Set(d, rest[0]), py = hn::Set(d, rest[1]), pz = hn::Set(d, rest[2]);
    const auto row = [&](V c, const Vector& g)
                         HWY_ATTR { return mul_add(g.x, px, mul_add(g.y, py, mul_add(g.z, pz, c))); };
    return {row(constant.x, x), row(constant.y, y), row(constant.z, z)};
  }
};

/// Returns the field at the fraction `part` of the tick.
HWY_INLINE FrameField frame_field(const FrameLoad<Lanes<float>>& load, const BellyScale<Lanes<float>>& scale, V part,
                                  std::size_t first_lane) {
  const auto between = [&](const Lanes<float>& from, const Lanes<float>& to) HWY_ATTR {
    const V a = hn::Load(d, from.lane + first_lane);
    return mul_add(hn::Sub(hn::Load(d, to.lane + first_lane), a), part, a);
  };
  const V across = hn::Load(d, scale.across.lane + first_lane), along = hn::Load(d, scale.along.lane + first_lane);
  const auto row = [&](const Vec3<Lanes<float>>& from, const Vec3<Lanes<float>>& to) HWY_ATTR {
    return Vector{hn::Mul(between(from.x, to.x), across), hn::Mul(between(from.y, to.y), across),
                  hn::Mul(between(from.z, to.z), along)};
  };
  const auto &c0 = load.constant_from, &c1 = load.constant_to;
  const auto &g0 = load.gradient_from, &g1 = load.gradient_to;
  return {{between(c0.x, c1.x), between(c0.y, c1.y), between(c0.z, c1.z)},
          row(g0.x, g1.x),
          row(g0.y, g1.y),
          row(g0.z, g1.z)};
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
