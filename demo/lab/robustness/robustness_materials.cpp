// Materials at the ends of their ranges, and extreme damping.

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "demo/lab/robustness/robustness_bellies.h"

namespace mobil {
namespace {

std::string_view name(Element element) {
  return element_name[static_cast<std::size_t>(element)];
}

/// Returns the sideways displacement of a far face under 1 N sideways, m.
double flexibility(const HexahedralMesh& mesh, const StiffnessTerms& terms) {
  auto belly = must(ReferenceBelly::make(mesh, terms, {.method = Method::statics, .end = FarEnd::free}));
  belly.start({{1, 0, 0}, {}, {}});
  return belly.displacement()[3 * std::size_t{insertion_centre(mesh.cells).front()}];
}

/// Returns the motion of sixteen shaken sizes over some ticks, in steps that scale with the material's period.
Bellies ring(const Material& material, double dt_s, Method method, int ticks) {
  Bellies bellies(must(make_muscle_template(spindle({2, 2, 8}), material, {FarEnd::held, 0, 0.5, 2})));
  make_sixteen_sizes(bellies);
  shake(bellies, 1e-3F);
  if (method != Method::explicit_central) bellies.solve_by(method, Mass::consistent, dt_s);
  const EndDrive<Lanes<float>> still{};
  for (int tick = 0; tick < ticks; ++tick) bellies.tick({FarEnd::held, still}, 8, static_cast<float>(8 * dt_s));
  return bellies;
}

std::size_t different_displacements(const Bellies& a, const Bellies& b) {
  std::size_t different = 0;
  for (std::size_t i = 0; i < a.displacement.size(); ++i) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      if (!(a.displacement[i][l] == b.displacement[i][l])) ++different;
    }
  }
  return different;
}

}  // namespace

void robustness_poisson(RobustnessRun& run) {
  const HexahedralMesh mesh = spindle({2, 2, 8});
  constexpr std::array<double, 6> ratios = {-0.99, 0.0, 0.3333, 0.49, 0.499, 0.4999};
  std::array<std::array<double, ratios.size()>, all_elements.size()> bend{};
  for (std::size_t e = 0; e < all_elements.size(); ++e) {
    WorstProbe worst;
    double drift = 0;
    for (std::size_t r = 0; r < ratios.size(); ++r) {
      const Material material{1000, 10000, ratios[r]};
      const auto terms = must(assemble(mesh, material, all_elements[e]));
      const auto probe =
          probe_limit(mesh, terms, {.method = Method::explicit_central, .end = FarEnd::free}, run.quick ? 200 : 3000);
      worst.take(probe);
      bend[e][r] = flexibility(mesh, terms);

      MuscleOptions options{FarEnd::held, 0, 0.5, 2};
      options.element = all_elements[e];
      Bellies bellies(must(make_muscle_template(mesh, material, options)));
      make_sixteen_sizes(bellies);
      shake(bellies, 1e-3F);
      const auto substeps = substeps_of(bellies, robustness_tick_s);
      const EndDrive<Lanes<float>> still{};
      bellies.tick({FarEnd::held, still}, substeps, static_cast<float>(robustness_tick_s));
      std::array<double, lane_count> first{};
      for (std::size_t l = 0; l < lane_count; ++l) first[l] = bellies.energy_j(l);
      for (int tick = 0; tick < (run.quick ? 10 : 120); ++tick) {
        bellies.tick({FarEnd::held, still}, substeps, static_cast<float>(robustness_tick_s));
      }
      for (std::size_t l = 0; l < lane_count; ++l) {
        const double change = std::fabs(bellies.energy_j(l) / first[l] - 1);
        if (!(change <= drift)) drift = change;
      }
      run.progress(static_cast<double>(e * ratios.size() + r + 1) / (all_elements.size() * ratios.size()));
    }
    const std::string tried = fmt::format("{} elements, Poisson's ratio -0.99 to 0.4999", name(all_elements[e]));
    add_rows(run, tried, worst);
    run.at_most(tried + ", sixteen sizes in lanes at the substeps that the engine chooses",
                "change of energy in parts of itself", 1e-4, drift,
                "conserved; single precision, ten times what was measured");
  }
  for (std::size_t e = 1; e < all_elements.size(); ++e) {
    const double softer = bend[e][5] / bend[e][3];
    run.at_least(fmt::format("{} elements bent sideways, Poisson's ratio 0.49 and 0.4999", name(all_elements[e])),
                 "flexibility at 0.4999 in parts of that at 0.49", 0.9, softer,
                 "bending depends on Young's modulus alone, shear by 0.7 %, clamping by some per cent; a locking "
                 "element loses most of it",
                 fmt::format("fully integrated elements {:.2g}, which lock and say so in their documentation",
                             bend[0][5] / bend[0][3]));
  }
  std::size_t accepted = 0;
  constexpr std::array<double, 6> refused = {
      -1.0, 0.49991, 0.5, 1.0, std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()};
  for (const double ratio : refused) {
    if (const auto terms = assemble(mesh, {1000, 10000, ratio}); terms) ++accepted;
  }
  run.at_most("Poisson's ratio of -1, above 0.4999, no number, infinite", "not refused", 0,
              static_cast<double>(accepted), "no stiffness, or one that no precision holds");
}

/// Compares materials whose square roots of stiffness over mass are successive powers of two. In steps of the same
/// fraction of their periods they ring with the same numbers.
void robustness_young(RobustnessRun& run) {
  constexpr int lowest = -3, highest = 4;
  const int ticks = run.quick ? 5 : 60;
  const auto usual_terms = must(assemble(spindle({2, 2, 8}), Material{}));
  constexpr double usual_dt = 0.00125;
  const double usual_limit = critical_step(usual_terms, 1, 1, FarEnd::held);
  for (const Method method : {Method::explicit_central, Method::implicit_central, Method::newmark}) {
    const double dt = method == Method::implicit_central ? usual_dt / 2 : usual_dt;
    const auto usual = ring(Material{}, dt, method, ticks);
    std::size_t different = 0, still = 0;
    double limit_error = 0;
    for (int power = lowest; power <= highest; ++power) {
      Material material;
      material.young_pa *= std::ldexp(1.0, 4 * power);
      const int longer = -2 * power;
      const auto other = ring(material, std::ldexp(dt, longer), method, ticks);
      different += different_displacements(usual, other);
      if (!(other.reach_m(0) > 0)) ++still;
      const auto terms = must(assemble(spindle({2, 2, 8}), material));
      const double limit = critical_step(terms, 1, 1, FarEnd::held);
      const double error = std::fabs(limit / std::ldexp(usual_limit, longer) - 1);
      if (!(error <= limit_error)) limit_error = error;
      run.progress(static_cast<double>(power - lowest + 1) / (highest - lowest + 1));
    }
    const std::string tried = "Young's modulus from 2.6 Pa to 0.7 GPa, in factors of 16, steps scaled with the period";
    run.at_most(
        fmt::format("{}, sixteen sizes by {}", tried, method_name[static_cast<std::size_t>(method)]),
        "displacements that are not the same number", 0, static_cast<double>(different + still),
        "all of the arithmetic scales by powers of two, unless something over- or underflows",
        fmt::format("of {}", usual.displacement.size() * lane_count * static_cast<std::size_t>(highest - lowest + 1)));
    if (method != Method::explicit_central) continue;
    run.at_most(tried, "critical step against its scaling, relative", 1e-12, limit_error,
                "it goes with the square root of density over Young's modulus");
  }
  std::size_t accepted = 0;
  for (const double young : {0.0, -1.0, 0.99, 4.5e-34, 1.1e12, std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()}) {
    if (const auto terms = assemble(spindle({2, 2, 4}), {1000, young, 0.3}); terms) ++accepted;
  }
  run.at_most("Young's modulus below 1 Pa, above 1e12 Pa, no number, infinite", "not refused", 0,
              static_cast<double>(accepted), "no such material");
}

}  // namespace mobil
