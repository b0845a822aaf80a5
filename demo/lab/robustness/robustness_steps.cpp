// Steps just below and just above the critical one, and absurd ones with the method that accepts any. Too much damping.

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "assets/fem/critical_step.h"
#include "demo/lab/muscle/muscle_options.h"
#include "demo/lab/robustness/robustness_bellies.h"

namespace mobil {
namespace {

struct Block {
  std::string cells, young, damping;
};

/// Requests steps of `mobil muscle` a little below and a little above the limit that it names.
void ask_for_steps(RobustnessRun& run) {
  const std::vector<Block> blocks = {
      {"2x2x8", "10666.7", "0"}, {"1x1x1", "1e6", "0"}, {"4x4x16", "10666.7", "8"}, {"3x2x5", "200", "1000"}};
  std::size_t refused = 0, named = 0, accepted = 0, asked = 0;
  std::string example;
  for (const Block& block : blocks) {
    for (const auto* method : {"explicit-central", "implicit-central"}) {
      MuscleText text;
      text.cells = block.cells;
      text.young = block.young;
      text.damping = block.damping;
      text.method = method;
      text.seconds = "0.01";
      const auto usual = must(read_muscle_request(text));
      const double limit = *usual.critical_step_s;
      ++asked;
      text.dt = fmt::format("{:.12g}", 0.9999 * limit);
      if (read_muscle_request(text)) ++accepted;
      text.dt = fmt::format("{:.12g}", 1.0001 * limit);
      const auto above = read_muscle_request(text);
      if (above) continue;
      ++refused;
      if (above.error().message.find(fmt::format("critical step {:.4g} s", limit)) == std::string::npos) continue;
      ++named;
      example = above.error().message;
    }
  }
  run.at_most(
      fmt::format("{} blocks of `mobil muscle` by explicit-central and implicit-central at 1.0001 of the critical step",
                  asked),
      "steps not refused with the limit named, or refused at 0.9999 of it", 0,
      static_cast<double>(3 * asked - refused - named - accepted), "above it the solution grows without bound",
      fmt::format("\"{}\"", example));
}

void try_in_double(RobustnessRun& run) {
  const std::vector<HexahedralMesh> meshes = {spindle({2, 2, 8}), spindle({3, 2, 5}),
                                              make_block({1, 1, 2}, 0.01).value(), make_block({4, 3, 2}, 0.02).value()};
  for (const Method method : {Method::explicit_central, Method::implicit_central}) {
    WorstProbe worst;
    for (const HexahedralMesh& mesh : meshes) {
      const auto terms = must(assemble(mesh, Material{}));
      for (const FarEnd end : {FarEnd::held, FarEnd::sliding, FarEnd::free}) {
        for (const auto& [across, along] : {std::pair{1.0, 1.0}, std::pair{0.6, 1.4}, std::pair{1.5, 0.7}}) {
          for (const double foundation : {0.0, 300.0}) {
            const auto probe = probe_limit(
                mesh, terms,
                {.method = method, .end = end, .foundation_1_s = foundation, .across = across, .along = along},
                run.quick ? 100 : 2000);
            worst.take(probe);
          }
        }
      }
      run.progress(static_cast<double>(worst.tried) / (18.0 * static_cast<double>(meshes.size())));
    }
    const std::string tried = fmt::format("{} bellies by {}, held, sliding and free, braced or not, three sizes",
                                          worst.tried, method_name[static_cast<std::size_t>(method)]);
    add_rows(run, tried, worst);
  }
}

/// Tries the tabulated limit, which is that of individuals, in the kernel.
void try_in_lanes(RobustnessRun& run) {
  double drift = 0, growth = 1e300;
  std::size_t tried = 0;
  for (const FarEnd end : {FarEnd::held, FarEnd::sliding, FarEnd::free}) {
    auto made = must(make_muscle_template(spindle({2, 2, 8}), Material{}, {end, 0, 0.4, 2.5}));
    const EndDrive<Lanes<float>> still{};
    const EndTraction<Lanes<float>> slack{};
    const FarFaceDrive drive = end == FarEnd::free ? FarFaceDrive(slack) : FarFaceDrive(end, still);
    for (const auto& [across, along] :
         {std::pair{1.0F, 1.0F}, std::pair{0.6F, 1.4F}, std::pair{1.5F, 0.7F}, std::pair{0.83F, 1.17F}}) {
      const auto limit =
          must(critical_step(made.critical_steps, static_cast<double>(across), static_cast<double>(along)));
      for (const bool above : {false, true}) {
        Bellies bellies(made);
        for (std::size_t l = 0; l < lane_count; ++l) {
          bellies.scale.across[l] = across;
          bellies.scale.along[l] = along;
        }
        shake(bellies, 1e-3F);
        const auto dt = static_cast<float>((above ? 1.015 : 0.999) * limit);
        bellies.tick(drive, 1, dt);
        const double first = bellies.energy_j(0), kinetic = static_cast<double>(bellies.report.kinetic_energy_j[0]);
        const std::uint32_t steps = above ? 600 : run.quick ? 1000 : 20000;
        bellies.tick(drive, steps, static_cast<float>(steps) * dt);
        ++tried;
        if (above) {
          const double grown =
              bellies.finite(0) ? static_cast<double>(bellies.report.kinetic_energy_j[0]) / kinetic : 1e300;
          if (!(grown >= growth)) growth = grown;
        } else {
          const double change = std::fabs(bellies.energy_j(0) / first - 1);
          if (!(change <= drift)) drift = change;
        }
      }
    }
  }
  const std::string bellies = fmt::format("{} blocks of the 81-node spindle in lanes", tried / 2);
  run.at_most(bellies + " at 0.999 of the tabulated critical step", "change of energy in parts of itself", 1e-3, drift,
              "conserved; rounding in single precision is amplified by at most 500");
  run.at_least(bellies + " at 1.015 of it", "growth of kinetic energy in 600 steps", 1e6, growth,
               "the table is at most 1 % low, which leaves at least e^0.2 a step");
}

/// Sets the range of sizes for which one solver is valid (assets/fem/belly_solver.h).
void make_sizes_of_one_solver(Bellies& bellies) {
  for (std::size_t l = 0; l < lane_count; ++l) {
    const auto part = [](std::size_t i) { return (static_cast<double>(i) - 1.5) / 1.5; };
    const double ratio = std::pow(1.06, part(l % 4)), product = std::pow(1.12, part(l / 4));
    bellies.scale.across[l] = static_cast<float>(std::sqrt(product * ratio));
    bellies.scale.along[l] = static_cast<float>(std::sqrt(product / ratio));
  }
}

/// Returns the static elongation of every lane under its load of 1 N, m.
std::array<double, lane_count> static_elongation(const Bellies& bellies, FarEnd end) {
  std::array<double, lane_count> elongation{};
  for (std::size_t l = 0; l < lane_count; ++l) {
    auto belly = must(ReferenceBelly::make(bellies.muscle.mesh, bellies.muscle.terms,
                                           {.method = Method::statics,
                                            .end = end,
                                            .across = static_cast<double>(bellies.scale.across[l]),
                                            .along = static_cast<double>(bellies.scale.along[l])}));
    belly.start({{0, 0, 1}, {}, {}});
    elongation[l] = belly.report().elongation_m;
  }
  return elongation;
}

/// Damped motion of a shaken free belly in lanes.
struct Decay {
  double worst_rise = 0;  // largest energy after a tick over the one before it
  double left = 0;        // last energy over the first
};

Decay decay(const MuscleOptions& options, Method method, int ticks) {
  Bellies bellies(must(make_muscle_template(spindle({2, 2, 8}), Material{}, options)));
  make_sixteen_sizes(bellies);
  shake(bellies, 1e-3F);
  std::uint32_t substeps = 4;
  if (method == Method::newmark) {
    bellies.solve_by(method, Mass::lumped, robustness_tick_s / substeps);
  } else {
    substeps = substeps_of(bellies, robustness_tick_s);
    bellies.scratch.resize(scratch_floats(bellies.muscle, method) / lane_count);
  }
  const EndTraction<Lanes<float>> slack{};
  Decay result;
  std::array<double, lane_count> first{}, last{};
  for (int tick = 0; tick < ticks; ++tick) {
    bellies.tick(slack, substeps, static_cast<float>(robustness_tick_s));
    for (std::size_t l = 0; l < lane_count; ++l) {
      const double energy = bellies.energy_j(l);
      if (tick == 0) {
        first[l] = last[l] = energy;
        continue;
      }
      // below some 1e-9 of the first energy only rounding is left
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

void robustness_steps(RobustnessRun& run) {
  ask_for_steps(run);
  try_in_double(run);
  try_in_lanes(run);
}

void robustness_newmark(RobustnessRun& run) {
  const int steps = run.quick ? 50 : 1000;
  double part = 0;
  for (const Mass mass : {Mass::lumped, Mass::consistent}) {
    for (const bool alike : {true, false}) {
      double most = 0, energy = 0, in_double = 0;
      constexpr std::array<double, 5> absurd = {0.05, 0.5, 5, 50, 100};
      for (const double dt : absurd) {
        Bellies bellies(must(make_muscle_template(spindle({2, 2, 8}), Material{}, {FarEnd::free, 0, 0.5, 2})));
        if (alike) {
          bellies.stiffness = Stiffness::shared;
        } else {
          make_sizes_of_one_solver(bellies);
        }
        bellies.solve_by(Method::newmark, mass, dt);
        const auto rest = static_elongation(bellies, FarEnd::free);
        EndTraction<Lanes<float>> pull{};
        for (std::size_t l = 0; l < lane_count; ++l) pull.from_n.z[l] = pull.to_n.z[l] = 1;
        auto reference =
            must(ReferenceBelly::make(bellies.muscle.mesh, bellies.muscle.terms,
                                      {.method = Method::newmark, .mass = mass, .end = FarEnd::free, .dt_s = dt}));
        const ReferenceLoad load{{0, 0, 1}, {}, {}};
        const double own = alike ? rest[0] : 1e300;
        for (int step = 0; step < steps; ++step) {
          bellies.tick(pull, 1, static_cast<float>(dt));
          for (std::size_t l = 0; l < lane_count; ++l) {
            const double of_static = static_cast<double>(bellies.report.elongation_m[l]) / rest[l];
            if (!(of_static <= most)) most = of_static;
            const double strain = static_cast<double>(bellies.report.strain_energy_j[l]) / (0.5 * rest[l]);
            if (!(strain <= energy)) energy = strain;
          }
          if (!alike || step >= 200) continue;
          reference.step(load, load);
          const double of_static = reference.report().elongation_m / own;
          if (!(of_static <= in_double)) in_double = of_static;
        }
        run.progress(++part / (4.0 * absurd.size()));
      }
      const std::string tried = fmt::format(
          "{} mass, {}, {} steps of 0.05 to 100 s each (critical 2 ms), 1 N all at once, undamped",
          mass_name[static_cast<std::size_t>(mass)], alike ? "all alike" : "sixteen sizes of one solver", steps);
      run.at_most(tried, "largest elongation in parts of the static one", alike ? 2.01 : 2.2, most,
                  alike ? "2 exactly: the method conserves energy and work at any step"
                        : "2, and what eight sweeps on another body's factor leave",
                  alike ? fmt::format("in double {:.6g}", in_double) : std::string());
      run.at_most(tried, "largest strain energy in parts of the static one", alike ? 4.04 : 4.4, energy,
                  "4, by the same invariant: it bounds every part of the motion");
    }
  }
}

void robustness_damping(RobustnessRun& run) {
  for (const Method method : {Method::explicit_central, Method::newmark}) {
    const auto name = method_name[static_cast<std::size_t>(method)];
    for (const auto& [alpha, beta] : {std::pair{8.0, 0.0}, std::pair{1000.0, 0.0}, std::pair{0.0, 0.001},
                                      std::pair{0.0, 0.03}, std::pair{1000.0, 0.03}}) {
      if (run.quick && beta > 0.01) continue;  // thousands of substeps a tick
      const auto result = decay(with(alpha, beta), method, run.quick ? 20 : 60);
      run.at_most(
          fmt::format("sixteen sizes shaken, by {}, mass damping {} 1/s, stiffness damping {} s", name, alpha, beta),
          "largest rise of energy from tick to tick, in parts of itself", 0.01, result.worst_rise,
          "damping takes energy away; rounding where 1e-9 of it is left",
          fmt::format("{:.2g} of the first is left", result.left));
    }
  }
  WorstProbe worst;
  const HexahedralMesh mesh = spindle({2, 2, 8});
  const auto terms = must(assemble(mesh, Material{}));
  double min_s = 1e300, rise = 0;
  for (const double beta : {1e-4, 1e-3, 1e-2, 0.1, 1.0}) {
    const auto probe = probe_limit(
        mesh, terms, {.method = Method::explicit_central, .end = FarEnd::free, .stiffness_damping_s = beta}, 200);
    worst.take(probe);
    min_s = std::min(min_s, probe.limit_s);
    // the fastest mode alone keeps its size at the limit; nothing grows
    if (!(probe.drift_below <= rise)) rise = probe.drift_below;
  }
  run.at_most(fmt::format("stiffness damping of 0.0001 to 1 s in double at {} of the critical step", just_below),
              "change of energy in parts of the first", 1, rise, "it falls, to nothing at the least",
              fmt::format("least critical step {:.2g} s", min_s));
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
}

}  // namespace mobil
