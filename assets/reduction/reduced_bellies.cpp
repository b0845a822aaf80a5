// With u = ψ·w + V·q, m = S²·l, VᵀM₁V = 1, K = Vᵀ(stiffness and foundation)V, k = Vᵀ(those)ψ and h = VᵀM₁ψ:
//   m·(q̈ + α·q̇) + m·h·(ẅ + α·ẇ) + K·q + k·w = loads.
// q + h·w is what the mass sees move. K/m = E·Ω²·Eᵀ makes of z = Eᵀ·(q + h·w)
//   z̈ + α·ż + Ω²·z = Ω²·(P·w + …),   P = Eᵀh − Ω⁻²·Eᵀk/m,   P = Ω⁻²·Eᵀ(load per unit)/m of the others,
// so that at rest q = E·(z − Eᵀh·w) = −K⁻¹·k·w + K⁻¹·loads. The force on a held far face at rest is ψᵀ(stiffness·u −
// loads): per metre ψᵀKψ − kᵀK⁻¹k, per load kᵀK⁻¹·VᵀL − ψᵀL.
#include "assets/reduction/reduced_bellies.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "assets/reduction/reduced_bellies.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// Multiplications and additions are never fused here: the same bits with and without that instruction.
using Tag = hn::CappedTag<double, 8>;
using V = hn::Vec<Tag>;
constexpr std::size_t width = hn::MaxLanes(Tag{});
constexpr std::size_t most = most_vectors;

HWY_INLINE V all(double x) {
  return hn::Set(Tag{}, x);
}
HWY_INLINE V load(const double* p) {
  return hn::Load(Tag{}, p);
}
HWY_INLINE void store(V v, double* p) {
  hn::Store(v, Tag{}, p);
}
HWY_INLINE V mul(V a, V b) {
  return hn::Mul(a, b);
}
HWY_INLINE V add(V a, V b) {
  return hn::Add(a, b);
}
HWY_INLINE V sub(V a, V b) {
  return hn::Sub(a, b);
}

/// A symmetric matrix, its upper half, and its eigenvectors to be, a row each.
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

/// Half an element below zero, lane by lane: what makes a_pq vanish. Lanes where it has vanished stay as they are.
HWY_INLINE Turn turn_of(Eigen& x, std::size_t p, std::size_t q) {
  const V app = load(x.at(p, p)), aqq = load(x.at(q, q)), apq = load(x.at(p, q));
  const auto active = hn::Gt(mul(apq, apq), mul(all(1e-22), hn::Abs(mul(app, aqq))));
  Turn turn{p, q, all(1), all(0), !hn::AllFalse(Tag{}, active)};
  if (!turn.any) return turn;
  const V apart = sub(aqq, app), twice = add(apq, apq);
  const V root = hn::Sqrt(add(mul(apart, apart), mul(twice, twice)));
  const V t = hn::IfThenElseZero(active, hn::Div(twice, add(apart, hn::CopySign(root, apart))));
  turn.c = hn::Div(all(1), hn::Sqrt(add(all(1), mul(t, t))));
  turn.s = mul(t, turn.c);
  store(sub(app, mul(t, apq)), x.at(p, p));
  store(add(aqq, mul(t, apq)), x.at(q, q));
  store(hn::IfThenZeroElse(active, apq), x.at(p, q));
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

/// Of n rows, n even: rounds of a tournament, in each of which every row meets another.
void diagonalise(Eigen& x, std::size_t n) {
  constexpr int most_sweeps = 30;
  std::size_t seat[most];
  for (std::size_t i = 0; i < n; ++i) seat[i] = i;
  bool changed = true;
  for (int sweep = 0; sweep < most_sweeps && changed; ++sweep) {
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
        store(hn::IfThenElse(mask, h, l), low);
        store(hn::IfThenElse(mask, l, h), high);
      };
      const auto wrong = hn::Gt(load(x.at(j, j)), load(x.at(j + 1, j + 1)));
      if (hn::AllFalse(Tag{}, wrong)) continue;
      swap(x.at(j, j), x.at(j + 1, j + 1), wrong);
      for (std::size_t i = 0; i < n; ++i) swap(x.row(j, i), x.row(j + 1, i), wrong);
    }
  }
}

void solve_some(const ReducedBasis& basis, V across, V along, std::size_t lane, ReducedBellies& to) {
  const std::size_t n = basis.vectors, even = n + n % 2;
  const bool held = !basis.lift_mass.empty(), braced = !basis.foundation.empty(), framed = !basis.frame.empty();
  const std::size_t inputs = basis.inputs, ends = inputs - (framed ? frame_inputs : 0);
  const V size = mul(across, along), ratio = hn::Div(across, along), mass = mul(across, size);
  const V a = hn::Div(all(1), mul(ratio, size)), b = hn::Div(all(1), size), c = hn::Div(ratio, size);
  const V brace = all(basis.foundation_1_s2);

  const ReducedBasis::Turned& turned = basis.turned;
  const bool warm = !turned.vector.empty();
  const double* const pa = warm ? turned.a.data() : basis.a.data();
  const double* const pb = warm ? turned.b.data() : basis.b.data();
  const double* const pc = warm ? turned.c.data() : basis.c.data();
  const double* const pf = warm ? turned.foundation.data() : basis.foundation.data();
  to.scratch.resize(2 * even * even);
  Eigen x{to.scratch[0].lane, to.scratch[even * even].lane, even};
  for (std::size_t i = 0; i < even; ++i) {
    for (std::size_t j = i; j < even; ++j) {
      V k = all(i == j ? 1 : 0);  // of the row that makes them even
      if (j < n) {
        const std::size_t at = i * n + j;
        k = add(add(mul(a, all(pa[at])), mul(b, all(pb[at]))), mul(c, all(pc[at])));
        if (braced) k = add(k, mul(brace, all(pf[at])));
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
  for (std::size_t k = 0; k < inputs; ++k) reaction[k] = all(0);
  V field[frame_inputs];  // what a body's size does to the field that each number stands for
  for (std::size_t k = 0; k < frame_inputs; ++k) field[k] = k < 3 ? all(1) : k % 3 == 2 ? along : across;
  for (std::size_t j = 0; j < n; ++j) {
    const V value = load(x.at(j, j));
    store(hn::Sqrt(value), &to.omega_1_s(j).lane[lane]);
    V share = all(0), tied = all(0), p[3 + frame_inputs];
    for (std::size_t k = 0; k < inputs; ++k) p[k] = all(0);
    for (std::size_t i = 0; i < n; ++i) {
      const V e = load(x.row(j, i));
      store(e, &to.eigenvector(j, i).lane[lane]);
      if (held) {
        share = add(share, mul(e, all(basis.lift_mass[i])));
        tied = add(tied, mul(e, pull[i]));
      } else {
        for (std::size_t k = 0; k < ends; ++k) p[k] = add(p[k], mul(e, all(basis.traction[i * ends + k])));
      }
      for (std::size_t k = ends; k < inputs; ++k) {
        p[k] = add(p[k], mul(e, all(basis.frame[i * frame_inputs + k - ends])));
      }
    }
    store(share, &to.lift_share(j).lane[lane]);
    if (held) {
      p[0] = sub(share, hn::Div(tied, value));
      kinetic = sub(kinetic, mul(share, share));
      energy = sub(energy, hn::Div(mul(tied, tied), value));
    } else {
      for (std::size_t k = 0; k < ends; ++k) p[k] = hn::Div(p[k], mul(mass, value));
    }
    for (std::size_t k = ends; k < inputs; ++k) {
      p[k] = mul(p[k], hn::Div(field[k - ends], value));
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

/// Sine and cosine of 0 ≤ x < 1e6 to some 1e-15: π/2 in three parts, Taylor's series.
HWY_INLINE void sin_cos(V x, V& sine, V& cosine) {
  const V quadrant = hn::Floor(add(mul(x, all(0.6366197723675814)), all(0.5)));
  V r = sub(x, mul(quadrant, all(0x1.921fb54400000p+0)));
  r = sub(r, mul(quadrant, all(0x1.0b4611a600000p-34)));
  r = sub(r, mul(quadrant, all(0x1.3198a2e037073p-69)));
  const V square = mul(r, r);
  V s = all(0), c = all(0);
  double factorial = 355687428096000.0;  // 17!
  for (int k = 17; k > 1; k -= 2) {      // down to 3! and 2!
    s = sub(all(1 / factorial), mul(square, s));
    factorial /= k;
    c = sub(all(1 / factorial), mul(square, c));
    factorial /= k - 1;
  }
  s = sub(r, mul(mul(r, square), s));
  c = sub(all(1), mul(square, c));
  const V turn = sub(quadrant, mul(all(4), hn::Floor(mul(quadrant, all(0.25)))));
  const auto odd = hn::Or(hn::Eq(turn, all(1)), hn::Eq(turn, all(3)));
  const V s0 = hn::IfThenElse(odd, c, s), c0 = hn::IfThenElse(odd, s, c);
  sine = hn::IfThenElse(hn::Ge(turn, all(2)), hn::Neg(s0), s0);
  cosine = hn::IfThenElse(hn::Or(hn::Eq(turn, all(1)), hn::Eq(turn, all(2))), hn::Neg(c0), c0);
}

HWY_INLINE void store_floats(V v, float* to) {
  const hn::Rebind<float, Tag> floats;
  hn::StoreU(hn::DemoteTo(floats, v), floats, to);
}

/// Of motions that swing; the others are made over again.
void swings(const ReducedBellies& bellies, double half, double tick_s, double decay, std::size_t stride,
            float* motion) {
  for (std::size_t j = 0; j < bellies.vectors; ++j) {
    float* const to = motion + j * stride * lane_count;
    for (std::size_t lane = 0; lane < bellies.count; lane += width) {
      const V omega = load(&bellies.omega_1_s(j).lane[lane]);
      const V square = hn::Max(sub(mul(omega, omega), all(half * half)), all(0)), swing = hn::Sqrt(square);
      const V angle = mul(swing, all(tick_s));
      V sine, cosine;
      sin_cos(angle, sine, cosine);
      sine = hn::IfThenElse(hn::Gt(angle, all(1e-8)), hn::Div(sine, swing), all(tick_s));
      sine = mul(all(decay), sine);
      cosine = mul(all(decay), cosine);
      store_floats(add(cosine, mul(all(half), sine)), to + lane);
      store_floats(mul(omega, sine), to + lane_count + lane);
      store_floats(hn::Div(all(2 * half), omega), to + 2 * lane_count + lane);
    }
  }
}

void shapes(const ReducedBellies& of, double damping_per_s, float* to) {
  const std::size_t n = of.vectors, inputs = of.inputs;
  const auto put = [&to](V v, std::size_t lane) HWY_ATTR { store_floats(v, to + lane); };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j, to += lane_count) {
      for (std::size_t l = 0; l < of.count; l += width) {
        const V unit = inputs == 1 ? load(&of.participation(j, 0).lane[l]) : all(1);
        put(mul(load(&of.eigenvector(j, i).lane[l]), hn::Div(unit, load(&of.omega_1_s(j).lane[l]))), l);
      }
    }
    for (std::size_t k = 0; k < inputs; ++k, to += lane_count) {
      for (std::size_t l = 0; l < of.count; l += width) {
        V rest = all(0);
        for (std::size_t j = 0; j < n; ++j) {
          V p = load(&of.participation(j, k).lane[l]);
          if (k == 0) p = sub(p, load(&of.lift_share(j).lane[l]));
          rest = add(rest, mul(load(&of.eigenvector(j, i).lane[l]), p));
        }
        put(rest, l);
      }
    }
  }
  const auto copy = [&](const Lanes<double>& from, double by) HWY_ATTR {
    for (std::size_t l = 0; l < of.count; l += width) put(mul(load(&from.lane[l]), all(by)), l);
    to += lane_count;
  };
  for (std::size_t j = 0; j < n; ++j) copy(of.omega_1_s(j), 1);
  for (std::size_t j = 0; j < n; ++j) copy(of.participation(j, 0), 1);
  for (std::size_t k = 0; k < inputs; ++k) copy(of.reaction(k), 1);
  copy(of.lift_mass_kg(), damping_per_s);
}

void rest(const ReducedBasis& basis, const ReducedBellies& of, const Lanes<float>& input, float* to) {
  const std::size_t n = of.vectors, rows = 3 * basis.control_weight.size();
  for (std::size_t l = 0; l < of.count; l += width) {
    alignas(64) double driven[width];
    for (std::size_t i = 0; i < width; ++i) driven[i] = static_cast<double>(input[l + i]);
    const V w = load(driven);
    V q[most];
    for (std::size_t i = 0; i < n; ++i) {
      q[i] = all(0);
      for (std::size_t j = 0; j < n; ++j) {
        const V p = sub(load(&of.participation(j, 0).lane[l]), load(&of.lift_share(j).lane[l]));
        q[i] = add(q[i], mul(load(&of.eigenvector(j, i).lane[l]), p));
      }
      q[i] = mul(q[i], w);
    }
    const float* shape = basis.shape.data();
    for (std::size_t row = 0; row < rows; ++row, shape += n + 1) {
      V sum = mul(all(static_cast<double>(shape[0])), w);
      for (std::size_t i = 0; i < n; ++i) sum = add(sum, mul(all(static_cast<double>(shape[i + 1])), q[i]));
      store_floats(sum, to + row * lane_count + l);
    }
  }
}

void solve_all(const ReducedBasis& basis, const Lanes<double>& across, const Lanes<double>& along, std::size_t count,
               ReducedBellies& bellies) {
  for (std::size_t lane = 0; lane < count; lane += width) {
    solve_some(basis, load(&across.lane[lane]), load(&along.lane[lane]), lane, bellies);
  }
}

}  // namespace
}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <fmt/format.h>

namespace mobil {
namespace {

HWY_EXPORT(solve_all);
HWY_EXPORT(swings);
HWY_EXPORT(shapes);
HWY_EXPORT(rest);

/// A float's upper sixteen bits, rounded to the nearest: eight digits.
std::uint32_t upper_half(double x) {
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(x));
  return (bits + 0x7FFFU + (bits >> 16 & 1U)) >> 16;
}

/// Of a motion that creeps home: a and b.
void creep(double omega, double half, double tick_s, float& a, float& b) {
  const double apart = std::sqrt(half * half - omega * omega);
  const double slow = std::exp(-omega * omega / (half + apart) * tick_s);
  const double fast = std::expm1(-2 * apart * tick_s);  // of the slow one, less 1
  const double cosine = slow * (1 + fast / 2), sine = slow * (apart * tick_s > 1e-8 ? -fast / (2 * apart) : tick_s);
  a = static_cast<float>(cosine + half * sine);
  b = static_cast<float>(omega * sine);
}

}  // namespace

Result<void> solve_bellies(const ReducedBasis& basis, std::span<const BellyScale<double>> bodies,
                           ReducedBellies& bellies) {
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
  bellies.resize(basis.vectors, basis.inputs);
  bellies.count = static_cast<std::uint32_t>(bodies.size());
  HWY_DYNAMIC_DISPATCH(solve_all)(basis, across, along, bodies.size(), bellies);
  for (std::size_t lane = 0; lane < bodies.size(); ++lane) {
    if (bellies.omega_1_s(0)[lane] > 0) continue;
    return fail(fmt::format("{} vectors of a mesh of {}x{}x{} cells are too many for a stiffness above 0{}; take fewer",
                            basis.vectors, basis.cells[0], basis.cells[1], basis.cells[2],
                            basis.options.corrected ? " with the mesh's error extrapolated away" : ""));
  }
  return {};
}

Result<void> solve_bellies(const ReducedBasis& basis, std::span<const BellyScale<float>> bodies,
                           ReducedBellies& bellies) {
  BellyScale<double> wide[lane_count];
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    wide[i] = {static_cast<double>(bodies[i].across), static_cast<double>(bodies[i].along)};
  }
  return solve_bellies(basis, {wide, bodies.size()}, bellies);
}

ReducedBelly belly_of(const ReducedBellies& bellies, std::size_t lane) {
  ReducedBelly one;
  one.vectors = bellies.vectors;
  one.inputs = bellies.inputs;
  for (std::size_t j = 0; j < one.vectors; ++j) {
    one.omega_1_s[j] = bellies.omega_1_s(j)[lane];
    one.lift_share[j] = bellies.lift_share(j)[lane];
    for (std::size_t i = 0; i < one.vectors; ++i) one.eigenvector[i][j] = bellies.eigenvector(j, i)[lane];
    for (std::size_t k = 0; k < one.inputs; ++k) one.participation[j][k] = bellies.participation(j, k)[lane];
  }
  for (std::size_t k = 0; k < one.inputs; ++k) one.reaction[k] = bellies.reaction(k)[lane];
  one.lift_mass_kg = bellies.lift_mass_kg()[lane];
  return one;
}

void write_motions(const ReducedBellies& bellies, double damping_per_s, double tick_s, float* motion) {
  const std::size_t inputs = bellies.inputs;
  const std::size_t stride = reduced_motion_width(bellies.vectors, inputs == 1 ? 1 : bellies.inputs) / bellies.vectors;
  const double half = damping_per_s / 2;
  HWY_DYNAMIC_DISPATCH(swings)(bellies, half, tick_s, std::exp(-half * tick_s), stride, motion);
  const std::size_t ends = inputs > frame_inputs ? inputs - frame_inputs : inputs;
  for (std::size_t j = 0; j < bellies.vectors; ++j) {
    float* to = motion + j * stride * lane_count;
    for (std::size_t lane = 0; lane < bellies.count; ++lane) {
      float &a = to[lane], &b = to[lane_count + lane];
      const float g = to[2 * lane_count + lane];
      const double omega = bellies.omega_1_s(j)[lane];
      if (omega * omega < half * half) creep(omega, half, tick_s, a, b);
      // An undamped motion must not grow by how its numbers round.
      const auto growth = [g](double x, double y) { return x * (x - static_cast<double>(g) * y) + y * y; };
      while (growth(static_cast<double>(a), static_cast<double>(b)) > 1) {
        a = std::nextafter(a, 0.0F);
        b = std::nextafter(b, 0.0F);
      }
    }
    if (inputs == 1) continue;
    to += 3 * lane_count;
    for (std::size_t k = 0; k < ends; ++k, to += lane_count) {
      for (std::size_t lane = 0; lane < bellies.count; ++lane)
        to[lane] = static_cast<float>(bellies.participation(j, k)[lane]);
    }
    for (std::size_t k = ends; k < inputs; k += 2, to += lane_count) {
      for (std::size_t lane = 0; lane < bellies.count; ++lane) {
        to[lane] = std::bit_cast<float>(upper_half(bellies.participation(j, k + 1)[lane]) << 16 |
                                        upper_half(bellies.participation(j, k)[lane]));
      }
    }
  }
}

void write_shapes(const ReducedBellies& bellies, double damping_per_s, float* shape) {
  HWY_DYNAMIC_DISPATCH(shapes)(bellies, damping_per_s, shape);
}

void place_at_rest(const ReducedBasis& basis, const ReducedBellies& bellies, const Lanes<float>& input,
                   float* displacement) {
  HWY_DYNAMIC_DISPATCH(rest)(basis, bellies, input, displacement);
}

}  // namespace mobil
#endif
