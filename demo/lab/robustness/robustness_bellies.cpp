#include "demo/lab/robustness/robustness_bellies.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "assets/fem/critical_step.h"
#include "demo/program/must.h"

namespace mobil {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

double total(const ReferenceBelly& belly) {
  const auto report = belly.report();
  return report.kinetic_energy_j + report.strain_energy_j;
}

template <class F>
void for_each_moving(const Cells& cells, FarEnd end, F&& f) {
  for (std::uint32_t n = 0; n < node_count(cells); ++n) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (moves(cells, end, n, c)) f(3 * std::size_t{n} + c);
    }
  }
}

}  // namespace

LimitProbe probe_limit(const HexahedralMesh& mesh, const StiffnessTerms& terms, ReferenceOptions options,
                       std::uint32_t steps) {
  const Mass mass = options.method == Method::implicit_central ? Mass::consistent : Mass::lumped;
  LimitProbe probe{critical_step(terms, options.across, options.along,
                                 {options.end, mass, options.stiffness_damping_s, options.foundation_1_s}),
                   0, 0};
  for (const bool above : {false, true}) {
    options.dt_s = (above ? just_above : just_below) * probe.limit_s;
    auto belly = must(ReferenceBelly::make(mesh, terms, options));
    shake(belly, mesh.cells, options.end, 1e-3);
    const ReferenceLoad none{};
    belly.step(none, none);
    const double first = total(belly), first_kinetic = belly.report().kinetic_energy_j;
    for (std::uint32_t step = 1; step < (above ? 600 : steps); ++step) {
      belly.step(none, none);
      if (above || step % 10 != 0) continue;
      const double change = std::fabs(total(belly) / first - 1);
      if (!(change <= probe.drift_below)) probe.drift_below = change;
      if (std::isnan(change)) break;
    }
    if (above) probe.growth_above = belly.finite() ? belly.report().kinetic_energy_j / first_kinetic : 1e300;
  }
  return probe;
}

void WorstProbe::take(const LimitProbe& probe) {
  ++tried;
  const bool sound = probe.limit_s > 0 && std::isfinite(probe.limit_s);
  if (!(probe.drift_below <= drift_below)) drift_below = probe.drift_below;
  if (!(probe.growth_above >= growth_above)) growth_above = probe.growth_above;
  if (!sound) drift_below = growth_above = nothing;
}

void add_rows(RobustnessRun& run, const std::string& tried, const WorstProbe& worst) {
  run.at_most(tried + fmt::format(", in double at {} of the critical step", just_below),
              "change of energy in parts of itself", 1e-8, worst.drift_below,
              "conserved exactly below the limit; rounding is amplified by 1/(1 - 0.999^2) = 500",
              fmt::format("{} bellies", worst.tried));
  run.at_least(tried + fmt::format(", at {} of it", just_above), "growth of kinetic energy in 600 steps", 1e6,
               worst.growth_above, "at least e^0.15 a step; the computed limit is at most 0.1 % low");
}

Bellies::Bellies(MuscleTemplate shape)
    : muscle(std::move(shape)),
      displacement(nodal_width(muscle.mesh.cells)),
      velocity(nodal_width(muscle.mesh.cells)),
      scratch(scratch_floats(muscle, Method::explicit_central) / lane_count) {
  for (std::size_t l = 0; l < lane_count; ++l) scale.across[l] = scale.along[l] = 1;
}

void Bellies::solve_by(Method method, Mass mass, double dt_s) {
  solver = must(make_belly_solver(muscle, method, mass, dt_s));
  scratch.resize(scratch_floats(muscle, method) / lane_count);
}

void Bellies::tick(const FarFaceDrive& end, std::uint32_t substeps, float tick_s) {
  const BellyBlock block{muscle, scale,     displacement.data()->lane,       velocity.data()->lane,
                         report, stiffness, frame ? &frame.value() : nullptr};
  float* const memory = scratch.empty() ? nullptr : scratch.data()->lane;
  if (solver) {
    deform_implicit(block, *solver, end, substeps, tick_s, memory);
  } else {
    deform_explicit(block, end, substeps, tick_s, memory);
  }
}

double Bellies::energy_j(std::size_t lane) const {
  return static_cast<double>(report.kinetic_energy_j[lane]) + static_cast<double>(report.strain_energy_j[lane]);
}

bool Bellies::finite(std::size_t lane) const {
  const auto sound = [lane](const Lanes<float>& x) { return std::isfinite(x[lane]); };
  return std::ranges::all_of(displacement, sound) && std::ranges::all_of(velocity, sound);
}

double Bellies::reach_m(std::size_t lane) const {
  float most = 0;
  for (const auto& x : displacement) {
    if (!(std::fabs(x[lane]) <= most)) most = std::fabs(x[lane]);
    if (std::isnan(most)) break;
  }
  return static_cast<double>(most);
}

void make_sixteen_sizes(Bellies& bellies) {
  for (std::size_t l = 0; l < lane_count; ++l) {
    bellies.scale.across[l] = 0.8F + 0.03F * static_cast<float>(l);
    bellies.scale.along[l] = 0.85F + 0.02F * static_cast<float>(7 * l % lane_count);
  }
}

double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random()) / 4294967295.0;
}

void shake(Bellies& bellies, float size_m, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto size = static_cast<double>(size_m);
  for_each_moving(bellies.muscle.mesh.cells, bellies.muscle.options.far_end, [&](std::size_t at) {
    const auto value = static_cast<float>(uniform(random, -size, size));
    for (float& x : bellies.displacement[at].lane) x = value;
  });
}

void shake(ReferenceBelly& belly, const Cells& cells, FarEnd end, double size_m, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto u = belly.displacement();
  for_each_moving(cells, end, [&](std::size_t at) { u[at] = uniform(random, -size_m, size_m); });
}

std::uint32_t substeps_of(const Bellies& bellies, double tick_s) {
  std::uint32_t most = 1;
  for (std::size_t l = 0; l < lane_count; ++l) {
    const auto limit = must(critical_step(bellies.muscle.critical_steps, static_cast<double>(bellies.scale.across[l]),
                                          static_cast<double>(bellies.scale.along[l])));
    most = std::max(most, substeps_within(limit, tick_s));
  }
  return most;
}

std::size_t different_lanes(const Lanes<float>& a, const Lanes<float>& b, std::size_t but_lane) {
  std::size_t different = 0;
  for (std::size_t l = 0; l < lane_count; ++l) {
    if (l != but_lane && std::bit_cast<std::uint32_t>(a.lane[l]) != std::bit_cast<std::uint32_t>(b.lane[l]))
      ++different;
  }
  return different;
}

std::size_t different_words(const Bellies& a, const Bellies& b, std::size_t but_lane) {
  std::size_t different = 0;
  const auto count = [&](const std::vector<Lanes<float>>& x, const std::vector<Lanes<float>>& y) {
    for (std::size_t i = 0; i < x.size(); ++i) different += different_lanes(x[i], y[i], but_lane);
  };
  count(a.displacement, b.displacement);
  count(a.velocity, b.velocity);
  return different;
}

HexahedralMesh spindle(const Cells& cells) {
  constexpr std::array<LatticeStation, 3> stations = {
      {{0, 0, 0, 0.014F, 0.016F}, {0.5F, 0.006F, -0.004F, 0.021F, 0.018F}, {1, 0, 0, 0.013F, 0.012F}}};
  return bend_block(cells, stations, 0.12).value();
}

}  // namespace mobil
