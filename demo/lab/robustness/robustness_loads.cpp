// Sudden loads, loads of a single step, and loads at the resonance, compared with theory; and conservation of energy
// over very many steps.

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <utility>

#include "demo/lab/robustness/robustness_bellies.h"

namespace mobil {
namespace {

constexpr double load_step_s = 0.001;  // about half of the critical step

/// A straight block with a free end, which a load along z only stretches: sixteen identical lanes, and one in double.
struct Pair {
  Bellies lanes;
  ReferenceBelly reference;
  double at_rest_m;  // elongation under 1 N at rest
};

Pair make_pair(Method method, double stiffness_damping_s) {
  MuscleOptions options{FarEnd::free, 0, 1, 1};
  options.stiffness_damping_s = stiffness_damping_s;
  const HexahedralMesh mesh = make_block({2, 2, 8}, 0.015).value();
  Bellies lanes(must(make_muscle_template(mesh, Material{}, options)));
  lanes.stiffness = Stiffness::shared;
  const Mass mass = method == Method::implicit_central ? Mass::consistent : Mass::lumped;
  if (method == Method::explicit_central) {
    lanes.scratch.resize(scratch_floats(lanes.muscle, method) / lane_count);
  } else {
    lanes.solve_by(method, mass, load_step_s);
  }
  auto reference = must(ReferenceBelly::make(mesh, lanes.muscle.terms,
                                             {.method = method,
                                              .mass = mass,
                                              .end = FarEnd::free,
                                              .dt_s = load_step_s,
                                              .stiffness_damping_s = stiffness_damping_s}));
  auto settled = must(ReferenceBelly::make(mesh, lanes.muscle.terms, {.method = Method::statics, .end = FarEnd::free}));
  settled.start({{0, 0, 1}, {}, {}});
  return Pair{std::move(lanes), std::move(reference), settled.report().elongation_m};
}

/// Copies the reference's state to the lanes.
void copy_state(Pair& pair) {
  const auto v = pair.reference.velocity();
  for (std::size_t i = 0; i < v.size(); ++i) {
    for (float& x : pair.lanes.velocity[i].lane) x = static_cast<float>(v[i]);
  }
}

void step(Pair& pair, double from_n, double to_n) {
  EndTraction<Lanes<float>> pull{};
  for (std::size_t l = 0; l < lane_count; ++l) {
    pull.from_n.z[l] = static_cast<float>(from_n);
    pull.to_n.z[l] = static_cast<float>(to_n);
  }
  pair.lanes.tick(pull, 1, static_cast<float>(load_step_s));
  pair.reference.step({{0, 0, from_n}, {}, {}}, {{0, 0, to_n}, {}, {}});
}

/// Returns the lowest frequency that a load along z excites (1/s), in the time of central differences. The block is
/// pulled and released, with so much stiffness damping that after a second only this frequency remains.
double lowest_stretch(const HexahedralMesh& mesh, const StiffnessTerms& terms) {
  auto belly = must(ReferenceBelly::make(mesh, terms,
                                         {.method = Method::explicit_central,
                                          .end = FarEnd::free,
                                          .dt_s = load_step_s,
                                          .damping_per_s = 0,
                                          .stiffness_damping_s = 2e-4}));
  const ReferenceLoad none{};
  for (int s = 0; s < 200; ++s) belly.step({{0, 0, s / 200.0}, {}, {}}, {{0, 0, (s + 1) / 200.0}, {}, {}});
  double last = 0, first_crossing = 0, crossing = 0;
  int crossings = 0;
  for (int s = 0; s < 4000; ++s) {
    belly.step(none, none);
    const double now = belly.report().elongation_m;
    if (s > 1000 && last < 0 && now >= 0) {
      crossing = (s - now / (now - last)) * load_step_s;
      if (crossings++ == 0) first_crossing = crossing;
    }
    last = now;
  }
  if (crossings < 3) throw Stopped("the belly does not ring");
  return 2 * std::numbers::pi * (crossings - 1) / (crossing - first_crossing);
}

}  // namespace

void robustness_step_load(RobustnessRun& run) {
  for (const Method method : {Method::explicit_central, Method::implicit_central, Method::newmark}) {
    auto pair = make_pair(method, 0);
    pair.reference.start({{0, 0, 1}, {}, {}});
    copy_state(pair);
    double most = 0, least = 0, in_double = 0;
    const int steps = run.quick ? 1000 : 20000;
    for (int s = 0; s < steps; ++s) {
      step(pair, 1, 1);
      const double now = static_cast<double>(pair.lanes.report.elongation_m[3]) / pair.at_rest_m;
      if (!(now <= most)) most = now;
      if (!(now >= least)) least = now;
      in_double = std::max(in_double, pair.reference.report().elongation_m / pair.at_rest_m);
    }
    const std::string tried =
        fmt::format("1 N all at once, undamped, {} steps by {}", steps, method_name[static_cast<std::size_t>(method)]);
    run.at_most(tried, "largest elongation in parts of the static one", 2.001, most,
                "2: every mode's part of the displacement under its own load swings between 0 and twice its rest",
                fmt::format("in double {:.6g}", in_double));
    run.at_least(tried, "least elongation in parts of the static one", -0.001, least, "0, likewise");
  }
}

void robustness_resonance(RobustnessRun& run) {
  auto probe = make_pair(Method::explicit_central, 0);
  const auto omega = lowest_stretch(probe.lanes.muscle.mesh, probe.lanes.muscle.terms);
  const double period = 2 * std::numbers::pi / omega;
  for (const Method method : {Method::explicit_central, Method::newmark}) {
    const auto name = method_name[static_cast<std::size_t>(method)];
    // a load at its own frequency in the method's time: central differences ring faster, mean acceleration slower
    const double exact = 2 / load_step_s * std::sin(omega * load_step_s / 2);
    const double own =
        method == Method::explicit_central ? omega : 2 / load_step_s * std::atan(exact * load_step_s / 2);
    auto undamped = make_pair(method, 0);
    const int periods = run.quick ? 8 : 32;
    const int steps = static_cast<int>(2 * periods * period / load_step_s);
    double early = 0, late = 0, early_double = 0, late_double = 0;
    for (int s = 0; s < steps; ++s) {
      step(undamped, std::sin(own * s * load_step_s), std::sin(own * (s + 1) * load_step_s));
      const double now = std::fabs(static_cast<double>(undamped.lanes.report.elongation_m[3]));
      const double in_double = std::fabs(undamped.reference.report().elongation_m);
      (s < steps / 2 ? early : late) = std::max(s < steps / 2 ? early : late, now);
      (s < steps / 2 ? early_double : late_double) = std::max(s < steps / 2 ? early_double : late_double, in_double);
    }
    run.at_most(
        fmt::format("a sine of 1 N at the lowest stretch, {:.2f} Hz, undamped by {}", own / (2 * std::numbers::pi),
                    name),
        fmt::format("distance from 2 of the amplitude after {} periods over that after {}", 2 * periods, periods), 0.02,
        std::fabs(late / early - 2), "it grows linearly; other modes and the steps' coarseness add a per cent",
        fmt::format("in double {:.3g}; {:.3g} times the static elongation is reached",
                    std::fabs(late_double / early_double - 2), late / undamped.at_rest_m));

    constexpr double beta = 1e-3;
    const double ratio = 0.5 * beta * omega;
    const double bound = 1 / std::tanh(std::numbers::pi * ratio / (2 * std::sqrt(1 - ratio * ratio)));
    for (const bool square : {false, true}) {
      auto damped = make_pair(method, beta);
      double most = 0, in_double = 0;
      const auto load = [&](int s) {
        const double wave = std::sin(own * s * load_step_s);
        return square ? (wave >= 0 ? 1.0 : -1.0) : wave;
      };
      for (int s = 0; s < (run.quick ? 2000 : 8000); ++s) {
        step(damped, load(s), load(s + 1));
        most = std::max(most, std::fabs(static_cast<double>(damped.lanes.report.elongation_m[3])));
        in_double = std::max(in_double, std::fabs(damped.reference.report().elongation_m));
      }
      run.at_most(fmt::format("a {} of 1 N at the lowest stretch, {:.2g} of critical damping, by {}",
                              square ? "square wave" : "sine", ratio, name),
                  "largest elongation in parts of the static one", 1.02 * bound, most / damped.at_rest_m,
                  fmt::format("no load within 1 N drives a mode beyond coth(pi/2 xi/sqrt(1 - xi^2)) = {:.4g} of its "
                              "rest, and the lowest has the least damping; 2 % for the step's length",
                              bound),
                  fmt::format("in double {:.4g}", in_double / damped.at_rest_m));
    }
    run.progress(method == Method::explicit_central ? 0.5 : 1.0);
  }
}

void robustness_energy_single(RobustnessRun& run) {
  Bellies bellies(must(make_muscle_template(spindle({2, 2, 8}), Material{}, {FarEnd::held, 0, 0.5, 2})));
  make_sixteen_sizes(bellies);
  shake(bellies, 0.005F);
  const auto substeps = substeps_of(bellies, robustness_tick_s);
  const auto dt = static_cast<float>(robustness_tick_s / substeps);
  const EndDrive<Lanes<float>> still{};
  bellies.tick({FarEnd::held, still}, 1, dt);
  std::array<double, lane_count> first{};
  for (std::size_t l = 0; l < lane_count; ++l) first[l] = bellies.energy_j(l);
  constexpr std::uint32_t at_once = 1000;
  const double steps = run.quick ? 5e4 : 1e7;
  double worst = 0, after_a_tenth = 0;
  for (double done = 0; done < steps; done += at_once) {
    bellies.tick({FarEnd::held, still}, at_once, at_once * dt);
    for (std::size_t l = 0; l < lane_count; ++l) {
      const double change = std::fabs(bellies.energy_j(l) / first[l] - 1);
      keep_worst(worst, change);
    }
    if (done < 0.1 * steps) after_a_tenth = worst;
    if (static_cast<std::uint64_t>(done) % 50000 == 0) run.progress(done / steps);
  }
  run.at_most(fmt::format("{:.0e} explicit steps of {:.2f} ms in single precision, sixteen bellies of 81 nodes, "
                          "at most 0.9 of their critical steps",
                          steps, 1e3 * static_cast<double>(dt)),
              "largest change of energy in parts of itself", 1e-3, worst,
              "conserved exactly but for rounding, which walks at random: ten times what was measured",
              fmt::format("{:.2g} in the first tenth", after_a_tenth));
}

}  // namespace mobil
