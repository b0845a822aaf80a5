// Forces and energy of one-point elements at finite strain, one register of lanes at a time. For inclusion inside
// Highway's targets only.

#if defined(MOBIL_SYSTEMS_DEFORMATION_FINITE_ELEMENT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_DEFORMATION_FINITE_ELEMENT_INL_H_
#undef MOBIL_SYSTEMS_DEFORMATION_FINITE_ELEMENT_INL_H_
#else
#define MOBIL_SYSTEMS_DEFORMATION_FINITE_ELEMENT_INL_H_
#endif

#include "assets/fem/finite_kernel.h"
#include "engine/fused-inl.h"
#include "systems/deformation/elastic-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {

/// What elements of a register of lanes have in common during one tick.
struct FiniteLaw {
  Factors size;               // a: l, b: S, c: S²/l, mass: S²·l
  V over_across, over_along;  // 1/S, 1/l
  V per_across, per_along;    // S·l, S²: volume over them
  V active_pa;                // times the activation that pulls
  V share_at_none;            // active share = max(least, slope·λ + this)
  float shear_pa, bulk_pa, passive_pa, slope, least_share, passive_slope, passive_start, linear_slope;
};

inline constexpr float least_stretch2 = 0.01F;  // λ² of fibres, which divides

/// Fibres' nominal stress at the stretch λ: active and passive, Pa.
struct FibreStress {
  V share, exponent, curved, series;  // exponent z ≥ 0; curved: what of it the series takes
  V stress_pa;
};

HWY_INLINE FibreStress fibre_stress(const FiniteLaw& law, V stretch) {
  FibreStress f;
  f.share = hn::Max(mul_add(hn::Set(d, law.slope), stretch, law.share_at_none), hn::Set(d, law.least_share));
  f.exponent = hn::Max(mul_add(hn::Set(d, law.passive_slope), stretch, hn::Set(d, law.passive_start)), hn::Zero(d));
  f.curved = hn::Min(f.exponent, hn::Set(d, static_cast<float>(most_passive_exponent)));
  const V z = f.curved;
  f.series =
      hn::Mul(z, mul_add(z, mul_add(z, mul_add(z, hn::Set(d, 1.0F / 24), hn::Set(d, 1.0F / 6)), hn::Set(d, 0.5F)),
                         hn::Set(d, 1.0F)));
  const V passive = mul_add(hn::Set(d, law.linear_slope), hn::Sub(f.exponent, z), f.series);
  f.stress_pa = mul_add(hn::Set(d, law.passive_pa), passive, hn::Mul(law.active_pa, f.share));
  return f;
}

/// ∫ stress over the stretch, Pa, up to a constant that depends on the lane alone.
HWY_INLINE V fibre_energy(const FiniteLaw& law, V stretch, const FibreStress& f) {
  const V floor_at = hn::Div(hn::Sub(hn::Set(d, law.least_share), law.share_at_none), hn::Set(d, law.slope));
  const V below = hn::Min(hn::Sub(stretch, floor_at), hn::Zero(d));
  const V active =
      mul_add(hn::Set(d, law.least_share), below, hn::Mul(hn::Mul(f.share, f.share), hn::Set(d, 0.5F / law.slope)));
  const V z = f.curved, past = hn::Sub(f.exponent, z);
  const V curved =
      hn::Mul(hn::Mul(z, z),
              mul_add(z, mul_add(z, mul_add(z, hn::Set(d, 1.0F / 120), hn::Set(d, 1.0F / 24)), hn::Set(d, 1.0F / 6)),
                      hn::Set(d, 0.5F)));
  const V straight = hn::Mul(past, mul_add(past, hn::Set(d, 0.5F * law.linear_slope), f.series));
  const V passive = hn::Mul(hn::Add(curved, straight), hn::Set(d, law.passive_pa / law.passive_slope));
  return mul_add(law.active_pa, active, passive);
}

/// A plane of nodes: where its forces are summed, its mean displacement sideways, and what acts on that mean.
struct FinitePlane {
  float* force;
  V mean[2], on_mean[2];
};

/// Sums over an element's corners, where ξ, η, ζ = ±1, of one component times what they are named for.
struct CornerSums {
  V xi, eta, zeta, eta_zeta, xi_zeta, xi_eta, xi_eta_zeta;
};

/// The same over the four corners of a face.
struct FaceSums {
  V one, xi, eta, xi_eta;
};

HWY_INLINE FaceSums face_sums(const float* u, const std::uint32_t* node) {
  const V a = hn::Load(d, u + node_stride * node[0]), b = hn::Load(d, u + node_stride * node[1]),
          c = hn::Load(d, u + node_stride * node[2]), e = hn::Load(d, u + node_stride * node[3]);
  const V near = hn::Add(a, b), far = hn::Add(e, c), near_xi = hn::Sub(b, a), far_xi = hn::Sub(c, e);
  return {hn::Add(near, far), hn::Add(near_xi, far_xi), hn::Sub(far, near), hn::Sub(far_xi, near_xi)};
}

HWY_INLINE CornerSums corner_sums(const float* u, const FiniteKernelElement& element) {
  const FaceSums low = face_sums(u, element.node.data()), high = face_sums(u, element.node.data() + 4);
  return {hn::Add(low.xi, high.xi),        hn::Add(low.eta, high.eta), hn::Sub(high.one, low.one),
          hn::Sub(high.eta, low.eta),      hn::Sub(high.xi, low.xi),   hn::Add(low.xi_eta, high.xi_eta),
          hn::Sub(high.xi_eta, low.xi_eta)};
}

/// To the corners of a face each sum, times what it is named for there.
HWY_INLINE void add_to_face(const FaceSums& sum, const std::uint32_t* node, std::uint32_t first, float* force) {
  const V near = hn::Sub(sum.one, sum.eta), far = hn::Add(sum.one, sum.eta);
  const V near_xi = hn::Sub(sum.xi, sum.xi_eta), far_xi = hn::Add(sum.xi, sum.xi_eta);
  const V part[4] = {hn::Sub(near, near_xi), hn::Add(near, near_xi), hn::Add(far, far_xi), hn::Sub(far, far_xi)};
  for (std::size_t a = 0; a < 4; ++a) {
    float* const to = force + node_stride * (node[a] - first);
    hn::Store(hn::Add(hn::Load(d, to), part[a]), d, to);
  }
}

/// To the corners of an element each sum, times what it is named for there.
HWY_INLINE void add_to_corners(const CornerSums& sum, const FiniteKernelElement& element, std::uint32_t plane,
                               float* low, float* high) {
  add_to_face({hn::Neg(sum.zeta), hn::Sub(sum.xi, sum.xi_zeta), hn::Sub(sum.eta, sum.eta_zeta),
               hn::Sub(sum.xi_eta, sum.xi_eta_zeta)},
              element.node.data(), 0, low);
  add_to_face(
      {sum.zeta, hn::Add(sum.xi, sum.xi_zeta), hn::Add(sum.eta, sum.eta_zeta), hn::Add(sum.xi_eta, sum.xi_eta_zeta)},
      element.node.data() + 4, plane, high);
}

/// One element between its nodes' displacements and their forces, which are worked on in three passes: within a pass no
/// element waits for another one. The gradient of the displacement by row, and then what acts on it (N·m, less the
/// body's size); hourglass patterns, m, and their stiffness, N/m.
struct ElementState {
  V gradient[3][3], hourglass[3][4], stiffness;
};

/// How an element is deformed, of its nodes' displacements, which begin at `u`.
HWY_INLINE void gather_element(const FiniteLaw& law, const FiniteKernelElement& element, const float* u,
                               ElementState& state) {
  for (std::size_t r = 0; r < 3; ++r) {
    const CornerSums sum = corner_sums(u + r * lane_count, element);
    V g[2];
    for (std::size_t c = 0; c < 2; ++c) {
      const auto& across = element.across[c];
      g[c] =
          mul_add(hn::Set(d, across[0]), sum.xi,
                  mul_add(hn::Set(d, across[1]), sum.eta,
                          mul_add(hn::Set(d, across[2]), sum.eta_zeta, hn::Mul(hn::Set(d, across[3]), sum.xi_zeta))));
      state.gradient[r][c] = hn::Mul(g[c], law.over_across);
    }
    const auto& along = element.along;
    const V rising = mul_add(hn::Set(d, along[0]), sum.xi,
                             mul_add(hn::Set(d, along[1]), sum.eta, hn::Mul(hn::Set(d, along[2]), sum.eta_zeta)));
    const V stretching = mul_add(hn::Set(d, along[3]), sum.xi_zeta,
                                 mul_add(hn::Set(d, along[4]), sum.zeta, hn::Mul(hn::Set(d, along[5]), sum.xi_eta)));
    state.gradient[r][2] = hn::Mul(hn::Add(rising, stretching), law.over_along);
    const V pattern[4] = {sum.eta_zeta, sum.xi_zeta, sum.xi_eta, sum.xi_eta_zeta};
    for (std::size_t m = 0; m < 4; ++m)
      state.hourglass[r][m] = neg_mul_add(hn::Set(d, element.straight[m][0]), g[0],
                                          neg_mul_add(hn::Set(d, element.straight[m][1]), g[1], pattern[m]));
  }
}

/// From how an element is deformed to what acts on that; what its fibres do to the means of its two planes is added
/// there. With `energy`, adds its energy (J), less that of its fibres at λ = 1, to `work`.
template <bool energy>
HWY_INLINE void stress_element(const FiniteLaw& law, const FiniteKernelElement& element, ElementState& state,
                               FinitePlane& low, FinitePlane& high, V at_rest, V& work) {
  const auto& gradient = state.gradient;
  const auto& hourglass = state.hourglass;
  const V one = hn::Set(d, 1.0F);
  V F[3][3], cofactor[3][3];
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) F[r][c] = r == c ? hn::Add(gradient[r][c], one) : gradient[r][c];
  }
  const V aside[2] = {hn::Mul(law.size.b, hn::Set(d, element.fibre[0])),
                      hn::Mul(law.size.b, hn::Set(d, element.fibre[1]))};
  const V straight = hn::Mul(law.size.a, hn::Set(d, element.fibre[2]));
  V along[3];
  for (std::size_t r = 0; r < 3; ++r)
    along[r] = mul_add(F[r][0], aside[0], mul_add(F[r][1], aside[1], hn::Mul(F[r][2], straight)));
  const V rest2 = mul_add(aside[0], aside[0], mul_add(aside[1], aside[1], hn::Mul(straight, straight)));
  const V rise = hn::Set(d, element.rise);
  const V swayed =
      mul_add(aside[0], hn::Sub(high.mean[0], low.mean[0]), hn::Mul(aside[1], hn::Sub(high.mean[1], low.mean[1])));
  const V drawn2 = mul_add(along[0], along[0], mul_add(along[1], along[1], hn::Mul(along[2], along[2])));
  const V now2 = hn::Max(neg_mul_add(hn::Add(rise, rise), swayed, drawn2), hn::Mul(rest2, hn::Set(d, least_stretch2)));
  const V over_lengths = hn::Div(one, hn::Sqrt(hn::Mul(now2, rest2)));  // 1/(λ|a|²)
  const V stretch = hn::Mul(now2, over_lengths);
  const FibreStress fibre = fibre_stress(law, stretch);
  const V fibre_volume = hn::Mul(law.size.mass, hn::Set(d, element.fibre_volume_m3));
  const V pull = hn::Mul(hn::Mul(fibre.stress_pa, over_lengths), fibre_volume);
  const V held = hn::Mul(pull, rise);
  for (std::size_t c = 0; c < 2; ++c) {
    low.on_mean[c] = mul_add(held, aside[c], low.on_mean[c]);
    high.on_mean[c] = neg_mul_add(held, aside[c], high.on_mean[c]);
  }

  for (std::size_t r = 0; r < 3; ++r) {
    const std::size_t s = (r + 1) % 3, t = (r + 2) % 3;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t e = (c + 1) % 3, f = (c + 2) % 3;
      cofactor[r][c] = mul_sub(F[s][e], F[t][f], hn::Mul(F[s][f], F[t][e]));
    }
  }
  const V ratio = mul_add(F[0][0], cofactor[0][0], mul_add(F[0][1], cofactor[0][1], hn::Mul(F[0][2], cofactor[0][2])));
  const V dilatation = hn::Min(hn::Max(hn::Sub(ratio, one), hn::Set(d, least_dilatation)), hn::Set(d, most_dilatation));
  const V pressure = mul_sub(hn::Set(d, law.bulk_pa), dilatation, hn::Set(d, law.shear_pa));

  const V volume = hn::Set(d, element.volume_m3);
  const V on_across = hn::Mul(volume, law.per_across), on_along = hn::Mul(volume, law.per_along);
  const V stiffness = mul_add(hn::Set(d, element.hourglass_across), law.size.a,
                              hn::Mul(hn::Set(d, element.hourglass_along), law.size.c));
  if constexpr (energy) {
    // μ/2 (I₁ − 3) − μ(J − 1) without the cancelling: with G = F − 1, μ(|G|²/2 − (J − 1 − tr G)).
    const auto& G = gradient;
    const auto minor = [&](std::size_t i, std::size_t j)
                           HWY_ATTR { return mul_sub(G[i][i], G[j][j], hn::Mul(G[i][j], G[j][i])); };
    V square = hn::Zero(d), patterns = square;
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) square = mul_add(G[r][c], G[r][c], square);
      for (std::size_t m = 0; m < 4; ++m) patterns = mul_add(hourglass[r][m], hourglass[r][m], patterns);
    }
    const V determinant = mul_add(G[0][0], minor(1, 2),
                                  mul_add(G[0][1], mul_sub(G[1][2], G[2][0], hn::Mul(G[1][0], G[2][2])),
                                          hn::Mul(G[0][2], mul_sub(G[1][0], G[2][1], hn::Mul(G[1][1], G[2][0])))));
    const V second = hn::Add(determinant, hn::Add(minor(0, 1), hn::Add(minor(0, 2), minor(1, 2))));
    const V shear = hn::Mul(hn::Set(d, law.shear_pa), mul_sub(hn::Set(d, 0.5F), square, second));
    // ∫ of the clamped dilatation.
    const V swelling = hn::Mul(hn::Set(d, law.bulk_pa),
                               hn::Mul(dilatation, neg_mul_add(hn::Set(d, 0.5F), dilatation, hn::Sub(ratio, one))));
    work = mul_add(hn::Add(shear, swelling), hn::Mul(volume, law.size.mass), work);
    work = mul_add(hn::Sub(fibre_energy(law, stretch, fibre), at_rest), fibre_volume, work);
    work = mul_add(hn::Mul(hn::Set(d, 0.5F), stiffness), patterns, work);
  }

  const V shear = hn::Set(d, law.shear_pa);
  const V swelling[2] = {hn::Mul(pressure, on_across), hn::Mul(pressure, on_along)};
  const V shearing[2] = {hn::Mul(shear, on_across), hn::Mul(shear, on_along)};
  for (std::size_t r = 0; r < 3; ++r) {
    const V taut = hn::Mul(pull, along[r]);
    for (std::size_t c = 0; c < 3; ++c) {
      const V tissue = mul_add(shearing[c / 2], F[r][c], hn::Mul(taut, hn::Set(d, element.fibre[c])));
      state.gradient[r][c] = mul_add(swelling[c / 2], cofactor[r][c], tissue);
    }
  }
  state.stiffness = stiffness;
}

/// Adds an element's forces, N, to its nodes' in the planes below and above it; `plane`: nodes of one plane.
HWY_INLINE void scatter_element(const FiniteKernelElement& element, std::uint32_t plane, const ElementState& state,
                                FinitePlane& low, FinitePlane& high) {
  for (std::size_t r = 0; r < 3; ++r) {
    V on[3] = {state.gradient[r][0], state.gradient[r][1], state.gradient[r][2]}, on_pattern[4];
    for (std::size_t m = 0; m < 4; ++m) {
      on_pattern[m] = hn::Mul(state.stiffness, state.hourglass[r][m]);
      for (std::size_t c = 0; c < 2; ++c) on[c] = neg_mul_add(hn::Set(d, element.straight[m][c]), on_pattern[m], on[c]);
    }
    const auto on_sum = [&](std::size_t k, V already) HWY_ATTR {
      return mul_add(
          hn::Set(d, element.across[0][k]), on[0],
          mul_add(hn::Set(d, element.across[1][k]), on[1], mul_add(hn::Set(d, element.along[k]), on[2], already)));
    };
    const V none = hn::Zero(d);
    const CornerSums sum = {on_sum(0, none),
                            on_sum(1, none),
                            hn::Mul(hn::Set(d, element.along[4]), on[2]),
                            on_sum(2, on_pattern[0]),
                            on_sum(3, on_pattern[1]),
                            mul_add(hn::Set(d, element.along[5]), on[2], on_pattern[2]),
                            on_pattern[3]};
    add_to_corners(sum, element, plane, low.force + r * lane_count, high.force + r * lane_count);
  }
}

}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
