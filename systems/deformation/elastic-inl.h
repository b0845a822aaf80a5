// The elastic force on a node, and what else the methods share, one register of lanes at a time. For inclusion inside
// Highway's targets only.

#if defined(MOBIL_SYSTEMS_DEFORMATION_ELASTIC_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_DEFORMATION_ELASTIC_INL_H_
#undef MOBIL_SYSTEMS_DEFORMATION_ELASTIC_INL_H_
#else
#define MOBIL_SYSTEMS_DEFORMATION_ELASTIC_INL_H_
#endif

#include <algorithm>

#include "engine/wide-inl.h"
#include "systems/deformation/deformation.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {

// The kernels work through one register of lanes at a time, a whole tick long: nine sums, three displacements and a
// coefficient then fit the sixteen registers of AVX2.
using V = hn::Vec<FloatTag>;
inline constexpr FloatTag d;
inline constexpr std::size_t node_stride = 3 * lane_count;

using Vector = Vec3<V>;

/// A value that is used several times, loaded once. gcc would fold the load into every use, and loads, not arithmetic,
/// would then bound the kernel.
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

/// Factors of A, B and C for each lane, and of the mass. S²/l goes in two parts: a slender belly bends some ten
/// thousand times more easily than it stretches, so that the three terms must cancel to all the digits there are.
struct Factors {
  V a, b, c, c_rest;
  V mass;
};

HWY_INLINE Factors factors(const BellyScale<Lanes<float>>& scale, std::size_t first_lane) {
  const V across = hn::Load(d, scale.across.lane + first_lane), along = hn::Load(d, scale.along.lane + first_lane);
  const V area = hn::Mul(across, across);
  const V c = hn::Div(area, along);
  const V c_rest = hn::Div(hn::Add(hn::NegMulAdd(c, along, area), hn::MulSub(across, across, area)), along);
  return {along, across, c, c_rest, hn::Mul(area, along)};
}

template <Stiffness stiffness>
inline constexpr std::size_t words =
    stiffness == Stiffness::individual ? KernelArrays::individual_words : KernelArrays::shared_words;

template <Stiffness stiffness>
HWY_INLINE const float* coefficients(const KernelArrays& kernel, const Cells& cells, std::uint32_t plane) {
  return (stiffness == Stiffness::individual ? kernel.individual : kernel.shared).data() +
         kernel.plane_pair[plane] * words<stiffness> +
         KernelArrays::rest_words * std::size_t{plane - 1} * plane_nodes(cells);
}

/// (K·u) of node (i, j, k), k > 0, in N. `coefficient` points at its row and moves on to the next one.
template <Stiffness stiffness>
HWY_INLINE Vector elastic_force(const Cells& cells, std::uint32_t i, std::uint32_t j, std::uint32_t k, const float* u,
                                const Factors& factor, const float*& coefficient) {
  const std::uint32_t width = cells[0] + 1;
  const std::uint32_t i_low = i > 0 ? i - 1 : 0;
  const std::uint32_t j_low = j > 0 ? j - 1 : 0;
  const std::uint32_t k_low = k > 1 ? k - 1 : 1;  // the first plane is fixed
  const std::uint32_t i_high = std::min(i + 1, cells[0]);
  const std::uint32_t j_high = std::min(j + 1, cells[1]);
  const std::uint32_t k_high = std::min(k + 1, cells[2]);
  const float* c = coefficient;
  V s0 = hn::Zero(d), s1 = s0, s2 = s0, s3 = s0, s4 = s0, s5 = s0, s6 = s0, s7 = s0, s8 = s0;
  const auto add_neighbour = [&](const float* p, const float* q) HWY_ATTR {
    const V x = load_once(p);
    const V y = load_once(p + lane_count);
    const V z = load_once(p + 2 * lane_count);
    const auto add = [q](std::size_t word, V value, V sum)
                         HWY_ATTR { return hn::MulAdd(hn::Set(d, q[word]), value, sum); };
    if constexpr (stiffness == Stiffness::individual) {
      s0 = add(0, x, s0);  // A: xx xy yx yy zz
      s1 = add(2, x, s1);
      s2 = add(4, z, s2);
      s3 = add(5, z, s3);  // B: xz yz zx zy
      s4 = add(6, z, s4);
      s5 = add(7, x, s5);
      s6 = add(9, x, s6);  // C: xx yy zz
      s7 = add(10, y, s7);
      s8 = add(11, z, s8);
      s0 = add(1, y, s0);
      s1 = add(3, y, s1);
      s5 = add(8, y, s5);
    } else {
      s0 = add(0, x, s0);
      s1 = add(3, x, s1);
      s2 = add(6, x, s2);
      s3 = add(1, y, s3);
      s4 = add(4, y, s4);
      s5 = add(7, y, s5);
      s6 = add(2, z, s6);
      s7 = add(5, z, s7);
      s8 = add(8, z, s8);
    }
  };
  for (std::uint32_t kk = k_low; kk <= k_high; ++kk) {
    for (std::uint32_t jj = j_low; jj <= j_high; ++jj) {
      const float* p = u + node_stride * ((kk * (cells[1] + 1) + jj) * width + i_low);
      for (std::uint32_t ii = i_low; ii <= i_high; ++ii, p += node_stride) {
        add_neighbour(p, c);
        c += words<stiffness>;
      }
    }
  }
  const float* own = u + node_stride * ((k * (cells[1] + 1) + j) * width + i);
  s0 = hn::MulAdd(hn::Set(d, c[0]), hn::Load(d, own), s0);
  (stiffness == Stiffness::individual ? s1 : s4) =
      hn::MulAdd(hn::Set(d, c[1]), hn::Load(d, own + lane_count), stiffness == Stiffness::individual ? s1 : s4);
  (stiffness == Stiffness::individual ? s2 : s8) =
      hn::MulAdd(hn::Set(d, c[2]), hn::Load(d, own + 2 * lane_count), stiffness == Stiffness::individual ? s2 : s8);
  coefficient = c + KernelArrays::rest_words;
  if constexpr (stiffness == Stiffness::individual) {
    const auto join = [&factor](V a, V b, V e) HWY_ATTR {
      return hn::MulAdd(factor.a, a, hn::MulAdd(factor.b, b, hn::MulAdd(factor.c, e, hn::Mul(factor.c_rest, e))));
    };
    return {join(s0, s3, s6), join(s1, s4, s7), join(s2, s5, s8)};
  } else {
    return {hn::Add(hn::Add(s0, s3), s6), hn::Add(hn::Add(s1, s4), s7), hn::Add(hn::Add(s2, s5), s8)};
  }
}

/// The acceleration that gravity and the frame's motion give the nodes, for one register of lanes and one moment.
struct FrameField {
  Vector constant, x, y, z;  // rows of the gradient, over the template's rest positions

  HWY_INLINE Vector at(const float* rest) const {
    const V px = hn::Set(d, rest[0]), py = hn::Set(d, rest[1]), pz = hn::Set(d, rest[2]);
    const auto row = [&](V c, const Vector& g)
                         HWY_ATTR { return hn::MulAdd(g.x, px, hn::MulAdd(g.y, py, hn::MulAdd(g.z, pz, c))); };
    return {row(constant.x, x), row(constant.y, y), row(constant.z, z)};
  }
};

/// The field at the fraction `part` of the tick.
HWY_INLINE FrameField frame_field(const FrameLoad<Lanes<float>>& load, const BellyScale<Lanes<float>>& scale, V part,
                                  std::size_t first_lane) {
  const auto between = [&](const Lanes<float>& from, const Lanes<float>& to) HWY_ATTR {
    const V a = hn::Load(d, from.lane + first_lane);
    return hn::MulAdd(hn::Sub(hn::Load(d, to.lane + first_lane), a), part, a);
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

}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
