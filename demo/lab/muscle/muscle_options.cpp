#include "demo/lab/muscle/muscle_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include <mobil/muscle_table.h>
#include "assets/fem/element_size.h"
#include "demo/program/units.h"

namespace mobil {
namespace {

constexpr double longest_run_steps = 2e6;

constexpr std::array<std::string_view, 2> precisions = {"single", "double"};
constexpr std::array<std::string_view, 6> moving_methods = {
    "static", "explicit-central", "implicit-central", "newmark", "modal", "finite"};
constexpr std::array moving_method = {
    Method::statics, Method::explicit_central, Method::implicit_central, Method::newmark, Method::modal,
    Method::finite};

std::vector<std::string> muscle_words() {
  std::vector<std::string> names;
  for (const MuscleRow& row : muscles()) names.emplace_back(row.name);
  return names;
}

/// Steps without --dt. Static writes a row for every frame of a display. CAA steps eight times as often, so that the
/// period of the default block's first stretch (12 Hz) is 0.2 % too long.
constexpr double static_step_s = 1.0 / 60, newmark_step_s = 1.0 / 480;

/// Returns the default load: a pull of 1 N along z within 0.1 s, held, released at 0.5 s.
ForceHistory default_load() {
  return {{{0, {0, 0, 0}}, {0.1, {0, 0, 1}}, {0.5, {0, 0, 1}}, {0.5, {0, 0, 0}}}};
}

Result<Cells> parse_cells(const std::string& text) {
  const auto parts = split(text, 'x');
  Cells cells{};
  bool good = parts.size() == cells.size();
  for (std::size_t i = 0; good && i < cells.size(); ++i) {
    const auto count = parse_count(parts[i], 0, 999);  // make_block checks the range and reports it
    good = count.has_value();
    if (good) cells[i] = static_cast<std::uint32_t>(*count);
  }
  if (good) return cells;
  return fail(fmt::format("--cells '{}' must be three counts from 1 to 256 as in 2x2x8", text));
}

Result<Vec3<double>> parse_gravity(const std::string& text) {
  const auto list = parse_list<3>(text, ',', -1000, 1000);
  if (list) return Vec3<double>{(*list)[0], (*list)[1], (*list)[2]};
  return fail(fmt::format("--gravity '{}' must be three accelerations from -1000 to 1000 m/s2, as in 0,-9.81,0",
                          text.substr(0, 60)));
}

Result<Grading> parse_grading(const std::string& text) {
  const auto list = parse_list<2>(text, ',', 0.01, 100);
  if (list) return Grading{(*list)[0], (*list)[1]};
  return fail(fmt::format("--grading '{}' must be two ratios from 0.01 to 100, across and along, as in 1,2",
                          text.substr(0, 60)));
}

/// Returns the mass of a method, if none or a valid one was requested.
Result<Mass> choose_mass(Method method, const std::string& text) {
  const Mass own = method == Method::implicit_central || method == Method::newmark ? Mass::consistent : Mass::lumped;
  if (text.empty()) return own;
  auto mass = choose<Mass>("--mass", text, mass_name);
  if (!mass) return mass;
  if ((method == Method::explicit_central || method == Method::finite) && *mass == Mass::consistent) {
    return fail(
        "--mass consistent would need a solve at every explicit step, which is --method implicit-central; --method "
        "explicit-central and finite "
        "take --mass lumped");
  }
  if (method == Method::implicit_central && *mass == Mass::lumped) {
    return fail(
        "--mass lumped needs no solve, which is --method explicit-central; --method implicit-central (central "
        "differences that solve with the "
        "mass) takes --mass consistent");
  }
  return mass;
}

struct Choices {
  Method method;
  Mass mass;
  Element element;
  bool in_double;
};

Result<Choices> read_choices(const MuscleText& text) {
  OptionReader read;
  Choices c{};
  c.method = moving_method[read(choose<std::size_t>("--method", text.method, moving_methods))];
  c.mass = read(choose_mass(c.method, text.mass));
  c.element = read(choose<Element>("--element", text.element, element_name));
  c.in_double = read(choose<std::size_t>("--precision", text.precision, precisions)) == 1;
  if (c.method == Method::modal && c.in_double)
    read.refuse("--precision double has no modal method; its steps are exact, leave the option out");
  if (c.method == Method::finite && c.element == Element::bbar)
    read.refuse("--method finite has elements of one point; leave --element bbar out, or take another method");
  if (c.method == Method::finite && c.in_double)
    read.refuse(
        "--precision double has no finite method; leave the option out, or take explicit-central, implicit-central, "
        "newmark or static");
  if (c.method != Method::modal && !text.glb.empty())
    read.refuse("--glb writes the modes of --method modal; add that, or leave --glb out");
  return read.result(c);
}

/// Returns true if a factorised operator is needed.
bool solves(const Choices& choices) {
  return !choices.in_double && choices.method != Method::explicit_central && choices.method != Method::modal &&
         choices.method != Method::finite;
}

Result<MuscleTemplate> make_template(const MuscleText& text, const Choices& choices) {
  const auto cells = parse_cells(text.cells);
  if (!cells) return tl::unexpected(cells.error());
  if (solves(choices)) {
    if (auto ok = check_belly_solver(*cells, choices.method); !ok) {
      return fail(ok.error().message + "; --precision double has no such limit");
    }
  }
  OptionReader read;
  const double size_m = read(read_value("--cell-size", text.cell_size, Quantity::length, 1e-4, 1));
  const double young = read(read_value("--young", text.young, Quantity::pressure));
  const double poisson = read(read_value("--poisson", text.poisson, Quantity::ratio));
  const double density = read(read_value("--density", text.density, Quantity::density));
  MuscleOptions options;
  options.far_end = FarEnd::free;
  options.damping_per_s = read(read_value("--damping", text.damping, Quantity::rate, 0, 1000));
  options.lowest_ratio = options.highest_ratio = 1;
  options.element = choices.element;
  options.mass = choices.mass;
  options.stiffness_damping_s = read(read_value("--stiffness-damping", text.stiffness_damping, Quantity::time, 0, 1));
  if (choices.method == Method::finite && options.stiffness_damping_s > 0)
    read.refuse(
        "--method finite is damped by --damping alone; leave --stiffness-damping out, or take --method "
        "explicit-central");
  options.foundation_hz = read(read_value("--foundation", text.foundation, Quantity::frequency, 0, 1000));
  const auto grading = read.result(read(parse_grading(text.grading)));
  if (!grading) return tl::unexpected(grading.error());
  auto mesh = make_block(*cells, size_m, *grading);
  if (!mesh) return tl::unexpected(mesh.error());
  if (choices.method == Method::finite) {
    options.strain = Strain::finite;
    options.element = Element::one_point;
  }
  return make_muscle_template(std::move(*mesh), Material{density, young, poisson}, options);
}

double limit_of(const MuscleTemplate& muscle) {
  const MuscleOptions& o = muscle.options;
  if (o.strain == Strain::finite) return critical_step(muscle.critical_steps, 1, 1).value();
  return critical_step(muscle.terms, 1, 1,
                       StepCase{FarEnd::free, o.mass, o.stiffness_damping_s, 2 * std::numbers::pi * o.foundation_hz});
}

std::string warn_of_coarse_elements(const MuscleTemplate& muscle) {
  const double longest = longest_edge_m(muscle.mesh), allowed = largest_element_m(muscle.material);
  if (longest <= allowed * (1 + 1e-9)) return "";
  return fmt::format(
      "warning: elements of {:.4g} m are longer than {:.4g} m, a tenth of this material's compression wave at {:.3g} "
      "Hz; "
      "fast loads are carried coarsely: take smaller cells",
      longest, allowed, highest_load_hz);
}

struct Stepping {
  std::optional<double> critical_step_s;
  double dt_s;
  std::size_t steps;
};

Result<Stepping> choose_step(const MuscleText& text, const MuscleTemplate& muscle, Method method) {
  const auto seconds = read_value("--seconds", text.seconds, Quantity::time, 1e-6, 3600);
  if (!seconds) return tl::unexpected(seconds.error());
  std::optional<double> dt;
  if (!text.dt.empty()) {
    const auto given = read_value("--dt", text.dt, Quantity::time, 1e-9, 1000);
    if (!given) return tl::unexpected(given.error());
    dt = *given;
  }
  std::optional<double> limit;
  double longest = method == Method::statics ? static_step_s : newmark_step_s;
  if (method == Method::explicit_central || method == Method::implicit_central || method == Method::finite) {
    limit = limit_of(muscle);
    longest = 0.9 * *limit;
    if (dt && *dt > *limit) {
      const double rounded = std::floor(longest * 1e6) / 1e6;
      return fail(fmt::format(
          "--dt {} s is above the critical step {:.4g} s of this mesh, material and mass; use at most {:.3g} s (0.9 of "
          "it), leave --dt out, or take --method newmark, which is stable at any step",
          *dt, *limit, rounded > 0 ? rounded : longest));
    }
  }
  // without --dt the run ends on a step: seconds / n with the smallest n that stays within the longest step
  const double step = dt.value_or(*seconds / std::ceil(*seconds / longest));
  const double steps = std::floor(*seconds / step * (1 + 1e-9));
  if (steps > longest_run_steps) {
    return fail(fmt::format("{} s in steps of {:.3g} s are {:.3g} steps; at most {:.0e} are run: shorten --seconds{}",
                            *seconds, step, steps, longest_run_steps, dt ? " or lengthen --dt" : ""));
  }
  return Stepping{limit, step, static_cast<std::size_t>(steps)};
}

}  // namespace

std::vector<Option> muscle_options(MuscleText& text) {
  const char *block = "Block", *time = "Time", *load = "Load and result", *contraction = "Contraction";
  return {
      {"--cells", &text.cells, "Elements along x, y, z, 1 to 256 each", block},
      {"--cell-size", &text.cell_size, "Edge of a cubic element, 0.0001 to 1 m", block},
      {"--element", &text.element,
       "full (2x2x2 points), bbar (mean dilatation: for Poisson's ratios near 0.5) or one-point (hourglass control)",
       block, words_of(element_name)},
      {"--young", &text.young, "Young's modulus, 1 to 1e12 Pa", block},
      {"--poisson", &text.poisson, "Poisson's ratio, -0.99 to 0.4999", block},
      {"--density", &text.density, "Density, 1 to 1e6 kg/m3", block},
      {"--foundation", &text.foundation,
       "Held sideways as fascia would, at this frequency, 0 to 1000 Hz: (2 pi f)^2 times the mass, in x and y", block},
      {"--grading", &text.grading,
       "How long elements in the middle are against those at the edges and ends: across,along, 0.01 to 100 each",
       block},
      {"--method", &text.method, "static, explicit-central, implicit-central, newmark, modal or finite, see below",
       time, words_of(moving_methods)},
      {"--modes", &text.modes, "Of modal: how many of the block's own modes move, 1 to 32", time},
      {"--mass", &text.mass,
       "lumped or consistent: explicit-central and finite are lumped, implicit-central consistent, newmark either "
       "(default: consistent)",
       time, words_of(mass_name)},
      {"--dt", &text.dt,
       "Step, s; explicit-central, implicit-central and finite refuse one above the critical step (default: just "
       "within 0.9 of it; newmark and "
       "modal 1/480, static 1/60)",
       time},
      {"--seconds", &text.seconds, "How long, up to 3600 s", time},
      {"--damping", &text.damping, "alpha of C = alpha M + beta K, 0 to 1000 1/s: damps slow motion most", time},
      {"--stiffness-damping", &text.stiffness_damping,
       "beta, 0 to 1 s: damps fast motion most, and shortens the critical step", time},
      {"--precision", &text.precision,
       "single: the kernels of the walk, sixteen lanes; double: the plain reference, one belly at a time", time,
       words_of(precisions)},
      {"--load", &text.load,
       "CSV time_s,force_x_n,force_y_n,force_z_n: total force, linear between rows, zero before the "
       "first, held after the last (default: 1 N along +z from 0.1 s, let go at 0.5 s)",
       load},
      {"--gravity", &text.gravity, "Acceleration of every mass in the block's frame, X,Y,Z, m/s2", load},
      {"--out", &text.out, "CSV time_s,u_x_m,u_y_m,u_z_m of the far face's centre, one row a step from t = 0", load},
      {"--glb", &text.glb,
       "Of modal: the block as GLB, its modes as morph targets whose weights are the modal coordinates; with up "
       "to 8 modes every viewer shows it",
       load},
      {"--activation", &text.activation,
       "In place of a block: excite a muscle of somebody who stands, 0 to 1, from a tenth to six tenths of --seconds; "
       "--out gets fibre, tendon, force and section",
       contraction},
      {"--of", &text.of, "Which muscle, by its name in mobil body", contraction, muscle_words()}};
}

/// Returns modes of the block itself, so that 32 of them come close to its full model.
Result<ModalBasis> make_block_basis(const MuscleText& text, const MuscleTemplate& muscle, bool weighed) {
  const auto modes = read_value("--modes", text.modes, Quantity::ratio, 1, max_modes);
  if (!modes) return tl::unexpected(modes.error());
  if (*modes != std::floor(*modes)) return fail(fmt::format("--modes {} must be a whole number", text.modes));
  const MuscleOptions& o = muscle.options;
  if (o.stiffness_damping_s > 0) {
    return fail("--method modal is damped by --damping alone; leave --stiffness-damping out, or take --method newmark");
  }
  ModalBasisOptions options;
  options.modes = static_cast<std::uint32_t>(*modes);
  options.far_end = o.far_end;
  options.frame_loads = weighed;
  options.corrected = false;
  options.foundation_hz = o.foundation_hz;
  options.damping_per_s = o.damping_per_s;
  options.middle_product = options.ratio_width = 1;
  options.control_cells = muscle.mesh.cells;
  return make_modal_basis(muscle.mesh, muscle.material, o.element, options);
}

Result<MuscleRequest> read_muscle_request(const MuscleText& text) {
  const auto choices = read_choices(text);
  if (!choices) return tl::unexpected(choices.error());
  const auto gravity = parse_gravity(text.gravity);
  if (!gravity) return tl::unexpected(gravity.error());
  auto load = text.load.empty() ? Result<ForceHistory>(default_load()) : read_force_history(text.load);
  if (!load) return fail(fmt::format("--load {}", load.error().message));
  auto muscle = make_template(text, *choices);
  if (!muscle) return tl::unexpected(muscle.error());
  const auto stepping = choose_step(text, *muscle, choices->method);
  if (!stepping) return tl::unexpected(stepping.error());
  std::optional<BellySolver> solver;
  if (solves(*choices)) {
    auto made = make_belly_solver(*muscle, choices->method, choices->mass, stepping->dt_s);
    if (!made) return tl::unexpected(made.error());
    solver = std::move(*made);
  }
  std::optional<ModalBasis> basis;
  if (choices->method == Method::modal) {
    auto made = make_block_basis(text, *muscle, gravity->x != 0 || gravity->y != 0 || gravity->z != 0);
    if (!made) return tl::unexpected(made.error());
    basis = std::move(*made);
  }
  std::string warning = warn_of_coarse_elements(*muscle);
  return MuscleRequest{.muscle = std::move(*muscle),
                       .method = choices->method,
                       .in_double = choices->in_double,
                       .solver = std::move(solver),
                       .basis = std::move(basis),
                       .critical_step_s = stepping->critical_step_s,
                       .dt_s = stepping->dt_s,
                       .steps = stepping->steps,
                       .load = std::move(*load),
                       .gravity_m_s2 = *gravity,
                       .out = text.out,
                       .glb = text.glb,
                       .warning = std::move(warning)};
}

std::string describe_method(const MuscleRequest& request) {
  static constexpr std::array<std::string_view, method_name.size()> long_name = {
      "static solution",
      "explicit central differences",
      "implicit central differences",
      "constant average acceleration",
      "a few modes, each integrated exactly",
      "nothing",
      "explicit central differences at finite strain"};
  const auto at = static_cast<std::size_t>(request.method);
  const MuscleOptions& o = request.muscle.options;
  return fmt::format("{}: {}{}, {} elements, {} precision", method_name[at], long_name[at],
                     request.basis ? fmt::format(", {} modes", request.basis->modes)
                     : request.method == Method::statics
                         ? ""
                         : fmt::format(", {} mass", mass_name[static_cast<std::size_t>(o.mass)]),
                     element_name[static_cast<std::size_t>(o.element)], request.in_double ? "double" : "single");
}

}  // namespace mobil
