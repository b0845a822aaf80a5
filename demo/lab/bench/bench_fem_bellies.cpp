#include "demo/lab/bench/bench_fem_bellies.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "assets/fem/belly_solver.h"
#include "demo/program/must.h"

namespace mobil {

MuscleTemplate paper_block(const Cells& cells) {
  constexpr double side_m = 0.03, length_m = 0.12;
  auto mesh = must(make_block(cells, side_m / cells[0]));
  const double stretch = length_m / mesh.node.back().z;
  for (Vec3<double>& node : mesh.node) node.z *= stretch;
  return must(make_muscle_template(std::move(mesh), {}, {.far_end = FarEnd::free}));
}

double paper_limit_s(const MuscleTemplate& muscle, Mass mass) {
  return critical_step(muscle.terms, 1, 1, StepCase(FarEnd::free, mass));
}

double useful_multiply_adds(const Cells& cells) {
  const auto pairs = [](std::uint32_t moving) { return 3.0 * moving - 2.0; };  // along one axis
  return 9 * pairs(cells[0] + 1) * pairs(cells[1] + 1) * pairs(cells[2]);
}

double bench_pull_n(double time_s) {
  constexpr double circle = 2 * std::numbers::pi;
  return 0.2 * (1 - std::cos(circle * 1.3 * time_s)) + 0.05 * std::sin(circle * 7 * time_s);
}

BenchBellies::BenchBellies(const MuscleTemplate& muscle, Stiffness stiffness, std::size_t blocks)
    : muscle_(muscle), stiffness_(stiffness), blocks_(blocks) {
  const std::size_t width = nodal_width(muscle.mesh.cells);
  std::size_t scratch = 0;
  for (const Method method : {Method::statics, Method::explicit_central, Method::implicit_central, Method::newmark}) {
    scratch = std::max(scratch, scratch_floats(muscle, method) / lane_count);
  }
  std::size_t i = 0;
  for (Block& block : blocks_) {
    block.displacement.resize(width);
    block.velocity.resize(width);
    block.scratch.resize(scratch);
    for (std::size_t l = 0; l < lane_count; ++l, ++i) {
      const bool own = stiffness == Stiffness::individual && i > 0;
      block.scale.across[l] = own ? 0.8F + 0.5F * static_cast<float>(7 * i % 32) / 31 : 1.0F;
      block.scale.along[l] = own ? 0.85F + 0.3F * static_cast<float>((5 * i + i / 32) % 32) / 31 : 1.0F;
      block.strength[l] = 1.0F + 0.5F * static_cast<float>(i) / static_cast<float>(muscles());
    }
  }
}

void BenchBellies::tick(std::uint32_t substeps, float tick_s, const BellySolver* solver) {
  for (std::size_t b = 0; b < blocks_.size(); ++b) tick_block(b, substeps, tick_s, solver);
}

void BenchBellies::tick_block(std::size_t b, std::uint32_t substeps, float tick_s, const BellySolver* solver) {
  Block& block = blocks_[b];
  EndTraction<Lanes<float>> end{};
  const auto from = static_cast<float>(bench_pull_n(block.time_s));
  block.time_s += static_cast<double>(tick_s);
  const auto to = static_cast<float>(bench_pull_n(block.time_s));
  constexpr auto sideways = static_cast<float>(bench_sideways);
  for (std::size_t l = 0; l < lane_count; ++l) {
    end.from_n.z[l] = from * block.strength[l];
    end.to_n.z[l] = to * block.strength[l];
    end.from_n.x[l] = sideways * end.from_n.z[l];
    end.to_n.x[l] = sideways * end.to_n.z[l];
  }
  BellyReport<Lanes<float>> unused;
  const BellyBlock bellies{
      muscle_, block.scale, block.displacement.data()->lane, block.velocity.data()->lane, unused, stiffness_,
      nullptr, false};
  float* const scratch = block.scratch.empty() ? nullptr : block.scratch.data()->lane;
  if (solver == nullptr) {
    deform_explicit(bellies, end, substeps, tick_s, scratch);
  } else {
    deform_implicit(bellies, *solver, end, substeps, tick_s, scratch);
  }
}

bool BenchBellies::finite() const {
  return std::ranges::all_of(blocks_, [this](const Block& block) {
    return std::ranges::all_of(elongation_m(block).lane, [](float e) { return std::isfinite(e); });
  });
}

Lanes<float> BenchBellies::elongation_m(const Block& block) const {
  const std::vector<float>& share = muscle_.kernel.far_share;
  const std::size_t far = first_insertion_node(muscle_.mesh.cells);
  Lanes<float> sum{};
  for (std::size_t n = 0; n < share.size(); ++n) {
    for (std::size_t l = 0; l < lane_count; ++l) sum[l] += share[n] * block.displacement[3 * (far + n) + 2][l];
  }
  return sum;
}

Histories bench_histories(const MuscleTemplate& muscle, Stiffness stiffness, double dt_s, double seconds,
                          const BellySolver* solver) {
  BenchBellies bellies(muscle, stiffness, 1);
  Histories histories;
  for (int n = 0; n < std::lround(seconds / dt_s); ++n) {
    bellies.tick(1, static_cast<float>(dt_s), solver);
    for (std::size_t l = 0; l < lane_count; ++l) {
      histories[l].push_back(static_cast<double>(bellies.elongation_m()[l]));
    }
  }
  return histories;
}

double history_error(const std::vector<double>& history, const std::vector<double>& truth) {
  const std::size_t each = truth.size() / history.size();
  double square = 0, largest = 0;
  for (std::size_t n = 0; n < history.size(); ++n) {
    const double expected = truth[(n + 1) * each - 1];
    square += (history[n] - expected) * (history[n] - expected);
    largest = std::max(largest, std::abs(expected));
  }
  return std::sqrt(square / static_cast<double>(history.size())) / largest;
}

void Rounds::add(const Measured& round) {
  rounds_.push_back(round);
}

Measured Rounds::all() const {
  Measured all = rounds_.front();
  std::vector<double> medians;
  for (const Measured& round : rounds_) {
    all.best_s = std::min(all.best_s, round.best_s);
    if (round.cpu_s) all.cpu_s = std::min(all.cpu_s.value_or(*round.cpu_s), *round.cpu_s);
    medians.push_back(round.median_s);
  }
  all.median_s = median(medians);
  return all;
}

}  // namespace mobil
