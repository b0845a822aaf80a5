// Runge–Kutta steps and Newton shooting in sixteen lanes. Include it as engine/wide-inl.h says.

#if defined(MOBIL_SYSTEMS_GAIT_SHOOT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_GAIT_SHOOT_INL_H_
#undef MOBIL_SYSTEMS_GAIT_SHOOT_INL_H_
#else
#define MOBIL_SYSTEMS_GAIT_SHOOT_INL_H_
#endif

#include "engine/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {

/// One fourth-order Runge–Kutta step of `h` seconds of N coordinates `q` with their `rate`;
/// `acceleration(half, state, out)` gives q̈ at half steps counted from the start.
template <std::size_t N, class State, class Acceleration>
HWY_INLINE void runge_kutta(State& s, const Wide& h, std::size_t half, Acceleration acceleration) {
  Wide sum_rate[N], sum[N], a[N];
  const Wide half_h = 0.5F * h;
  State at = s;
  acceleration(half, at, a);
  for (std::size_t i = 0; i < N; ++i) {
    sum_rate[i] = s.rate[i];
    sum[i] = a[i];
  }
  for (int stage = 0; stage < 2; ++stage) {
    for (std::size_t i = 0; i < N; ++i) {
      at.q[i] = fma(half_h, at.rate[i], s.q[i]);
      at.rate[i] = fma(half_h, a[i], s.rate[i]);
    }
    acceleration(half + 1, at, a);
    for (std::size_t i = 0; i < N; ++i) {
      sum_rate[i] = fma(wide(2.0F), at.rate[i], sum_rate[i]);
      sum[i] = fma(wide(2.0F), a[i], sum[i]);
    }
  }
  for (std::size_t i = 0; i < N; ++i) {
    at.q[i] = fma(h, at.rate[i], s.q[i]);
    at.rate[i] = fma(h, a[i], s.rate[i]);
  }
  acceleration(half + 2, at, a);
  const Wide sixth = h / 6.0F;
  for (std::size_t i = 0; i < N; ++i) {
    s.q[i] = fma(sixth, sum_rate[i] + at.rate[i], s.q[i]);
    s.rate[i] = fma(sixth, sum[i] + a[i], s.rate[i]);
  }
}

/// N linear equations per lane, by elimination with pivoting within each lane; lanes whose matrix is singular get 0.
template <std::size_t N>
struct Elimination {
  Wide a[N][N];  // upper triangle, and below it the factors
  WideMask swap[N][N];

  HWY_NOINLINE void factor() {
    for (std::size_t k = 0; k < N; ++k) {
      for (std::size_t i = k + 1; i < N; ++i) {
        swap[k][i] = abs(a[i][k]) > abs(a[k][k]);
        for (std::size_t j = 0; j < N; ++j) exchange(swap[k][i], a[k][j], a[i][j]);
      }
      const WideMask sound = abs(a[k][k]) > 1e-12F;
      a[k][k] = select(sound, 1.0F / select(sound, a[k][k], wide(1.0F)), wide(0.0F));
      for (std::size_t i = k + 1; i < N; ++i) {
        a[i][k] = a[i][k] * a[k][k];
        for (std::size_t j = k + 1; j < N; ++j) a[i][j] = fnma(a[i][k], a[k][j], a[i][j]);
      }
    }
  }

  HWY_NOINLINE void solve(Wide (&b)[N]) const {
    for (std::size_t k = 0; k < N; ++k) {
      for (std::size_t i = k + 1; i < N; ++i) exchange(swap[k][i], b[k], b[i]);
    }
    for (std::size_t k = 0; k < N; ++k) {
      for (std::size_t i = k + 1; i < N; ++i) b[i] = fnma(a[i][k], b[k], b[i]);
    }
    for (std::size_t k = N; k-- > 0;) {
      for (std::size_t j = k + 1; j < N; ++j) b[k] = fnma(a[k][j], b[j], b[k]);
      b[k] = b[k] * a[k][k];
    }
  }

 private:
  static HWY_INLINE void exchange(const WideMask& where, Wide& x, Wide& y) {
    const Wide kept = x;
    x = select(where, y, x);
    y = select(where, kept, y);
  }
};

/// Changes x so that run(x, end) ends at `wanted`, |x| ≤ most: a Newton step, its Jacobian by difference quotients over
/// 0.1, and `more` with the same Jacobian.
template <std::size_t N, class Run>
HWY_INLINE void shoot(Run run, const Wide (&wanted)[N], float most, int more, Wide (&x)[N]) {
  constexpr float moved = 0.1F;
  Wide end[N];
  run(x, end);
  Elimination<N> jacobian;
  for (std::size_t j = 0; j < N; ++j) {
    const Wide kept = x[j];
    x[j] = x[j] + moved;
    Wide there[N];
    run(x, there);
    x[j] = kept;
    for (std::size_t i = 0; i < N; ++i) jacobian.a[i][j] = (there[i] - end[i]) * (1.0F / moved);
  }
  jacobian.factor();
  for (int iteration = 0; iteration <= more; ++iteration) {
    if (iteration > 0) run(x, end);
    Wide step[N];
    for (std::size_t i = 0; i < N; ++i) step[i] = wanted[i] - end[i];
    jacobian.solve(step);
    for (std::size_t i = 0; i < N; ++i) x[i] = clamp(x[i] + step[i], -most, most);
  }
}

}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
