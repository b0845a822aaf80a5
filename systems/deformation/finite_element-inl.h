// Forces and energy of one-point elements at finite strain, one register of lanes at a time. For inclusion only inside
// Highway's targets.

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
namespace mobil::inline v0_3::HWY_NAMESPACE {

/// Values common to the elements of a register of lanes during one tick.
struct FiniteLaw {
  Factors size;                 // l, S, S²/l and S²·l (mass)
  V over_across, over_along;    // 1/S, 1/l
  V over_volume;                // 1/(S²·l)
  V across2, along2;            // S², l²
  V shear_across, shear_along;  // shear modulus times l and S²/l
  V active_pa;                  // times the pulling activation
  V share_at_none;              // active share = max(least, slope·λ + this)
  float shear_pa, bulk_pa, passive_pa, slope, min_share, passive_slope, passive_start, linear_slope;
};

inline constexpr float min_stretch2 = 0.01F;  // minimum λ² of fibres, which is a divisor

/// Nominal stress of fibres at the stretch λ: active and passive, Pa.
struct FibreStress {
  V share, exponent, curved, series;  // exponent z ≥ 0; curved: its part within the series
  V stress_pa;
};

/// Computes the stress of several elements side by side, so that none waits for the result of another.
template <std::size_t n>
HWY_INLINE void find_fibre_stress(const FiniteLaw& law, const V (&stretch)[n], FibreStress (&of)[n]) {
  for (std::size_t i = 0; i < n; ++i)
    of[i].share = hn::Max(mul_add(hn::Set(d, law.slope), stretch[i], law.share_at_none), hn::Set(d, law.min_share));
  for (std::size_t i = 0; i < n; ++i)
    of[i].exponent =
        hn::Max(mul_add(hn::Set(d, law.passive_slope), stretch[i], hn::Set(d, law.passive_start)), hn::Zero(d));
  for (std::size_t i = 0; i < n; ++i)
    of[i].curved = hn::Min(of[i].exponent, hn::Set(d, static_cast<float>(max_passive_exponent)));
  V sum[n];
  for (std::size_t i = 0; i < n; ++i) sum[i] = mul_add(of[i].curved, hn::Set(d, 1.0F / 24), hn::Set(d, 1.0F / 6));
  for (std::size_t i = 0; i < n; ++i) sum[i] = mul_add(of[i].curved, sum[i], hn::Set(d, 0.5F));
  for (std::size_t i = 0; i < n; ++i) sum[i] = mul_add(of[i].curved, sum[i], hn::Set(d, 1.0F));
  for (std::size_t i = 0; i < n; ++i) of[i].series = hn::Mul(of[i].curved, sum[i]);
  for (std::size_t i = 0; i < n; ++i)
    sum[i] = mul_add(hn::Set(d, law.linear_slope), hn::Sub(of[i].exponent, of[i].curved), of[i].series);
  for (std::size_t i = 0; i < n; ++i)
    of[i].stress_pa = mul_add(hn::Set(d, law.passive_pa), sum[i], hn::Mul(law.active_pa, of[i].share));
}
HWY_INLINE FibreStress fibre_stress(const FiniteLaw& law, V stretch) {
  const V one[1] = {stretch};
  FibreStress of[1];
  find_fibre_stress(law, one, of);
  return of[0];
}

/// Returns ∫ stress over the stretch, Pa, up to a constant that depends only on the lane.
HWY_INLINE V fibre_energy(const FiniteLaw& law, V stretch, const FibreStress& f) {
  const V floor_at = hn::Div(hn::Sub(hn::Set(d, law.min_share), law.share_at_none), hn::Set(d, law.slope));
  const V below = hn::Min(hn::Sub(stretch, floor_at), hn::Zero(d));
  const V active =
      mul_add(hn::Set(d, law.min_share), below, hn::Mul(hn::Mul(f.share, f.share), hn::Set(d, 0.5F / law.slope)));
  const V z = f.curved, past = hn::Sub(f.exponent, z);
  const V curved =
      hn::Mul(hn::Mul(z, z),
              mul_add(z, mul_add(z, mul_add(z, hn::Set(d, 1.0F / 120), hn::Set(d, 1.0F / 24)), hn::Set(d, 1.0F / 6)),
                      hn::Set(d, 0.5F)));
  const V straight = hn::Mul(past, mul_add(past, hn::Set(d, 0.5F * law.linear_slope), f.series));
  const V passive = hn::Mul(hn::Add(curved, straight), hn::Set(d, law.passive_pa / law.passive_slope));
  return mul_add(law.active_pa, active, passive);
}

/// Values common to the elements of a layer: twice the sideways distance between the means of its upper and lower
/// plane, and the force on the lower mean. The force on the upper mean is the opposite.
struct FiniteLayer {
  V sway[2], on_mean[2];
};

/// Sums over an element's corners, where ξ, η, ζ = ±1, of one component times the product in their names.
struct CornerSums {
  V xi, eta, zeta, eta_zeta, xi_zeta, xi_eta, xi_eta_zeta;
};

/// Sums over the four corners of a face.
struct FaceSums {
  V one, xi, eta, xi_eta;
};

/// Returns the sums of a face's corners, in the order of Hexahedron.
HWY_INLINE FaceSums face_sums(V a, V b, V c, V e) {
  const V near = hn::Add(a, b), far = hn::Add(e, c), near_xi = hn::Sub(b, a), far_xi = hn::Sub(c, e);
  return {hn::Add(near, far), hn::Add(near_xi, far_xi), hn::Sub(far, near), hn::Sub(far_xi, near_xi)};
}
/// Returns the sums of an element from those of its lower and upper face.
HWY_INLINE CornerSums corner_sums(const FaceSums& low, const FaceSums& high) {
  return {hn::Add(low.xi, high.xi),        hn::Add(low.eta, high.eta), hn::Sub(high.one, low.one),
          hn::Sub(high.eta, low.eta),      hn::Sub(high.xi, low.xi),   hn::Add(low.xi_eta, high.xi_eta),
          hn::Sub(high.xi_eta, low.xi_eta)};
}

/// Values at the corners of a face: all sums, each times the product in its name at that corner.
struct FaceCorners {
  V corner[4];
};
HWY_INLINE FaceCorners face_corners(const FaceSums& sum) {
  const V near = hn::Sub(sum.one, sum.eta), far = hn::Add(sum.one, sum.eta);
  const V near_xi = hn::Sub(sum.xi, sum.xi_eta), far_xi = hn::Add(sum.xi, sum.xi_eta);
  return {hn::Sub(near, near_xi), hn::Add(near, near_xi), hn::Add(far, far_xi), hn::Sub(far, far_xi)};
}
/// Return the values at the corners of an element's lower and upper face.
HWY_INLINE FaceCorners low_corners(const CornerSums& sum) {
  return face_corners({hn::Neg(sum.zeta), hn::Sub(sum.xi, sum.xi_zeta), hn::Sub(sum.eta, sum.eta_zeta),
                       hn::Sub(sum.xi_eta, sum.xi_eta_zeta)});
}
HWY_INLINE FaceCorners high_corners(const CornerSums& sum) {
  return face_corners(
      {sum.zeta, hn::Add(sum.xi, sum.xi_zeta), hn::Add(sum.eta, sum.eta_zeta), hn::Add(sum.xi_eta, sum.xi_eta_zeta)});
}

/// One element between its nodes' displacements and their forces. It is processed in passes over the elements of a
/// layer: within a pass no element waits for another, and each pass is a separate function with all registers.
/// `gradient` is the displacement's gradient by row, m of the body over m of the template, and later the force on it,
/// N·m. `hourglass` contains the hourglass patterns, m, and `stiffness` theirs, N/m.
struct ElementState {
  V gradient[3][3], hourglass[3][4], stiffness;
  V along[3], now2, rest2;  // fibre, m over m of the template; squares of its present and rest length
  V pull;                   // force of its tension on the gradient, over `along`, N·m
};

/// Computes one row of an element's deformation from the sums of that component of its nodes' displacements. Returns
/// the gradient's part along the fibre.
HWY_INLINE V gather_row(const FiniteKernelElement& element, const CornerSums& sum, V (&gradient)[3],
                        V (&hourglass)[4]) {
  V g[3];
  for (std::size_t c = 0; c < 2; ++c) {
    const auto& across = element.across[c];
    g[c] = mul_add(hn::Set(d, across[0]), sum.xi,
                   mul_add(hn::Set(d, across[1]), sum.eta,
                           mul_add(hn::Set(d, across[2]), sum.eta_zeta, hn::Mul(hn::Set(d, across[3]), sum.xi_zeta))));
  }
  const auto& along = element.along;
  const V rising = mul_add(hn::Set(d, along[0]), sum.xi,
                           mul_add(hn::Set(d, along[1]), sum.eta, hn::Mul(hn::Set(d, along[2]), sum.eta_zeta)));
  const V stretching = mul_add(hn::Set(d, along[3]), sum.xi_zeta,
                               mul_add(hn::Set(d, along[4]), sum.zeta, hn::Mul(hn::Set(d, along[5]), sum.xi_eta)));
  g[2] = hn::Add(rising, stretching);
  const V pattern[4] = {sum.eta_zeta, sum.xi_zeta, sum.xi_eta, sum.xi_eta_zeta};
  for (std::size_t m = 0; m < 4; ++m)
    hourglass[m] = neg_mul_add(hn::Set(d, element.straight[m][0]), g[0],
                               neg_mul_add(hn::Set(d, element.straight[m][1]), g[1], pattern[m]));
  for (std::size_t c = 0; c < 3; ++c) gradient[c] = g[c];
  const auto& fibre = element.fibre;
  return mul_add(g[0], hn::Set(d, fibre[0]), mul_add(g[1], hn::Set(d, fibre[1]), hn::Mul(g[2], hn::Set(d, fibre[2]))));
}

/// Computes the fibre lengths of several elements from the results of gather_row.
HWY_NOINLINE inline void stretch_fibres(const FiniteLaw& law, const FiniteKernelElement* element, std::uint32_t some,
                                        const FiniteLayer& layer, ElementState* state) {
  for (; some > 0; --some, ++element, ++state) {
    const V direction[3] = {hn::Set(d, element->fibre[0]), hn::Set(d, element->fibre[1]),
                            hn::Set(d, element->fibre[2])};
    const V along[3] = {mul_add(law.size.b, direction[0], state->along[0]),
                        mul_add(law.size.b, direction[1], state->along[1]),
                        mul_add(law.size.a, direction[2], state->along[2])};
    const V rest2 =
        mul_add(law.across2, hn::Set(d, element->aside2), hn::Mul(law.along2, hn::Set(d, element->straight2)));
    const V rise = hn::Mul(law.size.b, hn::Set(d, element->rise));
    const V swayed = mul_add(direction[0], layer.sway[0], hn::Mul(direction[1], layer.sway[1]));
    const V drawn2 = mul_add(along[0], along[0], mul_add(along[1], along[1], hn::Mul(along[2], along[2])));
    for (std::size_t r = 0; r < 3; ++r) state->along[r] = along[r];
    state->rest2 = rest2;
    state->now2 = hn::Max(neg_mul_add(rise, swayed, drawn2), hn::Mul(rest2, hn::Set(d, min_stretch2)));
  }
}

/// Computes the pull of the fibres of `n` elements.
template <std::size_t n>
HWY_NOINLINE inline void pull_fibres(const FiniteLaw& law, const FiniteKernelElement* element, ElementState* state) {
  V over_lengths[n], stretch[n];
  for (std::size_t e = 0; e < n; ++e) over_lengths[e] = hn::Sqrt(hn::Mul(state[e].now2, state[e].rest2));
  for (std::size_t e = 0; e < n; ++e) over_lengths[e] = hn::Div(hn::Set(d, 1.0F), over_lengths[e]);  // 1/(λ|a|²)
  for (std::size_t e = 0; e < n; ++e) stretch[e] = hn::Mul(state[e].now2, over_lengths[e]);
  FibreStress fibre[n];
  find_fibre_stress(law, stretch, fibre);
  for (std::size_t e = 0; e < n; ++e) {
    const V volume = hn::Mul(law.size.mass, hn::Set(d, element[e].fibre_volume_m3));
    state[e].pull = hn::Mul(hn::Mul(fibre[e].stress_pa, over_lengths[e]), volume);
  }
}

/// Computes the forces on an element's deformation, by row. The force of its fibres on the means of its two planes is
/// added to the layer's. With `energy`, adds its energy (J), minus that of its fibres at λ = 1, to `work`.
///
/// The deformation gradient F has columns F·e over the body's sizes S, S and l. A has those columns times the sizes
/// instead: A = diag(S, S, l) + gradient, so J = det A/(S²·l). The force on the gradient is
///   V·(p·cof A + μ·A·diag(l, l, S²/l)) + fibres' share, p = κ'(J − 1) − μ, V the template's volume.
template <bool energy>
HWY_INLINE void stress_element(const FiniteLaw& law, const FiniteKernelElement& element, ElementState& state,
                               FiniteLayer& layer, V at_rest, V& work) {
  const V one = hn::Set(d, 1.0F);
  const V size[3] = {law.size.b, law.size.b, law.size.a};
  V A[3][3];
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c)
      A[r][c] = r == c ? hn::Add(state.gradient[r][c], size[r]) : state.gradient[r][c];
  }
  const V direction[3] = {hn::Set(d, element.fibre[0]), hn::Set(d, element.fibre[1]), hn::Set(d, element.fibre[2])};
  const V held = hn::Mul(state.pull, hn::Mul(law.size.b, hn::Set(d, element.rise)));
  for (std::size_t c = 0; c < 2; ++c) layer.on_mean[c] = mul_add(held, direction[c], layer.on_mean[c]);
  V cofactor[3][3];
  for (std::size_t r = 0; r < 3; ++r) {
    const std::size_t s = (r + 1) % 3, t = (r + 2) % 3;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t e = (c + 1) % 3, f = (c + 2) % 3;
      cofactor[r][c] = mul_sub(A[s][e], A[t][f], hn::Mul(A[s][f], A[t][e]));
    }
  }
  const V determinant =
      mul_add(A[0][0], cofactor[0][0], mul_add(A[0][1], cofactor[0][1], hn::Mul(A[0][2], cofactor[0][2])));
  const V ratio = hn::Mul(determinant, law.over_volume);
  const V dilatation = hn::Min(hn::Max(hn::Sub(ratio, one), hn::Set(d, min_dilatation)), hn::Set(d, max_dilatation));
  const V pressure = mul_sub(hn::Set(d, law.bulk_pa), dilatation, hn::Set(d, law.shear_pa));

  const V volume = hn::Set(d, element.volume_m3);
  const V stiffness = mul_add(hn::Set(d, element.hourglass_across), law.size.a,
                              hn::Mul(hn::Set(d, element.hourglass_along), law.size.c));
  if constexpr (energy) {
    // μ/2 (I₁ − 3) − μ(J − 1) without cancellation: with G = F − 1, μ(|G|²/2 − (J − 1 − tr G)).
    V G[3][3];
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c)
        G[r][c] = hn::Mul(state.gradient[r][c], c < 2 ? law.over_across : law.over_along);
    }
    const auto minor = [&](std::size_t i, std::size_t j)
                           HWY_ATTR { return mul_sub(G[i][i], G[j][j], hn::Mul(G[i][j], G[j][i])); };
    V square = hn::Zero(d), patterns = square;
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) square = mul_add(G[r][c], G[r][c], square);
      for (std::size_t m = 0; m < 4; ++m) patterns = mul_add(state.hourglass[r][m], state.hourglass[r][m], patterns);
    }
    const V third = mul_add(G[0][0], minor(1, 2),
                            mul_add(G[0][1], mul_sub(G[1][2], G[2][0], hn::Mul(G[1][0], G[2][2])),
                                    hn::Mul(G[0][2], mul_sub(G[1][0], G[2][1], hn::Mul(G[1][1], G[2][0])))));
    const V second = hn::Add(third, hn::Add(minor(0, 1), hn::Add(minor(0, 2), minor(1, 2))));
    const V shear = hn::Mul(hn::Set(d, law.shear_pa), mul_sub(hn::Set(d, 0.5F), square, second));
    // ∫ of the clamped dilatation.
    const V swelling = hn::Mul(hn::Set(d, law.bulk_pa),
                               hn::Mul(dilatation, neg_mul_add(hn::Set(d, 0.5F), dilatation, hn::Sub(ratio, one))));
    work = mul_add(hn::Add(shear, swelling), hn::Mul(volume, law.size.mass), work);
    const V stretch = hn::Sqrt(hn::Div(state.now2, state.rest2));
    work = mul_add(hn::Sub(fibre_energy(law, stretch, fibre_stress(law, stretch)), at_rest),
                   hn::Mul(law.size.mass, hn::Set(d, element.fibre_volume_m3)), work);
    work = mul_add(hn::Mul(hn::Set(d, 0.5F), stiffness), patterns, work);
  }

  const V swelling = hn::Mul(pressure, volume);
  const V shearing[2] = {hn::Mul(volume, law.shear_across), hn::Mul(volume, law.shear_along)};
  for (std::size_t r = 0; r < 3; ++r) {
    const V taut = hn::Mul(state.pull, state.along[r]);
    for (std::size_t c = 0; c < 3; ++c)
      state.gradient[r][c] =
          mul_add(swelling, cofactor[r][c], mul_add(shearing[c / 2], A[r][c], hn::Mul(taut, direction[c])));
  }
  state.stiffness = stiffness;
}

template <bool energy>
HWY_NOINLINE void stress_elements(const FiniteLaw& law, const FiniteKernelElement* element, std::uint32_t some,
                                  ElementState* state, FiniteLayer& layer, V at_rest, V& work) {
  for (std::uint32_t e = 0; e < some; ++e) stress_element<energy>(law, element[e], state[e], layer, at_rest, work);
}

/// Returns an element's forces as sums over its corners, N, one component.
HWY_INLINE CornerSums force_sums(const FiniteKernelElement& element, const ElementState& state, std::size_t r) {
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
  return {on_sum(0, none),
          on_sum(1, none),
          hn::Mul(hn::Set(d, element.along[4]), on[2]),
          on_sum(2, on_pattern[0]),
          on_sum(3, on_pattern[1]),
          mul_add(hn::Set(d, element.along[5]), on[2], on_pattern[2]),
          on_pattern[3]};
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
