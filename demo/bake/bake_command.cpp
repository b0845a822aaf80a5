// `mobil bake`: what muscles of usual bodies share, made once and written to a file that a game ships.

#include <fmt/format.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <mobil/relevance.h>
#include <mobil/simulation.h>
#include "demo/bake/baked_file.h"
#include "demo/measure/measure.h"
#include "demo/program/commands.h"
#include "demo/program/progress.h"
#include "demo/program/units.h"

namespace mobil {
namespace {

struct BakeText {
  std::string out = "mobil.baked", muscles = "groups", threads = "0";
  bool inertia = false;
};

Result<void> bake(const BakeText& text) {
  const auto threads = parse_count(text.threads, 0, 256);
  if (!threads) return fail(fmt::format("--threads {}: give a whole number of 0 to 256", text.threads));
  const std::filesystem::path file = text.out;
  if (auto place = check_result_place("--out", file); !place) return place;
  const double start_s = wall_now_s();
  Simulation simulation({.threads = static_cast<int>(*threads)});
  RelevanceOptions options;
  options.leg_muscles.inertia = text.inertia;
  Relevance relevance(simulation, options);
  SceneNeeds all;
  all.muscles = text.muscles == "members" ? muscle_members() : muscle_groups();
  all.camera = Viewpoint{};  // who walks towards it needs every method
  if (auto done = relevance.set_scene(all); !done) return done;
  const auto progress = [](std::size_t done, std::size_t of) { show_progress("baking", done, of); };
  auto done = relevance.prepare({}, progress);
  show("");
  if (!done) return done;
  const std::vector<std::byte> bytes = simulation.bake();
  if (auto written = write_baked(file, bytes); !written) return fail("--out " + written.error().message);
  const double made_s = wall_now_s() - start_s;
  Simulation fresh;
  const double before_s = wall_now_s();
  if (auto loaded = fresh.load_baked(bytes); !loaded) return loaded;
  const double loaded_s = wall_now_s();
  const auto person = fresh.spawn({});
  if (!person) return tl::unexpected(person.error());
  const double spawned_s = wall_now_s();
  if (auto added = fresh.add_leg_muscles(*person, options.leg_muscles); !added) return added;
  say_where(fmt::format(
      "written {}: {:.1f} MB, made in {:.1f} s, loaded in {:.1f} ms; a person's first muscles then take {:.2f} ms",
      text.out, 1e-6 * static_cast<double>(bytes.size()), made_s, 1e3 * (loaded_s - before_s),
      1e3 * (wall_now_s() - spawned_s)));
  return {};
}

}  // namespace

Subcommand bake_command() {
  auto text = std::make_shared<BakeText>();
  Subcommand command{.name = "bake"};
  command.footer =
      "Meshes, operators and bases of all methods among which a scene may choose, for bodies of usual build. A "
      "program\n"
      "loads them by Simulation::load_baked and then waits for none of them. The file belongs to this version and to\n"
      "processors that compute alike: others refuse it. What is lacking is still made when it is called for.\n"
      "\nExamples: mobil bake\n"
      "          mobil bake --inertia --out game/assets/mobil.baked\n"
      "          mobil crowd --humans 5000 --baked mobil.baked";
  add_options(
      command,
      {{"--out", &text->out, "FILE to write"},
       {.name = "--muscles", .target = &text->muscles, .help = "Which muscles", .choices = {"groups", "members"}},
       {"--inertia", &text->inertia, "For muscles that feel gravity and their frame's acceleration"},
       {"--threads", &text->threads, "Threads that work, 1 to 256; 0: as many as the machine has"}});
  command.empty_refused = true;
  command.run = [text] { return exit_status_of("bake", bake(*text)); };
  return command;
}

}  // namespace mobil
