// Linear equations in sixteen lanes. See engine/wide-inl.h for how to include it.

#if defined(MOBIL_SYSTEMS_GAIT_ELIMINATION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_GAIT_ELIMINATION_INL_H_
#undef MOBIL_SYSTEMS_GAIT_ELIMINATION_INL_H_
#else
#define MOBIL_SYSTEMS_GAIT_ELIMINATION_INL_H_
#endif

#include "engine/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

/// N linear equations per lane, solved by elimination with pivoting in each lane. Lanes with a singular matrix get 0.
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

/// Least-squares solution of any number of equations for N numbers per lane.
template <std::size_t N>
struct LeastSquares {
  Elimination<N> normal;
  Wide sum[N];

  /// `held` is the strength with which each number is held at 0.
  HWY_NOINLINE explicit LeastSquares(const float (&held)[N]) {
    for (std::size_t k = 0; k < N; ++k) {
      sum[k] = wide(0.0F);
      for (std::size_t j = 0; j < N; ++j) normal.a[k][j] = wide(k == j ? held[k] : 0.0F);
    }
  }
  /// Adds the equation row · numbers = value.
  HWY_NOINLINE void ask(const Wide (&row)[N], const Wide& value) {
    for (std::size_t k = 0; k < N; ++k) {
      sum[k] = fma(row[k], value, sum[k]);
      for (std::size_t j = 0; j < N; ++j) normal.a[k][j] = fma(row[k], row[j], normal.a[k][j]);
    }
  }
  /// Writes the numbers to `sum`.
  HWY_NOINLINE void solve() {
    normal.factor();
    normal.solve(sum);
  }
};

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
