#include "demo/lab/muscle/muscle_contraction.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numbers>
#include <vector>

#include <mobil/components/activation.h>
#include <mobil/simulation.h>
#include "assets/fem/muscle_template.h"
#include "demo/program/units.h"

namespace mobil {
namespace {

constexpr double contraction_tick_s = 1.0 / 480;
constexpr double on_at = 0.1, off_at = 0.6;  // of the time

/// Area of the middle plane of control points over that at rest.
double middle_section(const Simulation& simulation, Entity muscle) {
  const HexahedralMesh& mesh = simulation.world().shared<MuscleTemplate>(muscle)->mesh;
  const BellyScale<float> scale = *simulation.get<BellyScale>(muscle);
  const NodalView moved = simulation.nodal_displacement(muscle);
  const std::uint32_t below = (mesh.cells[2] - mesh.cells[2] / 2) * plane_nodes(mesh.cells);
  std::array<double, 2> area{};
  for (const Quad& quad : insertion_quads(mesh.cells)) {
    for (const bool now : {false, true}) {
      std::array<std::array<double, 2>, 4> at;
      for (std::size_t corner = 0; corner < 4; ++corner) {
        const std::uint32_t n = quad[corner] - below;
        const float* const u = moved.first + std::size_t{3} * n * lane_count;
        const double across = double{scale.across};
        at[corner] = {across * mesh.node[n].x + (now ? double{u[0]} : 0),
                      across * mesh.node[n].y + (now ? double{u[lane_count]} : 0)};
      }
      area[now ? 1 : 0] +=
          0.5 * ((at[2][0] - at[0][0]) * (at[3][1] - at[1][1]) - (at[2][1] - at[0][1]) * (at[3][0] - at[1][0]));
    }
  }
  return area[1] / area[0];
}

}  // namespace

Result<ContractionRequest> read_contraction(const std::string& level, const std::string& muscle,
                                            const std::string& seconds, const std::string& out) {
  ContractionRequest request;
  const auto excitation = read_value("--activation", level, Quantity::ratio, 0, 1);
  if (!excitation) return tl::unexpected(excitation.error());
  request.level = static_cast<float>(*excitation);
  const auto found = find_muscle(muscle);
  if (!found) {
    std::string known;
    for (const MuscleRow& row : muscles()) known += fmt::format("{}{}", known.empty() ? "" : ", ", row.name);
    return fail(fmt::format("--of '{}': choose one of {}", muscle.substr(0, 60), known));
  }
  request.muscle = *found;
  const auto time = read_value("--seconds", seconds, Quantity::time, 0.05, 60);
  if (!time) return tl::unexpected(time.error());
  request.seconds = *time;
  request.out = out;
  return request;
}

Result<Contraction> contract_muscle(const ContractionRequest& request) {
  SimulationOptions options;
  options.tick_s = contraction_tick_s;
  Simulation simulation(options);
  const auto human = simulation.spawn_posed({});
  if (!human) return tl::unexpected(human.error());
  LegMuscles choice;
  choice.muscles.reset();
  choice.muscles.set(static_cast<std::size_t>(request.muscle));
  choice.method = Method::reduced;
  choice.activation = ExcitationSource::host;
  if (auto added = simulation.add_leg_muscles(*human, choice); !added) return tl::unexpected(added.error());
  const Entity muscle = simulation.muscle(*human, request.muscle, Side::right);
  const auto ticks = static_cast<int>(std::lround(request.seconds / contraction_tick_s));
  Contraction made;
  made.csv =
      "time_s,excitation,activation,line_m,fibre_m,tendon_m,pennation_deg,muscle_force_n,belly_shortening_m,"
      "middle_section_ratio,volume_ratio\n";
  double most_force = 0, most_short = 0, most_section = 0;
  std::vector<double> forces;
  for (int tick = 0; tick < ticks; ++tick) {
    const bool on = tick >= on_at * ticks && tick < off_at * ticks;
    if (auto set = simulation.set_excitation(*human, request.muscle, Side::right, on ? request.level : 0); !set)
      return tl::unexpected(set.error());
    simulation.tick();
    const auto pull = *simulation.get<Musculotendon>(muscle);
    const auto state = *simulation.get<Activation>(muscle);
    const double section = middle_section(simulation, muscle);
    fmt::format_to(
        std::back_inserter(made.csv), "{:.6f},{:.4f},{:.4f},{:.6f},{:.6f},{:.6f},{:.3f},{:.2f},{:.6f},{:.5f},{:.5f}\n",
        simulation.time_s(), state.excitation, state.activation, simulation.get<LineOfAction>(muscle)->length_m,
        pull.fibre_m, pull.tendon_m, pull.pennation_rad * 180 / std::numbers::pi_v<float>, pull.force_n, -pull.belly_m,
        section, simulation.get<BellyReport>(muscle)->volume_ratio);
    forces.push_back(double{pull.force_n});
    most_force = std::max(most_force, double{pull.force_n});
    most_short = std::max(most_short, -double{pull.belly_m});
    most_section = std::max(most_section, section);
  }
  const auto risen = std::ranges::find_if(forces, [&](double force) { return force >= 0.9 * most_force; });
  const double rise_s = static_cast<double>(risen - forces.begin()) * contraction_tick_s - on_at * request.seconds;
  const BodyRequest body;
  made.summary = fmt::format(
      "{} of somebody of {:.2f} m and {:g} kg who stands, excited at {:g} from {:.3g} to {:.3g} s,\n"
      "pulls with up to {:.0f} N, nine tenths of that {:.0f} ms after it began; its belly shortens by up to {:.1f} "
      "mm,\n"
      "its middle section grows to {:.3f} of that at rest\n",
      muscle_name(request.muscle), body.height_m, body.mass_kg, request.level, on_at * request.seconds,
      off_at * request.seconds, most_force, 1e3 * std::max(rise_s, 0.0), 1e3 * most_short, most_section);
  return made;
}

}  // namespace mobil
