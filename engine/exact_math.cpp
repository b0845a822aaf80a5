#include "engine/exact_math.h"

#include <cmath>

namespace mobil::inline v0_3::exact {
namespace {

/// A number as the sum of two doubles, the second below half a unit of the first's last place.
struct Pair {
  double high = 0, low = 0;
};

Pair sum_of(double a, double b) {
  const double s = a + b, t = s - a;
  return {s, (a - (s - t)) + (b - t)};
}
/// Splits a number into halves of 26 bits with exact products (Dekker 1971). Some libraries round fma incorrectly.
Pair halves_of(double a) {
  const double large = 0x8000001p0 * a, high = large - (large - a);
  return {high, a - high};
}
Pair product_of(double a, double b) {
  const double p = a * b;
  const Pair x = halves_of(a), y = halves_of(b);
  return {p, ((x.high * y.high - p) + x.high * y.low + x.low * y.high) + x.low * y.low};
}
Pair operator+(Pair a, Pair b) {
  const Pair high = sum_of(a.high, b.high), low = sum_of(a.low, b.low);
  const Pair once = sum_of(high.high, high.low + low.high);
  return sum_of(once.high, once.low + low.low);
}
Pair operator-(Pair a) {
  return {-a.high, -a.low};
}
Pair operator*(Pair a, Pair b) {
  const Pair p = product_of(a.high, b.high);
  return sum_of(p.high, p.low + (a.high * b.low + a.low * b.high));
}
Pair operator/(Pair a, Pair b) {
  const double first = a.high / b.high;
  const Pair left = a + -(b * Pair{first, 0});
  const double second = left.high / b.high;
  const double third = (left + -(b * Pair{second, 0})).high / b.high;
  return sum_of(first, second) + Pair{third, 0};
}
Pair scaled(Pair a, double power_of_two) {
  return {a.high * power_of_two, a.low * power_of_two};
}
Pair square_root(Pair a) {
  if (!(a.high > 0)) return {};
  const double root = std::sqrt(a.high);
  return sum_of(root, (a + -product_of(root, root)).high / (2 * root));
}

constexpr Pair half_pi = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
constexpr double half_pi_end = -0x1.f1976b7ed8fbcp-110;
constexpr Pair log_2 = {0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56};
constexpr double log_2_end = 0x1.7b57a079a1934p-111;

/// Values of 1 / n!.
constexpr Pair one_over_factorial[] = {{0x1.0000000000000p+0, 0x0.0p+0},
                                       {0x1.0000000000000p+0, 0x0.0p+0},
                                       {0x1.0000000000000p-1, 0x0.0p+0},
                                       {0x1.5555555555555p-3, 0x1.5555555555555p-57},
                                       {0x1.5555555555555p-5, 0x1.5555555555555p-59},
                                       {0x1.1111111111111p-7, 0x1.1111111111111p-63},
                                       {0x1.6c16c16c16c17p-10, -0x1.f49f49f49f49fp-65},
                                       {0x1.a01a01a01a01ap-13, 0x1.a01a01a01a01ap-73},
                                       {0x1.a01a01a01a01ap-16, 0x1.a01a01a01a01ap-76},
                                       {0x1.71de3a556c734p-19, -0x1.c154f8ddc6c00p-73},
                                       {0x1.27e4fb7789f5cp-22, 0x1.cbbc05b4fa99ap-76},
                                       {0x1.ae64567f544e4p-26, -0x1.c062e06d1f209p-80},
                                       {0x1.1eed8eff8d898p-29, -0x1.2aec959e14c06p-83},
                                       {0x1.6124613a86d09p-33, 0x1.f28e0cc748ebep-87},
                                       {0x1.93974a8c07c9dp-37, 0x1.05d6f8a2efd1fp-92},
                                       {0x1.ae7f3e733b81fp-41, 0x1.1d8656b0ee8cbp-97},
                                       {0x1.ae7f3e733b81fp-45, 0x1.1d8656b0ee8cbp-101},
                                       {0x1.952c77030ad4ap-49, 0x1.ac981465ddc6cp-103},
                                       {0x1.6827863b97d97p-53, 0x1.eec01221a8b0bp-107},
                                       {0x1.2f49b46814157p-57, 0x1.2650f61dbdcb4p-112},
                                       {0x1.e542ba4020225p-62, 0x1.ea72b4afe3c2fp-120},
                                       {0x1.71b8ef6dcf572p-66, -0x1.d043ae40c4647p-120},
                                       {0x1.0ce396db7f853p-70, -0x1.aebcdbd20331cp-124},
                                       {0x1.761b41316381ap-75, -0x1.3423c7d91404fp-130},
                                       {0x1.f2cf01972f578p-80, -0x1.9ada5fcc1ab14p-135},
                                       {0x1.3f3ccdd165fa9p-84, -0x1.58ddadf344487p-139},
                                       {0x1.88e85fc6a4e5ap-89, -0x1.71c37ebd16540p-143},
                                       {0x1.d1ab1c2dccea3p-94, 0x1.054d0c78aea14p-149},
                                       {0x1.0a18a2635085dp-98, 0x1.b9e2e28e1aa54p-153}};

/// Returns x minus `times` times a constant of three doubles.
Pair reduced(Pair x, double times, Pair constant, double end) {
  return ((x + -product_of(times, constant.high)) + -product_of(times, constant.low)) + Pair{-times * end, 0};
}

/// Returns e^x − 1 for |x| up to 0.35: the series of x / 512, then (1 + e)² − 1 = e·(2 + e) nine times.
Pair small_expm1(Pair x) {
  constexpr int doublings = 9, terms = 9;
  const Pair part = scaled(x, 1.0 / (1 << doublings));
  Pair e = one_over_factorial[terms];
  for (int n = terms - 1; n >= 1; --n) e = one_over_factorial[n] + part * e;
  e = part * e;
  for (int i = 0; i < doublings; ++i) e = e * (Pair{2, 0} + e);
  return e;
}

/// Multiple of log 2 in x, and e^(remainder) − 1.
struct Power {
  int of_two;
  Pair rest;
};
Power power_of(Pair x) {
  const double times = std::nearbyint(x.high / log_2.high);
  return {static_cast<int>(times), small_expm1(reduced(x, times, log_2, log_2_end))};
}

double exp_of(Pair x) {
  if (!(x.high < 710)) return x.high > 0 ? HUGE_VAL : x.high;
  if (x.high < -746) return 0;
  const Power power = power_of(x);
  const Pair whole = Pair{1, 0} + power.rest;
  return std::ldexp(whole.high + whole.low, power.of_two);
}

/// Returns log x by one Newton step, log x = y + log(x·e^−y), from the library's y. Errors in y's last bits vanish.
Pair log_of(double x) {
  int power = 0;
  const double part = std::frexp(x, &power);  // ½ to 1
  const double y = std::log(part);
  const Pair half_back = Pair{1, 0} + small_expm1(Pair{-y / 2, 0});
  const Pair off = (Pair{part, 0} * half_back * half_back) + Pair{-1, 0};
  const Pair here = Pair{y, 0} + off + scaled(off * off, -0.5);
  const auto times = static_cast<double>(power);
  return ((product_of(times, log_2.high) + product_of(times, log_2.low)) + Pair{times * log_2_end, 0}) + here;
}

/// Sine and cosine of |x| up to π/4, from their series.
struct Turn {
  Pair sine, cosine;
};
Turn small_turn(Pair x) {
  constexpr int last = 27;
  const Pair square = -(x * x);
  Turn turn{one_over_factorial[last], one_over_factorial[last + 1]};
  for (int n = last - 2; n >= 1; n -= 2) {
    turn.sine = one_over_factorial[n] + square * turn.sine;
    turn.cosine = one_over_factorial[n + 1] + square * turn.cosine;
  }
  turn.sine = x * turn.sine;
  turn.cosine = one_over_factorial[0] + square * turn.cosine;
  return turn;
}
Turn turn_of(double x) {
  const double quarters = std::nearbyint(x / half_pi.high);
  const Turn small = small_turn(reduced({x, 0}, quarters, half_pi, half_pi_end));
  switch (static_cast<long long>(quarters) & 3) {
    case 0:
      return small;
    case 1:
      return {small.cosine, -small.sine};
    case 2:
      return {-small.sine, -small.cosine};
    default:
      return {-small.cosine, small.sine};
  }
}

/// Returns the angle of (x, y), not both 0. It rotates by the library's angle and adds the small remainder.
double angle_of(Pair y, Pair x) {
  const double about = std::atan2(y.high, x.high);
  const Turn turn = turn_of(about);
  const Pair across = y * turn.cosine + -(x * turn.sine), along = x * turn.cosine + y * turn.sine;
  const Pair off = across / along;
  const Pair angle = Pair{about, 0} + off;  // off³ is below the last digit, so off is its own arc tangent
  return angle.high + angle.low;
}

}  // namespace

double exp(double x) {
  return exp_of({x, 0});
}

double expm1(double x) {
  if (!(std::abs(x) < 40)) return x < 0 ? -1 : exp(x);
  const Power power = power_of({x, 0});
  if (power.of_two == 0) return power.rest.high == 0 ? x : power.rest.high + power.rest.low;
  const double scale = std::ldexp(1, power.of_two);
  const Pair whole = sum_of(scale, -1) + scaled(power.rest, scale);
  return whole.high + whole.low;
}

double log(double x) {
  if (!(x > 0) || std::isinf(x)) return x > 0 ? x : x == 0 ? -HUGE_VAL : std::nan("");
  if (x == 1) return 0;
  const Pair y = log_of(x);
  return y.high + y.low;
}

double pow(double x, double y) {
  return x == 1 || y == 0 ? 1 : exp_of(log_of(x) * Pair{y, 0});
}

double cbrt(double x) {
  if (x == 0 || !std::isfinite(x)) return x;
  const double root = std::cbrt(x);
  const Pair square = product_of(root, root);
  const Pair off = (square * Pair{root, 0} + Pair{-x, 0}) / (Pair{3, 0} * square);
  const Pair exact = Pair{root, 0} + -off;
  return exact.high + exact.low;
}

double sin(double x) {
  if (!(std::abs(x) < 1e6)) return std::nan("");
  if (x == 0) return x;
  const Pair sine = turn_of(x).sine;
  return sine.high + sine.low;
}

double cos(double x) {
  if (!(std::abs(x) < 1e6)) return std::nan("");
  const Pair cosine = turn_of(x).cosine;
  return cosine.high + cosine.low;
}

double atan2(double y, double x) {
  const bool plain = std::isfinite(x) && std::isfinite(y) && x != 0 && y != 0;
  return plain ? angle_of({y, 0}, {x, 0}) : std::atan2(y, x);  // multiples of 1/8 turn, or NaN
}

double asin(double x) {
  if (!(std::abs(x) <= 1) || x == 0) return std::asin(x);
  return angle_of({x, 0}, square_root(sum_of(1, -x) * sum_of(1, x)));
}

double acos(double x) {
  if (!(std::abs(x) <= 1) || x == 1) return std::acos(x);
  return angle_of(square_root(sum_of(1, -x) * sum_of(1, x)), {x, 0});
}

}  // namespace mobil::inline v0_3::exact
