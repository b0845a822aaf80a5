// No damping is measured by every row of energy; here is too much of it.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "demo/lab/stress/stress.h"
#include "demo/lab/stress/stress_bellies.h"
#include "demo/lab/stress/stress_limits.h"

namespace mobil {
namespace {

/// The damped motion of a shaken free belly in lanes.
struct Decay {
  double worst_rise = 0;  // largest energy after a tick over the one before it
  double left = 0;        // last energy over the first
};

Result<Decay> decay(const MuscleOptions& options, Method method, int ticks) {
  auto made = make_muscle_template(spindle({2, 2, 8}), Material{}, options);
  if (!made) return tl::unexpected(made.error());
  Bellies bellies(std::move(*made));
  make_sixteen_sizes(bellies);
  shake(bellies, 1e-3F);
  std::uint32_t substeps = 4;
  if (method == Method::caa) {
    if (auto ok = bellies.solve_by(method, Mass::lumped, stress_tick_s / substeps); !ok)
      return tl::unexpected(ok.error());
  } else {
    const auto within = substeps_of(bellies, stress_tick_s);
    if (!within) return tl::unexpected(within.error());
    substeps = *within;
    bellies.scratch.resize(scratch_floats(bellies.muscle, method) / lane_count);
  }
  const EndTraction<Lanes<float>> slack{};
  Decay result;
  std::array<double, lane_count> first{}, last{};
  for (int tick = 0; tick < ticks; ++tick) {
    bellies.tick(slack, substeps, static_cast<float>(stress_tick_s));
    for (std::size_t l = 0; l < lane_count; ++l) {
      const double energy = bellies.energy_j(l);
      if (tick == 0) {
        first[l] = last[l] = energy;
        continue;
      }
      // below some 1e-9 of the first energy what is left is rounding
      const double rise = (energy - last[l]) / (last[l] + 1e-9 * first[l]);
      if (!(rise <= result.worst_rise)) result.worst_rise = rise;
      last[l] = energy;
      if (!(energy / first[l] <= result.left)) result.left = energy / first[l];
    }
    if (tick > 0 && tick + 1 < ticks) result.left = 0;
  }
  return result;
}

MuscleOptions with(double damping_per_s, double stiffness_damping_s) {
  MuscleOptions options{FarEnd::free, damping_per_s, 0.5, 2};
  options.stiffness_damping_s = stiffness_damping_s;
  return options;
}

}  // namespace

Result<void> stress_damping(StressRun& run) {
  for (const Method method : {Method::ecd, Method::caa}) {
    const auto name = method_name[static_cast<std::size_t>(method)];
    for (const auto& [alpha, beta] : {std::pair{8.0, 0.0}, std::pair{1000.0, 0.0}, std::pair{0.0, 0.001},
                                      std::pair{0.0, 0.03}, std::pair{1000.0, 0.03}}) {
      if (run.quick && beta > 0.01) continue;  // thousands of substeps a tick
      const auto result = decay(with(alpha, beta), method, run.quick ? 20 : 60);
      if (!result) return tl::unexpected(result.error());
      run.at_most(
          fmt::format("sixteen sizes shaken, by {}, mass damping {} 1/s, stiffness damping {} s", name, alpha, beta),
          "largest rise of energy from tick to tick, in parts of itself", 0.01, result->worst_rise,
          "damping takes energy away; rounding where 1e-9 of it is left",
          fmt::format("{:.2g} of the first is left", result->left));
    }
  }
  WorstProbe worst;
  const HexahedralMesh mesh = spindle({2, 2, 8});
  const auto terms = assemble(mesh, Material{});
  if (!terms) return tl::unexpected(terms.error());
  double least_s = 1e300, rise = 0;
  for (const double beta : {1e-4, 1e-3, 1e-2, 0.1, 1.0}) {
    const auto probe =
        probe_limit(mesh, *terms, {.method = Method::ecd, .end = FarEnd::free, .stiffness_damping_s = beta}, 200);
    if (!probe) return tl::unexpected(probe.error());
    worst.take(*probe);
    least_s = std::min(least_s, probe->limit_s);
    // the fastest mode alone keeps its size at the limit; nothing grows
    if (!(probe->drift_below <= rise)) rise = probe->drift_below;
  }
  run.at_most(fmt::format("stiffness damping of 0.0001 to 1 s in double at {} of the critical step", just_below),
              "change of energy in parts of the first", 1, rise, "it falls, to nothing at the least",
              fmt::format("least critical step {:.2g} s", least_s));
  run.at_least(fmt::format("stiffness damping of 0.0001 to 1 s, at {} of it", just_above),
               "growth of kinetic energy in 600 steps", 10, worst.growth_above,
               "overdamped, the fastest mode grows by 0.2 % and more a step");
  constexpr double none = std::numeric_limits<double>::quiet_NaN(), endless = std::numeric_limits<double>::infinity();
  std::size_t accepted = 0, asked = 0;
  for (const double bad : {-1.0, 1001.0, none, endless, -endless}) {
    MuscleOptions foundation{FarEnd::held, 0, 1, 1};
    foundation.foundation_hz = bad;
    for (const MuscleOptions& options : {with(bad, 0), with(0, bad), foundation}) {
      ++asked;
      if (make_muscle_template(spindle({1, 1, 2}), Material{}, options)) ++accepted;
    }
  }
  run.at_most("damping of either kind or a foundation that is negative, too large, no number, infinite", "not refused",
              0, static_cast<double>(accepted), "it would make energy, or nothing would be left of the motion",
              fmt::format("{} refused", asked - accepted));
  return {};
}

}  // namespace mobil
