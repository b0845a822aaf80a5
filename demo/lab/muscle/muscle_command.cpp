// `mobil muscle`: one block of muscle in its own frame under a load; or, with --activation, one real muscle of a
// standing person, excited and released.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <memory>
#include <numbers>

#include <mobil/assets/files/output_file.h>
#include <mobil/components/activation.h>
#include <mobil/components/muscle.h>
#include <mobil/engine/error.h>
#include <mobil/engine/world.h>
#include <mobil/muscle_table.h>
#include <mobil/simulation.h>
#include <mobil/systems/surfaces/nodal_view.h>
#include "demo/lab/muscle/muscle_run.h"
#include "demo/program/commands.h"
#include "demo/program/console.h"
#include "demo/program/units.h"

namespace mobil {
namespace {

struct ContractionRequest {
  Muscle muscle{};
  float level = 0;     // excitation, 0 to 1
  double seconds = 1;  // excited from a tenth of it to six tenths
  std::filesystem::path out;
};

/// The CSV, with a row per tick of 1/480 s, and its summary in a few lines.
struct Contraction {
  std::string csv, summary;
};

constexpr double contraction_tick_s = 1.0 / 480;
constexpr double on_at = 0.1, off_at = 0.6;  // of the time

/// Returns the area of the middle plane of control points relative to that at rest.
double middle_section(const Simulation& simulation, Entity muscle) {
  const HexahedralMesh& mesh = simulation.world().shared<MuscleTemplate>(muscle)->mesh;
  const BellyScale<float> scale = *simulation.get<BellyScale>(muscle);
  const NodalView moved = nodal_displacement(simulation.world(), muscle);
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

/// Reads the options as typed. Fails, naming the option, on an unknown muscle, a level outside 0 to 1, or seconds
/// outside 0.05 to 60.
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
  const auto person = simulation.spawn_posed({});
  if (!person) return tl::unexpected(person.error());
  LegMuscles choice;
  choice.muscles.reset();
  choice.muscles.set(static_cast<std::size_t>(request.muscle));
  choice.method = Method::modal;
  choice.activation = ExcitationSource::host;
  if (auto added = simulation.set_muscles(*person, choice); !added) return tl::unexpected(added.error());
  const Entity muscle = simulation.muscle(*person, request.muscle, Side::right);
  const auto ticks = static_cast<int>(std::lround(request.seconds / contraction_tick_s));
  Contraction made;
  made.csv =
      "time_s,excitation,activation,line_m,fibre_m,tendon_m,pennation_deg,muscle_force_n,belly_shortening_m,"
      "middle_section_ratio,volume_ratio\n";
  double max_force = 0, max_short = 0, max_section = 0;
  std::vector<double> forces;
  for (int tick = 0; tick < ticks; ++tick) {
    const bool on = tick >= on_at * ticks && tick < off_at * ticks;
    if (auto set = simulation.set_excitation(*person, request.muscle, Side::right, on ? request.level : 0); !set)
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
    max_force = std::max(max_force, double{pull.force_n});
    max_short = std::max(max_short, -double{pull.belly_m});
    max_section = std::max(max_section, section);
  }
  const auto risen = std::ranges::find_if(forces, [&](double force) { return force >= 0.9 * max_force; });
  const double rise_s = static_cast<double>(risen - forces.begin()) * contraction_tick_s - on_at * request.seconds;
  const BodyRequest body;
  made.summary = fmt::format(
      "{} of somebody of {:.2f} m and {:g} kg who stands, excited at {:g} from {:.3g} to {:.3g} s,\n"
      "pulls with up to {:.0f} N, nine tenths of that {:.0f} ms after it began; its belly shortens by up to {:.1f} "
      "mm,\n"
      "its middle section grows to {:.3f} of that at rest\n",
      muscle_name(request.muscle), body.height_m, body.mass_kg, request.level, on_at * request.seconds,
      off_at * request.seconds, max_force, 1e3 * std::max(rise_s, 0.0), 1e3 * max_short, max_section);
  return made;
}

constexpr const char* help_footer =
    "Methods. With K the stiffness, M the mass and f the load, K u + C u' + M u'' = f:\n"
    "  static  K u = f at every row: what is left when nothing moves fast.\n"
    "  explicit-central     explicit central differences. Lumped mass, so a step is one product with K; stable only "
    "below the\n"
    "          critical step 2/omega_max, which is computed and named. Beats a little fast: -(omega dt)^2/24.\n"
    "  implicit-central     the same with the consistent mass, which takes a solve a step and about halves the "
    "critical step.\n"
    "  newmark     constant average acceleration (Newmark 1/4, 1/2): a solve a step, stable at any; beats a little "
    "slow:\n"
    "          +(omega dt)^2/12.\n"
    "  modal the block's motion along a few modes that its load calls for, each integrated exactly: no critical\n"
    "          step, no error of the step, and hardly any cost; what the modes cannot show is missing.\n"
    "  finite  explicit-central at finite strain: tissue that all but keeps its volume, with fibres that resist "
    "stretch. Poisson's\n"
    "          ratio has no part beyond the shear modulus. Its critical step holds for |cof F - 1| up to 0.65.\n"
    "Lumped and consistent mass bracket the true beat from below and above; they draw together as cells get smaller.\n"
    "\n"
    "Example: how the calf contracts\n"
    "  mobil muscle --activation 1 --of soleus --out soleus.csv\n"
    "Example: a sideways nudge of 1 mN for 0.1 s, and how three methods ring after it:\n"
    "  printf 'time_s,force_x_n,force_y_n,force_z_n\\n0,0,0,0\\n0.05,.001,0,0\\n0.1,0,0,0\\n' > nudge.csv\n"
    "  mobil muscle --load nudge.csv --dt 2ms --out explicit-central.csv\n"
    "  mobil muscle --load nudge.csv --dt 2ms --method newmark --out newmark.csv\n"
    "  mobil muscle --load nudge.csv --dt 2ms --method newmark --mass lumped --damping 8 --out damped.csv";

std::string summary(const MuscleRequest& request, const MuscleRun& result, double wall_s) {
  const MuscleTemplate& m = request.muscle;
  const std::string limit = request.critical_step_s             ? fmt::format("{:.4g} s", *request.critical_step_s)
                            : request.method == Method::statics ? std::string("none, nothing moves in time")
                                                                : std::string("none, stable at any");
  return fmt::format(
      "mesh           {} elements, {} nodes, {:.4g} kg\n"
      "method         {}\n"
      "critical step  {}\n"
      "step           {:.4g} s, {} steps ({:.3g} s simulated in {:.2g} s)\n"
      "peak           {:.4g} m at {:.4g} s\n",
      element_count(m.mesh.cells), node_count(m.mesh.cells), m.material.density_kg_m3 * volume(m.mesh),
      describe_method(request), limit, request.dt_s, request.steps, static_cast<double>(request.steps) * request.dt_s,
      wall_s, result.peak_m, result.peak_time_s);
}

int contraction(const MuscleText& text) {
  const auto request = read_contraction(text.activation, text.of, text.seconds, text.out);
  if (!request) return complain("muscle", request.error().message);
  const auto made = contract_muscle(*request);
  if (!made) return complain("muscle", made.error().message);
  if (auto ok = write_file(request->out, made->csv); !ok)
    return complain("muscle", fmt::format("--out {}", ok.error().message));
  write_note(made->summary);
  say_where(fmt::format("written        {}", request->out.string()));
  return 0;
}

int muscle(const MuscleText& text) {
  if (!text.activation.empty()) return contraction(text);
  const auto request = read_muscle_request(text);
  if (!request) return complain("muscle", request.error().message);
  const auto start = std::chrono::steady_clock::now();
  const auto result = run_muscle(*request);
  if (!result) return complain("muscle", result.error().message);
  const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (result->lost_at_s) {
    const std::string lost =
        fmt::format("the displacement overflowed at {:.6g} s; lower the load or raise --young", *result->lost_at_s);
    return complain("muscle", lost, 1);
  }
  if (auto ok = write_file(request->out, result->csv); !ok) {
    return complain("muscle", fmt::format("--out {}", ok.error().message));
  }
  if (!request->glb.empty()) {
    if (auto ok = write_basis_glb(request->glb, result->recording); !ok) {
      return complain("muscle", fmt::format("--glb {}", ok.error().message));
    }
  }
  if (!request->warning.empty()) complain("muscle", request->warning);
  write_note(summary(*request, *result, wall_s));
  say_where(fmt::format("written        {}", request->out.string()));
  return 0;
}

}  // namespace

Subcommand muscle_command() {
  auto text = std::make_shared<MuscleText>();
  Subcommand command{.name = "muscle"};
  command.footer = help_footer;
  command.options = muscle_options(*text);
  command.last_stands = false;
  command.run = [text] { return muscle(*text); };
  return command;
}

}  // namespace mobil
