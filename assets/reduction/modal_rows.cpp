#include "assets/reduction/modal_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include <bit>
#include <cmath>

#include "assets/reduction/double_lanes-inl.h"
#include "engine/exact_math.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {

/// Computes sine and cosine of 0 ≤ x < 1e6 to about 1e-15: π/2 in three parts, Taylor's series.
HWY_INLINE void sin_cos(V x, V& sine, V& cosine) {
  const V quadrant = dn::Floor(add(mul(x, all(0.6366197723675814)), all(0.5)));
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
  const V turn = sub(quadrant, mul(all(4), dn::Floor(mul(quadrant, all(0.25)))));
  const auto odd = dn::Or(dn::Eq(turn, all(1)), dn::Eq(turn, all(3)));
  const V s0 = dn::IfThenElse(odd, c, s), c0 = dn::IfThenElse(odd, s, c);
  sine = dn::IfThenElse(dn::Ge(turn, all(2)), dn::Neg(s0), s0);
  cosine = dn::IfThenElse(dn::Or(dn::Eq(turn, all(1)), dn::Eq(turn, all(2))), dn::Neg(c0), c0);
}

HWY_INLINE void store_floats(V v, float* to) {
#if HWY_HAVE_FLOAT64
  const dn::Rebind<float, Tag> floats;
  dn::StoreU(dn::DemoteTo(floats, v), floats, to);
#else
  *to = static_cast<float>(v);
#endif
}

/// Writes motions that oscillate; the others are overwritten later.
void swings(const ModalBellies& bellies, double half, double tick_s, double decay, std::size_t stride, float* motion) {
  for (std::size_t j = 0; j < bellies.modes; ++j) {
    float* const to = motion + j * stride * lane_count;
    for (std::size_t lane = 0; lane < bellies.count; lane += width) {
      const V omega = load(&bellies.omega_1_s(j).lane[lane]);
      const V square = dn::Max(sub(mul(omega, omega), all(half * half)), all(0)), swing = dn::Sqrt(square);
      const V angle = mul(swing, all(tick_s));
      V sine, cosine;
      sin_cos(angle, sine, cosine);
      sine = dn::IfThenElse(dn::Gt(angle, all(1e-8)), dn::Div(sine, swing), all(tick_s));
      sine = mul(all(decay), sine);
      cosine = mul(all(decay), cosine);
      store_floats(add(cosine, mul(all(half), sine)), to + lane);
      store_floats(mul(omega, sine), to + lane_count + lane);
      store_floats(dn::Div(all(2 * half), omega), to + 2 * lane_count + lane);
    }
  }
}

void shapes(const ModalBellies& of, double damping_per_s, float* to) {
  const std::size_t n = of.modes, inputs = of.inputs;
  const auto put = [&to](V v, std::size_t lane) HWY_ATTR { store_floats(v, to + lane); };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j, to += lane_count) {
      for (std::size_t l = 0; l < of.count; l += width) {
        const V unit = inputs == 1 ? load(&of.participation(j, 0).lane[l]) : all(1);
        put(mul(load(&of.eigenvector(j, i).lane[l]), dn::Div(unit, load(&of.omega_1_s(j).lane[l]))), l);
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

void rest(const ModalBasis& basis, const ModalBellies& of, const Lanes<float>& input, float* to) {
  const std::size_t n = of.modes, rows = 3 * basis.control_weight.size();
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

}  // namespace
}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {
namespace {

HWY_EXPORT(swings);
HWY_EXPORT(shapes);
HWY_EXPORT(rest);

/// Returns a float's upper sixteen bits, rounded to the nearest: eight binary digits.
std::uint32_t upper_half(double x) {
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(x));
  return (bits + 0x7FFFU + (bits >> 16 & 1U)) >> 16;
}

/// Computes a and b of an overdamped motion.
void creep(double omega, double half, double tick_s, float& a, float& b) {
  const double apart = std::sqrt(half * half - omega * omega);
  const double slow = exact::exp(-omega * omega / (half + apart) * tick_s);
  const double fast = exact::expm1(-2 * apart * tick_s);  // of the slow one, less 1
  const double cosine = slow * (1 + fast / 2), sine = slow * (apart * tick_s > 1e-8 ? -fast / (2 * apart) : tick_s);
  a = static_cast<float>(cosine + half * sine);
  b = static_cast<float>(omega * sine);
}

void write_swings(const ModalBellies& bellies, double damping_per_s, double tick_s, std::size_t stride, float* motion) {
  const double half = damping_per_s / 2;
  HWY_DYNAMIC_DISPATCH(swings)(bellies, half, tick_s, exact::exp(-half * tick_s), stride, motion);
  for (std::size_t j = 0; j < bellies.modes; ++j) {
    float* const to = motion + j * stride * lane_count;
    for (std::size_t lane = 0; lane < bellies.count; ++lane) {
      float &a = to[lane], &b = to[lane_count + lane];
      const float g = to[2 * lane_count + lane];
      const double omega = bellies.omega_1_s(j)[lane];
      if (omega * omega < half * half) creep(omega, half, tick_s, a, b);
      // An undamped motion must not grow by the rounding of its numbers.
      const auto growth = [g](double x, double y) { return x * (x - static_cast<double>(g) * y) + y * y; };
      while (growth(static_cast<double>(a), static_cast<double>(b)) > 1) {
        a = std::nextafter(a, 0.0F);
        b = std::nextafter(b, 0.0F);
      }
    }
  }
}

void write_tensions(const ModalBellies& bellies, std::size_t stride, float* motion) {
  for (std::size_t j = 0; j < bellies.modes; ++j) {
    float* const to = motion + j * stride * lane_count;
    for (std::size_t lane = 0; lane < bellies.count; ++lane) {
      const double omega = bellies.omega_1_s(j)[lane], tension = bellies.tension_1_s2(j)[lane];
      to[lane] = static_cast<float>(1 / omega);
      to[lane_count + lane] = static_cast<float>(omega * omega - tuned_activation * tension);
      to[2 * lane_count + lane] = static_cast<float>(tension);
    }
  }
}

}  // namespace

void write_motions(const ModalBellies& bellies, double damping_per_s, double tick_s, float* motion) {
  const std::size_t inputs = bellies.inputs;
  const std::size_t stride = modal_motion_width(1, bellies.inputs);
  if (bellies.tuned) {
    write_tensions(bellies, stride, motion);
  } else {
    write_swings(bellies, damping_per_s, tick_s, stride, motion);
  }
  if (inputs == 1) return;
  const std::size_t ends = inputs > frame_inputs ? inputs - frame_inputs : inputs;
  for (std::size_t j = 0; j < bellies.modes; ++j) {
    float* to = motion + (j * stride + 3) * lane_count;
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

void write_shapes(const ModalBellies& bellies, double damping_per_s, float* shape) {
  HWY_DYNAMIC_DISPATCH(shapes)(bellies, damping_per_s, shape);
}

void place_at_rest(const ModalBasis& basis, const ModalBellies& bellies, const Lanes<float>& input,
                   float* displacement) {
  HWY_DYNAMIC_DISPATCH(rest)(basis, bellies, input, displacement);
}

}  // namespace mobil::inline v0_3
#endif
