// Eigen, one muscle at a time in double precision.
#include "demo/lab/rivals/block.h"
#include "demo/lab/rivals/timing.h"

namespace rivals {
namespace {

struct State {
  Eigen::VectorXd u = Eigen::VectorXd::Zero(moving), v = Eigen::VectorXd::Zero(moving);
};

/// Factors of a muscle's step, in addition to its stiffness.
struct Factors {
  Eigen::VectorXd push, load;  // Δt·M⁻¹/(1 + αΔt/2), and times the force of a unit pull
  double keep;

  explicit Factors(const Block& block)
      : push(step_s / (1 + 0.5 * damping_per_s * step_s) * block.mass.cwiseInverse()),
        load(push.cwiseProduct(block.share_z + sideways * block.share_x)),
        keep((1 - 0.5 * damping_per_s * step_s) / (1 + 0.5 * damping_per_s * step_s)) {}
};

void step(const Eigen::SparseMatrix<double, Eigen::RowMajor>& k, const Factors& f, double pull, State& s,
          Eigen::VectorXd& elastic) {
  elastic.noalias() = k * s.u;
  s.v.array() = f.keep * s.v.array() + pull * f.load.array() - f.push.array() * elastic.array();
  s.u += step_s * s.v;
}

/// Steps all muscles for a tick, `visit` steps of one muscle before the next muscle.
template <class Stiffness, class FactorsOf>
void tick(std::vector<State>& states, int first_step, int visit, Eigen::VectorXd& elastic, Stiffness&& stiffness,
          FactorsOf&& factors) {
  for (int at = 0; at < steps_a_tick; at += visit) {
    for (int m = 0; m < static_cast<int>(states.size()); ++m) {
      for (int n = at; n < at + visit; ++n) {
        step(stiffness(m), factors(m), strength(m) * pull_n(first_step + n), states[static_cast<std::size_t>(m)],
             elastic);
      }
    }
  }
}

/// Returns half a second of one muscle of the template's size, by separate matrices: the reference of the others.
Eigen::VectorXd dense_history(const Block& block, int steps) {
  const Eigen::MatrixXd k = block.stiffness;
  Eigen::VectorXd u = Eigen::VectorXd::Zero(moving), before = u;
  const double half = 0.5 * damping_per_s * step_s;
  for (int n = 0; n < steps; ++n) {
    const Eigen::VectorXd force = strength(0) * pull_n(n) * (block.share_z + sideways * block.share_x) - k * u;
    Eigen::VectorXd next =
        u + ((1 - half) * (u - before) + step_s * step_s * force.cwiseQuotient(block.mass)) / (1 + half);
    before = u;
    u = std::move(next);
  }
  return u;
}

constexpr int checked_steps = 31 * steps_a_tick;

template <class Stiffness, class FactorsOf>
Rival measured(std::string name, double limit_s, const Block& block, Stiffness&& stiffness, FactorsOf&& factors) {
  Rival rival{.name = std::move(name), .repeats = repeats};
  Eigen::VectorXd elastic(moving);
  {
    std::vector<State> one(1);
    for (int n = 0; n < checked_steps; n += steps_a_tick) tick(one, n, steps_a_tick, elastic, stiffness, factors);
    const Eigen::VectorXd expected = dense_history(block, checked_steps);
    rival.check = "displacement after 248 steps against dense matrices in the three-level form";
    rival.check_error = (one[0].u - expected).norm() / expected.norm();
    rival.holds = rival.check_error < 1e-9;
    rival.far_z_m = far_mean(block, one[0].u)[0];
  }
  std::vector<State> states(muscles);
  for (const int visit : {1, steps_a_tick}) {
    int n = 0;
    rival.variants.push_back(timed(visit == 1 ? "a step of everyone in turn" : "a tick of everyone in turn",
                                   muscles * steps_a_tick, limit_s, [&] {
                                     tick(states, n, visit, elastic, stiffness, factors);
                                     n += steps_a_tick;
                                   }));
  }
  return rival;
}

}  // namespace

Rival eigen(double limit_s) {
  const Block block = make_block(1, 1);
  const Factors factors(block);
  return measured(
      "eigen", limit_s,
      block, [&](int) -> const auto& { return block.stiffness; }, [&](int) -> const auto& { return factors; });
}

Rival eigen_individual(double limit_s) {
  std::vector<Block> blocks;
  std::vector<Factors> factors;
  for (int m = 0; m < muscles; ++m) {
    const int row = m / 32;
    const double across = m == 0 ? 1 : 0.8 + 0.5 * (m % 32) / 31, along = m == 0 ? 1 : 0.85 + 0.3 * row / 31;
    blocks.push_back(make_block(across, along));
    factors.emplace_back(blocks.back());
  }
  return measured(
      "eigen_individual", limit_s,
      blocks[0], [&](int m) -> const auto& { return blocks[static_cast<std::size_t>(m)].stiffness; },
      [&](int m) -> const auto& { return factors[static_cast<std::size_t>(m)]; });
}

}  // namespace rivals
