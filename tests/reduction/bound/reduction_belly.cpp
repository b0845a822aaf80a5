#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "assets/reduction/symmetric_eigen.h"
#include "tests/reduction/bound/reduction_bound.h"
#include "tests/reduction/bound/reduction_tables.h"

namespace mobil {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Vibrations z̈ + α·ż + ω²·z = −k·w − m·(ẅ + α·ẇ) + load: z = rest·input + late·rate + y, y free; a change of rate by 1
/// changes y by −late and ẏ by −(share + rest).
struct Vibrations {
  VectorXd omega2, swing;
  MatrixXd rest, late, kick;
  VectorXd y, speed;              // now
  VectorXd decay_cos, decay_sin;  // of one tick, both with e^(−αh/2)

  void resize_motion() { y = speed = VectorXd::Zero(omega2.size()); }
  void set_tick(double damping_per_s, double tick_s) {
    const double decay = std::exp(-damping_per_s / 2 * tick_s);
    decay_cos = decay * (swing * tick_s).array().cos();
    decay_sin = decay * (swing * tick_s).array().sin();
  }
  void change_rate(const VectorXd& change) {
    y -= late * change;
    speed -= kick * change;
  }
  /// Amplitudes of e^(−αt/2)·cos(ω_d·t) and sin from now on: y and this.
  VectorXd sine(double damping_per_s) const { return (speed + damping_per_s / 2 * y).cwiseQuotient(swing); }
  void advance(double damping_per_s) {
    const VectorXd s = sine(damping_per_s);
    const VectorXd next = y.cwiseProduct(decay_cos) + s.cwiseProduct(decay_sin);
    speed = swing.cwiseProduct(s.cwiseProduct(decay_cos) - y.cwiseProduct(decay_sin)) - damping_per_s / 2 * next;
    y = next;
  }
};

double square(const MatrixXd& form, const VectorXd& x) {
  return std::max(0.0, x.dot(form * x));
}

/// Of Σ (a_j·cos(ω_j·t) + b_j·sin(ω_j·t))·x_j over a tick: ∫|…|² dt as a form in (a, b), `gram` being that of the x.
MatrixXd integrated(const MatrixXd& gram, const VectorXd& swing, double tick_s) {
  const Index n = swing.size();
  const auto even = [&](double w) { return std::abs(w * tick_s) < 1e-6 ? tick_s : std::sin(w * tick_s) / w; };
  const auto odd = [&](double w) {
    const double half = std::sin(w * tick_s / 2);
    return std::abs(w * tick_s) < 1e-6 ? w * tick_s * tick_s / 2 : 2 * half * half / w;
  };
  MatrixXd form(2 * n, 2 * n);
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < n; ++i) {
      const double apart = even(swing(i) - swing(j)), together = even(swing(i) + swing(j));
      form(i, j) = gram(i, j) * (apart + together) / 2;
      form(n + i, n + j) = gram(i, j) * (apart - together) / 2;
      const double mixed = gram(i, j) * (odd(swing(i) + swing(j)) + odd(swing(j) - swing(i))) / 2;
      form(i, n + j) = form(n + j, i) = mixed;  // cos of i, sin of j
    }
  }
  return form;
}

double field_scale(Index number, double across, double along) {
  return number < 3 ? 1 : number % 3 == 2 ? along : across;
}

}  // namespace

struct BoundedMotion {
  std::shared_ptr<const ReductionTables> tables;
  double damping_per_s = 0, tick_s = 0;
  double mass_scale = 1;  // S²·l
  double slowest2 = 0, kappa = 1;
  Index inputs = 0, vectors = 0, lifts = 0;

  Vibrations own, wide;            // of V, all; of W, those that are followed
  MatrixXd own_shape, wide_shape;  // in W's vectors
  MatrixXd wide_rest, wide_late;   // of all of W, in W's vectors
  MatrixXd stiffness;              // of W
  VectorXd lift_pull;              // WᵀKψ
  double lift_energy = 0;

  MatrixXd dual;         // of ρ₀, ρ₁ and the followed ρ_j: in K⁻¹, above
  MatrixXd answer_mass;  // of K⁻¹ times those in M₁, above
  MatrixXd jump_stiffness, jump_mass, jump_answer_mass, jump_speed, jump_answer_speed, jump_impulse;
  MatrixXd rest_mass;  // of K⁻¹ρ₀
  MatrixXd drive;      // over a tick, of (a, b)

  VectorXd input, rate;
  double d = 0, d_mass = 0, peak = 0;

  void set_tick(double seconds) {
    if (seconds == tick_s) return;
    tick_s = seconds;
    own.set_tick(damping_per_s, seconds);
    wide.set_tick(damping_per_s, seconds);
    const Index n = wide.omega2.size();
    const MatrixXd gram = wide.omega2.asDiagonal() * answer_mass.bottomRightCorner(n, n) * wide.omega2.asDiagonal();
    drive = integrated(gram, wide.swing, seconds);
  }

  /// Adds what a change of the inputs' rates does.
  void jump(const VectorXd& change) {
    const double moved2 = square(jump_stiffness, change);
    const double moved = std::sqrt(square(jump_mass, change)) + std::sqrt(square(jump_answer_mass, change));
    const double speed = std::sqrt(square(jump_speed, change)) + std::sqrt(square(jump_answer_speed, change));
    d += std::sqrt(moved2 + speed * speed + damping_per_s * moved * speed);
    const double answered = std::sqrt(square(jump_answer_speed, change)) + damping_per_s / 2 * moved;
    d_mass += moved + kappa * (std::sqrt(square(jump_impulse, change)) + answered / std::sqrt(slowest2));
  }

  ReductionError report() {
    VectorXd apart = wide_rest * input + wide_late * rate + wide_shape * wide.y;
    const VectorXd own_moved = own_shape * (own.rest * input + own.late * rate + own.y);
    apart -= own_moved;
    VectorXd residual(2 * inputs + wide.y.size());
    residual << input, rate, wide.y;
    const double lifted = lifts > 0 ? input(0) : 0;
    const VectorXd pushed = stiffness * own_moved;
    const double energy2 =
        own_moved.dot(pushed) + (lifts > 0 ? 2 * lifted * lift_pull.dot(own_moved) : 0) + lifted * lifted * lift_energy;
    const double scale = std::sqrt(mass_scale);
    ReductionError error;
    error.own = scale * std::sqrt(std::max(0.0, energy2));
    peak = std::max(peak, error.own);
    error.rounding = 1e-5 * peak;
    error.energy = scale * (std::hypot(d, damping_per_s / 2 * d_mass) +
                            std::sqrt(square(stiffness, apart) + square(dual, residual))) +
                   error.rounding;
    const double moved = apart.norm() + std::sqrt(square(answer_mass, residual)) + d_mass;
    error.rms_m = (moved + error.rounding / (scale * std::sqrt(slowest2))) / std::sqrt(tables->mass_kg);
    return error;
  }
};

namespace {

/// One belly's operators over the mass S²·l, in W.
struct Operators {
  MatrixXd stiffness;  // with ψ's row and column before, where there is a lift
  MatrixXd rest_pull;  // W × inputs: what pulls at rest, per unit
  MatrixXd share;      // W × inputs: WᵀM₁ψ, 0 for loads
};

Operators operators_of(const ReductionTables& t, double across, double along) {
  const double p = across * along, r = across / along, mass = across * p;
  Operators o;
  o.stiffness = (t.a / r + t.b + r * t.c) / p;
  if (t.foundation_1_s2 > 0) o.stiffness += t.foundation_1_s2 * t.foundation;
  const Index n = t.order.space, lifts = t.order.lifts, loads = t.order.loads;
  o.rest_pull.resize(n, lifts + loads);
  o.share = MatrixXd::Zero(n, lifts + loads);
  if (lifts > 0) {
    o.rest_pull.col(0) = -o.stiffness.col(0).tail(n);
    o.share.col(0) = t.mass.col(0).tail(n);
  }
  const Index ends = t.options.frame_loads ? loads - Index{frame_inputs} : loads;
  for (Index i = 0; i < loads; ++i) {
    o.rest_pull.col(lifts + i) = t.loads.col(i) * (i < ends ? 1 / mass : field_scale(i - ends, across, along));
  }
  return o;
}

/// Of the Galerkin problem on the first `count` vectors; shape in those.
Vibrations vibrations_of(const Operators& o, Index lifts, Index count, double damping_per_s, MatrixXd& shape) {
  const SymmetricEigen modes = symmetric_eigen(o.stiffness.block(lifts, lifts, count, count));
  Vibrations v;
  shape = modes.vectors;
  v.omega2 = modes.values;
  v.swing = (v.omega2.array() - damping_per_s * damping_per_s / 4).max(0.0).sqrt();
  v.rest = v.omega2.cwiseInverse().asDiagonal() * (shape.transpose() * o.rest_pull.topRows(count));
  v.kick = shape.transpose() * o.share.topRows(count) + v.rest;
  v.late = -damping_per_s * (v.omega2.cwiseInverse().asDiagonal() * v.kick);
  v.resize_motion();
  return v;
}

/// Which terms (TermOrder) the residuals are the sums of: those of ρ₀, ρ₁ and all ρ_j, a column each.
MatrixXd residual_terms(const ReductionTables& t, double across, double along, double damping_per_s,
                        const Vibrations& v, const MatrixXd& shape) {
  const TermOrder& order = t.order;
  const Index n = order.space, inputs = order.lifts + order.loads;
  const double p = across * along, r = across / along;
  const double by_a = (1 / r - 1 / t.constants.ratio) / p, by_c = (r - t.constants.ratio) / p;
  const double by_brace = (p - t.constants.product) * t.foundation_1_s2 / p;
  MatrixXd terms = MatrixXd::Zero(order.count(), 2 * inputs + n);
  const auto minus_stiffness = [&](Index first, const MatrixXd& fields) {  // −K·W·fields
    const Index width = fields.cols();
    const auto add = [&](TermOrder::Kind kind, double factor) {
      terms.block(order.of_space(kind), first, n, width) -= factor * fields;
    };
    add(TermOrder::whole, 1 / p);
    add(TermOrder::a, by_a);
    add(TermOrder::c, by_c);
    if (order.kinds > TermOrder::brace) add(TermOrder::brace, by_brace);
  };
  minus_stiffness(0, shape * v.rest);
  minus_stiffness(inputs, shape * v.late);
  minus_stiffness(2 * inputs, shape);
  const Index mass = order.of_space(TermOrder::mass);
  terms.block(mass, inputs, n, inputs) -= damping_per_s * shape * v.rest;
  terms.block(mass, 2 * inputs, n, n) += shape * v.omega2.asDiagonal();
  if (order.lifts > 0) {
    terms(order.of_lift(TermOrder::whole), 0) -= 1 / p;
    terms(order.of_lift(TermOrder::a), 0) -= by_a;
    terms(order.of_lift(TermOrder::c), 0) -= by_c;
    if (order.kinds > TermOrder::brace) terms(order.of_lift(TermOrder::brace), 0) -= by_brace;
    terms(order.of_lift(TermOrder::mass), inputs) -= damping_per_s;
  }
  const Index ends = t.options.frame_loads ? order.loads - Index{frame_inputs} : order.loads;
  for (Index i = 0; i < order.loads; ++i) {
    terms(order.of_loads() + i, order.lifts + i) += i < ends ? 1 / (across * p) : field_scale(i - ends, across, along);
  }
  return terms;
}

/// termsᵀ·gram·terms, and on its diagonal what rounding may have taken away.
MatrixXd collapsed(const MatrixXd& gram, const MatrixXd& terms) {
  constexpr double rounding = 2e-15;
  const VectorXd sizes = gram.diagonal().cwiseMax(0.0).cwiseSqrt();
  const VectorXd lost = (sizes.transpose() * terms.cwiseAbs()).transpose();
  MatrixXd form = terms.transpose() * (gram * terms);
  form = ((form + form.transpose()) / 2).eval();
  form.diagonal() += rounding * static_cast<double>(terms.cols()) * lost.cwiseAbs2();
  return form;
}

/// Fills everything that jumps need, `chosen` being the vibrations that are followed.
void set_jumps(BoundedMotion& m, const Vibrations& all, const MatrixXd& shape, const MatrixXd& share,
               const std::vector<bool>& chosen, double dual_scale) {
  const Index inputs = m.inputs, n = all.omega2.size(), followed = m.wide.omega2.size();
  const TermOrder& order = m.tables->order;
  MatrixXd impulse = MatrixXd::Zero(order.count(), inputs);  // M₁ times the jump of speed outside what is followed
  impulse.middleRows(order.of_space(TermOrder::mass), n) = share;
  if (m.lifts > 0) impulse(order.of_lift(TermOrder::mass), 0) = -1;
  m.jump_stiffness = m.jump_mass = m.jump_speed = MatrixXd::Zero(inputs, inputs);
  for (Index j = 0; j < n; ++j) {
    if (chosen[static_cast<std::size_t>(j)]) continue;
    const MatrixXd late = all.late.row(j).transpose() * all.late.row(j);
    m.jump_stiffness += all.omega2(j) * late;
    m.jump_mass += late;
    m.jump_speed += all.kick.row(j).transpose() * all.kick.row(j);
    impulse.middleRows(order.of_space(TermOrder::mass), n) -= shape.col(j) * all.kick.row(j);
  }
  if (m.lifts > 0) m.jump_speed(0, 0) += m.tables->unseen_square;
  MatrixXd moved = MatrixXd::Zero(2 * inputs + followed, inputs), speed = moved;
  moved.middleRows(inputs, inputs).setIdentity();
  moved.bottomRows(followed) = -m.wide.late;
  speed.topRows(inputs).setIdentity();
  speed.bottomRows(followed) = -m.wide.kick;
  m.jump_stiffness += moved.transpose() * m.dual * moved;
  m.jump_answer_mass = moved.transpose() * m.answer_mass * moved;
  m.jump_impulse = dual_scale * collapsed(m.tables->stiffness_gram, impulse);
  m.jump_answer_speed = speed.transpose() * m.answer_mass * speed;
}

}  // namespace

BodyRange body_range(const ReductionBound& bound, double across, double along) {
  const StiffnessConstants& constants = bound.tables->constants;
  const StiffnessRange range = stiffness_range(constants, across, along);
  return {range.least, range.most, std::sqrt(slowest_square(constants, across, along))};
}

Result<BoundedBelly> BoundedBelly::make(const ReductionBound& bound, double across, double along,
                                        double damping_per_s) {
  const ReductionTables& t = *bound.tables;
  const double ratio = across / along, p = across * along;
  if (!(across > 0 && along > 0 && ratio >= t.lowest_ratio * (1 - 1e-5) && ratio <= t.highest_ratio * (1 + 1e-5))) {
    return fail(fmt::format("scales {:.4g} across and {:.4g} along: their ratio must lie between {:.4g} and {:.4g}",
                            across, along, t.lowest_ratio, t.highest_ratio));
  }
  const BodyRange range = body_range(bound, across, along);
  if (!(range.least > 0.05)) {
    return fail(
        fmt::format("a ratio of {:.4g} is too far from the basis's middle {:.4g} for a bound; take a narrower"
                    " basis",
                    ratio, t.constants.ratio));
  }
  if (!(damping_per_s > 0 && damping_per_s < 1.98 * range.slowest_1_s)) {
    return fail(
        fmt::format("mass damping {:.4g} 1/s must lie above 0 and below {:.4g}, where the slowest vibration"
                    " stops swinging, for a bound",
                    damping_per_s, 1.98 * range.slowest_1_s));
  }
  auto motion = std::make_unique<BoundedMotion>();
  BoundedMotion& m = *motion;
  m.tables = bound.tables;
  m.damping_per_s = damping_per_s;
  m.mass_scale = across * p;
  m.slowest2 = range.slowest_1_s * range.slowest_1_s;
  m.kappa = 1 / std::sqrt(1 - damping_per_s * damping_per_s / 4 / m.slowest2);
  m.inputs = t.order.lifts + t.order.loads;
  m.vectors = t.vectors;
  m.lifts = t.order.lifts;
  const Operators o = operators_of(t, across, along);
  const Index n = t.order.space;
  m.stiffness = o.stiffness.bottomRightCorner(n, n);
  if (m.lifts > 0) {
    m.lift_pull = o.stiffness.col(0).tail(n);
    m.lift_energy = o.stiffness(0, 0);
  }
  MatrixXd shape;
  m.own = vibrations_of(o, m.lifts, m.vectors, damping_per_s, shape);
  m.own_shape = MatrixXd::Zero(n, m.vectors);
  m.own_shape.topRows(m.vectors) = shape;
  const Vibrations all = vibrations_of(o, m.lifts, n, damping_per_s, shape);
  m.wide_rest = shape * all.rest;
  m.wide_late = shape * all.late;

  // Residuals' norms, and the vibrations whose own are small enough to follow them.
  const MatrixXd terms = residual_terms(t, across, along, damping_per_s, all, shape);
  const double below = 1 - range.least, above = std::max(0.0, range.most - 1);
  const double apart2 = std::max(below * below / range.least, above * above / (1 + above)) / m.slowest2;  // ε²/ω₁²
  const MatrixXd energy = p * collapsed(t.stiffness_gram, terms), moved = p * p * collapsed(t.mass_gram, terms);
  std::vector<bool> chosen(static_cast<std::size_t>(n));
  std::vector<Index> columns;
  for (Index i = 0; i < 2 * m.inputs; ++i) columns.push_back(i);
  double by_energy = 0, by_mass = 0;
  for (Index j = 0; j < n; ++j) {
    const Index column = 2 * m.inputs + j;
    const double answer = std::sqrt(moved(column, column)) + std::sqrt(apart2 * energy(column, column));
    const double omega = std::sqrt(all.omega2(j));
    chosen[static_cast<std::size_t>(j)] = omega * answer * (1 + 2 / damping_per_s * omega) < omega;
    if (!chosen[static_cast<std::size_t>(j)]) continue;
    columns.push_back(column);
    by_mass += all.omega2(j) * moved(column, column);
    by_energy += all.omega2(j) * apart2 * energy(column, column);
  }
  const double share = by_energy > 0 && by_mass > 0 ? std::sqrt(by_energy / by_mass) : 1;
  m.dual = energy(columns, columns) / range.least;
  m.answer_mass = (1 + share) * moved(columns, columns) + (1 + 1 / share) * apart2 * MatrixXd(energy(columns, columns));
  const std::vector<Index> followed = [&] {
    std::vector<Index> rows(columns.begin() + 2 * m.inputs, columns.end());
    for (Index& row : rows) row -= 2 * m.inputs;
    return rows;
  }();
  m.wide.omega2 = all.omega2(followed);
  m.wide.swing = all.swing(followed);
  m.wide.rest = all.rest(followed, Eigen::all);
  m.wide.late = all.late(followed, Eigen::all);
  m.wide.kick = all.kick(followed, Eigen::all);
  m.wide.resize_motion();
  m.wide_shape = shape(Eigen::all, followed);
  set_jumps(m, all, shape, o.share, chosen, p / range.least);
  m.rest_mass = m.answer_mass.topLeftCorner(m.inputs, m.inputs);
  m.input = m.rate = VectorXd::Zero(m.inputs);
  return BoundedBelly(std::move(motion));
}

BoundedBelly::BoundedBelly(std::unique_ptr<BoundedMotion> motion) : motion_(std::move(motion)) {}
BoundedBelly::BoundedBelly(BoundedBelly&&) noexcept = default;
BoundedBelly& BoundedBelly::operator=(BoundedBelly&&) noexcept = default;
BoundedBelly::~BoundedBelly() = default;

ReductionError BoundedBelly::start(std::span<const double> inputs) {
  BoundedMotion& m = *motion_;
  m.input = Eigen::Map<const VectorXd>(inputs.data(), m.inputs);
  m.rate.setZero();
  m.own.resize_motion();
  m.wide.resize_motion();
  m.d = m.d_mass = m.peak = 0;
  return m.report();
}

ReductionError BoundedBelly::step(std::span<const double> inputs, double tick_s) {
  BoundedMotion& m = *motion_;
  m.set_tick(tick_s);
  const Eigen::Map<const VectorXd> end(inputs.data(), m.inputs);
  const VectorXd rate = (end - m.input) / tick_s, change = rate - m.rate;
  m.jump(change);
  m.own.change_rate(change);
  m.wide.change_rate(change);
  m.input = end;
  m.rate = rate;
  const Index n = m.wide.omega2.size();
  VectorXd amplitude(2 * n);
  amplitude << m.wide.y, m.wide.sine(m.damping_per_s);
  const double half = m.damping_per_s / 2, decay = std::exp(-half * tick_s);
  const double driven = decay * std::sqrt(tick_s * square(m.drive, amplitude)) -
                        2 * std::expm1(-half * tick_s) * std::sqrt(square(m.rest_mass, rate));
  m.d = decay * m.d + driven;
  m.d_mass = decay * m.d_mass + m.kappa / std::sqrt(m.slowest2) * driven;
  m.own.advance(m.damping_per_s);
  m.wide.advance(m.damping_per_s);
  m.peak *= decay;
  return m.report();
}

std::vector<double> BoundedBelly::coordinates() const {
  const BoundedMotion& m = *motion_;
  const VectorXd q = (m.own_shape * (m.own.rest * m.input + m.own.late * m.rate + m.own.y)).head(m.vectors);
  return {q.data(), q.data() + q.size()};
}

std::size_t BoundedBelly::followed() const {
  return static_cast<std::size_t>(motion_->wide.omega2.size());
}

}  // namespace mobil
