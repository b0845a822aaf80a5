// `mobil muscle`: one block of muscle in its own frame under a load.

#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <string>

#include <mobil/assets/files/output_file.h>
#include "assets/fem/muscle_template.h"
#include "demo/lab/muscle/muscle_contraction.h"
#include "demo/lab/muscle/muscle_options.h"
#include "demo/lab/muscle/muscle_run.h"
#include "demo/program/commands.h"

namespace mobil {
namespace {

constexpr const char* help_footer =
    "Methods. With K the stiffness, M the mass and f the load, K u + C u' + M u'' = f:\n"
    "  static  K u = f at every row: what is left when nothing moves fast.\n"
    "  ecd     explicit central differences. Lumped mass, so a step is one product with K; stable only below the\n"
    "          critical step 2/omega_max, which is computed and named. Beats a little fast: -(omega dt)^2/24.\n"
    "  icd     the same with the consistent mass, which takes a solve a step and about halves the critical step.\n"
    "  caa     constant average acceleration (Newmark 1/4, 1/2): a solve a step, stable at any; beats a little slow:\n"
    "          +(omega dt)^2/12.\n"
    "  reduced the block's motion along a few vectors that its load calls for, each integrated exactly: no critical\n"
    "          step, no error of the step, and hardly any cost; what the vectors cannot show is missing.\n"
    "  finite  ecd at finite strain: tissue that all but keeps its volume, with fibres that resist stretch. Poisson's\n"
    "          ratio has no part beyond the shear modulus. Its critical step holds for |cof F - 1| up to 0.65.\n"
    "Lumped and consistent mass bracket the true beat from below and above; they draw together as cells get smaller.\n"
    "\n"
    "Example: how the calf contracts\n"
    "  mobil muscle --activation 1 --of soleus --out soleus.csv\n"
    "Example: a sideways nudge of 1 mN for 0.1 s, and how three methods ring after it:\n"
    "  printf 'time_s,force_x_n,force_y_n,force_z_n\\n0,0,0,0\\n0.05,.001,0,0\\n0.1,0,0,0\\n' > nudge.csv\n"
    "  mobil muscle --load nudge.csv --dt 2ms --out ecd.csv\n"
    "  mobil muscle --load nudge.csv --dt 2ms --method caa --out caa.csv\n"
    "  mobil muscle --load nudge.csv --dt 2ms --method caa --mass lumped --damping 8 --out damped.csv";

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
  fmt::print("{}", made->summary);
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
  fmt::print("{}", summary(*request, *result, wall_s));
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
