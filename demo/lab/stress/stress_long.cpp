// Very many steps: does the energy of bellies stay?

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

#include "demo/lab/stress/stress.h"
#include "demo/lab/stress/stress_bellies.h"

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
  return {};
}

}  // namespace mobil
