// Very many steps: does the energy of free bellies stay?

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "demo/lab/stress/stress.h"
#include "demo/lab/stress/stress_bellies.h"
#include "demo/lab/stress/stress_limits.h"

namespace mobil {

Result<void> stress_energy_single(StressRun& run) {
  auto made = make_muscle_template(spindle({2, 2, 8}), Material{}, {FarEnd::held, 0, 0.5, 2});
  if (!made) return tl::unexpected(made.error());
  Bellies bellies(std::move(*made));
  make_sixteen_sizes(bellies);
  shake(bellies, 0.005F);
  const auto substeps = substeps_of(bellies, stress_tick_s);
  if (!substeps) return tl::unexpected(substeps.error());
  const auto dt = static_cast<float>(stress_tick_s / *substeps);
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
      if (!(change <= worst)) worst = change;
    }
    if (done < 0.1 * steps) after_a_tenth = worst;
    if (static_cast<std::uint64_t>(done) % 50000 == 0) run.progress(done / steps);
  }
  run.add({.tried = fmt::format("{:.0e} explicit steps of {:.2f} ms in single precision, sixteen bellies of 81 nodes, "
                                "at most 0.9 of their critical steps",
                                steps, 1e3 * static_cast<double>(dt)),
           .quantity = "largest change of energy in parts of itself",
           .bound = 1e-3,
           .reason = "conserved exactly but for rounding, which walks at random: ten times what was measured",
           .value = worst,
           .detail = fmt::format("{:.2g} in the first tenth", after_a_tenth)});
  return {};
}

Result<void> stress_energy_double(StressRun& run) {
  const HexahedralMesh mesh = spindle({1, 1, 4});
  const auto terms = assemble(mesh, Material{});
  if (!terms) return tl::unexpected(terms.error());
  const int steps = run.quick ? 20000 : 1'000'000;
  double part = 0;
  for (const Method method : {Method::ecd, Method::icd, Method::caa}) {
    ReferenceOptions options{.method = method, .end = FarEnd::free};
    options.mass = method == Method::ecd ? Mass::lumped : Mass::consistent;
    options.dt_s = 0.9 * critical_step(*terms, 1, 1, {FarEnd::free, options.mass});
    auto belly = ReferenceBelly::make(mesh, *terms, options);
    if (!belly) return tl::unexpected(belly.error());
    shake(*belly, mesh.cells, FarEnd::free, 0.005);
    const ReferenceLoad none{};
    belly->step(none, none);
    const auto energy = [&] {
      const auto report = belly->report();
      return report.kinetic_energy_j + report.strain_energy_j;
    };
    const double first = energy();
    double worst = 0;
    for (int s = 0; s < steps; ++s) {
      belly->step(none, none);
      if (s % 100 != 0) continue;
      const double change = std::fabs(energy() / first - 1);
      if (!(change <= worst)) worst = change;
      if (s % 10000 == 0) run.progress((part + static_cast<double>(s) / steps) / 3);
    }
    ++part;
    run.add({.tried = fmt::format("{} steps of {:.2f} ms in double by {}, a free belly of 20 nodes", steps,
                                  1e3 * options.dt_s, method_name[static_cast<std::size_t>(method)]),
             .quantity = "largest change of energy in parts of itself",
             .bound = 1e-11,
             .reason = "conserved exactly but for rounding: the square root of the steps times 1e-16, times 100",
             .value = worst});
  }
  return {};
}

}  // namespace mobil
