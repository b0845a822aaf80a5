// `mobil fit-shapes`: makes the tables of bellies at finite strain again.

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <memory>
#include <string>

#include <mobil/assets/files/output_file.h>
#include <mobil/muscle_table.h>
#include "assets/finite/packed_shapes.h"
#include "assets/finite/shape_tables.h"
#include "demo/program/commands.h"
#include "demo/program/console.h"
#include "demo/program/must.h"
#include "demo/program/progress.h"

namespace mobil {
namespace {

// Between the values from which tables are made.
constexpr std::array held_shortenings = {-0.175, -0.075, 0.025, 0.075, 0.125, 0.175, 0.225};
constexpr std::array held_activations = {0.02, 0.1, 0.25, 0.7};
constexpr std::array held_ratios = {0.9, 1.0, 1.1};

void write_table(Muscle muscle, const std::string& folder) {
  const auto made = must(make_shape_table(muscle));
  const auto packed = must(pack_shapes(made));
  const std::string path = fmt::format("{}/{}.inl", folder, muscle_name(muscle));
  must(write_file(path, initialiser(packed)));
  const ShapeTable kept = unpack_shapes(packed);
  const SampledBelly belly = sampled_belly(muscle);
  const HexahedralMesh control = finite_mesh(muscle, kept.control);
  std::string line = fmt::format("{:<27}", muscle_name(muscle));
  for (const double ratio : held_ratios) {
    const auto samples = must(shape_samples(belly, ratio, held_shortenings, held_activations));
    const ShapeErrors errors = shape_errors(kept, control, samples);
    line += fmt::format("{:>8.1f} {:>5.1f} {:>5.2f} {:>5.2f}", 100 * errors.rms, 100 * errors.worst,
                        1e3 * errors.farthest_m, 100 * errors.volume);
  }
  show("");
  print_note("{}\n", line);
}

/// Also prints the errors for shapes from which the tables were not made.
void write_finite_tables(const std::string& folder, const std::string& only) {
  const auto chosen = find_muscle(only);
  if (!only.empty() && !chosen) throw Stopped(fmt::format("--muscle {}: no such muscle; leave it out for all", only));
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw Stopped(fmt::format("--out {}: {}; give a folder that can be made", folder, failed.message()));
  print_note(
      "shapes that tables were not made from: displacement across off, rms and worst, %; farthest point off, mm; "
      "volume "
      "off, %\n{:<27}{:>26}{:>26}{:>26}\n",
      "", "slenderness 0.9", "1", "1.1");
  for (std::size_t m = 0; m < muscles().size(); ++m) {
    if (chosen && m != static_cast<std::size_t>(*chosen)) continue;
    show_part(std::string(muscles()[m].name), static_cast<double>(m) / static_cast<double>(muscles().size()));
    write_table(static_cast<Muscle>(m), folder);
  }
  say_where(fmt::format("look at {}", folder));
}

}  // namespace

Subcommand fit_shapes_command() {
  auto out = std::make_shared<std::string>("tables");
  auto only = std::make_shared<std::string>();
  Subcommand command{.name = "fit-shapes"};
  command.footer =
      "For those who change the library: a file a muscle, as assets/finite/tables has them. Minutes.\n"
      "Example: mobil fit-shapes --out assets/finite/tables";
  command.options = {{"--out", out.get(), "Folder for the tables, made if missing"},
                     {"--muscle", only.get(), "Only the table of this muscle"}};
  command.empty_refused = true;
  command.run = [out, only] {
    return exit_status_of("fit-shapes", attempt([&] { write_finite_tables(*out, *only); }));
  };
  return command;
}

}  // namespace mobil
