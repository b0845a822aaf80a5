#include "demo/lab/stress/stress_limits.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "assets/fem/critical_step.h"
#include "demo/lab/stress/stress_bellies.h"

namespace mobil {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

double total(const ReferenceBelly& belly) {
  const auto report = belly.report();
  return report.kinetic_energy_j + report.strain_energy_j;
}

}  // namespace

Result<LimitProbe> probe_limit(const HexahedralMesh& mesh, const StiffnessTerms& terms, ReferenceOptions options,
                               std::uint32_t steps) {
  const Mass mass = options.method == Method::icd ? Mass::consistent : Mass::lumped;
  LimitProbe probe{critical_step(terms, options.across, options.along,
                                 {options.end, mass, options.stiffness_damping_s, options.foundation_1_s}),
                   0, 0};
  for (const bool above : {false, true}) {
    options.dt_s = (above ? just_above : just_below) * probe.limit_s;
    auto belly = ReferenceBelly::make(mesh, terms, options);
    if (!belly) return tl::unexpected(belly.error());
    shake(*belly, mesh.cells, options.end, 1e-3);
    const ReferenceLoad none{};
    belly->step(none, none);
    const double first = total(*belly), first_kinetic = belly->report().kinetic_energy_j;
    for (std::uint32_t step = 1; step < (above ? 600 : steps); ++step) {
      belly->step(none, none);
      if (above || step % 10 != 0) continue;
      const double change = std::fabs(total(*belly) / first - 1);
      if (!(change <= probe.drift_below)) probe.drift_below = change;
      if (std::isnan(change)) break;
    }
    if (above) probe.growth_above = belly->finite() ? belly->report().kinetic_energy_j / first_kinetic : 1e300;
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

void add_rows(StressRun& run, const std::string& tried, const WorstProbe& worst) {
  run.at_most(tried + fmt::format(", in double at {} of the critical step", just_below),
              "change of energy in parts of itself", 1e-8, worst.drift_below,
              "conserved exactly below the limit; rounding is amplified by 1/(1 - 0.999^2) = 500",
              fmt::format("{} bellies", worst.tried));
  run.at_least(tried + fmt::format(", at {} of it", just_above), "growth of kinetic energy in 600 steps", 1e6,
               worst.growth_above, "at least e^0.15 a step; the computed limit is at most 0.1 % low");
}

}  // namespace mobil
