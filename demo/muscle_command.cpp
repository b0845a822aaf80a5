// `mobil muscle`: one block of muscle in its own frame under a load.

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "assets/force_history.h"
#include "assets/muscle_template.h"
#include "assets/output_file.h"
#include "demo/commands.h"
#include "demo/units.h"
#include "systems/deformation/deformation.h"

namespace mobil {
namespace {

struct MuscleText {
  std::string cells = "2x2x8", cell_size = "0.015", method = "ecd", mass = "lumped", dt, seconds = "1";
  std::string young = "10666.7", poisson = "0.3333", density = "1000", damping = "0", load, out = "disp.csv";
};

struct MuscleRequest {
  MuscleTemplate muscle;
  double critical_step_s;
  double dt_s;
  std::size_t steps;
  ForceHistory load;
  std::filesystem::path out;
};

constexpr double longest_run_steps = 2e6;

/// Pulled by 1 N along z within 0.1 s, held, let go at 0.5 s.
ForceHistory default_load() {
  return {{{0, {0, 0, 0}}, {0.1, {0, 0, 1}}, {0.5, {0, 0, 1}}, {0.5, {0, 0, 0}}}};
}

Result<Cells> parse_cells(const std::string& text) {
  Cells cells{};
  char end = 0;
  // at most three digits each, so that nothing overflows
  const int read = std::sscanf(text.c_str(), "%3ux%3ux%3u%c", &cells[0], &cells[1], &cells[2], &end);
  if (read != 3 || text.find_first_not_of("0123456789x") != std::string::npos) {
    return fail(fmt::format("--cells '{}' must be three counts from 1 to 256 as in 2x2x8", text));
  }
  return cells;
}

Result<void> check_choices(const MuscleText& text) {
  if (text.method != "ecd") {
    return fail(
        fmt::format("--method '{}' is not available; available: ecd (explicit central differences)", text.method));
  }
  if (text.mass == "consistent") {
    return fail("--mass consistent would need a solve at every explicit step; --method ecd takes --mass lumped");
  }
  if (text.mass != "lumped") return fail(fmt::format("--mass '{}' is not available; available: lumped", text.mass));
  return {};
}

Result<MuscleTemplate> make_template(const MuscleText& text) {
  const auto cells = parse_cells(text.cells);
  if (!cells) return tl::unexpected(cells.error());
  const auto size = read_value("--cell-size", text.cell_size, Quantity::length, 1e-4, 1);
  if (!size) return tl::unexpected(size.error());
  const auto young = read_value("--young", text.young, Quantity::pressure);
  if (!young) return tl::unexpected(young.error());
  const auto poisson = read_value("--poisson", text.poisson, Quantity::ratio);
  if (!poisson) return tl::unexpected(poisson.error());
  const auto density = read_value("--density", text.density, Quantity::density);
  if (!density) return tl::unexpected(density.error());
  const auto damping = read_value("--damping", text.damping, Quantity::rate);
  if (!damping) return tl::unexpected(damping.error());
  auto mesh = make_block(*cells, *size);
  if (!mesh) return tl::unexpected(mesh.error());
  return make_muscle_template(std::move(*mesh), Material{*density, *young, *poisson},
                              MuscleOptions{FarEnd::free, *damping, 1, 1});
}

Result<MuscleRequest> read_request(const MuscleText& text) {
  if (auto ok = check_choices(text); !ok) return tl::unexpected(ok.error());
  const auto seconds = read_value("--seconds", text.seconds, Quantity::time, 1e-6, 3600);
  if (!seconds) return tl::unexpected(seconds.error());
  std::optional<double> dt;
  if (!text.dt.empty()) {
    const auto given = read_value("--dt", text.dt, Quantity::time, 1e-9, 1000);
    if (!given) return tl::unexpected(given.error());
    dt = *given;
  }
  auto load = text.load.empty() ? Result<ForceHistory>(default_load()) : read_force_history(text.load);
  if (!load) return fail(fmt::format("--load {}", load.error().message));
  auto muscle = make_template(text);
  if (!muscle) return tl::unexpected(muscle.error());
  const double limit = critical_step(muscle->terms, 1, 1, FarEnd::free);
  if (dt && *dt > limit) {
    return fail(fmt::format(
        "--dt {} s is above the critical step {:.4g} s of this mesh and material; use at most {:.3g} s (0.9 of it), or "
        "leave --dt out",
        *dt, limit, std::floor(0.9 * limit * 1e6) / 1e6 > 0 ? std::floor(0.9 * limit * 1e6) / 1e6 : 0.9 * limit));
  }
  // without --dt the run ends on a step: seconds / n with the smallest n that stays within 0.9 of the limit
  const double step = dt.value_or(*seconds / std::ceil(*seconds / (0.9 * limit)));
  const double steps = std::floor(*seconds / step * (1 + 1e-9));
  if (steps > longest_run_steps) {
    return fail(fmt::format("{} s in steps of {:.3g} s are {:.3g} steps; at most {:.0e} are run: shorten --seconds{}",
                            *seconds, step, steps, longest_run_steps, dt ? " or lengthen --dt" : ""));
  }
  return MuscleRequest{std::move(*muscle), limit, step, static_cast<std::size_t>(steps), std::move(*load), text.out};
}

/// On a terminal, after the first second: how far the run is.
class Progress {
 public:
  explicit Progress(std::size_t total) : total_(total) {}
  ~Progress() {
    if (shown_) std::fputs("\r\033[K", stderr);
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void at(std::size_t done) {
    if (done % 64 != 0 || isatty(STDERR_FILENO) == 0) return;
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::seconds(1) && !(shown_ && now - last_ > std::chrono::milliseconds(100))) return;
    last_ = now;
    shown_ = true;
    const std::size_t bars = 40 * done / total_;
    std::fputs(fmt::format("\r[{:<40}] {:3d} %", std::string(bars, '='), 100 * done / total_).c_str(), stderr);
  }

 private:
  std::size_t total_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  bool shown_ = false;
};

void spread(const Vec3<double>& force, Vec3<Lanes<float>>& lanes) {
  for (std::size_t l = 0; l < lane_count; ++l) {
    lanes.x[l] = static_cast<float>(force.x);
    lanes.y[l] = static_cast<float>(force.y);
    lanes.z[l] = static_cast<float>(force.z);
  }
}

/// Half-step velocity before t = 0 of a belly that is at rest at t = 0 under the first load: −½Δt·M⁻¹·f(0).
void start_at_rest(const MuscleRequest& request, std::vector<Lanes<float>>& velocity) {
  const KernelArrays& kernel = request.muscle.kernel;
  const auto force = force_at(request.load, 0);
  const double axis[3] = {force.x, force.y, force.z};
  const std::size_t first = first_insertion_node(request.muscle.mesh.cells);
  for (std::size_t i = 0; i < kernel.far_share.size(); ++i) {
    const double over_mass =
        static_cast<double>(kernel.far_share[i]) * static_cast<double>(kernel.inverse_mass[first + i]);
    for (std::size_t c = 0; c < 3; ++c) {
      for (float& v : velocity[3 * (first + i) + c].lane)
        v = static_cast<float>(-0.5 * request.dt_s * over_mass * axis[c]);
    }
  }
}

struct MuscleRun {
  std::string csv;
  double peak_m = 0, peak_time_s = 0;
  std::optional<double> lost_at_s;  // when the displacement ceased to be a number
};

MuscleRun run(const MuscleRequest& request) {
  const Cells& cells = request.muscle.mesh.cells;
  const std::size_t blocks = nodal_width(cells);
  std::vector<Lanes<float>> displacement(blocks), velocity(blocks);
  BellyScale<Lanes<float>> scale{};
  for (std::size_t l = 0; l < lane_count; ++l) scale.across[l] = scale.along[l] = 1;
  EndTraction<Lanes<float>> traction{};
  BellyReport<Lanes<float>> report{};
  const auto centre = insertion_centre(cells);
  const auto mean = [&](std::size_t axis) {
    double sum = 0;
    for (const auto n : centre) sum += static_cast<double>(displacement[3 * n + axis][0]);
    return sum / static_cast<double>(centre.size());
  };
  start_at_rest(request, velocity);
  MuscleRun result;
  result.csv = "time_s,u_x_m,u_y_m,u_z_m\n";
  Progress progress(request.steps);
  for (std::size_t step = 0;; ++step) {
    const double time = static_cast<double>(step) * request.dt_s;
    const double u[3] = {mean(0), mean(1), mean(2)};
    const double size = std::hypot(u[0], u[1], u[2]);
    if (!std::isfinite(size)) {
      result.lost_at_s = time;
      return result;
    }
    if (size > result.peak_m) {
      result.peak_m = size;
      result.peak_time_s = time;
    }
    fmt::format_to(std::back_inserter(result.csv), "{:.9g},{:.9g},{:.9g},{:.9g}\n", time, u[0], u[1], u[2]);
    if (step == request.steps) return result;
    spread(force_at(request.load, time), traction.from_n);
    traction.to_n = traction.from_n;  // one substep a call: only its start counts
    deform_explicit(
        {request.muscle, scale, displacement.data()->lane, velocity.data()->lane, report, Stiffness::shared}, traction,
        1, static_cast<float>(request.dt_s));
    progress.at(step + 1);
  }
}

int muscle(const MuscleText& text) {
  const auto complain = [](const std::string& message) {
    std::fputs(fmt::format("mobil muscle: {}\n", message).c_str(), stderr);
    return 2;
  };
  const auto request = read_request(text);
  if (!request) return complain(request.error().message);
  const auto start = std::chrono::steady_clock::now();
  const MuscleRun result = run(*request);
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (result.lost_at_s) {
    std::fputs(fmt::format("mobil muscle: the displacement overflowed at {:.6g} s; lower the load or raise --young\n",
                           *result.lost_at_s)
                   .c_str(),
               stderr);
    return 1;
  }
  if (auto ok = write_file(request->out, result.csv); !ok) return complain(fmt::format("--out {}", ok.error().message));
  const MuscleTemplate& m = request->muscle;
  std::fputs(fmt::format("mesh           {} elements, {} nodes, {:.4g} kg\n"
                         "critical step  {:.4g} s\n"
                         "step           {:.4g} s, {} steps ({:.3g} s simulated in {:.2g} s)\n"
                         "peak           {:.4g} m at {:.4g} s\n"
                         "written        {}\n",
                         element_count(m.mesh.cells), node_count(m.mesh.cells),
                         m.material.density_kg_m3 * volume(m.mesh), request->critical_step_s, request->dt_s,
                         request->steps, static_cast<double>(request->steps) * request->dt_s, wall, result.peak_m,
                         result.peak_time_s, request->out.string())
                 .c_str(),
             stdout);
  return 0;
}

}  // namespace

void add_muscle_command(CLI::App& app, int& exit_status) {
  auto text = std::make_shared<MuscleText>();
  CLI::App* command = app.add_subcommand("muscle",
                                         "Deform one block of muscle: the face z = 0 fixed, a uniform traction on the "
                                         "far face, at rest at t = 0");
  command->add_option("--cells", text->cells, "Elements along x, y, z, 1 to 256 each")->capture_default_str();
  command->add_option("--cell-size", text->cell_size, "Edge of a cubic element, 0.0001 to 1 m")->capture_default_str();
  command->add_option("--method", text->method, "ecd: explicit central differences")->capture_default_str();
  command->add_option("--mass", text->mass, "lumped")->capture_default_str();
  command->add_option("--dt", text->dt, "Step, s; above the critical step is refused (default: just within 0.9 of it)");
  command->add_option("--seconds", text->seconds, "How long, up to 3600 s")->capture_default_str();
  command->add_option("--young", text->young, "Young's modulus, Pa")->capture_default_str();
  command->add_option("--poisson", text->poisson, "Poisson's ratio, above -1 and below 0.5")->capture_default_str();
  command->add_option("--density", text->density, "Density, kg/m3")->capture_default_str();
  command->add_option("--damping", text->damping, "Mass damping alpha, 0 to 1000 1/s")->capture_default_str();
  command->add_option("--load", text->load,
                      "CSV time_s,force_x_n,force_y_n,force_z_n: total force, linear between rows, zero before the "
                      "first, held after the last (default: 1 N along +z from 0.1 s, let go at 0.5 s)");
  command->add_option("--out", text->out, "CSV time_s,u_x_m,u_y_m,u_z_m of the far face's centre")
      ->capture_default_str();
  command->callback([text, &exit_status] { exit_status = muscle(*text); });
}

}  // namespace mobil
