// Let u = ψ·w + V·q, m = S²·l, VᵀM₁V = 1, K = Vᵀ(stiffness and foundation)V, k = Vᵀ(those)ψ and h = VᵀM₁ψ. Then
//   m·(q̈ + α·q̇) + m·h·(ẅ + α·ẇ) + K·q + k·w = loads.
// q + h·w is the motion of the mass. With K/m = E·Ω²·Eᵀ, z = Eᵀ·(q + h·w) follows
//   z̈ + α·ż + Ω²·z = Ω²·(P·w + …),   P = Eᵀh − Ω⁻²·Eᵀk/m,   P = Ω⁻²·Eᵀ(load per unit)/m of the others.
// At rest q = E·(z − Eᵀh·w) = −K⁻¹·k·w + K⁻¹·loads. Tuned bellies have the K of `tuned_activation`, except in w's
// static response, whose K and k have no tension. The force on a held far face at rest is ψᵀ(stiffness·u − loads):
// per metre ψᵀKψ − kᵀK⁻¹k, per load kᵀK⁻¹·VᵀL − ψᵀL.
#include "assets/reduction/modal_bellies.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include <algorithm>
#include <cmath>

#include "assets/reduction/double_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {
/// A symmetric matrix, its upper half, and its later eigenvectors, a row each.
struct Eigen {
  double *a, *e;
  std::size_t n;

  HWY_INLINE double* at(std::size_t i, std::size_t j) const {
    return a + (std::min(i, j) * n + std::max(i, j)) * width;
  }
  HWY_INLINE double* row(std::size_t motion, std::size_t i) const { return e + (motion * n + i) * width; }
};

struct Turn {
  std::size_t p, q;
  V c, s;
  bool any;
};

/// Makes a_pq vanish, lane by lane, and returns the rotation. Lanes where it has vanished do not change.
HWY_INLINE Turn turn_of(Eigen& x, std::size_t p, std::size_t q) {
  const V app = load(x.at(p, p)), aqq = load(x.at(q, q)), apq = load(x.at(p, q));
  const auto active = dn::Gt(mul(apq, apq), mul(all(1e-22), dn::Abs(mul(app, aqq))));
  Turn turn{p, q, all(1), all(0), !dn::AllFalse(Tag{}, active)};
  if (!turn.any) return turn;
  const V apart = sub(aqq, app), twice = add(apq, apq);
  const V root = dn::Sqrt(add(mul(apart, apart), mul(twice, twice)));
  const V t = dn::IfThenElseZero(active, dn::Div(twice, add(apart, dn::CopySign(root, apart))));
  turn.c = dn::Div(all(1), dn::Sqrt(add(all(1), mul(t, t))));
  turn.s = mul(t, turn.c);
  store(sub(app, mul(t, apq)), x.at(p, p));
  store(add(aqq, mul(t, apq)), x.at(q, q));
  store(dn::IfThenZeroElse(active, apq), x.at(p, q));
  return turn;
}

HWY_INLINE void rotate(V& x, V& y, const Turn& turn) {
  const V before = x;
  x = sub(mul(turn.c, x), mul(turn.s, y));
  y = add(mul(turn.s, before), mul(turn.c, y));
}

HWY_INLINE void turn_between(Eigen& x, const Turn& one, const Turn& other) {
  double *const pr = x.at(one.p, other.p), *const ps = x.at(one.p, other.q);
  double *const qr = x.at(one.q, other.p), *const qs = x.at(one.q, other.q);
  V vpr = load(pr), vps = load(ps), vqr = load(qr), vqs = load(qs);
  if (one.any) {
    rotate(vpr, vqr, one);
    rotate(vps, vqs, one);
  }
  if (other.any) {
    rotate(vpr, vps, other);
    rotate(vqr, vqs, other);
  }
  store(vpr, pr);
  store(vps, ps);
  store(vqr, qr);
  store(vqs, qs);
}

/// Diagonalises n rows, n even, in rounds of a tournament, in each of which every row meets another.
void diagonalise(Eigen& x, std::size_t n) {
  constexpr int max_sweeps = 30;
  std::size_t seat[most];
  for (std::size_t i = 0; i < n; ++i) seat[i] = i;
  bool changed = true;
  for (int sweep = 0; sweep < max_sweeps && changed; ++sweep) {
    changed = false;
    for (std::size_t round = 0; round + 1 < n; ++round) {
      Turn turn[most / 2];
      bool any = false;
      for (std::size_t i = 0; i < n / 2; ++i) {
        turn[i] = turn_of(x, std::min(seat[i], seat[n - 1 - i]), std::max(seat[i], seat[n - 1 - i]));
        any = any || turn[i].any;
      }
      std::rotate(seat + 1, seat + n - 1, seat + n);
      if (!any) continue;
      changed = true;
      for (std::size_t i = 0; i < n / 2; ++i) {
        for (std::size_t j = i + 1; j < n / 2; ++j) {
          if (turn[i].any || turn[j].any) turn_between(x, turn[i], turn[j]);
        }
        if (!turn[i].any) continue;
        for (std::size_t k = 0; k < n; ++k) {
          double *const ep = x.row(turn[i].p, k), *const eq = x.row(turn[i].q, k);
          V vp = load(ep), vq = load(eq);
          rotate(vp, vq, turn[i]);
          store(vp, ep);
          store(vq, eq);
        }
      }
    }
  }
}

void sort(Eigen& x, std::size_t n) {
  for (std::size_t done = 0; done + 1 < n; ++done) {
    for (std::size_t j = 0; j + 1 < n - done; ++j) {
      const auto swap = [&](double* low, double* high, auto mask) HWY_ATTR {
        const V l = load(low), h = load(high);
        store(dn::IfThenElse(mask, h, l), low);
        store(dn::IfThenElse(mask, l, h), high);
      };
      const auto wrong = dn::Gt(load(x.at(j, j)), load(x.at(j + 1, j + 1)));
      if (dn::AllFalse(Tag{}, wrong)) continue;
      swap(x.at(j, j), x.at(j + 1, j + 1), wrong);
      for (std::size_t i = 0; i < n; ++i) swap(x.row(j, i), x.row(j + 1, i), wrong);
    }
  }
}

/// rhs ← K⁻¹·rhs by Cholesky. K's lower half is row by row in `k`, which is overwritten.
void solve_in_place(double* k, std::size_t n, V* rhs) {
  const auto at = [&](std::size_t i, std::size_t j) { return k + (i * n + j) * width; };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      V sum = load(at(i, j));
      for (std::size_t c = 0; c < j; ++c) sum = sub(sum, mul(load(at(i, c)), load(at(j, c))));
      store(i == j ? dn::Sqrt(sum) : dn::Div(sum, load(at(j, j))), at(i, j));
    }
    for (std::size_t c = 0; c < i; ++c) rhs[i] = sub(rhs[i], mul(load(at(i, c)), rhs[c]));
    rhs[i] = dn::Div(rhs[i], load(at(i, i)));
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t c = i + 1; c < n; ++c) rhs[i] = sub(rhs[i], mul(load(at(c, i)), rhs[c]));
    rhs[i] = dn::Div(rhs[i], load(at(i, i)));
  }
}

void solve_some(const ModalBasis& basis, V across, V along, std::size_t lane, ModalBellies& to) {
  const std::size_t n = basis.modes, even = n + n % 2;
  const bool held = !basis.lift_mass.empty(), braced = !basis.foundation.empty(), framed = !basis.frame.empty();
  const std::size_t inputs = basis.inputs, ends = inputs - (framed ? frame_inputs : 0);
  const V size = mul(across, along), ratio = dn::Div(across, along), mass = mul(across, size);
  const V a = dn::Div(all(1), mul(ratio, size)), b = dn::Div(all(1), size), c = dn::Div(ratio, size);
  const V brace = all(basis.foundation_1_s2);

  const ModalBasis::Turned& turned = basis.turned;
  const bool warm = !turned.vector.empty();
  const double* const pa = warm ? turned.a.data() : basis.a.data();
  const double* const pb = warm ? turned.b.data() : basis.b.data();
  const double* const pc = warm ? turned.c.data() : basis.c.data();
  const double* const pf = warm ? turned.foundation.data() : basis.foundation.data();
  const double* const pt = warm ? turned.tension.data() : basis.tension.data();
  const V slender = dn::Div(all(1), mul(along, along)), tone = mul(all(tuned_activation), slender);
  to.scratch.resize(3 * even * even);
  Eigen x{to.scratch[0].lane, to.scratch[even * even].lane, even};
  for (std::size_t i = 0; i < even; ++i) {
    for (std::size_t j = i; j < even; ++j) {
      V k = all(i == j ? 1 : 0);  // of the row that makes them even
      if (j < n) {
        const std::size_t at = i * n + j;
        k = add(add(mul(a, all(pa[at])), mul(b, all(pb[at]))), mul(c, all(pc[at])));
        if (braced) k = add(k, mul(brace, all(pf[at])));
        if (to.tuned) k = add(k, mul(tone, all(pt[at])));
      }
      store(k, x.at(i, j));
    }
    for (std::size_t j = 0; j < even; ++j) {
      const bool inside = warm && i < n && j < n;
      store(all(inside ? turned.vector[i * n + j] : i == j ? 1 : 0), x.row(i, j));
    }
  }
  diagonalise(x, even);
  sort(x, n);

  V pull[most], energy = all(0), kinetic = all(basis.lift_kinetic), reaction[3 + frame_inputs];
  if (held) {
    for (std::size_t i = 0; i < n; ++i) {
      pull[i] = add(add(mul(a, all(basis.lift_a[i])), mul(b, all(basis.lift_b[i]))), mul(c, all(basis.lift_c[i])));
      if (braced) pull[i] = add(pull[i], mul(brace, all(basis.lift_foundation[i])));
    }
    energy = add(add(mul(a, all(basis.lift_energy_a)), mul(b, all(basis.lift_energy_b))),
                 add(mul(c, all(basis.lift_energy_c)), mul(brace, all(basis.lift_energy_foundation))));
  }
  V answer[most];  // K⁻¹·k of tuned bellies
  if (to.tuned && held) {
    double* const factor = to.scratch[2 * even * even].lane;
    for (std::size_t i = 0; i < n; ++i) {
      answer[i] = pull[i];
      for (std::size_t j = 0; j <= i; ++j) {
        const std::size_t at = i * n + j;
        V k = add(add(mul(a, all(basis.a[at])), mul(b, all(basis.b[at]))), mul(c, all(basis.c[at])));
        if (braced) k = add(k, mul(brace, all(basis.foundation[at])));
        store(k, factor + at * width);
      }
    }
    solve_in_place(factor, n, answer);
    for (std::size_t i = 0; i < n; ++i) energy = sub(energy, mul(pull[i], answer[i]));
  }
  for (std::size_t k = 0; k < inputs; ++k) reaction[k] = all(0);
  V field[frame_inputs];  // factor of a body's size on each number's field
  for (std::size_t k = 0; k < frame_inputs; ++k) field[k] = k < 3 ? all(1) : k % 3 == 2 ? along : across;
  for (std::size_t j = 0; j < n; ++j) {
    const V value = load(x.at(j, j));
    store(dn::Sqrt(value), &to.omega_1_s(j).lane[lane]);
    V share = all(0), tied = all(0), moved = all(0), taut = all(0), p[3 + frame_inputs];
    for (std::size_t k = 0; k < inputs; ++k) p[k] = all(0);
    for (std::size_t i = 0; i < n; ++i) {
      const V e = load(x.row(j, i));
      store(e, &to.eigenvector(j, i).lane[lane]);
      if (held) {
        share = add(share, mul(e, all(basis.lift_mass[i])));
        tied = add(tied, mul(e, pull[i]));
        if (to.tuned) moved = add(moved, mul(e, answer[i]));
      } else {
        for (std::size_t k = 0; k < ends; ++k) p[k] = add(p[k], mul(e, all(basis.traction[i * ends + k])));
      }
      for (std::size_t k = ends; k < inputs; ++k) {
        p[k] = add(p[k], mul(e, all(basis.frame[i * frame_inputs + k - ends])));
      }
    }
    for (std::size_t i = 0; to.tuned && i < n; ++i) {
      V along_row = all(0);
      for (std::size_t k = 0; k < n; ++k)
        along_row = add(along_row, mul(load(x.row(j, k)), all(basis.tension[i * n + k])));
      taut = add(taut, mul(load(x.row(j, i)), along_row));
    }
    // The remainder of a coarse mesh's tension can be negative after its error is extrapolated.
    const V least = mul(value, all((min_taut_stiffness - 1) / (1 - tuned_activation)));
    store(dn::Max(mul(taut, slender), least), &to.tension_1_s2(j).lane[lane]);
    store(share, &to.lift_share(j).lane[lane]);
    if (held) {
      if (!to.tuned) moved = dn::Div(tied, value);
      p[0] = sub(share, moved);
      kinetic = sub(kinetic, mul(share, share));
      if (!to.tuned) energy = sub(energy, dn::Div(mul(tied, tied), value));
    } else {
      for (std::size_t k = 0; k < ends; ++k) p[k] = dn::Div(p[k], mul(mass, value));
    }
    for (std::size_t k = ends; k < inputs; ++k) {
      p[k] = mul(p[k], dn::Div(field[k - ends], value));
      if (held) reaction[k] = add(reaction[k], mul(mul(mass, tied), p[k]));
    }
    for (std::size_t k = 0; k < inputs; ++k) store(p[k], &to.participation(j, k).lane[lane]);
  }
  store(held ? mul(mass, kinetic) : all(0), &to.lift_mass_kg().lane[lane]);
  if (held) {
    reaction[0] = mul(mass, energy);
    for (std::size_t k = ends; k < inputs; ++k) {
      reaction[k] = sub(reaction[k], mul(mul(mass, field[k - ends]), all(basis.lift_frame[k - ends])));
    }
  }
  for (std::size_t k = 0; k < inputs; ++k) store(reaction[k], &to.reaction(k).lane[lane]);
}

void solve_all(const ModalBasis& basis, const Lanes<double>& across, const Lanes<double>& along, std::size_t count,
               ModalBellies& bellies) {
  for (std::size_t lane = 0; lane < count; lane += width) {
    solve_some(basis, load(&across.lane[lane]), load(&along.lane[lane]), lane, bellies);
  }
}

}  // namespace
}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <fmt/format.h>

namespace mobil::inline v0_3 {
namespace {

HWY_EXPORT(solve_all);

}  // namespace

Result<void> solve_bellies(const ModalBasis& basis, std::span<const BellyScale<double>> bodies, ModalBellies& bellies) {
  constexpr double rounding = 1e-5;
  Lanes<double> across, along;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const BellyScale<double>& of = bodies[lane < bodies.size() ? lane : 0];
    across[lane] = of.across;
    along[lane] = of.along;
    const double ratio = across[lane] / along[lane];
    if (!(across[lane] > 0 && along[lane] > 0 && ratio >= basis.lowest_ratio * (1 - rounding) &&
          ratio <= basis.highest_ratio * (1 + rounding))) {
      return fail(fmt::format("scales {:.4g} across and {:.4g} along: their ratio must lie between {:.4g} and {:.4g}",
                              across[lane], along[lane], basis.lowest_ratio, basis.highest_ratio));
    }
  }
  bellies.resize(basis.modes, basis.inputs);
  bellies.count = static_cast<std::uint32_t>(bodies.size());
  HWY_DYNAMIC_DISPATCH(solve_all)(basis, across, along, bodies.size(), bellies);
  for (std::size_t lane = 0; lane < bodies.size(); ++lane) {
    if (bellies.omega_1_s(0)[lane] > 0 && std::isfinite(bellies.participation(0, 0)[lane])) continue;
    return fail(fmt::format("{} modes of a mesh of {}x{}x{} cells are too many for a stiffness above 0{}; take fewer",
                            basis.modes, basis.cells[0], basis.cells[1], basis.cells[2],
                            basis.options.corrected ? " with the mesh's error extrapolated away" : ""));
  }
  return {};
}

Result<void> solve_bellies(const ModalBasis& basis, std::span<const BellyScale<float>> bodies, ModalBellies& bellies) {
  BellyScale<double> wide[lane_count];
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    wide[i] = {static_cast<double>(bodies[i].across), static_cast<double>(bodies[i].along)};
  }
  return solve_bellies(basis, {wide, bodies.size()}, bellies);
}

ModalBelly belly_of(const ModalBellies& bellies, std::size_t lane) {
  ModalBelly one;
  one.modes = bellies.modes;
  one.inputs = bellies.inputs;
  one.tuned = bellies.tuned;
  for (std::size_t j = 0; j < one.modes; ++j) {
    one.omega_1_s[j] = bellies.omega_1_s(j)[lane];
    one.lift_share[j] = bellies.lift_share(j)[lane];
    one.tension_1_s2[j] = bellies.tension_1_s2(j)[lane];
    for (std::size_t i = 0; i < one.modes; ++i) one.eigenvector[i][j] = bellies.eigenvector(j, i)[lane];
    for (std::size_t k = 0; k < one.inputs; ++k) one.participation[j][k] = bellies.participation(j, k)[lane];
  }
  for (std::size_t k = 0; k < one.inputs; ++k) one.reaction[k] = bellies.reaction(k)[lane];
  one.lift_mass_kg = bellies.lift_mass_kg()[lane];
  return one;
}

}  // namespace mobil::inline v0_3
#endif
